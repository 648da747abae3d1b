/* virga/vulkan.h - the context that Virga makes of a host's device; recording, targets, views, memory and timings.
 *
 * The contract in short:
 *  - Virga only records into command buffers of the host. It never submits, never waits, and creates no queue, thread
 *    or surface. It has no global state.
 *  - Recording allocates nothing and compiles nothing.
 *  - It needs Vulkan 1.2 with the features of virga_required_features(), and no extension.
 *  - The library links no Vulkan symbol. All entry points come from the host's vkGetInstanceProcAddr.
 *
 * A frame:
 *
 *     virga_frame_begin(context, frame_index, completed_index);
 *     virga_rain_draw_occlusion(rain, cmd, ...);      // outside rendering
 *     virga_rain_step(rain, cmd, ...);           // outside rendering
 *     virga_rain_prepare(rain, cmd, ...);        // outside rendering, once per view, see virga_prepared
 *     ... host begins rendering its scene ...
 *     virga_rain_draw(rain, cmd, ...);           // inside rendering, after the opaque scene
 *     ... host ends rendering, submits, and reports in a later frame that this one has completed ...
 *
 * "Outside rendering" means outside a render pass and outside dynamic rendering; "inside" means within one.
 *
 * Command buffers belong to the context's queue family. A frame may use one or several of them. They go to one queue,
 * each once, in the order in which they were recorded. A host that throws them away calls virga_frame_dropped. Virga
 * orders its own work by barriers alone. What a host writes (vertex buffers, images of a view) the host must make
 * visible before it calls Virga. What it gives to a frame must live until that frame has completed.
 *
 * What calls change in a command buffer. Nothing is put back: the host sets what it needs again. "compute" is the
 * compute pipeline and its descriptor set 0; "graphics" the graphics pipeline, its descriptor set 0, viewport 0 and
 * scissor 0. The line width changes where the context has wide_lines.
 *
 *     virga_rain_draw                 graphics, index buffer, line width
 *     virga_rain_draw_haze            graphics
 *     virga_splash_draw               graphics, index buffer, line width
 *     virga_glass_draw                graphics, index buffer
 *     virga_glass_draw_refraction     graphics, index buffer
 *     virga_water_draw                graphics
 *     virga_water_draw_data           graphics
 *     virga_water_draw_foam           graphics
 *     virga_ground_draw_wet           graphics
 *     virga_lens_draw                 graphics, push constants
 *     virga_lens_draw_part            graphics, push constants
 *     virga_scene_draw                graphics, index buffer, line width
 *
 *     virga_rain_draw_occlusion       compute, graphics, push constants, index buffer, vertex buffer 0
 *     virga_ground_step               compute, graphics, push constants, index buffer, vertex buffer 0
 *     virga_water_prepare             compute, graphics, push constants
 *     virga_scene_record              compute, graphics, push constants, index buffer, vertex buffer 0
 *     others outside rendering        compute, push constants
 *
 * Those whose names go on (`_parts`, `_view`) change the same. By Vulkan's rules the host's dynamic state that is
 * static in Virga's pipelines (depth bias, blend constants, stencil reference, ...) is no longer set after a draw, nor
 * are descriptor sets of other numbers, as layouts differ. So set these again, too. Virga also records timestamps
 * (`timings`) and debug labels.
 *
 * Handles. Objects are made from a context and belong to it. An object of another context is refused. NULL is accepted
 * by destroy functions, and refused by all others that return a result. A destroy function sets the handle that it is
 * given to NULL. A copy of that handle is not known to the library: to use it afterwards is undefined, as with free().
 * Objects may be destroyed in any order, also while frames use them. Parts of a scene belong to the scene: to destroy
 * one logs a line, and only sets the handle to NULL. Calls may come in any order; one that comes too early is refused,
 * or returns VIRGA_NOT_READY. Handles of Vulkan (command buffers, buffers, images) are not checked.
 *
 * Lists. Effects pass lists to each other through the host, e.g. the impacts of rain to ground. A list whose effect has
 * not stepped yet, or in lost frames only, is empty for the effect that reads it: a step of ground beside rain that has
 * never stepped lets nothing land. A list of an object that was destroyed is refused while frames in flight may use it;
 * afterwards its buffer does not exist. The group_count of a host's own list is used as it is.
 *
 * Thread-safety: calls on one context, and on objects made from it, must not overlap. Different contexts may be used
 * from different threads at the same time, also on the same device.
 */
#ifndef VIRGA_VULKAN_H
#define VIRGA_VULKAN_H

#include <virga/base.h>
#include <vulkan/vulkan.h>

