/* gpu/effect_type.h - an effect is data: a table lists its parts, and the same code creates, records and destroys any
 * such table. Internal.
 *
 * An effect's object begins with a virga_effect. Its virga_effect_type lists buffers, rings, images, bindings, passes
 * and draws, each with the member of the object that holds it. From these rows effect.c estimates memory, creates,
 * shrinks to the memory budget, initialises contents, attaches to targets, reads statistics back, and destroys. An
 * effect does the rest in the callbacks of its type. */
#ifndef VIRGA_GPU_EFFECT_TYPE_H
#define VIRGA_GPU_EFFECT_TYPE_H

#include "core/settings.h"
#include "gpu/bindings.h"
#include "gpu/device_check.h"
#include "gpu/journal.h"
#include "gpu/pipelines.h"
#include "gpu/resources.h"

#include <virga/light.h>

#define VIRGA_EFFECT_MAX_COUNTS   40
#define VIRGA_EFFECT_MAX_DEF      512   /* bytes */
#define VIRGA_EFFECT_MAX_SETTINGS 16384 /* bytes */
#define VIRGA_EFFECT_MAX_DRAWS    46    /* pipelines of a target */
#define VIRGA_EFFECT_PARTS        2     /* parts of a frame's statistics: its step and its prepare */

#define VIRGA_ROWS(table) (uint32_t)(sizeof(table) / sizeof(table)[0])

/* Sizes depend on the definition. An effect fills an array of counts, and each row names one of them: e.g. a buffer of
 * `entry` bytes for each of counts[SPLASH_COUNT_DROPLETS]. Count 0 is always 1. */
#define VIRGA_COUNT_ONE 0

/* Usages of buffers that occur in every effect. A storage buffer can be copied from and to. */
#define VIRGA_USE_STORAGE \
    (VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT)
#define VIRGA_USE_INDIRECT (VIRGA_USE_STORAGE | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT)
#define VIRGA_USE_TEXELS   (VIRGA_USE_STORAGE | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT)
#define VIRGA_USE_INDEX    (VIRGA_USE_STORAGE | VK_BUFFER_USAGE_INDEX_BUFFER_BIT)
#define VIRGA_USE_UNIFORM  VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT

/* A buffer or image of which each view has its own, so that several prepared views live in one frame. `name` is the one
 * of the selected view (virga_effect_select); those of all views are behind it. */
#define VIRGA_PER_VIEW(type, name) type *name, *name##_of_view[VIRGA_MAX_VIEWS]

/* The contents of a buffer or image before the first pass. See virga_effect_first_contents. */
typedef enum virga_first {
    VIRGA_FIRST_ANYTHING, /* (buffers) undefined: passes write before they read */
    VIRGA_FIRST_FILL,     /* (buffers) `fill` in every word; (images) zero, in the layout GENERAL */
    VIRGA_FIRST_STORAGE,  /* (images) undefined, in the layout GENERAL */
    VIRGA_FIRST_SAMPLED,  /* (images) undefined, in the layout SHADER_READ_ONLY_OPTIMAL */
} virga_first;

/* A buffer of head + entry x counts[count] bytes. It is not created if its size is 0. */
typedef struct virga_effect_buffer {
    const char *name;
    size_t member; /* offset of the virga_buffer * */
    VkBufferUsageFlags usage;
    virga_heap_kind heap;
    VkDeviceSize head, entry;
    uint32_t count;
    virga_first first;
    uint32_t fill;
    uint32_t word, word_value; /* (FILL) one word that differs: its index and its value; 0: none differs */
    bool keeps;                /* (ANYTHING) later steps read it before they write it: it is part of the state */
    bool scratch;              /* (FILL) no later step reads it: it is no part of the state */
    bool per_view;             /* each view has its own; the member is a VIRGA_PER_VIEW. It is no part of the state */
} virga_effect_buffer;

