/* virga/vulkan.h - a host's device, taken into use; the recording contract; targets, views, memory and timings.
 *
 * The contract in short: Virga records into the host's command buffers and does nothing else. It never submits,
 * waits, creates queues, threads or surfaces, and keeps no globals. Recording allocates and compiles nothing.
 * Vulkan 1.2 with the features of virga_required_features() and no extension. The library links no Vulkan symbol:
 * all entry points come from the host's vkGetInstanceProcAddr.
 *
 * A frame:
 *
 *     virga_frame_begin(context, frame_index, completed_index);
 *     virga_rain_occlusion(rain, cmd, ...);      // outside rendering
 *     virga_rain_step(rain, cmd, ...);           // outside rendering
 *     virga_rain_prepare(rain, cmd, ...);        // outside rendering, once a view
 *     ... host begins rendering its scene ...
 *     virga_rain_draw(rain, cmd, ...);           // inside rendering, after the opaque scene
 *     ... host ends, submits, and says in a later frame that this one completed ...
 *
 * Command buffers are of the context's queue family, one or several a frame; they go to one queue in the order they
 * were recorded in, each once. Virga orders its own work by barriers alone. What a host writes (vertex buffers, images
 * of a view) it makes visible itself before Virga's call, and what a frame was told of lives until that frame has
 * completed.
 *
 * Thread-safety: calls on one context and on what was made from it must not overlap; different contexts, also on
 * one device, may be used from different threads at once.
 */
#ifndef VIRGA_VULKAN_H
#define VIRGA_VULKAN_H

#include <virga/base.h>
#include <vulkan/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VIRGA_VULKAN_API VK_API_VERSION_1_2 /* least VkApplicationInfo::apiVersion and device version */
#define VIRGA_MAX_FRAMES_IN_FLIGHT 8

/* ---- what a device must have ---------------------------------------------------------------------------------- */

/* One required feature: the VkBool32 at `offset` in the Vulkan struct with sType `struct_type`. */
typedef struct virga_feature {
    VkStructureType struct_type; /* VkPhysicalDeviceFeatures2 or VkPhysicalDeviceVulkan12Features */
    size_t offset;               /* of the VkBool32, from the start of that struct */
    const char *name;            /* as Vulkan spells it */
    const char *why;             /* what Virga uses it for */
} virga_feature;

/* The required features, `*count` of them (count may be NULL); static data. Thread-safety: any thread. */
VIRGA_API const virga_feature *virga_required_features(uint32_t *count);

/* Sets each required feature to VK_TRUE in the structs of a pNext chain that is to go into VkDeviceCreateInfo; it
 * changes nothing else. Returns VIRGA_ERROR_INVALID if the chain lacks a struct that a feature lives in.
 * Thread-safety: any thread. */
VIRGA_API virga_result virga_enable_features(VkPhysicalDeviceFeatures2 *chain);

/* Whether a physical device can run Virga. On VIRGA_ERROR_UNSUPPORTED `reason` (may be NULL) gets one line that
 * names what is missing. Creates nothing. Thread-safety: any thread. */
VIRGA_API virga_result virga_check_device(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                          VkPhysicalDevice physical_device, char *reason, size_t reason_size);

/* ---- a context: one host device taken into use ---------------------------------------------------------------- */

typedef struct virga_context virga_context; /* opaque */

/* Where a piece of device memory lives, as the host's callback hands it out. */
typedef struct virga_memory_block {
    VkDeviceMemory memory;
    VkDeviceSize offset; /* aligned as asked */
    void *mapped;        /* host address of `offset`, or NULL if not mapped; required for host-visible requests */
    void *host_handle;   /* the host's own, given back to `free` */
} virga_memory_block;

/* Device memory from the host's allocator. Leave all zero and Virga takes few large blocks and suballocates.
 * `alloc` returns VK_SUCCESS and fills *block. `type_index` was chosen by Virga; `mapped` says that a host address
 * is needed. Called in create, destroy, set and frame_begin only, never while recording. */