#ifndef VK_API_VERSION_1_2
#error "Virga needs the headers of Vulkan 1.2 or newer; these are older"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Minimum of VkApplicationInfo::apiVersion and of the device's version. */
#define VIRGA_VULKAN_API           VK_API_VERSION_1_2
#define VIRGA_MAX_FRAMES_IN_FLIGHT 8

/* ---- what a device must have ---------------------------------------------------------------------------------- */

/* One required feature: the VkBool32 at `offset` in the Vulkan struct with sType `struct_type`. */
typedef struct virga_feature {
    VkStructureType struct_type; /* VkPhysicalDeviceFeatures2 or VkPhysicalDeviceVulkan12Features */
    size_t offset;               /* of the VkBool32, in bytes from the start of that struct */
    const char *name;            /* as Vulkan spells it */
    const char *why;             /* what Virga uses it for */
} virga_feature;

/* Returns the required features and writes their number to *count (`count` may be NULL). The array is static.
 * Thread-safety: any thread. */
VIRGA_API const virga_feature *virga_required_features(uint32_t *count);

/* Sets each required feature to VK_TRUE in a pNext chain that the host will give to VkDeviceCreateInfo. Changes nothing
 * else. Returns VIRGA_ERROR_INVALID if the chain lacks a struct that holds a required feature. Thread-safety: any
 * thread. */
VIRGA_API virga_result virga_enable_features(VkPhysicalDeviceFeatures2 *chain);

/* Checks whether a physical device can run Virga. With VIRGA_ERROR_UNSUPPORTED, `reason` (may be NULL) gets one line
 * that names what is missing. Creates nothing. Thread-safety: any thread. */
VIRGA_API virga_result virga_check_device(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                          VkPhysicalDevice physical_device, char *reason, size_t reason_size);

/* ---- context: what Virga makes of one host device ------------------------------------------------------------- */

typedef struct virga_context virga_context; /* opaque */

/* A piece of device memory, as the host's callback returns it. */
typedef struct virga_memory_block {
    VkDeviceMemory memory;
    VkDeviceSize offset; /* bytes; aligned as the requirements say */
    void *mapped;        /* host address of `offset`, or NULL if not mapped; must be set where `mapped` was requested */
    void *host_handle;   /* for the host; comes back in `free` */
} virga_memory_block;

/* Callbacks for device memory. Leave all zero: Virga then allocates a few large blocks and suballocates from them.
 * Called from create, destroy and set functions and from virga_frame_begin only, never while recording. */
typedef struct virga_device_memory {
    /* Passed to both callbacks. */
    void *user;

    /* Allocates, fills *block and returns VK_SUCCESS, or returns the error. Virga has chosen `type_index`. `mapped`
     * requests a host address. */
    VkResult (*alloc)(void *user, const VkMemoryRequirements *requirements, uint32_t type_index, bool mapped,
                      virga_memory_block *block);

    /* Frees a block that `alloc` returned. */
    void (*free)(void *user, const virga_memory_block *block);
} virga_device_memory;

/* When the pipelines of effects are built. A scene with all effects has about 100 pipelines (140 with three targets).
 * A driver needs 1 to 80 ms for each one that is not in its caches. Objects of one kind in a context share pipelines: a
 * second pane with the same settings builds none. */
typedef enum virga_pipeline_build_mode {
    /* Inside create and attach, on the calling thread, before they return. For loading screens. */
    VIRGA_PIPELINES_IMMEDIATE = 0,

    /* Create and attach return at once. Each call of virga_pipelines_build builds as many as it is allowed to, e.g. one
     * per frame. */
    VIRGA_PIPELINES_DEFERRED = 1,

    /* Create and attach give each pipeline to the host's job system as a job, see virga_pipeline_jobs. */
    VIRGA_PIPELINES_AS_JOBS = 2,

    /* Inside the recording call that first uses it. For programs in which a frame may take longer: offline renderers,
     * tools, tests. They start faster, because most pipelines are for settings that a program never chooses. A pipeline
     * that can not be built is an error of the call that needs it, and of all later calls of its effect.
     * The render pass of a target must then live as long as the target. */
    VIRGA_PIPELINES_ON_USE = 3,
} virga_pipeline_build_mode;

/* The host's job system.
 *
 * A job counts as done once virga_frame_begin or virga_pipelines_build has seen it. Before virga_context_destroy, all
 * jobs must have returned or must never run any more. An effect may be destroyed before its jobs have run; they then do
 * nothing. */
typedef struct virga_pipeline_jobs {
    /* Passed to `run`. */
    void *user;

    /* Accepts a job. The host must call job(data) exactly once: before `run` returns or at any later time, on any
     * thread, several jobs at the same time if it likes. A job builds one pipeline, takes no lock, and needs about
     * 256 KiB of stack. `run` itself is called on the thread that calls create or attach. */
    void (*run)(void *user, void (*job)(void *data), void *data);
} virga_pipeline_jobs;

