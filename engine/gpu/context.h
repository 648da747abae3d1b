/* gpu/context.h - a host's device in use, and the few helpers that every effect records with. Internal.
 *
 * A pass is one GLSL file, one pipeline and one call. Buffers and images are made here, named here, counted here,
 * and when they are let go they wait in the graveyard until the frame that used them last has completed. */
#ifndef VIRGA_GPU_CONTEXT_H
#define VIRGA_GPU_CONTEXT_H

#include "core/log.h"
#include "core/memory.h"
#include "core/settings.h"
#include "gpu/functions.h"

#include <virga/vulkan.h>

#define VIRGA_MAX_PASSES     32  /* names that timings tell apart */
#define VIRGA_MAX_QUERIES    512 /* timestamps a frame; passes beyond go untimed */
#define VIRGA_RING_ALIGNMENT 256 /* the largest offset alignment that Vulkan allows a device to ask for */
#define VIRGA_SURE_TEXELS    65536    /* that Vulkan promises to a view of a buffer */
#define VIRGA_MOST_TEXELS    33554432 /* more than any pool has at its largest: 4194304 streaks or sprites of 5 each */

/* A piece of device memory. */
typedef struct virga_memory {
    virga_memory_block block;
    struct virga_memory_page *page; /* NULL: from the host's callback */
    VkDeviceSize size;
    uint32_t type_index;
} virga_memory;

/* Anything that waits in the graveyard. */
typedef struct virga_resource {
    struct virga_resource *next;
    uint64_t last_frame;
    bool retired; /* lies in the graveyard */
    void (*destroy)(struct virga_context *context, struct virga_resource *resource);
} virga_resource;

typedef struct virga_buffer {
    virga_resource resource; /* first */
    VkBuffer buffer;
    VkBufferView texels; /* as R32G32B32A32_UINT, where it was made with the usage of a uniform texel buffer: all of it,
                          * or with small_views as much as a view may have */
    VkDeviceSize size;
    virga_memory memory;
    bool coherent;
} virga_buffer;

typedef struct virga_image_2d {
    virga_resource resource; /* first */
    VkImage image;
    VkImageView view;         /* all layers, as a 2D array */
    VkImageView *layer_views; /* one layer each, as plain 2D */
    uint32_t layers;
    VkExtent2D extent;
    VkFormat format;
    virga_memory memory;
} virga_image_2d;

/* Pipelines that are needed together: nothing that uses them is recorded before all of them are there. */
typedef struct virga_pipeline_group {
    uint32_t waiting;    /* to be built */
    virga_result failed; /* of the first that could not be; VIRGA_OK: none */
} virga_pipeline_group;

typedef struct virga_pipeline {
    virga_resource resource;   /* first */
    VkPipeline pipeline;       /* null while it waits to be built, or where that failed */
    const char *name;          /* static */
    virga_pipeline_group *group; /* (optional) lives as long as this is not let go of */
    struct virga_build *build; /* NULL: nothing is left to be done */
    uint32_t *code;            /* of the fragment shader, where it was changed for the target; until it is built */
    virga_result failed;
} virga_pipeline;

/* Timestamps of one frame in flight. */
typedef struct virga_timer_slot {
    VkQueryPool pool;
    uint64_t frame_index;
    uint32_t count;                       /* queries written */
    uint8_t names[VIRGA_MAX_QUERIES / 2]; /* of the pass that the pair belongs to */
    bool reset;                           /* the pool was reset in this frame */
} virga_timer_slot;

struct virga_context {
    virga_functions vk;
    virga_log log;
    virga_host_heap heap;
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkPipelineCache pipeline_cache;
    VkPhysicalDeviceMemoryProperties memory_properties;
    VkPhysicalDeviceProperties properties;
    virga_device_memory device_memory;
    VkDeviceSize memory_budget;
    VkDeviceSize budget_share; /* of it that may be taken in all for now, 0: all of it */
    bool share_is_wish;        /* not fitting into the share is not yet worth a line in the log */
    bool making;      /* an effect, which no frame has used yet */
    bool may_shrink;  /* if it does not fit into the budget */
    bool over_budget; /* it did not */
    uint32_t frames_in_flight;
    bool debug_names;
    bool lost;
    bool software; /* the device is a processor: forms of passes that were measured to suit it */
    bool lines;    /* what is as wide as a pixel may be drawn as a line: see virga_context_def.wide_lines */
    bool small_views; /* of texels: pools are read from storage buffers, see shaders/gpu/texels.glsl */
    virga_pipelines_when pipelines_when;
    virga_pipeline_jobs pipeline_jobs;
    struct virga_build *builds; /* pipelines to be built, in the order they were asked for */
    virga_result upload_failed; /* the newest flush that did, see virga_uploaded */