typedef struct virga_device_memory {
    void *user;
    VkResult (*alloc)(void *user, const VkMemoryRequirements *requirements, uint32_t type_index, bool mapped,
                      virga_memory_block *block);
    void (*free)(void *user, const virga_memory_block *block);
} virga_device_memory;

/* When the pipelines of effects are built. A scene of all effects has some 100 (140 with three targets); a driver takes
 * 1 to 80 ms for each that its caches do not know. */
typedef enum virga_pipelines_when {
    VIRGA_PIPELINES_AT_ONCE = 0,  /* in create and attach, on their thread, before they return: for loading screens */
    VIRGA_PIPELINES_IN_STEPS = 1, /* create and attach return at once; virga_pipelines_build builds as many as it is
                                   * told, e.g. one a frame */
    VIRGA_PIPELINES_AS_JOBS = 2,  /* create and attach hand each to the host's job system (virga_pipeline_jobs) */
} virga_pipelines_when;

/* The host's job system. `run` takes a job, which the host calls once as job(data), at any later time (or before `run`
 * returns) and on any thread, several at once if it likes; each calls the device for a pipeline, takes no lock and
 * needs about 256 KiB of stack. `run` is called on the thread of create and attach.
 * A job counts as done when virga_frame_begin or virga_pipelines_build have seen it. All jobs must have returned, or be
 * forgotten, before virga_context_destroy; effects may be destroyed before theirs have run, which then do nothing. */
typedef struct virga_pipeline_jobs {
    void *user;
    void (*run)(void *user, void (*job)(void *data), void *data);
} virga_pipeline_jobs;

/* What virga_context_create needs. Fill with virga_default_context_def. */
typedef struct virga_context_def {
    uint32_t size, cookie; /* set by the default function */

    VkInstance instance;                               /* required */
    VkPhysicalDevice physical_device;                  /* required */
    VkDevice device;                                   /* required, made with the required features. Which were enabled
                                                        * Vulkan does not tell: one that was forgotten shows in the
                                                        * validation layer alone */
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;  /* required */
    uint32_t queue_family; /* family of the queue that the command buffers go to; graphics and compute, else refused.
                            * Default 0 */

    uint32_t frames_in_flight; /* [1; 8] how many frames may be recorded before the first is complete. Default 3.
                                * Host-written rings have this many places; it has nothing to do with a swapchain */

    virga_host_memory host_memory;     /* (optional) */
    virga_device_memory device_memory; /* (optional) */
    VkDeviceSize memory_budget;        /* (optional) most device memory in bytes, never passed. An effect that does not
                                        * fit into what is left is made with smaller pools, says which, and its create
                                        * returns VIRGA_DEGRADED; VIRGA_ERROR_DEVICE_MEMORY where the smallest does not
                                        * fit. 0 means no limit */

    virga_log_fn log; /* (optional) */
    void *log_user;

    const void *pipeline_cache;  /* (optional) a blob from virga_pipeline_cache_get; a stale one is ignored */
    size_t pipeline_cache_size;

    virga_pipelines_when pipelines;    /* default VIRGA_PIPELINES_AT_ONCE */
    virga_pipeline_jobs pipeline_jobs; /* required with VIRGA_PIPELINES_AS_JOBS, else all zero */

    bool wide_lines;   /* the device was made with the feature wideLines (one that lacks it is refused). Streaks and
                        * droplets that are no wider than the least that is drawn are lines then where that was measured
                        * to be quicker, which is on software devices with strictLines: rain takes two thirds to three
                        * quarters of the time to draw, splashes half to three quarters. The picture is the same.
                        * Default false */
    bool timings;      /* write timestamps around each pass; default true, ignored where the queue has none. Costs two
                        * timestamps a pass; on a software device also two barriers, so that passes run one by one */
    bool debug_names;  /* name objects and label passes where VK_EXT_debug_utils is enabled: where
                        * get_instance_proc_addr gives its functions for the instance. Default true */
} virga_context_def;