/* Which variants of passes run. Some passes exist twice: in the way that is fastest on software Vulkan, and in the way
 * that is fastest on a GPU. States have the same bits with both. Pictures may differ in the last bits of a colour. */
typedef enum virga_pass_variants {
    VIRGA_VARIANTS_OF_DEVICE = 0, /* by the type of the device */
    VIRGA_VARIANTS_SOFTWARE = 1,  /* those for software Vulkan, on any device */
    VIRGA_VARIANTS_GPU = 2,       /* those for GPUs, on any device */
} virga_pass_variants;

/* Arguments of virga_context_create. Fill with virga_default_context_def. */
typedef struct virga_context_def {
    uint32_t size, cookie; /* set by the default function */

    /* Required. */
    VkInstance instance;

    /* Required. */
    VkPhysicalDevice physical_device;

    /* Required. It must have been created with the required features. Vulkan does not report which features were
     * enabled, so only the validation layer shows one that was forgotten. */
    VkDevice device;

    /* Required. */
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;

    /* Family of the queue that the command buffers go to. It must support graphics and compute. Default 0. */
    uint32_t queue_family;

    /* [1; 8] how many frames may be recorded before the first of them has completed. Buffers that the host writes each
     * frame have this many slots. It is independent of any swapchain. Default 3. */
    uint32_t frames_in_flight;

    virga_host_memory host_memory;     /* (optional) */
    virga_device_memory device_memory; /* (optional) */

    /* (optional) Maximum of device memory in bytes; it is never exceeded. An effect that does not fit into what is left
     * gets smaller pools. Its create function then logs which, and returns VIRGA_DEGRADED. If even the smallest pools
     * do not fit, it returns VIRGA_ERROR_DEVICE_MEMORY. Default 0: no limit. */
    VkDeviceSize memory_budget;

    /* (optional) Set it at least while you develop: a result says that something failed, a line says why. Lines of
     * VIRGA_LOG_INFO say on which device it rains and how large objects became. */
    virga_log_fn log;

    /* Passed to `log`. */
    void *log_user;

    /* Passes on every log line, also one that comes again in later frames, see virga_log_fn. For tests. Default
     * false. */
    bool log_repeats;

    /* (optional) A blob from virga_pipeline_cache_get, and its size in bytes. A blob of another driver is ignored. */
    const void *pipeline_cache;
    size_t pipeline_cache_size;

    /* When pipelines are built. Default VIRGA_PIPELINES_IMMEDIATE. */
    virga_pipeline_build_mode pipeline_build_mode;

    /* Required with VIRGA_PIPELINES_AS_JOBS; must be all zero otherwise. */
    virga_pipeline_jobs pipeline_jobs;

    /* The device was created with the feature wideLines. A device without that feature is refused. Streaks and droplets
     * of the minimum width are then drawn as lines instead of quads, where measurements showed that to be faster: on
     * software devices with strictLines, see `variants`. Drawing rain then takes two thirds to three quarters of the
     * time, drawing splashes half to three quarters. The picture is the same. Default false. */
    bool wide_lines;

    /* Which variants of passes run. The log line of the context names them. Other values than
     * VIRGA_VARIANTS_OF_DEVICE are for tests and measurements. Default VIRGA_VARIANTS_OF_DEVICE. */
    virga_pass_variants variants;

    /* Writes timestamps around each pass. Ignored where the queue has no timestamps. Costs two timestamps per pass. On
     * a software device it also costs two barriers per pass, so that passes run one after another. Without timings,
     * effects that have nothing to do with each other share their barriers on GPUs (virga_scene_record), which saves a
     * third of the barriers or more: set false in what you release. Default true. */
    bool timings;

    /* Refuses what Virga could only check with more information: a target for a render pass then needs
     * render_pass_info. For development. Default false. */
    bool strict;

    /* Names objects and labels passes for debuggers. Ignored unless get_instance_proc_addr returns the functions of
     * VK_EXT_debug_utils for the instance. Default true. */
    bool debug_names;
} virga_context_def;

VIRGA_API virga_context_def virga_default_context_def(void);

/* Creates a context: function table, memory, pipeline cache. The VkDevice must outlive it.
 * Errors: INVALID, UNSUPPORTED, HOST_MEMORY, DEVICE_MEMORY, VULKAN, DEVICE_LOST. *context is NULL then. */
VIRGA_API virga_result virga_context_create(const virga_context_def *def, virga_context **context);

