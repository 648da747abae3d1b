/* virga/state.h - saves and loads what is simulated: for save games, for seeks, and for films that start in the middle
 * of a storm.
 *
 * A state is a block of bytes. Saving is recorded like everything else: it copies the state into a buffer of the host.
 * When the frame has completed, the host seals the bytes and stores them where it likes; Virga opens no files.
 *
 *     virga_scene_record(scene, cmd, &frame);
 *     virga_scene_save(scene, cmd, &range);                // range.size >= virga_scene_state_bytes(scene)
 *     ... the frame completes ...
 *     virga_state_seal(mapped, bytes, frame_index, &info); // checks that it is whole, and adds the hash
 *
 * and later, in the same program or in another one:
 *
 *     virga_scene_load(scene, cmd, &source);               // before the step of a frame
 *     virga_scene_record(scene, cmd, &frame);              // goes on from it
 *
 * What is in it: all that later steps depend on, e.g. water on the ground, splashes in the air, drops on panes, the
 * wind's phase, the time, and all water balances. What is not: settings, lighting, meshes, materials, targets, and what
 * a prepare makes anew for each view. The host sets these as before.
 *
 * A scene that has loaded a state goes on with the same bits as the scene that saved it, if the calls that follow are
 * the same, on the same device and driver. Software Vulkan gives the same bits for any number of threads, but not for
 * another vector width. Between different devices a state loads too; then the same drops are at the same positions, and
 * later steps differ by rounding, as the devices do. Occlusion maps of the rain are not part of a state: give the
 * occluders in the first frame after a load. They are drawn where they were. Occluders that have moved since then, with
 * occlusion_interval above 1, are the one case in which bits may differ.
 *
 * A scene's state has that of its water: spray that flies on, and foam. The particles are the host's; where a
 * virga_fluid simulates them, it has a state of its own, which the host saves and loads beside the scene's, in the same
 * frame. Bodies are added before the load, the same as before the save; virga_fluid_body_get tells their loaded poses
 * when the first step has completed.
 *
 * A state belongs to a definition: sizes, ticks and seeds must be the same, as they are after the budget has made pools
 * smaller. Settings that the simulation depends on must be the same too, e.g. the rain rate; those that change only the
 * picture may differ. If something differs, the load is refused with one line in the log that names it and both values.
 *
 * Damaged bytes are refused by their hash. The hash does not protect against bytes that somebody made on purpose, so
 * the contents are checked too: what later steps use as an index, a count or a number of workgroups is refused if it is
 * out of range, with a line that names it, its value and the range. Other wrong contents give a wrong picture, or steps
 * that are refused. */
#ifndef VIRGA_STATE_H
#define VIRGA_STATE_H

#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of the format. A library loads only states of its own version. */
#define VIRGA_STATE_VERSION 1

/* Where a state is saved to. */
typedef struct virga_state_range {
    /* A buffer of the host with the usage TRANSFER_DST, and HOST_VISIBLE memory if the host wants to read it without
     * another copy. It must live until the frame has completed. */
    VkBuffer buffer;

    /* In bytes, a multiple of 16. */
    VkDeviceSize offset;

    /* Bytes from `offset` on. At least what virga_..._state_bytes returns; the rest stays as it is. */
    VkDeviceSize size;
} virga_state_range;

/* Where a state is loaded from: the same bytes twice. The call reads the headers on the host, and records
 * copies of the large arrays. With memory that is mapped these are the same memory. */
typedef struct virga_state_source {
    /* The sealed state, `size` bytes, aligned to 8 bytes. */
    const void *bytes;

    VkDeviceSize size;

    /* A buffer with the usage TRANSFER_SRC that holds the same bytes from `offset` on, a multiple of 16. Visible to the
     * device; it must live until the frame has completed. */
    VkBuffer buffer;

    VkDeviceSize offset;
} virga_state_source;

/* What a state says about itself. */
typedef struct virga_state_info {
    /* Of the format. */
    uint32_t version;

    /* Number of effects in it. */
    uint32_t effects;

    /* Bytes of the state. */
    uint64_t bytes;

    /* The host's frame_index of the frame that saved it. */
    uint64_t frame_index;

    /* Of all bytes; 0: not sealed. Two states with the same hash are the same. */
    uint64_t hash;

    /* VkPhysicalDeviceProperties of the device that saved it. */
    uint32_t vendor_id, device_id, driver_version;
} virga_state_info;

/* Checks that a state has arrived whole from the device, computes the hash of its bytes, and writes it into them.
 * `frame_index`: the frame in which it was saved. To be called once the frame has completed. Costs about a second for
 * 2 GB.
 *
 * VIRGA_NOT_READY: the bytes are not the state of that frame, e.g. because the device has not executed the frame.
 * VIRGA_ERROR_INVALID: NULL argument, `bytes` not aligned to 8 bytes, or `size` smaller than the state. `info` may be
 * NULL. Thread-safety: any thread. */