VIRGA_API virga_context_def virga_default_context_def(void);

/* Takes a device into use: function table, memory, pipeline cache. The VkDevice must outlive the context.
 * Errors: INVALID, UNSUPPORTED, HOST_MEMORY, DEVICE_MEMORY, VULKAN, DEVICE_LOST; *context is NULL then. */
VIRGA_API virga_result virga_context_create(const virga_context_def *def, virga_context **context);

/* Destroys the context and sets *context to NULL. Accepts NULL and a pointer to NULL. All effects made from it must
 * be destroyed before (else VIRGA_LOG_LIVE_OBJECTS), and the device must have completed all work recorded with it. */
VIRGA_API void virga_context_destroy(virga_context **context);

/* Begins a frame. `frame_index` rises by any amount from call to call (VIRGA_ERROR_INVALID if not);
 * `completed_index` is the last frame whose device work has completed (0: none yet; indices start at 1). At most
 * frames_in_flight frames may be open: frame_index - completed_index <= frames_in_flight is required.
 * To name a frame that the device still runs is an error that cannot be noticed here: what it uses is freed, and the
 * driver crashes at best. A host with N command buffers that waits for the fence of each before it records into it
 * again knows frame_index - N to be complete (0 while there is none). Frees what completed frames held, takes in their
 * timings and statistics. Costs microseconds. VIRGA_DEGRADED: the frame has begun, and timings could not be had. */
VIRGA_API virga_result virga_frame_begin(virga_context *context, uint64_t frame_index, uint64_t completed_index);

/* Says between frames that a frame has completed, for hosts that wait for their device (an offline renderer): timings
 * and statistics of that frame are then there at once. Frees nothing. `completed_index` must not fall, nor pass the
 * newest frame begun (VIRGA_ERROR_INVALID). */
VIRGA_API virga_result virga_frame_completed(virga_context *context, uint64_t completed_index);

/* Builds up to `most` of the pipelines that wait (VIRGA_PIPELINES_IN_STEPS, oldest first, on this thread; with jobs it
 * builds none), and takes in what jobs have built. *left (optional) gets how many are not there yet. While an effect's
 * pipelines are not there, its calls that record return VIRGA_NOT_READY and record nothing; no simulated time passes.
 * Returns VIRGA_OK with none left, VIRGA_NOT_READY with some; VULKAN, HOST_MEMORY, DEVICE_MEMORY or DEVICE_LOST where
 * one could not be built: the effect that it belongs to returns the same from then on. Costs what the driver takes for
 * the pipelines, and microseconds with most 0. Render passes of targets must live until the pipelines are there. */
VIRGA_API virga_result virga_pipelines_build(virga_context *context, uint32_t most, uint32_t *left);

/* The pipeline cache: call with data NULL for the size, then with a buffer of *size bytes. */
VIRGA_API virga_result virga_pipeline_cache_get(virga_context *context, size_t *size, void *data);

/* Live objects and memory. All zero but for the context's own just before virga_context_destroy. */
typedef struct virga_memory_stats {
    VkDeviceSize device_bytes;     /* taken from the device (or from the host's callback) */
    VkDeviceSize device_used;      /* of which in use by buffers and images */
    uint32_t device_allocations;   /* live VkDeviceMemory or host blocks */
    uint32_t objects;              /* live Vulkan objects of any kind */
    size_t host_bytes;             /* live host memory */
    uint32_t host_allocations;
} virga_memory_stats;

VIRGA_API void virga_memory_get(const virga_context *context, virga_memory_stats *stats);

/* The device time of one pass in the newest completed frame that recorded it: from when the device came to it to when
 * all up to its end was done. On a GPU no barrier sets passes apart for it, so that neighbours (and the host's own work
 * recorded just before) may overlap and times add up to more than the frame took. On a software device passes are timed
 * one by one. */