/* Destroys the context and sets *context to NULL. Accepts NULL and a pointer to NULL. The device must have completed
 * all work that was recorded with the context. All effects, scenes and targets made from it should have been destroyed
 * before. Otherwise it logs VIRGA_LOG_LIVE_OBJECTS, and the context ends with the last of them, which the VkDevice must
 * outlive. Until then calls on them return VIRGA_ERROR_DEVICE_LOST. */
VIRGA_API void virga_context_destroy(virga_context **context);

/* Begins a frame. Frees what completed frames used, and reads back their timings and statistics. Costs microseconds.
 *
 * `frame_index` must be greater than that of the call before, by any amount; the first is 1 or more.
 * `completed_index` is the last frame whose work the device has completed; 0 if there is none yet. It must not fall.
 * At most frames_in_flight frames may be open: frame_index - completed_index <= frames_in_flight. Else the call returns
 * VIRGA_ERROR_INVALID.
 *
 * Never report a frame as completed while the device still runs it. Virga cannot detect that. It would free what the
 * frame uses, and at best the driver would crash. A host with N command buffers, which waits for a buffer's fence
 * before it records into it again, knows that frame_index - N has completed (0 while there is no such frame).
 *
 * VIRGA_DEGRADED: the frame has begun, but its timings could not be read. */
VIRGA_API virga_result virga_frame_begin(virga_context *context, uint64_t frame_index, uint64_t completed_index);

/* Reports between two frames that a frame has completed. For hosts that wait for the device, e.g. offline renderers:
 * the timings and statistics of that frame are then available at once. Frees nothing. `completed_index` must not fall,
 * and must not pass the newest frame that has begun (VIRGA_ERROR_INVALID). */
VIRGA_API virga_result virga_frame_completed(virga_context *context, uint64_t completed_index);

/* Tells that the device will never execute what was recorded in a frame: the host has thrown its command buffers away.
 *
 * It is an error to submit them after that. Virga records what later frames need again, e.g. uploads and first
 * contents. The time that was stepped in the frame is skipped: no drop lands in it. Call it before the next
 * virga_frame_begin. Then the next frame already contains what is missing.
 *
 * A host that does not call it gets a complete picture again, too: each call leaves a mark when the device executes it.
 * If one is missing when the frame is completed, all is recorded again. Until then, frames in flight may show less. So
 * it is with a part of a frame that is lost with all that needs it: prepares need their step, draws their prepare.
 *
 * A dropped frame counts as completed once all frames before it have: report it so. `frame_index` must have begun and
 * not be completed (VIRGA_ERROR_INVALID). Costs microseconds. */
VIRGA_API virga_result virga_frame_dropped(virga_context *context, uint64_t frame_index);

/* Number of frames of which the device has not executed some or all, since the context was created. 0 for NULL. */
VIRGA_API uint64_t virga_frames_lost(const virga_context *context);

/* Builds pipelines that wait, and collects those that jobs have built.
 *
 * With VIRGA_PIPELINES_DEFERRED it builds up to `max_count` of them, oldest first, on this thread. With jobs it builds
 * none. With VIRGA_PIPELINES_ON_USE it builds as many ahead of their use; no call waits for those that are left.
 * *remaining (optional) gets the number of pipelines that are still missing.
 *
 * While pipelines of an effect are missing, its recording calls record nothing and return VIRGA_NOT_READY, and no
 * simulated time passes for it; but with VIRGA_PIPELINES_ON_USE they build what they need.
 *
 * Returns VIRGA_OK if none is missing, VIRGA_NOT_READY if some are. Returns VULKAN, HOST_MEMORY, DEVICE_MEMORY or
 * DEVICE_LOST if one could not be built; its effect returns the same error from then on.
 *
 * Costs what the driver needs for the pipelines; microseconds where `max_count` is 0. The render pass of a target must
 * live until its pipelines are built. */
VIRGA_API virga_result virga_pipelines_build(virga_context *context, uint32_t max_count, uint32_t *remaining);

/* Reads the pipeline cache. Call it with `data` NULL to get the size in bytes, then with a buffer of *size bytes. */
VIRGA_API virga_result virga_pipeline_cache_get(virga_context *context, size_t *size, void *data);

/* Live objects and memory. Just before virga_context_destroy only the context's own objects are left. */
typedef struct virga_memory_stats {
    VkDeviceSize device_bytes;   /* allocated from the device or from the host's callback */
    VkDeviceSize device_used;    /* bytes of these that buffers and images use */
    uint32_t device_allocations; /* live VkDeviceMemory objects or blocks of the host */
    uint32_t objects;            /* live Vulkan objects of any kind */
    size_t host_bytes;           /* live host memory */
    uint32_t host_allocations;   /* live blocks of host memory */
} virga_memory_stats;