    VkSampler nearest, linear; /* clamped to the edge */
    uint64_t frame_index, completed_index;
    uint32_t ring_slot; /* frame_index modulo frames_in_flight, by count of frames begun */
    virga_resource *graveyard;

    struct virga_memory_page *pages;
    VkDeviceSize device_bytes, device_used;
    uint32_t device_allocations, objects;
    uint32_t effects; /* alive */
    uint64_t target_serial;

    bool timings;
    double timestamp_ns;
    uint64_t timestamp_mask;
    virga_timer_slot timers[VIRGA_MAX_FRAMES_IN_FLIGHT];
    virga_pass_time pass_times[VIRGA_MAX_PASSES];
    uint32_t pass_count;
};

/* Logs a failed Vulkan call, remembers a lost device, and gives the result that the API returns. */
virga_result virga_vulkan_failed(virga_context *context, VkResult result, const char *call);

/* One Vulkan call in a function that has `virga_result result` and a label `error`. */
#define VK_TRY(context, call)                                              \
    do {                                                                   \
        const VkResult vk_result_ = (context)->vk.call;                    \
        if (vk_result_ != VK_SUCCESS) {                                    \
            result = virga_vulkan_failed(context, vk_result_, "vk" #call); \
            goto error;                                                    \
        }                                                                  \
    } while (0)

/* One call of ours in such a function. */
#define TRY(call)        \
    do {                 \
        result = (call); \
        if (result < 0)  \
            goto error;  \
    } while (0)

/* An out of host memory result, with its line in the log. */
virga_result virga_out_of_host_memory(virga_context *context, const char *what);

/* Says what was wrong with an argument, and gives VIRGA_ERROR_INVALID. */
virga_result virga_wrong_argument(const virga_log *log, const char *format, ...) VIRGA_PRINTF(2, 3);

/* A draw's VIRGA_NOT_READY. Who looks at errors alone would see nothing and never learn why, so `call` says it once:
 * whoever draws sets `told` back. Where `ready` is not VIRGA_OK, pipelines are on their way and nothing is wrong. */
virga_result virga_not_drawn(virga_context *context, const char *call, bool attached, virga_result ready, bool *told);

/* A host's list in a storage buffer: where it may begin, and that its size (0: not told) holds `least` bytes.
 * `name` is that of the member that holds the buffer; _offset and _size are those beside it. */
virga_result virga_host_list_check(const virga_context *context, const char *name, VkDeviceSize offset,
                                   VkDeviceSize size, VkDeviceSize least);

/* The part of it that is bound: `most` bytes, as far as it reaches and the device allows; VK_WHOLE_SIZE where its size
 * is not told. */
VkDeviceSize virga_host_list_range(const virga_context *context, VkDeviceSize size, VkDeviceSize most);

/* Whether the ticks of a step follow those before it: VIRGA_ERROR_INVALID with a line where they do not. `last` is NULL
 * before the first. */
virga_result virga_ticks_check(const virga_log *log, uint32_t first, uint32_t ticks, const uint32_t *last);

/* ---- memory.c */
virga_result virga_memory_allocate(virga_context *context, const VkMemoryRequirements *requirements,
                                   VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred, bool for_image,
                                   const char *name, virga_memory *memory);
void virga_memory_release(virga_context *context, virga_memory *memory);

/* ---- budget.c */

#define VIRGA_MAX_POOLS 8

/* A size in an effect's definition that may be smaller than it was asked to be. */
typedef struct virga_pool {
    const char *name;
    uint32_t *size, least;
    uint32_t unit; /* it stays a multiple of that; 0: a power of two */
} virga_pool;

/* Makes an effect from its definition, in which the pools lie; with smaller pools, a line in the log and VIRGA_DEGRADED
 * where it does not fit into the memory budget else. `make` leaves nothing behind where it fails. */
virga_result virga_make_in_budget(virga_context *context, const char *what, const virga_pool *pools, uint32_t count,
                                  virga_result (*make)(virga_context *context, const void *def, void **made),
                                  const void *def, void **made);

/* ---- resources.c */

/* Where a buffer lives. */
typedef enum virga_heap_kind {
    VIRGA_HEAP_DEVICE,   /* on the device */
    VIRGA_HEAP_UPLOAD,   /* mapped, written by the host each frame */
    VIRGA_HEAP_READBACK, /* mapped, read by the host */
} virga_heap_kind;

virga_result virga_buffer_create(virga_context *context, VkDeviceSize size, VkBufferUsageFlags usage,
                                 virga_heap_kind heap, const char *name, virga_buffer **buffer);

/* A row of an effect's table of buffers. */
typedef struct virga_buffer_row {
    virga_buffer **buffer;
    VkDeviceSize size; /* 0: not made, an option that is off */
    VkBufferUsageFlags usage;
    virga_heap_kind heap;
    const char *name;
} virga_buffer_row;

/* Makes the buffers of a table, up to the first that can not be made. */
virga_result virga_buffers_create(virga_context *context, const virga_buffer_row *rows, uint32_t count);

/* Lets go of those that were made; sizes and names are not looked at. */
void virga_buffers_retire(virga_context *context, const virga_buffer_row *rows, uint32_t count);

/* `layers` 0: a 3D image of depth 1. */
virga_result virga_image_create(virga_context *context, VkFormat format, VkExtent2D extent, uint32_t layers,
                                VkImageUsageFlags usage, VkImageAspectFlags aspect, const char *name,
                                virga_image_2d **image);

/* Makes what the host wrote visible to the device, or what the device wrote visible to the host. Where that fails it is
 * said in the log, and the call of the API that it is done in ends with virga_uploaded. */
void virga_buffer_flush(virga_context *context, const virga_buffer *buffer, VkDeviceSize offset, VkDeviceSize size);
void virga_buffer_invalidate(virga_context *context, const virga_buffer *buffer);

/* The error of flushes since the last call, VIRGA_OK if there was none; that of a lost device stays. */
virga_result virga_uploaded(virga_context *context);

/* Lets go of a resource (buffer, image, pipeline): at once where every frame begun has completed, else when the newest
 * has. The macro sets the pointer to NULL, and accepts NULL. */
void virga_retire(virga_context *context, virga_resource *resource);
#define VIRGA_RETIRE(context, pointer)                   \
    do {                                                 \
        if (pointer)                                     \
            virga_retire(context, &(pointer)->resource); \
        (pointer) = NULL;                                \
    } while (0)

/* Destroys what completed frames have let go of; all of it where `all`. */
void virga_graveyard_sweep(virga_context *context, bool all);

void virga_set_name(virga_context *context, VkObjectType type, uint64_t handle, const char *name);

/* ---- pipelines.c */
typedef struct virga_spirv {
    const uint32_t *code;
    size_t size; /* bytes */
} virga_spirv;

/* An embedded shader: the array that the build made of shaders/<effect>/<pass>. */
#define VIRGA_SPIRV(name) ((virga_spirv){name##_spv, sizeof name##_spv})

/* What a compute pipeline is built from. `constant` is specialisation constant 0 where the shader has one; constant 1
 * is the context's small_views. */
typedef struct virga_compute_def {
    virga_spirv shader;
    VkPipelineLayout layout;
    uint32_t constant;
    virga_pipeline_group *group; /* (optional) */
    const char *name;            /* static */
} virga_compute_def;

virga_result virga_compute_pipeline_create(virga_context *context, const virga_compute_def *def,
                                           virga_pipeline **pipeline);

/* A row of an effect's table of compute passes. */
typedef struct virga_compute_row {
    virga_pipeline **pipeline;
    virga_spirv shader;
    const char *name;
} virga_compute_row;

/* As virga_buffers_create and virga_buffers_retire. `constant` is every row's, see virga_compute_def. */
virga_result virga_compute_pipelines_create(virga_context *context, VkPipelineLayout layout, uint32_t constant,
                                            virga_pipeline_group *group, const virga_compute_row *rows, uint32_t count);
void virga_compute_pipelines_retire(virga_context *context, const virga_compute_row *rows, uint32_t count);

/* What fragment shaders write beside the colour: bits. Such a shader has a form for each, see shaders/meson.build. */
typedef enum virga_target_outputs {
    VIRGA_OUTPUTS_COLOR = 0,
    VIRGA_OUTPUTS_MOTION = 1,
    VIRGA_OUTPUTS_REACTIVE = 2,
    VIRGA_OUTPUTS_BOTH = 3,
    VIRGA_OUTPUTS_FORMS = 4,
} virga_target_outputs;

/* The four forms of a fragment shader, and the two of a vertex shader, by outputs. */
#define VIRGA_FRAGMENT_FORM(name, outputs)                                   \
    ((outputs) == VIRGA_OUTPUTS_BOTH       ? VIRGA_SPIRV(name##_both)     \
     : (outputs) == VIRGA_OUTPUTS_MOTION   ? VIRGA_SPIRV(name##_motion)   \
     : (outputs) == VIRGA_OUTPUTS_REACTIVE ? VIRGA_SPIRV(name##_reactive) \
                                           : VIRGA_SPIRV(name))
#define VIRGA_VERTEX_FORM(name, outputs) \
    ((outputs) & VIRGA_OUTPUTS_MOTION ? VIRGA_SPIRV(name##_motion) : VIRGA_SPIRV(name))

/* What a graphics pipeline of ours varies in. Holds no pointer that must outlive the call. */
typedef struct virga_graphics_def {
    virga_spirv vertex, fragment;
    VkPipelineLayout layout;
    VkRenderPass render_pass; /* null: dynamic rendering into these formats */
    uint32_t subpass;
    VkFormat color_formats[VIRGA_MAX_ATTACHMENTS], depth_format, stencil_format;
    uint32_t vertex_stride; /* 0: no vertex input; else one vec3 at location 0 */
    uint32_t color_count;   /* those beyond the first are not written but for these: */
    virga_target_outputs outputs; /* of the fragment shader */
    uint32_t motion_attachment, reactive_attachment; /* 0: none */
    bool blend_premultiplied, blend_add;
    bool depth_test, depth_write, reversed_depth;
    bool cull_back;    /* counter-clockwise on the picture is the front */
    bool lines;        /* and not triangles; their width is dynamic */
    uint32_t constant; /* specialisation constant 0 of either shader, where it has one */
    VkSampleCountFlagBits samples;
    virga_pipeline_group *group; /* (optional) */
    const char *name;            /* static */
} virga_graphics_def;

virga_result virga_graphics_pipeline_create(virga_context *context, const virga_graphics_def *def,
                                            virga_pipeline **pipeline);

/* Builds one pipeline: touches the device and nothing of the context's own, so that any thread may call it. `call` gets
 * the name of the call that failed. */
VkResult virga_compute_build(const virga_context *context, const virga_compute_def *def, VkPipeline *pipeline,
                             const char **call);
VkResult virga_graphics_build(const virga_context *context, const virga_graphics_def *def, VkPipeline *pipeline,
                              const char **call);

/* The context's pipeline cache, from a blob of virga_pipeline_cache_get (or NULL). One that is not whole or from
 * another driver or device is ignored, with a line. */
virga_result virga_pipeline_cache_create(virga_context *context, const void *blob, size_t size);

/* ---- builds.c: when pipelines are built - at once, in steps, or by the host's jobs */

/* Builds at once or queues, as the context was told. Exactly one of the two definitions is given; they are copied. On
 * failure the pipeline stays its owner's, to be let go of. */
virga_result virga_pipeline_ask(virga_context *context, virga_pipeline *pipeline, const virga_compute_def *compute,
                                const virga_graphics_def *graphics);

/* VIRGA_OK: all may be bound. VIRGA_NOT_READY: waits to be built. Else why it never will be. */
virga_result virga_pipelines_ready(const virga_pipeline *const *pipelines, uint32_t count);
virga_result virga_group_ready(const virga_pipeline_group *group);

/* Takes in what was built since; the first failure among it, which it logs. On the API's thread. */
virga_result virga_builds_collect(virga_context *context);

/* A pipeline dies before it was built. */
void virga_build_disown(virga_context *context, virga_pipeline *pipeline);

/* Keeps builds that nobody wants any more from starting; true where a job still runs, so that what its pipeline is made
 * of must stay. */
bool virga_builds_hold(virga_context *context);

/* Frees all of them, with the context: no job may run any more. */
void virga_builds_free(virga_context *context);

/* ---- bindings.c: one set of bindings an effect, the same for all of its passes */

#define VIRGA_MAX_BINDINGS 32
#define VIRGA_ALL_STAGES   (VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT)

typedef struct virga_binding_kind {
    VkDescriptorType type;
    VkShaderStageFlags stages;
} virga_binding_kind;

typedef struct virga_bindings {
    virga_resource resource;         /* first */
    const virga_binding_kind *kinds; /* static */
    uint32_t count, sets_per_frame;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet *sets; /* frames_in_flight x sets_per_frame */
} virga_bindings;

/* What a binding is bound to: a buffer (range 0: to its end) or an image view. Neither: it is left as it is. */
typedef struct virga_bound {
    VkBuffer buffer;
    VkDeviceSize offset, range;
    VkBufferView texels;
    VkImageView view;
    VkImageLayout image_layout;
    VkSampler sampler;
} virga_bound;

/* Set layout, pipeline layout (with push constants for all stages where push_bytes is not 0), pool and sets. `kinds`
 * must be static. */
virga_result virga_bindings_create(virga_context *context, const virga_binding_kind *kinds, uint32_t count,
                                   uint32_t sets_per_frame, uint32_t push_bytes, virga_bindings **bindings);

/* Writes set `index` of the frame being recorded; once a frame, before it is bound. */
VkDescriptorSet virga_bindings_write(virga_context *context, virga_bindings *bindings, uint32_t index,
                                     const virga_bound *bound);

/* ---- record.c */

/* Label and timestamps around a pass; `name` is static, e.g. "rain.step". */
typedef struct virga_pass_scope {
    uint32_t query; /* of the end; 0: untimed */
} virga_pass_scope;

virga_pass_scope virga_pass_begin(virga_context *context, VkCommandBuffer cmd, const char *name);

/* The same inside a host's rendering, where no barrier may stand. */
virga_pass_scope virga_draw_begin(virga_context *context, VkCommandBuffer cmd, const char *name);
void virga_pass_end(virga_context *context, VkCommandBuffer cmd, virga_pass_scope scope);

/* A view's viewport (x, y, width, height in pixels) and the scissor around it. */
void virga_draw_area(virga_context *context, VkCommandBuffer cmd, const float viewport[4]);

/* All writes before, in these stages, are seen by all reads and writes after, in those. */
void virga_barrier(virga_context *context, VkCommandBuffer cmd, VkPipelineStageFlags from, VkAccessFlags wrote,
                   VkPipelineStageFlags to, VkAccessFlags reads);

/* What a compute pass does to the buffers and images that it writes. */
#define READ_WRITE (VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT)

/* Between two compute passes. */
void virga_compute_barrier(virga_context *context, VkCommandBuffer cmd);

/* The same where the pass before may also have written how large an indirect dispatch or draw after it is. */
void virga_indirect_barrier(virga_context *context, VkCommandBuffer cmd);

/* One compute pass, of so many workgroups in a row or in columns and rows. */
void virga_dispatch(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t groups);
void virga_dispatch_2d(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t columns,
                       uint32_t rows);

/* One as large as a buffer says at `offset`, e.g. at 0 the head of a list (virga_list_gpu). */
void virga_dispatch_indirect(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                             VkBuffer arguments, VkDeviceSize offset);

/* One of a chain of passes, each of which works on what those before it wrote: a dispatch, then an indirect barrier. */
void virga_dispatch_and_barrier(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                                uint32_t groups);
void virga_dispatch_indirect_and_barrier(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                                         VkBuffer arguments, VkDeviceSize offset);

/* Ordered compaction of the slots of `groups` workgroups, see shaders/gpu/compact_buffers.glsl. The pass that lists has
 * an invocation for each word of 32 slots. Leaves the list ready for a pass over it. */
void virga_record_list(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *find,
                       const virga_pipeline *scan, const virga_pipeline *list, uint32_t groups);

void virga_image_barrier(virga_context *context, VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect,
                         virga_image_state before, virga_image_state after);

/* Before the passes of a call that records outside rendering. */
void virga_timers_reset(virga_context *context, VkCommandBuffer cmd);

/* VIRGA_DEGRADED where the times can not be had, VIRGA_ERROR_DEVICE_LOST where the device is lost. */
virga_result virga_timers_collect(virga_context *context, virga_timer_slot *slot);

/* ---- target.c */
struct virga_target {
    virga_context *context;
    virga_target_def def;
    uint64_t serial; /* another for each target of a context, never used again */
};

/* What a target takes beside the colour. */
virga_target_outputs virga_target_outputs_of(const virga_target *target);

/* A graphics pipeline for a target: fills what the target decides, then creates it. */
virga_result virga_target_pipeline(const virga_target *target, virga_graphics_def def, virga_pipeline **pipeline);

#endif