typedef struct virga_pass_time {
    const char *name;    /* e.g. "rain.step"; static */
    double milliseconds; /* summed over the frame's dispatches or draws of that name */
    uint64_t frame_index;
} virga_pass_time;

/* Copies up to `capacity` pass times and returns how many there are. Late by the frames in flight. */
VIRGA_API uint32_t virga_timings_get(const virga_context *context, virga_pass_time *times, uint32_t capacity);

/* ---- images, targets and views -------------------------------------------------------------------------------- */

/* How an image is used at a moment: what a barrier needs to know. */
typedef struct virga_image_state {
    VkImageLayout layout;
    VkPipelineStageFlags stage;
    VkAccessFlags access;
} virga_image_state;

/* A host's image, which Virga samples: made with VK_IMAGE_USAGE_SAMPLED_BIT. All zero: none. Virga records no barrier
 * for it: it is in the layout of `before` when the call that takes it runs on the device, with its contents visible to
 * shaders, and stays so until all draws of it are done. */
typedef struct virga_image {
    VkImage image;   /* an image without its view, and a view without its image, are refused in views */
    VkImageView view; /* all layers and levels that are to be used */
    VkFormat format; /* of `view`. VK_FORMAT_R32G32B32A32_SFLOAT is read without filtering, all others are filtered */
    VkExtent3D extent; /* read by virga_rain_occlusion_import alone */
    uint32_t layers; /* the same */
    virga_image_state before; /* layout: not UNDEFINED. stage (virga_view.color): that of the host's barrier, which
                               * compute waits for too; 0: fragment shaders */
    virga_image_state after;  /* not read */
} virga_image;

/* What draws go into. A target is an object of its own: change formats by making another; simulation state stays. */
typedef struct virga_target virga_target; /* opaque */

#define VIRGA_MAX_ATTACHMENTS 8

typedef enum virga_target_kind {
    VIRGA_TARGET_RENDER_PASS = 0, /* a host's VkRenderPass and subpass */
    VIRGA_TARGET_DYNAMIC = 1,     /* dynamic rendering (Vulkan 1.3 or VK_KHR_dynamic_rendering, enabled by the host) */
} virga_target_kind;

typedef struct virga_target_def {
    uint32_t size, cookie;
    virga_target_kind kind;
    VkRenderPass render_pass; /* (render pass) must live until the last attach of the target, and its pipelines, are
                               * done; what is drawn in is compatible with it */
    uint32_t subpass;         /* (render pass) */
    VkFormat color_formats[VIRGA_MAX_ATTACHMENTS]; /* (dynamic) of each attachment, VK_FORMAT_UNDEFINED for one that the
                               * host has left out. Attachment 0 is required: it gets premultiplied linear radiance and
                               * coverage, by blending. (render pass) optional: those given are checked. What
                               * the device cannot blend is refused. Linear: a float or _SRGB format; in a plain UNORM
                               * one the host has to encode what it reads back */
    VkFormat depth_format;    /* (dynamic) VK_FORMAT_UNDEFINED: no depth attachment */
    VkFormat stencil_format;  /* (dynamic) */
    uint32_t color_count;     /* [1; VIRGA_MAX_ATTACHMENTS] attachments in the pass; others than 0 and the two below are
                               * not written. Default 1 */
    uint32_t motion_attachment; /* [1; color_count - 1], 0: none. Where this attachment of the pass is, draws write
                               * motion vectors into its first two channels, see virga_temporal. A format of two or
                               * more floats that can be blended: R16G16_SFLOAT always can. Costs other shaders, some
                               * 16 bytes and a few operations for each streak, sprite or corner; without it nothing.
                               * Default 0 */
    uint32_t reactive_attachment; /* the same for the reactive mask, its first channel; R8_UNORM always can. May not be
                               * motion_attachment. Default 0 */
    VkSampleCountFlagBits samples; /* one of Vulkan's, else refused. Default 1 */
    bool depth_attached;      /* a depth attachment is there and drawing is to be tested against it (never written).
                               * Default true; false where the pass has none */
    bool reversed_depth;      /* nearer is greater. Default false */
} virga_target_def;