VIRGA_API void virga_memory_get(const virga_context *context, virga_memory_stats *stats);

/* Device time of one pass, from the newest completed frame that recorded it.
 *
 * The time runs from the moment the device reaches the pass until everything up to its end is done. On a GPU no barrier
 * separates passes for this. Neighbours may overlap, also with the host's work recorded just before, so times may add
 * up to more than the frame took. On a software device passes are timed one after another, and draws inside the host's
 * rendering not at all: they are rasterised only when it ends. */
typedef struct virga_pass_time {
    const char *name;     /* e.g. "rain.step"; static */
    double milliseconds;  /* sum over all dispatches or draws of that name in the frame */
    uint64_t frame_index; /* the frame that it was measured in */
} virga_pass_time;

/* Copies up to `capacity` pass times, and returns how many there are. They are late by the frames in flight. */
VIRGA_API uint32_t virga_timings_get(const virga_context *context, virga_pass_time *times, uint32_t capacity);

/* ---- images, targets and views -------------------------------------------------------------------------------- */

/* How an image is used at a point in time: what a barrier needs to know. */
typedef struct virga_image_state {
    VkImageLayout layout;
    VkPipelineStageFlags stage;
    VkAccessFlags access;
} virga_image_state;

/* A host's image that Virga samples. It must have VK_IMAGE_USAGE_SAMPLED_BIT. All zero: no image.
 *
 * Virga records no barrier for it. When the device executes the call that takes the image, it must be in the layout of
 * `before`, with its contents visible to shaders. It must stay so until all draws that use it are done. */
typedef struct virga_image {
    /* In views, an image without `view` and a `view` without its image are refused. */
    VkImage image;

    /* Covers all layers and levels that are to be read. */
    VkImageView view;

    /* Format of `view`. VK_FORMAT_R32G32B32A32_SFLOAT is read without filtering, all others with linear filtering. In
     * views, formats of integers are refused. */
    VkFormat format;

    /* Read by virga_rain_import_occlusion only. */
    VkExtent3D extent;
    uint32_t layers;

    /* Its state while it is read. layout: not UNDEFINED. stage (of virga_view.color only): destination stage of the
     * host's barrier, which Virga's compute passes then wait for too; 0 means fragment shaders. */
    virga_image_state before;

    /* Not read. */
    virga_image_state after;
} virga_image;

/* How the values of a picture stand for light. An image or attachment of an _SRGB format is linear here: the device
 * converts it. */
typedef enum virga_encoding {
    /* As linear. A target that is known to have a UNORM format of up to 10 bits then logs a warning. */
    VIRGA_ENCODING_NOT_GIVEN = 0,
    VIRGA_ENCODING_LINEAR = 1,

    /* Linear light through the curve of sRGB (IEC 61966-2-1): a swapchain of a plain UNORM format, into which a host
     * writes colors as the screen shows them. */
    VIRGA_ENCODING_SRGB = 2,
} virga_encoding;

/* Describes what draws go into. A target is an object of its own: to change formats, make another one. The state of
 * the simulation does not depend on it. */
typedef struct virga_target virga_target; /* opaque */

#define VIRGA_MAX_ATTACHMENTS 8

typedef enum virga_target_kind {
    VIRGA_TARGET_RENDER_PASS = 0, /* a VkRenderPass of the host, and a subpass */
    VIRGA_TARGET_DYNAMIC = 1,     /* dynamic rendering: Vulkan 1.3 or VK_KHR_dynamic_rendering, enabled by the host */
} virga_target_kind;

