/* virga/quality.h - presets of definitions: how much of an effect a device can afford. Needs the Vulkan headers.
 *
 * A preset fills the sizes of a definition and leaves all else as it is: seeds, ticks, what is on. So begin with the
 * default definition, apply a preset, then set what is yours:
 *
 *     virga_scene_def def = virga_default_scene_def();
 *     virga_scene_apply_quality(VIRGA_QUALITY_MEDIUM, &def);
 *     def.with_ground = true;
 *
 * The same rain falls at all qualities: the water that lands is the rate's, and slots that are left out are made up for
 * by the weight of the others. What changes is how far single drops, splashes and cells reach, and how fine maps are.
 *
 *     quality   meant for                                       ticks in a frame, at most
 *     LOW       software Vulkan, phones, small integrated GPUs  2
 *     MEDIUM    integrated GPUs, handheld consoles              3
 *     HIGH      a desktop GPU in a game; sizes are the default  4        (the lens: half resolution)
 *     FILM      pictures that may take seconds                  64
 *
 * With at most 4 ticks of 1/60 s, rain falls at its own speed down to 15 frames per second, and slower below. It never
 * makes a slow frame slower: see also virga_scene_frame.step_budget_ms.
 *
 * Thread-safety: any thread. A NULL pointer is ignored, and so is a quality that does not exist. */
#ifndef VIRGA_QUALITY_H
#define VIRGA_QUALITY_H

#include <virga/lens.h>
#include <virga/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum virga_quality {
    VIRGA_QUALITY_LOW = 0,
    VIRGA_QUALITY_MEDIUM = 1,
    VIRGA_QUALITY_HIGH = 2,
    VIRGA_QUALITY_FILM = 3,
} virga_quality;

/* Returns "low", "medium", "high" or "film", for menus and options; "unknown" for another number. Never NULL. */
VIRGA_API const char *virga_quality_name(virga_quality quality);

/* max_drops, max_impacts, max_streaks, occlusion_size, _cascades and _slants, max_ticks_per_step. */
VIRGA_API void virga_rain_apply_quality(virga_quality quality, virga_rain_def *def);

/* cells, cached_tiles, far_cells, ripple_texels, flow_ticks, max_impacts, max_spawns, max_returned_droplets,
 * max_ticks_per_step. cell_m and ripple_texel_m change too, so that low qualities do not reach less far. */
VIRGA_API void virga_ground_apply_quality(virga_quality quality, virga_ground_def *def);

/* max_splashes, max_droplets, max_spawns, max_returned_droplets, max_ticks_per_step. */
VIRGA_API void virga_splash_apply_quality(virga_quality quality, virga_splash_def *def);

/* cell_m, max_drops, max_texels, max_ticks_per_step. */
VIRGA_API void virga_glass_apply_quality(virga_quality quality, virga_glass_def *def);

/* max_particles, max_cells, max_blocks, max_surfels, max_spray, max_droplets, max_foam, max_width, max_height. There
 * are 16384, 32768, 65536 and 1048576 particles, as in a fluid; a host whose own simulation has more sets it. */
VIRGA_API void virga_water_apply_quality(virga_quality quality, virga_water_def *def);

/* max_particles, max_cells, max_substeps, max_iterations. What fits into so many particles is as fine as
 * virga_fluid_settings.spacing_m: choose it for the water that you add. */
VIRGA_API void virga_fluid_apply_quality(virga_quality quality, virga_fluid_def *def);

/* half_resolution: 1 in all but FILM. */
VIRGA_API void virga_lens_apply_quality(virga_quality quality, virga_lens_def *def);

/* All of these for the effects of a scene, but panes: these are the host's own definitions, see
 * virga_glass_apply_quality. Memory: virga_scene_estimate. Time: virga_scene_cost. */
VIRGA_API void virga_scene_apply_quality(virga_quality quality, virga_scene_def *def);

/* What a scene takes, in device time (ms). */
typedef struct virga_scene_costs {
    float tick_ms;             /* each tick that virga_scene_record runs */
    float frame_ms;            /* all else of virga_scene_record, once a frame: maps, and the prepares of one view */
    float draw_ms;             /* virga_scene_draw of that view */
    VkDeviceSize memory_bytes; /* as virga_scene_estimate */
} virga_scene_costs;

/* Says beforehand what a definition takes on a kind of device, in a storm of 50 mm/h and a view of so many pixels
 * ([1; 16384] each) that its panes fill. Needs no device. virga_timings_get says what it is.
 *
 *  - VK_PHYSICAL_DEVICE_TYPE_CPU: from measured times of software Vulkan on two cores of 2.5 GHz; more cores take less.
 *  - INTEGRATED_GPU, DISCRETE_GPU, VIRTUAL_GPU (as discrete): modelled, and never measured. They follow from the cycles
 *    that a compiler of AMD GPUs counts, for 16 SIMD of 1.6 GHz and for 144 of 2.25 GHz, and 7 us for each dispatch.
 *  - OTHER: as integrated.
 *
 * Good for choosing among presets, not for planning a frame: real scenes are off by a factor of two and more. Not in
 * it: occluders of many triangles, a moving window of the ground (once in some seconds), lamps, and water beyond
 * max_particles.
 *
 * VIRGA_ERROR_INVALID: NULL, another kind or size, or a definition that virga_scene_create would refuse; *costs is all
 * zero then. */
VIRGA_API virga_result virga_scene_cost(const virga_scene_def *def, VkPhysicalDeviceType kind, uint32_t width,
                                        uint32_t height, virga_scene_costs *costs);

#ifdef __cplusplus
}
#endif
#endif