VIRGA_API virga_target_def virga_default_target_def(void);

/* Makes a target. Each effect then builds its pipelines for it once, e.g. virga_rain_attach. Errors as
 * virga_context_create. */
VIRGA_API virga_result virga_target_create(virga_context *context, const virga_target_def *def, virga_target **target);

/* Destroys it and sets *target to NULL; accepts NULL. What effects built for it stays until they are destroyed. */
VIRGA_API void virga_target_destroy(virga_target **target);

/* What temporal anti-aliasing and upscaling are told of rain, splashes and panes, for targets with a motion or a
 * reactive attachment.
 *
 * Motion vectors lead from where a point is on the picture to where it was when the previous frame was drawn, in pixels
 * of the viewport (right, down) times `motion_scale`, without jitter. What is seen through drops on a pane gets the
 * motion of its picture in the drop, which moves with the scene behind, only less, as much as the drop shrinks it.
 *
 * A pixel has one motion vector but, where water covers it in part, two things that move: the vector is water's
 * where it covers at least `motion_coverage` of the pixel, else it stays what it was, that of the scene. They are never
 * mixed: halfway between two motions lies what neither shows. Physical rain covers a few hundredths of a pixel, so
 * for most of its streaks the reactive mask does the work: in tests/rain/test_rain_temporal.c streaks' own vectors from
 * a coverage of 1/20 on, with a gain of 1, double the error, as they drag the wall behind along.
 *
 * The reactive mask is 1 - (1 - coverage)^reactive_gain, laid over what is there: how little the pixel's history is
 * worth. A gain of 1 is the coverage itself; thin streaks that are much brighter than what is behind them want more, up
 * to 16, which lets more of the edges behind them flicker. On panes it is coverage, with a gain of 1, times how far the
 * water's picture moves in a frame against the pane or against what is behind it, all from half a pixel on: at rest
 * drops keep their history.
 *
 *     taker               direction      unit        motion_scale            reactive mask
 *     FSR 2 and 3         now to before  pixels      1, 1                    reactive, at most 0.9
 *                                                    (motionVectorScale 1, 1; no jitter cancellation)
 *     DLSS                now to before  pixels      1, 1                    bias current color
 *                                                    (InMVScale 1, 1; not jittered)
 *     TAA, before = uv + m               uv, v down  1 / width, 1 / height   1 - weight of history
 *     TAA, before = uv - m               uv, v down  -1 / width, -1 / height likewise
 *     compositing         before to now  pixels      -1, -1                  -
 *
 * The mask says where water is, not where it was: a resolve without a neighbourhood clamp keeps what left the pixel.
 * Let it use the larger of this frame's mask and the last one's, at the pixel's history.
 *
 * Draws of one pass order themselves: what is drawn last and covers enough gives the vector. Haze writes neither. */
typedef struct virga_temporal {
    double position_m[3];         /* of the camera of the previous frame; these three as open_* of virga_view. */
    float view_from_world[16];
    float clip_from_view[16];     /* with this frame's jitter, so that jitter is no motion. All zero (default): the open
                                   * camera and its time are the previous frame's */
    double ago_s;                 /* [0; 1] how long before the time drawn it was drawn. 0: open_camera_s or, that 0
                                   * too, shutter_s. Default 0 */
    float motion_scale[2];        /* of motion vectors, see the table. Not 0. Default 1, 1 */
    float motion_coverage;        /* [0; 1] see above; above 0 to 1. Default 0.5 */
    float reactive_gain;          /* [0; 64] see above. Default 8 */
    virga_image motion;           /* (optional) motion vectors of the opaque scene, in the target's pixels and with
                                   * motion_scale, single-sampled, sampled where panes refract; not the attachment that
                                   * is drawn into. `before` is the layout while drawing, and stays. image
                                   * VK_NULL_HANDLE: what is behind stands still, and only the camera moves */
} virga_temporal;