/* Blocks that the host writes while it records, and that passes read at a dynamic offset: counts[count] blocks for each
 * frame in flight. */
typedef struct virga_effect_ring {
    const char *name;
    size_t member; /* offset of the virga_ring */
    VkBufferUsageFlags usage;
    VkDeviceSize block; /* in bytes, from VIRGA_RING_BYTES */
    uint32_t count;
} virga_effect_ring;

/* An image of counts[width] x counts[height] texels. It is not created if one of them is 0. */
typedef struct virga_effect_image {
    const char *name;
    size_t member; /* offset of the virga_image_2d * */
    VkFormat format;
    VkImageAspectFlags aspect;
    VkImageUsageFlags usage;
    uint32_t width, height; /* indices of counts */
    uint32_t layers;        /* 0: a 3D image of depth 1 */
    virga_first first;
    bool keeps;    /* passes do not write it anew in every frame: it is part of the state, and in the layout GENERAL */
    bool per_view; /* as in virga_effect_buffer */
    VkFormat seen_as; /* that samplers see it in, see virga_image_create_seen_as */
} virga_effect_image;

/* A descriptor set layout and its pipeline layout. Rows with a source are bound by virga_effect_bound; the effect binds
 * the others itself. */
typedef struct virga_effect_layout {
    size_t member; /* offset of the virga_bindings * */
    const virga_binding_kind *rows;
    uint32_t row_count, sets_per_frame, push_bytes;
} virga_effect_layout;

/* A compute pass. If `forms` is above 1, the member is an array of that many pipelines. They differ in specialisation
 * constant 0: `constant` + the index. */
typedef struct virga_effect_pass {
    const char *name;
    size_t member; /* offset of the virga_pipeline *, or of an array of them */
    const virga_spirv *shader;
    uint32_t forms; /* 0: one */
    uint32_t constant;
    uint32_t layout; /* index of the virga_effect_layout */
    bool shuffles;   /* only where virga_shuffled_lanes is a multiple of 8; the row behind it is for other devices */
} virga_effect_pass;

/* Index of the first vertex shader for passes of several views. */
#define VIRGA_VIEWS_FORM 2

/* The shaders of a draw, indexed by virga_target_outputs. If a row omits a combination, the draw writes only color on
 * such targets. */