typedef struct virga_target_def {
    uint32_t size, cookie;

    virga_target_kind kind;

    /* (render pass) Must live until the last attach of the target has returned and its pipelines are built. The pass
     * that is drawn in must be compatible with it. */
    VkRenderPass render_pass;

    /* (render pass) Index of the subpass. */
    uint32_t subpass;

    /* (render pass, optional) What `render_pass` was created with. Vulkan can not be asked for it, so without it a
     * subpass that does not exist, other samples or formats of integers are found by the validation layer at best, and
     * crash some drivers. With it, wrong members of this definition are refused, each with a line that says what was
     * expected. Only read in virga_target_create. Default NULL. */
    const VkRenderPassCreateInfo *render_pass_info;

    /* (render pass) A number of your choice for render passes that are compatible with each other (Vulkan's chapter
     * "Render Pass Compatibility"), e.g. those of the same code before and after a resize. Targets with the same
     * number, and otherwise equal definitions, share pipelines: after the first one, attach compiles nothing. Render
     * passes that are not compatible must have different numbers; Virga cannot check that. Dynamic targets are always
     * shared if they are equal. Default 0: this target shares with none. */
    uint64_t render_pass_class;

    /* Format of each color attachment.
     * (dynamic) VK_FORMAT_UNDEFINED for an attachment that the host has left out. Attachment 0 is required.
     * (render pass) Optional: formats that are given are checked.
     * Attachment 0 gets premultiplied linear radiance and coverage, by blending. A format that the device cannot blend
     * is refused. Use a float or an _SRGB format, or say in `encoding` that the values are encoded. */
    VkFormat color_formats[VIRGA_MAX_ATTACHMENTS];

    /* (dynamic) VK_FORMAT_UNDEFINED: no depth attachment. */
    VkFormat depth_format;

    /* (dynamic) VK_FORMAT_UNDEFINED: no stencil attachment. */
    VkFormat stencil_format;

    /* [1; VIRGA_MAX_ATTACHMENTS] color attachments of the pass. Only attachment 0 and the two below are written.
     * Default 1. */
    uint32_t color_count;

    /* [1; color_count - 1], or 0 for none. Draws write motion vectors into the first two channels of this attachment,
     * see virga_temporal. The format needs two or more float channels and must be blendable; R16G16_SFLOAT always is.
     * Costs other shaders, about 16 bytes and a few operations per streak, sprite or vertex. Costs nothing where it is
     * 0. Default 0. */
    uint32_t motion_attachment;

    /* [1; color_count - 1], or 0 for none. Draws write the reactive mask into the first channel of this attachment,
     * see virga_temporal. R8_UNORM can always be blended. Must not be motion_attachment. Default 0. */
    uint32_t reactive_attachment;

    /* One of Vulkan's sample counts, else refused. Default 1. */
    VkSampleCountFlagBits samples;

    /* The pass has a depth attachment, and draws are tested against it. Set it to false where the pass has none.
     * Default true. */
    bool depth_attached;

    /* (depth_attached) Draws also write the depth of what they cover. For a pass of its own, which draws a layer again
     * for a lens that blurs it by its depth; colors blend wrong in it. Haze has no depth and writes none. Default
     * false. */
    bool depth_written;

    /* Greater depth is nearer. Default false. */
    bool reversed_depth;

    /* The view mask of the subpass (VkRenderPassMultiviewCreateInfo) or of dynamic rendering (viewMask): a pass that
     * draws several views at once, each into its own layer, as for stereo. Each draw then belongs to one of them, see
     * virga_view.multiview_index. Needs the feature multiview of Vulkan 1.1, which the host enables; a device without
     * it is refused with VIRGA_ERROR_UNSUPPORTED. Draws in such a pass have no times (virga_timings_get). Default 0: a
     * pass of one view. */
    uint32_t view_mask;

    /* How attachment 0 holds color. With VIRGA_ENCODING_SRGB, draws and the lens's picture are encoded in the shader,
     * which costs some operations per pixel; with an _SRGB format that is refused. Data (virga_glass_draw_refraction,
     * virga_water_draw_data) are never encoded. Default VIRGA_ENCODING_NOT_GIVEN.
     *
     * Blending then takes place between encoded values, where light does not add up. Virga allows for that: what it
     * draws is exact where it covers all of a pixel, and over a background of the light blend_background. Where it only
     * adds a little light to a background of a tenth of that, it adds a quarter of what it should, and to one of five
     * times that about 2.6 times as much. To have it exact everywhere, draw into a float target and encode the whole
     * picture afterwards. */
    virga_encoding encoding;

    /* (VIRGA_ENCODING_SRGB) [0.0001; 1] linear light behind the water for which blending is exact: about the middle of
     * the picture's. 0.02 suits a night. Default 0.18. */
    float blend_background;
} virga_target_def;

VIRGA_API virga_target_def virga_default_target_def(void);

/* Creates a target. Each effect then builds its pipelines for it once, e.g. with virga_rain_attach. There is no limit
 * to the number of targets. Errors as virga_context_create. */
VIRGA_API virga_result virga_target_create(virga_context *context, const virga_target_def *def, virga_target **target);

/* Destroys the target and sets *target to NULL. Accepts NULL. Frames in flight may still use it. The next
 * virga_frame_begin releases the pipelines that effects built for it, unless another target shares them by then. So at
 * a resize it makes no difference whether the old target is destroyed before or after the new one is created. */
VIRGA_API void virga_target_destroy(virga_target **target);

