/* gpu/effect.h - an effect is data: a table lists its parts, and the same code creates, records and destroys any such
 * table. Internal.
 *
 * An effect's object begins with a virga_effect. Its virga_effect_type lists buffers, rings, images, bindings, passes
 * and draws, each with the member of the object that holds it. From these rows effect.c estimates memory, creates,
 * shrinks to the memory budget, initialises contents, attaches to targets, reads statistics back, and destroys. An
 * effect does the rest in the callbacks of its type. */
#ifndef VIRGA_GPU_EFFECT_H
#define VIRGA_GPU_EFFECT_H

#include "core/settings.h"
#include "gpu/bindings.h"
#include "gpu/device_check.h"
#include "gpu/journal.h"
#include "gpu/pipelines.h"
#include "gpu/resources.h"

#include <virga/light.h>

#define VIRGA_EFFECT_MAX_COUNTS   32
#define VIRGA_EFFECT_MAX_DEF      512   /* bytes */
#define VIRGA_EFFECT_MAX_SETTINGS 16384 /* bytes */
#define VIRGA_EFFECT_MAX_DRAWS    40    /* pipelines of a target */
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
    virga_spirv shader;
    uint32_t forms; /* 0: one */
    uint32_t constant;
    uint32_t layout; /* index of the virga_effect_layout */
} virga_effect_pass;

/* Index of the first vertex shader for passes of several views. */
#define VIRGA_VIEWS_FORM 2

/* The shaders of a draw, indexed by virga_target_outputs. If a row omits a combination, the draw writes only color on
 * such targets. */