/* What a camera sees, at the end of the shutter time. Fill with virga_default_view. What is no view is refused by
 * the calls that take it: matrices that are no rotation (to 2 %) or no perspective projection with w = -z (elements up
 * to 1e7, the first two of the diagonal from 1e-4 up), times and viewports out of range. One of less than a pixel gives
 * VIRGA_NOT_READY and one log line: nothing is prepared. */
typedef struct virga_view {
    uint32_t size, cookie;
    double position_m[3];         /* of the camera in the world; double, so that it may be far from the origin */
    float view_from_world[16];    /* rotation part only is read; the translation is taken from position_m */
    float clip_from_view[16];     /* projection with the jitter in it; Vulkan clip space, y down, depth 0..1. Who
                                   * averages sub-frames of one shutter prepares rain without the jitter: its streaks
                                   * are smooth by themselves, and lines of jittered parts are kinked */
    double open_position_m[3];    /* the same at the start of the shutter time (a game: the previous frame's camera) */
    float open_view_from_world[16];
    float open_clip_from_view[16]; /* with this frame's jitter, so that jitter does not show as motion */
    double shutter_s;             /* [0; 1] how long the shutter is open before the time drawn: streaks are as long
                                   * as drops fall in it. Default 1/96; half of a frame is 1/48 in film and 1/120 in a
                                   * game of 60 frames a second */
    uint32_t sub_frames;          /* [1; 65536] so many views, each with a shutter of shutter_s behind the one before,
                                   * are averaged into a picture: rain covers in each what makes their mean that of one
                                   * view with all of the shutter, and no less rain is to be seen the more there are.
                                   * Default 1 */
    double open_camera_s;         /* [0; 1e9] how long before the time drawn the open camera was; 0 means shutter_s, the
                                   * default. A game whose open camera is the previous frame's gives the time between
                                   * the two: without it, motion counts as that of the shorter shutter */
    float aperture_m;             /* [0; 1] width of the lens's opening: streaks nearer or farther than focus_m are as
                                   * wide as it blurs a point there, and cover as much in all. A lens of 50 mm at f/2
                                   * has 0.025. What else water shows is as sharp as the scene. Default 0: all sharp */
    float focus_m;                /* [0; 1e6] view depth that is sharp; 0: infinity, the default */
    float viewport[4];            /* x, y, width, height in pixels, within what the device allows. Who turns the picture
                                   * over by a negative height, which counts as none, negates [1][1] of the projection
                                   * instead. Draws set it */
    bool reversed_depth;          /* must match the target's, and clip_from_view, else refused. A projection may do
                                   * without a far plane. Default false */
    virga_image depth;            /* (optional) the scene's depth in the target's pixels, sampled for occlusion by the
                                   * scene (also where a target has no depth attached), soft edges and haze; layout and
                                   * access while drawing are `before`, and stay. A single-sample view of the depth
                                   * aspect. Attached in the same pass too it must be read only, with
                                   * VK_ATTACHMENT_STORE_OP_NONE: a store counts as a write whatever the layout says.
                                   * image VK_NULL_HANDLE: hard edges by the depth test, no haze */
    virga_image color;            /* (optional) the opaque scene's colour, linear radiance, single-sampled and in the
                                   * target's pixels, sampled where water refracts what is behind it; layout and
                                   * access while drawing are `before`, and stay. That of the frame before will
                                   * do where it has no drops of panes in it: films would show them, and what they
                                   * show, again and again. image VK_NULL_HANDLE: refraction shows the environment
                                   * instead */
    virga_temporal temporal;      /* (motion, reactive) the previous frame, and what is told of it */
} virga_view;

VIRGA_API virga_view virga_default_view(void);

#ifdef __cplusplus
}
#endif
#endif