#define VIRGA_FRAGMENT_FORMS(name)                                                                            \
    {                                                                                                         \
        VIRGA_SPIRV(name), VIRGA_SPIRV(name##_motion), VIRGA_SPIRV(name##_reactive), VIRGA_SPIRV(name##_both) \
    }
/* Those of its vertices: plain, with motion, and both for passes of several views. */
#define VIRGA_VERTEX_FORMS(name)                                                                                   \
    {                                                                                                              \
        VIRGA_SPIRV(name), VIRGA_SPIRV(name##_motion), VIRGA_SPIRV(name##_views), VIRGA_SPIRV(name##_motion_views) \
    }
/* Without motion. */
#define VIRGA_VERTEX_FORM(name)                                                 \
    {                                                                           \
        [0] = VIRGA_SPIRV(name), [VIRGA_VIEWS_FORM] = VIRGA_SPIRV(name##_views) \
    }
#define VIRGA_FORM(name)  \
    {                     \
        VIRGA_SPIRV(name) \
    }

/* Pipelines of a target that differ in specialisation constant 0: one for each entry of `constants`. */
typedef struct virga_effect_draw {
    const char *name;
    const virga_spirv *vertex[2 * VIRGA_VIEWS_FORM], *fragment[VIRGA_OUTPUTS_FORMS];
    const uint32_t *constants;
    uint32_t constant_count;
    bool lines;     /* created only if the context draws lines */
    bool cull_back; /* counter-clockwise is the front */
    bool no_depth;  /* no depth test */
    bool replace;   /* overwrites the target; otherwise blends with premultiplied alpha */
} virga_effect_draw;

/* A size in the definition that may be reduced to fit the memory budget. */
typedef struct virga_effect_pool {
    const char *name;
    size_t member; /* offset of a uint32_t in the definition */
    uint32_t min;
    uint32_t unit; /* the size stays a multiple of this; 0: a power of two */
} virga_effect_pool;

/* A public struct that begins with size and cookie: a definition or settings. */
typedef struct virga_effect_struct {
    const char *name; /* as in virga_settings_check */
    uint32_t size;
    size_t member; /* offset in the object */
    const virga_setting_row *rows;
    uint32_t row_count;
} virga_effect_struct;

/* What a part of the state consists of, for its check. */
typedef enum virga_state_kind {
    VIRGA_STATE_BYTES,   /* checked by the effect, if at all */
    VIRGA_STATE_BOOLS,   /* each 0 or 1 */
    VIRGA_STATE_DOUBLES, /* each finite and not huge */
} virga_state_kind;

/* A part of the state that the object holds on the host, see gpu/state.h. */
typedef struct virga_effect_state_row {
    const char *name; /* for log lines */
    size_t member;    /* offset in the object */
    size_t bytes;
    uint32_t count;  /* index of the counts that multiply `bytes`; 0: none */
    bool pointed;    /* the member is a pointer to it */
    bool must_match; /* settings without rows: a state that has others is refused */
    virga_state_kind kind;
} virga_effect_state_row;

/* A step of an effect that needs only time and position. */
typedef struct virga_effect_step {
    uint32_t first_tick, ticks; /* as virga_rain_ticks */
    double camera_m[3];
    float wind_m_s[3];
} virga_effect_step;

struct virga_state_check;

/* The view of the newest prepare, for virga_effect_type.draw. */
#define VIRGA_PREPARED_NEWEST UINT64_MAX

typedef struct virga_effect_type {
    const char *name;     /* in log lines: "the ground", "a pane" */
    const char *log_name; /* of its settings in log lines */
    size_t size;          /* of the object */
    virga_effect_struct def, settings;
    size_t lighting; /* offset of the virga_lighting in the settings; 0: none */

    const virga_effect_buffer *buffers;
    uint32_t buffer_count;
    const virga_effect_ring *rings;
    uint32_t ring_count;
    const virga_effect_image *images;
    uint32_t image_count;
    const virga_effect_layout *layouts;
    uint32_t layout_count;
    const virga_effect_pass *passes;
    uint32_t pass_count;
    const virga_effect_draw *draws;
    uint32_t draw_count;
    uint32_t draw_layout; /* index of the virga_effect_layout of draws */
    const virga_effect_pool *pools;
    uint32_t pool_count;
    const virga_effect_state_row *state_rows;
    uint32_t state_row_count;
    size_t max_views;          /* offset of a uint32_t in the definition: number of views in a frame; 0: one */
    const char *readback_name; /* name of the buffer for statistics readback */
    uint32_t readback_bytes;   /* per frame; 0: no statistics */

    /* (optional) Checks what the rows of a definition do not, after them. */
    virga_result (*check_def)(const virga_log *log, void *def);
    /* (optional) Makes a definition fit the device: VIRGA_DEGRADED if it had to be reduced. */
    virga_result (*fit_device)(const virga_context *context, void *def);
    /* Fills the counts of a definition. */
    void (*count)(const void *def, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS]);
    /* (optional) Bytes of device memory that `create` allocates besides the rows. */
    VkDeviceSize (*extra_bytes)(const void *def);
    /* (optional) Initialises the object, before anything is created. Its definition and its default settings are set.
     */
    virga_result (*init)(void *object);
    /* (optional) Creates what rows can not describe. Buffers, images and layouts exist already, passes do not. */
    virga_result (*create)(void *object);
    /* (optional) Fills what takes milliseconds to work out. Last, so that nothing which fails waited for it. */
    virga_result (*fill)(void *object);
    /* (optional) Releases what init and create created. NULL pointers are accepted. */
    void (*destroy)(void *object);
    /* Describes a new object in a log line, e.g. "splash: up to 65536 splashes". */
    void (*describe)(const void *object, char *line, size_t size);
    /* (optional) Bits that are set in the specialisation constant 0 of every pass, and of every draw. */
    uint32_t (*pass_constant)(const void *object);
    /* (optional) Whether an object with this definition and these settings ever records this form of a pass. Pipelines
     * of other forms are created once its settings use them. Without it: all forms. */
    bool (*form_used)(const void *object, const void *settings, const virga_effect_pass *pass, uint32_t form);
    uint32_t (*draw_constant)(const void *object);
    /* (optional) The rows of `draws` that an object with these settings may draw with, as bits. Pipelines of other rows
     * are built once its settings want them. Without it: all rows. */
    uint32_t (*wanted_draws)(const void *object, const void *settings);
    /* (optional) The device has not executed calls of a completed frame. `did` tells what they recorded. What later
     * frames need must be recorded again. */
    void (*lost)(void *object, uint64_t frame, uint32_t did);
    /* (optional) Checks what a saved state says, before it is loaded: see gpu/state_check.h. */
    void (*check_state)(const void *object, struct virga_state_check *check);
    /* (optional) A state was loaded: the parts of it on the host are in the object. */
    void (*state_loaded)(void *object);
    /* Reads the statistics of a completed frame. `parts` is a bit mask of the parts that were recorded in it. */
    void (*read_statistics)(void *object, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);

    /* (optional) Fills the default settings that are not in rows. */
    void (*fill_settings)(void *settings);
    /* (optional) Checks what the rows of settings do not, after them. Sets *changed if it clamped something. */
    virga_result (*check_settings)(const void *object, void *settings, bool *changed);
    /* (optional) Applies new settings, while the object still has the old ones. An error leaves those in force. */
    virga_result (*apply_settings)(void *object, void *settings);

    /* (optional) The public functions of the effect, as a scene calls them. draw: `prepared` may be
     * VIRGA_PREPARED_NEWEST. */
    virga_result (*step)(void *object, VkCommandBuffer cmd, const virga_effect_step *step);
    virga_result (*prepare)(void *object, VkCommandBuffer cmd, const virga_view *view, double time_s,
                            virga_prepared *prepared);
    virga_result (*draw)(void *object, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared);
} virga_effect_type;

/* The rows of a definition with ticks, made with its DEF. */
#define VIRGA_TICK_ROWS DEF(U32, max_ticks_per_step, 1, 64, 16), DEF(DOUBLE, tick_s, 1e-3, 0.05, 1.0 / 60)

/* The fields .<row>s and .<row>_count for a table of that name, e.g. VIRGA_TABLE(image) for the table `images`. */
#define VIRGA_TABLE(row) .row##s = row##s, .row##_count = VIRGA_ROWS(row##s)

/* The fields of callbacks whose functions have the names of the fields, e.g. VIRGA_CALLBACKS(init, create) for
 * .init = init, .create = create. At most ten. */
/* clang-format off */
#define VIRGA_CALLBACKS(...) VIRGA_CALLBACKS_OF(__VA_ARGS__, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0)(__VA_ARGS__)
#define VIRGA_CALLBACKS_OF(a, b, c, d, e, f, g, h, i, j, count, ...) VIRGA_CALLBACKS_##count
#define VIRGA_CALLBACKS_1(name) .name = name
#define VIRGA_CALLBACKS_2(name, ...) .name = name, VIRGA_CALLBACKS_1(__VA_ARGS__)
#define VIRGA_CALLBACKS_3(name, ...) .name = name, VIRGA_CALLBACKS_2(__VA_ARGS__)
#define VIRGA_CALLBACKS_4(name, ...) .name = name, VIRGA_CALLBACKS_3(__VA_ARGS__)
#define VIRGA_CALLBACKS_5(name, ...) .name = name, VIRGA_CALLBACKS_4(__VA_ARGS__)
#define VIRGA_CALLBACKS_6(name, ...) .name = name, VIRGA_CALLBACKS_5(__VA_ARGS__)
#define VIRGA_CALLBACKS_7(name, ...) .name = name, VIRGA_CALLBACKS_6(__VA_ARGS__)
#define VIRGA_CALLBACKS_8(name, ...) .name = name, VIRGA_CALLBACKS_7(__VA_ARGS__)
#define VIRGA_CALLBACKS_9(name, ...) .name = name, VIRGA_CALLBACKS_8(__VA_ARGS__)
#define VIRGA_CALLBACKS_10(name, ...) .name = name, VIRGA_CALLBACKS_9(__VA_ARGS__)
/* clang-format on */

/* The names and tables of a type, for an effect that names its parts like the others: virga_<name>, its _def and
 * _settings; tables def_rows, setting_rows, buffers, rings, layouts and passes; callbacks count and describe. */
#define VIRGA_EFFECT_TABLES(effect, title, settings_log_name)                                                        \
    .name = title, .log_name = settings_log_name, .size = sizeof(virga_##effect),                                    \
    .def = {#effect "_def", sizeof(virga_##effect##_def), offsetof(virga_##effect, def), def_rows,                   \
            VIRGA_ROWS(def_rows)},                                                                                   \
    .settings = {#effect "_settings", sizeof(virga_##effect##_settings), offsetof(virga_##effect, settings),         \
                 setting_rows, VIRGA_ROWS(setting_rows)},                                                            \
    VIRGA_TABLE(buffer), VIRGA_TABLE(ring), VIRGA_TABLE(layout), .passes = passes, .pass_count = VIRGA_ROWS(passes), \
    .readback_name = #effect ".readback", .count = count, .describe = describe

/* The same for an effect that also has the table pools, <name>_readback, the callbacks check_def and
 * <name>_read_statistics. */
#define VIRGA_EFFECT_TYPE(effect, title, settings_log_name)                   \
    VIRGA_EFFECT_TABLES(effect, title, settings_log_name), VIRGA_TABLE(pool), \
        .readback_bytes = sizeof(effect##_readback), .check_def = check_def,  \
        .read_statistics = effect##_read_statistics

/* The fields of an effect that draws: the table `images`, <name>_draws, the settings' `lighting`. */
#define VIRGA_EFFECT_DRAWS(effect)                                                                          \
    VIRGA_TABLE(image), .lighting = offsetof(virga_##effect##_settings, lighting), .draws = effect##_draws, \
                        .draw_count = VIRGA_ROWS(effect##_draws), .draw = effect##_type_draw,               \
                        .max_views = offsetof(virga_##effect##_def, max_views)

/* A ring's buffer, and how much of the current frame's part is used. */
typedef struct virga_ring {
    virga_buffer *buffer;
    uint32_t block_bytes, blocks_per_frame;
    uint64_t frame; /* the frame that `used` belongs to */
    uint32_t used;
} virga_ring;

/* Bytes of a block of this type in a ring, aligned for dynamic offsets. */
#define VIRGA_RING_BYTES(type) ((sizeof(type) + VIRGA_RING_ALIGNMENT - 1) / VIRGA_RING_ALIGNMENT * VIRGA_RING_ALIGNMENT)

/* Pipelines for the targets of one class. */
typedef struct virga_effect_target {
    struct virga_effect_target *next;
    struct virga_target_class *class_of;
    const virga_target *from;                      /* the target that they were created for */
    uint32_t rows;                                 /* whose pipelines were asked for, as bits */
    virga_pipeline *draws[VIRGA_EFFECT_MAX_DRAWS]; /* by row, then by constant; NULL: not wanted so far */
} virga_effect_target;

/* A view that was prepared. */
typedef struct virga_effect_view {
    virga_prepared handle; /* 0: none, or it can not be drawn any more */
    uint64_t frame;        /* in which it was prepared */
    VkDescriptorSet set;
    uint32_t offset; /* of its block in the ring of views */
    float viewport[4];
    bool reversed_depth;
    uint32_t multiview_index;
    bool drawn;
} virga_effect_view;

/* An upload buffer whose copy was recorded. */
typedef struct virga_effect_upload {
    virga_buffer **staging; /* the object's pointer to it */
    virga_buffer *buffer;
    uint64_t first_frame; /* in which its copy was recorded */
} virga_effect_upload;

#define VIRGA_EFFECT_MAX_UPLOADS 4
#define VIRGA_EFFECT_MAX_READS   16 /* lists of other effects that calls of one frame read */

/* Whether something was recorded, and whether the device has executed it. */
typedef enum virga_progress { VIRGA_NOT_RECORDED, VIRGA_RECORDED, VIRGA_EXECUTED } virga_progress;

/* The first member of every effect's object. */
typedef struct virga_effect {
    const virga_effect_type *type;
    virga_context *context;
    struct virga_effect *next_effect; /* of the context */
    virga_journal journal;
    bool of_scene;                   /* a scene destroys it */
    virga_progress contents, images; /* first contents: of buffers and passing images, and of images that are kept */
    uint64_t contents_frame;         /* the newest frame in which they were recorded */
    virga_bindings *fill_bindings;   /* of the pass that fills buffers; NULL: there are none to fill */
    virga_pipeline *fill_pass;
    uint64_t reads_frame; /* the newest frame in which lists of other effects were filled, see virga_effect_reads */
    uint32_t reads;       /* how many of them */
    virga_effect_upload uploads[VIRGA_EFFECT_MAX_UPLOADS];
    uint64_t load_frame;         /* the frame in which a state was loaded last */
    bool own_first;              /* a load has recorded first contents, and the effect not yet those of its own */
    virga_pipeline_group passes; /* all passes that a step and a prepare use */
    virga_effect_target *targets;
    virga_effect_view views[VIRGA_MAX_VIEWS];
    uint32_t max_views;      /* that live in a frame */
    uint32_t slot;           /* index of the selected view, see virga_effect_select */
    uint32_t serial;         /* differs from that of other effects, in handles of views */
    uint32_t prepares;       /* in the frame prepares_frame */
    uint64_t prepares_frame; /* the newest frame with a prepare */
    virga_prepared newest;   /* the view of the newest prepare; 0: it failed */
    uint32_t newest_slot;    /* of the newest prepare that did not fail */
    bool undrawn_logged;     /* it was logged that a prepare replaced a view that was not drawn */
    bool not_drawn_logged;   /* it was logged that a draw had nothing to draw; reset by a successful draw */
    uint64_t step_frame;     /* frame of the newest step */
    virga_buffer *readback;  /* statistics of the frames in flight, for the host */
    /* Frames whose statistics were not read yet; 0: none. */
    uint64_t readback_frames[VIRGA_EFFECT_PARTS][VIRGA_MAX_FRAMES_IN_FLIGHT];
    uint32_t readback_views[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* number of prepares in these frames */
} virga_effect;

/* The member of an object at the offset that a row gives. */
static inline void *virga_effect_member(const virga_effect *effect, size_t offset)
{
    return (char *)effect + offset;
}

/* Number of buffers or images of a row, and the pointer to one of them. */
static inline uint32_t virga_effect_copies(const virga_effect *effect, bool per_view)
{
    return per_view ? effect->max_views : 1;
}

static inline void *virga_effect_copy(const virga_effect *effect, size_t member, bool per_view, uint32_t index)
{
    void **at = virga_effect_member(effect, member);
    return per_view ? at + 1 + index : at;
}

#endif