/* What temporal anti-aliasing and upscaling need to know about rain, splashes and panes. For targets with a motion or a
 * reactive attachment.
 *
 * Motion vectors. A motion vector leads from where a point is on the picture to where it was when the previous frame
 * was drawn. Its unit is pixels of the viewport (right, down) times `motion_scale`, without jitter. What is seen
 * through drops on a pane gets the motion of its image in the drop. That image moves with the scene behind it, but
 * less, by as much as the drop shrinks it.
 *
 * Where water covers a part of a pixel, two things move in it, but it has one motion vector. Water writes its own
 * vector where it covers at least `motion_coverage` of the pixel. Elsewhere the vector of the scene stays. The two are
 * never mixed, because a mean of two motions matches neither.
 *
 * Physical rain covers a few hundredths of a pixel, so for most of its streaks the reactive mask does the work. In
 * tests/rain/test_rain_temporal.c, vectors of streaks from a coverage of 1/20 on, with a gain of 1, double the error:
 * they drag the wall behind them along.
 *
 * Reactive mask. Its value is 1 - (1 - coverage)^reactive_gain, blended over what is there. It says how little the
 * pixel's history is worth. With a gain of 1 it is the coverage itself. Thin streaks that are much brighter than what
 * is behind them need more, up to 16; then more of the edges behind them flicker. On panes the mask is the coverage,
 * with a gain of 1, times how far the water's image moves in a frame against the pane or against what is behind it;
 * half a pixel counts as the full coverage. Drops at rest keep their history.
 *
 *     technique           direction      unit        motion_scale            reactive mask
 *     FSR 2 and 3         now to before  pixels      1, 1                    reactive, at most 0.9
 *                                                    (motionVectorScale 1, 1; no jitter cancellation)
 *     DLSS                now to before  pixels      1, 1                    bias current color
 *                                                    (InMVScale 1, 1; not jittered)
 *     TAA, before = uv + m               uv, v down  1 / width, 1 / height   1 - weight of history
 *     TAA, before = uv - m               uv, v down  -1 / width, -1 / height likewise
 *     compositing         before to now  pixels      -1, -1                  -
 *
 * The mask says where water is, not where it was. A resolve without a neighbourhood clamp therefore keeps what has left
 * the pixel. Such a resolve should use the larger of this frame's mask and the last one's at the pixel's history.
 *
 * Within one pass, the last draw that covers enough gives the vector. Haze writes neither vector nor mask. */
typedef struct virga_temporal {
    /* The camera of the previous frame. These three are as open_position_m, open_view_from_world and
     * open_clip_from_view of virga_view. clip_from_view contains the jitter of this frame, so that jitter is no motion.
     * If clip_from_view is all zero (default), the open camera and its time are used as the previous frame's. */
    double position_m[3];
    float view_from_world[16];
    float clip_from_view[16];

    /* [0; 1] time from the previous frame's draw time to this one's (s). 0: open_camera_s, or shutter_s if that is 0
     * too. Default 0. */
    double frame_interval_s;

    /* Scale of motion vectors, see the table. Not 0. Default 1, 1. */
    float motion_scale[2];

    /* (0; 1] coverage from which on water writes its own vector. Default 0.5. */
    float motion_coverage;

    /* [0; 64] exponent of the reactive mask. Default 8. */
    float reactive_gain;

    /* (optional) Motion vectors of the opaque scene: in the target's pixels, with motion_scale, single-sampled. Sampled
     * where panes refract. It must not be the attachment that is drawn into. `before` is the layout while drawing, and
     * stays. image VK_NULL_HANDLE: what is behind stands still, and only the camera moves. */
    virga_image motion;
} virga_temporal;

/* What a camera sees at the end of the shutter time. Fill with virga_default_view.
 *
 * Calls that take a view refuse one with wrong numbers: a matrix that is no rotation (to 2 %), or no perspective
 * projection with w = -z (elements up to 1e7, the first two of the diagonal from 1e-4 up); times and viewports that are
 * out of range. A viewport of less than a pixel gives VIRGA_NOT_READY and one log line; nothing is prepared. */