VIRGA_API virga_result virga_state_seal(void *bytes, VkDeviceSize size, uint64_t frame_index, virga_state_info *info);

/* Reads what a sealed state says about itself, and checks its hash. VIRGA_ERROR_INVALID: it is no state of this
 * version, not sealed, cut off or damaged; `reason` (may be NULL) gets one line of up to reason_size bytes. `info` may
 * be NULL. Thread-safety: any thread. */
VIRGA_API virga_result virga_state_read(const void *bytes, VkDeviceSize size, virga_state_info *info, char *reason,
                                        size_t reason_size);

struct virga_scene;
struct virga_rain;
struct virga_ground;
struct virga_splash;
struct virga_glass;
struct virga_water;
struct virga_fluid;

/* Returns the bytes of a state: the sum of what the effects hold, most of it in proportion to their pools. A scene of
 * rain alone has some megabytes; its ground has 80 bytes for each cell and 24 for each cell of the cache; water 2.2 KB
 * for each of max_spray and 64 bytes for each of max_foam; a fluid 40 bytes for each of max_particles. It stays the
 * same for the life of the object. Returns 0 for NULL. */
VIRGA_API VkDeviceSize virga_scene_state_bytes(const struct virga_scene *scene);
VIRGA_API VkDeviceSize virga_rain_state_bytes(const struct virga_rain *rain);
VIRGA_API VkDeviceSize virga_ground_state_bytes(const struct virga_ground *ground);
VIRGA_API VkDeviceSize virga_splash_state_bytes(const struct virga_splash *splash);
VIRGA_API VkDeviceSize virga_glass_state_bytes(const struct virga_glass *glass);
VIRGA_API VkDeviceSize virga_water_state_bytes(const struct virga_water *water);
VIRGA_API VkDeviceSize virga_fluid_state_bytes(const struct virga_fluid *fluid);

/* Records a copy of the state, as it is after all steps that were recorded before. Outside rendering, in any frame, any
 * number of times. The device copies virga_..._state_bytes; nothing waits for it but later steps and the host.
 *
 * VIRGA_NOT_READY: nothing was stepped yet, so there is no state; nothing is recorded. VIRGA_ERROR_INVALID: a NULL
 * argument, an offset that is no multiple of 16, or a range that is too small; the log says which. */
VIRGA_API virga_result virga_scene_save(struct virga_scene *scene, VkCommandBuffer cmd, const virga_state_range *to);
VIRGA_API virga_result virga_rain_save(struct virga_rain *rain, VkCommandBuffer cmd, const virga_state_range *to);
VIRGA_API virga_result virga_ground_save(struct virga_ground *ground, VkCommandBuffer cmd, const virga_state_range *to);
VIRGA_API virga_result virga_splash_save(struct virga_splash *splash, VkCommandBuffer cmd, const virga_state_range *to);
VIRGA_API virga_result virga_glass_save(struct virga_glass *glass, VkCommandBuffer cmd, const virga_state_range *to);
VIRGA_API virga_result virga_water_save(struct virga_water *water, VkCommandBuffer cmd, const virga_state_range *to);
VIRGA_API virga_result virga_fluid_save(struct virga_fluid *fluid, VkCommandBuffer cmd, const virga_state_range *to);

/* Records the load of a state: the object goes on from it with its next step. Outside rendering, before the step of the
 * frame. Views must be prepared again.
 *
 * VIRGA_NOT_READY, and nothing changes: pipelines are missing, see virga_scene_ready. VIRGA_ERROR_INVALID, and nothing
 * changes: the bytes are no sealed state of this version or are damaged, it is the state of other effects, its
 * definition or a setting differs, its contents are out of range, a step was recorded in this frame already, or an
 * argument is wrong. The log says which, with both values.
 *
 * The host reads all bytes twice, for the hash and for the check of the contents: about a second and a half for 2 GB.
 *
 * If the frame is lost, so is the load: the log says so, and the host loads again. */
VIRGA_API virga_result virga_scene_load(struct virga_scene *scene, VkCommandBuffer cmd, const virga_state_source *from);
VIRGA_API virga_result virga_rain_load(struct virga_rain *rain, VkCommandBuffer cmd, const virga_state_source *from);
VIRGA_API virga_result virga_ground_load(struct virga_ground *ground, VkCommandBuffer cmd,
                                         const virga_state_source *from);
VIRGA_API virga_result virga_splash_load(struct virga_splash *splash, VkCommandBuffer cmd,
                                         const virga_state_source *from);
VIRGA_API virga_result virga_glass_load(struct virga_glass *glass, VkCommandBuffer cmd, const virga_state_source *from);
VIRGA_API virga_result virga_water_load(struct virga_water *water, VkCommandBuffer cmd, const virga_state_source *from);
VIRGA_API virga_result virga_fluid_load(struct virga_fluid *fluid, VkCommandBuffer cmd, const virga_state_source *from);

#ifdef __cplusplus
}
#endif
#endif