#define VIRGA_FRAGMENT_FORMS(name)                                                               \
    {                                                                                            \
        VIRGA_SPIRV_ROW(name), VIRGA_SPIRV_ROW(name##_motion), VIRGA_SPIRV_ROW(name##_reactive), \
            VIRGA_SPIRV_ROW(name##_both)                                                         \
    }
/* Those of its vertices: plain, with motion, and both for passes of several views. */
#define VIRGA_VERTEX_FORMS(name)                                                              \
    {                                                                                         \
        VIRGA_SPIRV_ROW(name), VIRGA_SPIRV_ROW(name##_motion), VIRGA_SPIRV_ROW(name##_views), \
            VIRGA_SPIRV_ROW(name##_motion_views)                                              \
    }
/* Without motion. */
#define VIRGA_VERTEX_FORM(name)                                                         \
    {                                                                                   \
        [0] = VIRGA_SPIRV_ROW(name), [VIRGA_VIEWS_FORM] = VIRGA_SPIRV_ROW(name##_views) \
    }
#define VIRGA_FORM(name)      \
    {                         \
        VIRGA_SPIRV_ROW(name) \
    }

/* Pipelines of a target that differ in specialisation constant 0: one for each entry of `constants`. */
typedef struct virga_effect_draw {
    const char *name;
    virga_spirv vertex[2 * VIRGA_VIEWS_FORM], fragment[VIRGA_OUTPUTS_FORMS];
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

/* A part of the state that the object holds on the host, see gpu/state.h. */
typedef struct virga_effect_state_row {
    const char *name; /* for log lines */
    size_t member;    /* offset in the object */
    size_t bytes;
    uint32_t count;  /* index of the counts that multiply `bytes`; 0: none */
    bool pointed;    /* the member is a pointer to it */
    bool must_match; /* settings without rows: a state that has others is refused */
} virga_effect_state_row;

/* A step of an effect that needs only time and position. */
typedef struct virga_effect_step {
    uint32_t first_tick, ticks; /* as virga_rain_ticks */
    double camera_m[3];
    float wind_m_s[3];
} virga_effect_step;

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
    /* (optional) Releases what init and create created. NULL pointers are accepted. */
    void (*destroy)(void *object);
    /* Describes a new object in a log line, e.g. "splash: up to 65536 splashes". */
    void (*describe)(const void *object, char *line, size_t size);
    /* (optional) Bits that are set in the specialisation constant 0 of every pass, and of every draw. */
    uint32_t (*pass_constant)(const void *object);
    uint32_t (*draw_constant)(const void *object);
    /* (optional) The device has not executed calls of a completed frame. `did` tells what they recorded. What later
     * frames need must be recorded again. */
    void (*lost)(void *object, uint64_t frame, uint32_t did);
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

/* The public functions that are the same for all effects. They use <name>_type. */
#define VIRGA_EFFECT_FUNCTIONS(name)                                                                               \
    _Static_assert(sizeof(virga_##name##_settings) <= VIRGA_EFFECT_MAX_SETTINGS, "room for a copy of them");       \
    virga_##name##_def virga_default_##name##_def(void)                                                            \
    {                                                                                                              \
        virga_##name##_def def;                                                                                    \
        virga_effect_default_def(&name##_type, &def);                                                              \
        return def;                                                                                                \
    }                                                                                                              \
    virga_##name##_settings virga_default_##name##_settings(void)                                                  \
    {                                                                                                              \
        virga_##name##_settings settings;                                                                          \
        virga_effect_default_settings(&name##_type, &settings);                                                    \
        return settings;                                                                                           \
    }                                                                                                              \
    virga_result virga_##name##_set(virga_##name *object, const virga_##name##_settings *settings)                 \
    {                                                                                                              \
        return object ? virga_effect_set(&object->base, "virga_" #name "_set", settings) : VIRGA_ERROR_INVALID;    \
    }                                                                                                              \
    VkDeviceSize virga_##name##_estimate(const virga_##name##_def *def)                                            \
    {                                                                                                              \
        return virga_effect_estimate(&name##_type, def);                                                           \
    }                                                                                                              \
    virga_result virga_##name##_create(virga_context *context, const virga_##name##_def *def, virga_##name **made) \
    {                                                                                                              \
        void *object = NULL;                                                                                       \
        const virga_result result =                                                                                \
            virga_effect_create(context, &name##_type, "virga_" #name "_create", def, made ? &object : NULL);      \
        if (made)                                                                                                  \
            *made = object;                                                                                        \
        return result;                                                                                             \
    }                                                                                                              \
    void virga_##name##_destroy(virga_##name **object)                                                             \
    {                                                                                                              \
        if (object && *object)                                                                                     \
            virga_effect_destroy_by_host(&(*object)->base, "virga_" #name "_destroy");                             \
        if (object)                                                                                                \
            *object = NULL;                                                                                        \
    }                                                                                                              \
    void virga_##name##_get(const virga_##name *object, virga_##name##_settings *settings)                         \
    {                                                                                                              \
        if (object && settings)                                                                                    \
            *settings = object->settings;                                                                          \
    }                                                                                                              \
    virga_result virga_##name##_ready(const virga_##name *object)                                                  \
    {                                                                                                              \
        return object ? virga_effect_ready(&object->base) : VIRGA_ERROR_INVALID;                                   \
    }

/* The public reader of statistics, for effects that keep them in `stats` as the host gets them. */
#define VIRGA_EFFECT_STATISTICS_FUNCTION(name)                                       \
    void virga_##name##_stats_get(virga_##name *object, virga_##name##_stats *stats) \
    {                                                                                \
        if (object)                                                                  \
            virga_effect_read_statistics(&object->base);                             \
        if (stats)                                                                   \
            *stats = object ? object->stats : (virga_##name##_stats){0};             \
    }

/* The public draws of an effect. They use <name>_draw, which draws a prepared view for the public function `call`. */
#define VIRGA_EFFECT_VIEW_FUNCTIONS(name)                                                                              \
    virga_result virga_##name##_draw(virga_##name *object, VkCommandBuffer cmd, const virga_target *target)            \
    {                                                                                                                  \
        return object ? name##_draw(object, cmd, target, virga_effect_newest(&object->base), "virga_" #name "_draw")   \
                      : VIRGA_ERROR_INVALID;                                                                           \
    }                                                                                                                  \
    virga_result virga_##name##_draw_view(virga_##name *object, VkCommandBuffer cmd, const virga_target *target,       \
                                          virga_prepared prepared)                                                     \
    {                                                                                                                  \
        return object ? name##_draw(object, cmd, target, prepared, "virga_" #name "_draw_view") : VIRGA_ERROR_INVALID; \
    }                                                                                                                  \
    static virga_result name##_type_draw(void *object, VkCommandBuffer cmd, const virga_target *target,                \
                                         virga_prepared prepared)                                                      \
    {                                                                                                                  \
        return prepared == VIRGA_PREPARED_NEWEST ? virga_##name##_draw(object, cmd, target)                            \
                                                 : virga_##name##_draw_view(object, cmd, target, prepared);            \
    }

/* The same, and the attach. */
#define VIRGA_EFFECT_DRAW_FUNCTIONS(name)                                                                           \
    VIRGA_EFFECT_VIEW_FUNCTIONS(name)                                                                               \
    virga_result virga_##name##_attach(virga_##name *object, const virga_target *target)                            \
    {                                                                                                               \
        return object ? virga_effect_attach(&object->base, "virga_" #name "_attach", target) : VIRGA_ERROR_INVALID; \
    }

/* The public prepares of an effect, and the callback `prepare`. They use <name>_prepare. */
#define VIRGA_EFFECT_PREPARE_FUNCTIONS(name)                                                                    \
    virga_result virga_##name##_prepare_view(virga_##name *object, VkCommandBuffer cmd, const virga_view *view, \
                                             double time_s, virga_prepared *prepared)                           \
    {                                                                                                           \
        if (prepared)                                                                                           \
            *prepared = 0;                                                                                      \
        return object ? name##_prepare(object, cmd, view, time_s, prepared) : VIRGA_ERROR_INVALID;              \
    }                                                                                                           \
    virga_result virga_##name##_prepare(virga_##name *object, VkCommandBuffer cmd, const virga_view *view,      \
                                        double time_s)                                                          \
    {                                                                                                           \
        return virga_##name##_prepare_view(object, cmd, view, time_s, NULL);                                    \
    }                                                                                                           \
    static virga_result prepare(void *object, VkCommandBuffer cmd, const virga_view *view, double time_s,       \
                                virga_prepared *prepared)                                                       \
    {                                                                                                           \
        return virga_##name##_prepare_view(object, cmd, view, time_s, prepared);                                \
    }

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
    virga_pipeline *draws[VIRGA_EFFECT_MAX_DRAWS]; /* by row, then by constant */
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
    virga_bound first_head; /* (optional) the head of a list of another effect, which is filled with 0 too */
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

/* ---- life cycle */

/* Creates an object. *object is NULL if that fails. `call` is the name of the public function for log lines. */
virga_result virga_effect_create(virga_context *context, const virga_effect_type *type, const char *call,
                                 const void *def, void **object);
void virga_effect_destroy(virga_effect *effect); /* accepts NULL */

/* The same for the public functions: a part of a scene is not destroyed, which is logged. */
void virga_effect_destroy_by_host(virga_effect *effect, const char *call);

/* Fill a definition or settings with the defaults. */
void virga_effect_default_def(const virga_effect_type *type, void *def);
void virga_effect_default_settings(const virga_effect_type *type, void *settings);

/* Upper bound of the device memory in bytes, with the maximum number of frames in flight. 0 for an invalid
 * definition. */
VkDeviceSize virga_effect_estimate(const virga_effect_type *type, const void *def);

/* VIRGA_OK if the pipelines of all passes are built. */
virga_result virga_effect_ready(const virga_effect *effect);

/* Checks settings, clamps them and applies them. `call` is the name of the public function for log lines.
 * VIRGA_DEGRADED: some are clamped. An error changes nothing. */
virga_result virga_effect_set(virga_effect *effect, const char *call, const void *settings);

/* Replaces the lighting in the current settings. */
virga_result virga_effect_set_lighting(virga_effect *effect, const virga_lighting *lighting);

/* Fills the counts of the object's definition. */
void virga_effect_counts(const virga_effect *effect, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS]);

/* Bytes of a texel, for the formats that effects use. */
VkDeviceSize virga_texel_bytes(VkFormat format);

/* ---- recording */

/* The common checks of a step: cmd and info are not NULL, and a frame has begun. */
virga_result virga_effect_check_step(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                     const void *info);

/* The same for effects with one step per frame: checks too that this is the first one in the frame. */
virga_result virga_effect_check_one_step(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                         const void *info);

/* The ticks that a host requests for a step: `count` of them, beginning with `first`, at most `max`. */
typedef struct virga_tick_range {
    uint32_t first, count, max;
} virga_tick_range;

/* Checks that the ticks of a step follow the last one. `last_tick` is NULL before the first step. */
virga_result virga_effect_check_ticks(const virga_effect *effect, const virga_tick_range *range,
                                      const uint32_t *last_tick);

/* Begins the step of a frame: reads the statistics of completed frames, and waits until earlier frames have read what
 * this step writes. */
void virga_effect_begin_step(virga_effect *effect, VkCommandBuffer cmd);

/* Records the first contents that rows describe, once a frame, until the device is known to have executed them. Ends
 * with a barrier before transfers and passes. Returns true if it recorded: the effect then records those first contents
 * of its own that are the same at any time, e.g. tables and layouts.
 *
 * Buffers are filled by a pass that does nothing if an earlier frame has filled them. So the recording is right whether
 * or not the earlier frames are lost. */
bool virga_effect_first_contents(virga_effect *effect, VkCommandBuffer cmd);

/* Parts of it for effect.c. */
virga_result virga_effect_create_fills(virga_effect *effect);
VkDeviceSize virga_effect_fill_bytes(void);

/* The copy from an upload buffer was recorded. The buffer is retired, and *staging set to NULL, once the device has
 * executed the copy. Until then the copy must be recorded in every frame. */
void virga_effect_uploaded(virga_effect *effect, virga_buffer **staging);

/* Ends a call that recorded outside rendering without statistics: adds what it did to the journal. */
void virga_effect_note(virga_effect *effect, VkCommandBuffer cmd, uint32_t did);

/* For all effects of a context: learns which calls of completed frames the device has executed, and lets effects do
 * again what is lost. `dropped` is a frame that the host has thrown away; 0: none. */
void virga_effects_settle(virga_context *context, uint64_t dropped);

/* Copies a block into the frame's part of a ring and returns its offset in bytes. push takes the next block. */
uint32_t virga_ring_push(virga_context *context, virga_ring *ring, const void *block, size_t size);
uint32_t virga_ring_write(virga_context *context, virga_ring *ring, uint32_t index, const void *block, size_t size);

/* Offset of the next push. */
uint32_t virga_ring_next_offset(const virga_context *context, const virga_ring *ring);

/* Number of blocks that were pushed in the current frame. */
uint32_t virga_ring_used(const virga_context *context, const virga_ring *ring);

/* Fills the bindings whose rows have a source; the others stay empty. */
void virga_effect_bound(const virga_effect *effect, const virga_bindings *bindings,
                        virga_bound bound[VIRGA_MAX_BINDINGS]);

/* The host's image, or `blank` if there is none. */
virga_bound virga_bound_or_blank(const virga_image *image, const virga_image_2d *blank, VkSampler sampler);

/* The sampler for a host's color image: linear, unless devices may not filter its format. */
VkSampler virga_color_sampler(const virga_context *context, const virga_image *image);

/* ---- statistics */

/* Copies `size` bytes of a buffer, and adds the call to the journal. The host can read them once this frame has
 * completed. */
void virga_effect_copy_statistics(virga_effect *effect, VkCommandBuffer cmd, uint32_t part, const virga_buffer *from,
                                  VkDeviceSize from_offset, VkDeviceSize to_offset, VkDeviceSize size);

/* Reads the statistics of all completed frames, oldest first. */
void virga_effect_read_statistics(virga_effect *effect);

/* ---- targets and draws */

virga_result virga_effect_attach(virga_effect *effect, const char *call, const virga_target *target);

/* Whether any target has motion vectors. */
bool virga_effect_wants_motion(const virga_effect *effect);

/* The common checks of a draw. Selects the view, and returns the target's pipelines in *found. VIRGA_NOT_READY if the
 * target is not attached or `prepared` is 0, as nothing was prepared in this frame; this is logged once, if the effect
 * is ready and was `stepped`: without a step nothing can be prepared. VIRGA_ERROR_INVALID if there is no such view, or
 * if its depth and that of the target run in different directions. */
virga_result virga_effect_check_draw(virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                     const virga_target *target, virga_prepared prepared, bool stepped,
                                     const virga_effect_target **found);

/* The same for draws that need no prepare. *found is NULL for a target that is not attached. */
virga_result virga_effect_find_target(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                      const virga_target *target, const virga_effect_target **found);

/* VIRGA_ERROR_INVALID, logged, if the target has several views and not this one, see virga_view.multiview_index. */
virga_result virga_effect_check_multiview(const virga_effect *effect, const char *call, const virga_target *target,
                                          uint32_t index);

/* Releases the pipelines of all targets. */
void virga_effect_retire_targets(virga_effect *effect);

/* For all effects of a context: releases pipelines whose targets are all destroyed. Not before the next frame, so that
 * a host may destroy its targets before it creates compatible ones. */
void virga_effects_free_targets(virga_context *context);

/* A target is being destroyed, and then its render pass. Pipelines that are still to be built for it are created again
 * for another target of its class, if there is one. */
void virga_effects_forget_target(const virga_target *target);

/* ---- views: effect_views.c */

/* The common checks of a prepare. Selects a view for it, whose buffers and images it may write, and which is no longer
 * drawn. VIRGA_NOT_READY if passes are not built, or if `stepped` is false: before the first step. */
virga_result virga_effect_check_prepare(virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                        const virga_view *view, double time_s, bool stepped);

/* Pushes the block of a view into a ring. Returns the index of the view in this frame, and the offset of the block. An
 * error if the frame has no room for another view. */
virga_result virga_effect_push_view(virga_effect *effect, const char *call, virga_ring *ring, const void *block,
                                    size_t size, uint32_t *index, uint32_t *offset);

/* Ends a prepare: stores what draws need, and gives the handle of the view to *prepared, which may be NULL. `offset` is
 * that of its block in the ring. */
void virga_effect_set_view(virga_effect *effect, VkDescriptorSet set, uint32_t offset, const virga_view *view,
                           virga_prepared *prepared);

/* Makes the buffers and images of a view the object's members. */
void virga_effect_select(virga_effect *effect, uint32_t slot);

/* The selected view. */
static inline const virga_effect_view *virga_effect_selected(const virga_effect *effect)
{
    return &effect->views[effect->slot];
}

/* The view of the newest prepare of this frame; 0: none, or it failed. */
virga_prepared virga_effect_newest(const virga_effect *effect);

/* Selects a prepared view of this frame. VIRGA_ERROR_INVALID, logged, if there is none with this handle. */
virga_result virga_effect_find_view(virga_effect *effect, const char *call, virga_prepared prepared);

/* Views that were prepared are no longer drawn: of a frame, or of all frames (0). */
void virga_effect_forget_views(virga_effect *effect, uint64_t frame);

/* The index of the prepare that is being recorded among those of its frame, at most VIRGA_MAX_VIEWS - 1: that of its
 * statistics. */
uint32_t virga_effect_view_index(const virga_effect *effect);

#endif