typedef struct virga_view {
    uint32_t size, cookie;

    /* Position of the camera in the world. Double, so that it may be far from the origin. */
    double position_m[3];

    /* Only the rotation is read. The translation is taken from position_m. */
    float view_from_world[16];

    /* Projection, including the jitter. Vulkan clip space: y down, depth 0 to 1. A host that averages sub-frames of one
     * shutter time prepares rain without jitter: streaks are smooth by themselves, and a streak of jittered parts would
     * be kinked. */
    float clip_from_view[16];

    /* The open camera: the same three at the start of the shutter time. In a game, the camera of the previous frame.
     * open_clip_from_view contains the jitter of this frame, so that jitter does not show as motion. */
    double open_position_m[3];
    float open_view_from_world[16];
    float open_clip_from_view[16];

    /* [0; 1] how long the shutter is open before the time drawn (s). Streaks are as long as drops fall in that time.
     * Default 1/96. Half a frame is 1/48 in film, and 1/120 in a game with 60 frames per second. */
    double shutter_s;

    /* [1; 65536] number of views that are averaged into one picture, each with a shutter of shutter_s right behind the
     * one before. Rain covers in each view what makes their mean equal to one view with the whole shutter time, so that
     * more views do not show less rain. Default 1. */
    uint32_t sub_frames;

    /* [-16; 16] jitter that clip_from_view and open_clip_from_view contain (pixels, right and down), for a host that
     * averages sub-frames. Droplets in motion are drawn without it, as rain is: they have soft edges by themselves, and
     * the parts of their streaks then meet. A game whose TAA takes the jitter back leaves it 0. Default 0, 0. */
    float jitter_px[2];

    /* [0; 1e9] time from the open camera to the time drawn (s). 0: shutter_s. A game whose open camera is that of the
     * previous frame gives the time between the two frames; else its motion would count as that of the shorter shutter.
     * Default 0. */
    double open_camera_s;

    /* [0; 1] diameter of the lens opening (m). Streaks nearer or farther than focus_m get as wide as the lens blurs a
     * point there, with the same coverage in all. With `depth`, the scene's edges before them are as blurred; without
     * it an attached depth buffer cuts them. A 50 mm lens at f/2 has 0.025. All other water is as sharp as the scene.
     * Default 0: everything is sharp. */
    float aperture_m;

    /* [0; 1e6] view depth that is sharp (m). 0: infinity. Default 0. */
    float focus_m;

    /* x, y, width and height in pixels, within the limits of the device. Draws set it. A negative height counts as no
     * pixels: a host that flips the picture negates element [1][1] of the projection instead. */
    float viewport[4];

    /* Greater depth is nearer. Must match clip_from_view, else the view is refused, and the targets with depth that it
     * is drawn into, else the draw is. The projection may have no far plane. Default false. */
    bool reversed_depth;

    /* [0; 31] the view of a multiview pass (gl_ViewIndex) that draws of this one show in. Draw each view once in the
     * pass, e.g. by virga_scene_draw_view; that costs vertices that are nowhere in the other views, but no pixels.
     * `depth` and `color` show the layer of this view alone. Not read for other passes. Default 0. */
    uint32_t multiview_index;

    /* (optional) Depth of the scene in the target's pixels: a single-sample view of the depth aspect. Sampled for
     * occlusion by the scene (also where a target has no depth attachment), for soft edges and for haze. `before` is
     * its layout and access while drawing, and stays. If it is also an attachment of the pass, it must be read-only
     * with VK_ATTACHMENT_STORE_OP_NONE, because a store counts as a write in any layout. image VK_NULL_HANDLE: hard
     * edges by the depth test, and no haze. */
    virga_image depth;

    /* (optional) Color of the opaque scene in the target's pixels: radiance, single-sampled. Sampled where water
     * refracts what is behind it. `before` is its layout and access while drawing, and stays. The image of the previous
     * frame will do if it has no drops of panes in it; films would show those again and again. image VK_NULL_HANDLE:
     * refraction shows the environment instead. */
    virga_image color;

    /* How `color` holds radiance. Encoded colors are decoded after they are filtered; a format of _SRGB is refused with
     * VIRGA_ENCODING_SRGB. Default VIRGA_ENCODING_NOT_GIVEN: linear. */
    virga_encoding color_encoding;

    /* For motion vectors and the reactive mask: the previous frame, and what is written. */
    virga_temporal temporal;
} virga_view;

VIRGA_API virga_view virga_default_view(void);

/* Largest max_views of a definition. */
#define VIRGA_MAX_VIEWS 8

/* A view that an effect has prepared in this frame: a number that its draws take. 0: none.
 *
 * For one view at a time it is not needed: draw without it draws what was prepared last. Several views (split screen,
 * portals, stereo, mirrors) live in one frame side by side if the effect was created for them, by max_views in its
 * definition:
 *
 *     virga_prepared left, right;                                       // outside rendering
 *     virga_rain_prepare_view(rain, cmd, &left_view, time_s, &left);
 *     virga_rain_prepare_view(rain, cmd, &right_view, time_s, &right);
 *     virga_rain_draw_view(rain, cmd, target, left);                    // inside rendering, in any order, also twice
 *     virga_rain_draw_view(rain, cmd, target, right);
 *
 * In a multiview pass it is the same: each view is prepared with its own multiview_index, and drawn once.
 *
 * It is valid from its prepare to the end of the frame, or until max_views further prepares or a step of the effect. A
 * draw refuses any other, and one of another effect, with VIRGA_ERROR_INVALID. */
typedef uint64_t virga_prepared;

#ifdef __cplusplus
}
#endif
#endif
