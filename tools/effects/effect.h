/* effect.h - declares the table through which the program uses an effect.
 *
 * Every effect has one file here that defines its table, and one entry in the list in meson.build. All other code
 * loops over the tables, so no other file of the program has to change for a new effect. All members but `name` are
 * optional.
 *
 * Functions get the effect's own state, which is all zero when a shot opens. They are also called for effects that the
 * scene does not use, unless noted otherwise. A function that returns bool writes one line into `error` if it fails. */
#ifndef VIRGA_EFFECTS_EFFECT_H
#define VIRGA_EFFECTS_EFFECT_H

#include "exr.h"
#include "jsonl.h"
#include "options.h"
#include "ply.h"
#include "scene_schema.h"
#include "shot_state.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What depth a lens blurs a layer by. */
typedef enum tool_layer_depth {
    TOOL_DEPTH_DRAWN, /* its own: drawing it writes depth */
    TOOL_DEPTH_SCENE, /* that of the scene, which it lies on */
    TOOL_DEPTH_FOCUS, /* none: what is drawn is as blurred as it should be */
} tool_layer_depth;

/* One layer of a frame: channels in its EXR. */
typedef struct tool_layer {
    const char *name;        /* for --layers */
    const char *channels[4]; /* NULL after the last */
    exr_sample type;
    const char *help;
    /* Draws the layer into its own image. Called inside a render pass. NULL: the layer is part of the plate. */
    virga_result (*draw)(void *state, VkCommandBuffer cmd, const virga_target *target);
    int order; /* layers with a higher order cover those with a lower one */
    tool_layer_depth depth;
    bool is_data; /* not a color: not part of the beauty layer, and taken from one sub-frame, not averaged */
    /* Number of samples from which on it is averaged from some sub-frames only, as it hardly differs between them but
     * at edges of the scene. What shows small lamps sharply needs four pictures of them. 0: all sub-frames have it. */
    uint32_t shared_from;
    /* (shared_from) It moves, so it is drawn over the whole time of the sub-frames that share it: `prepare` gets the
     * moment at which the last of them closes, with the shutter of all. */
    bool spans;
    /* (is_data) Its values are pixels right and down: 1 to another place, -1 from a place a frame ago; 0: others. */
    int offset;
    host_output plate; /* (no draw) the output that holds the layer */
    uint32_t value;    /* (no draw) index of the layer's first value in a pixel of that output */
    /* (draw) In `virga view`. */
    const char *view_title, *view_help;
} tool_layer;

/* The fields of a layer of premultiplied color, NAME.R to NAME.A. */
#define TOOL_COLOR_LAYER(layer, draw_function, draw_order, title, text)                                        \
    .name = layer, .channels = {layer ".R", layer ".G", layer ".B", layer ".A"}, .type = EXR_SAMPLE_HALF,      \
    .help = text ", premultiplied", .draw = draw_function, .order = draw_order, .view_title = "Layer: " title, \
    .view_help = text ", over squares"

/* A cache of points, a file per frame: NAME.%04u.ply. */
typedef struct tool_points {
    const char *name;               /* NULL: that of the effect */
    const struct tool_points *next; /* a further cache of the effect; NULL: none */
    const ply_property *properties;
    uint32_t property_count;
    size_t stride;       /* bytes per row */
    const char *comment; /* first line of the file */
    const char *help;
    /* Records the copies for `read`, after each step. */
    bool (*record)(shot *s, void *state, VkCommandBuffer cmd, char *error, size_t error_size);
    /* Returns the rows of the newest step. The caller frees them with free(). */
    bool (*read)(shot *s, void *state, void **rows, uint32_t *count, char *error, size_t error_size);
} tool_points;

/* Vertices and triangles of a mesh. */
typedef struct tool_mesh_data {
    void *vertices;
    uint32_t vertex_count;
    uint32_t (*triangles)[3];
    uint32_t triangle_count;
} tool_mesh_data;

/* A triangle mesh, a file per frame: `name`.%04u.ply. */
typedef struct tool_mesh {
    const char *name;
    const ply_property *properties; /* of vertices */
    uint32_t property_count;
    size_t stride;       /* bytes per vertex */
    const char *comment; /* first line of the file */
    const char *help;
    /* Makes that of the newest step. The caller frees vertices and triangles with free(). */
    bool (*make)(shot *s, void *state, tool_mesh_data *data, char *error, size_t error_size);
} tool_mesh;

/* A volume, a file per frame: `name`.%04u.vdb. */
typedef struct tool_volume {
    const char *name;
    const char *help;
    /* Writes that of the newest step. */
    bool (*write)(shot *s, void *state, const char *path, char *error, size_t error_size);
} tool_volume;

/* The time and the views of an image. */
typedef struct tool_moment {
    const virga_view *jittered; /* with the jitter of the sub-frame */
    const virga_view *steady;   /* without jitter: it would bend streaks, which are smooth */
    double camera_s;            /* time on the camera's path */
    double late_s;              /* seconds before the newest tick */
    double focus_inv_m;         /* 1 / view depth that is in focus; 0: infinity */
} tool_moment;

/* ---- virga view */

/* In the order in which views are listed. */
typedef enum tool_view_kind {
    TOOL_VIEW_PLATE,   /* an output of the plate */
    TOOL_VIEW_PICTURE, /* drawn from the camera, over the scene */
    TOOL_VIEW_FLAT,    /* a flat map */
    TOOL_VIEW_KINDS,
} tool_view_kind;

/* Inputs of the shader of a view, in addition to the outputs. See views/view_common.glsl. Missing inputs are blank. */
typedef struct tool_view_data {
    const host_camera *camera;
    uint32_t item;
    void *own; /* the view's uniforms: TOOL_VIEW_BYTES bytes, initially zero */
    VkImageView array, image;
    VkImageLayout array_layout, image_layout;
    VkBuffer buffers[2];
} tool_view_data;

#define TOOL_VIEW_BYTES 1024

/* A debug view. */
typedef struct tool_view {
    const char *name; /* one word, for scripts */
    const char *title, *help;
    tool_view_kind kind;
    uint32_t mode;                        /* passed to its shader */
    host_code fragment;                   /* draws the view */
    host_code quad_vertex, quad_fragment; /* draw quads on top of it */
    uint32_t (*quad_count)(const void *state, uint32_t item);
    void (*fill)(shot *s, void *state, tool_view_data *data);
    /* Number of items, e.g. panes. NULL: one. 0: the view shows nothing in this scene. */
    uint32_t (*item_count)(const void *state);
    /* (two or more items) Text of the control that selects one, with %d for its number. */
    void (*print_item)(const void *state, uint32_t item, char *text, size_t size);
    /* An entry of the legend: sets a color and returns its meaning. NULL after the last. */
    const char *(*legend)(uint32_t index, float color[3]);
    bool wide_legend; /* in two columns */
    bool debug_map;   /* needs shot_options.debug_maps */
} tool_view;

/* The fields that all views have. `shader` is the name of its fragment shader's array, without _spv. */
#define TOOL_VIEW(view_name, view_title, view_kind, view_mode, shader, text)                    \
    .name = view_name, .title = view_title, .help = text, .kind = view_kind, .mode = view_mode, \
    .fragment = {shader##_spv, sizeof shader##_spv}

/* A graph of a count. */
typedef struct tool_count {
    const char *what;
    double (*value)(const void *state);
} tool_count;

#define TOOL_BUDGET_ROWS 14

/* A budget of water, in nanolitres. */
typedef struct tool_budget {
    const char *title;
    struct tool_budget_row {
        const char *what;
        uint64_t nl, of_nl; /* `of_nl`: the total; 0: no share is shown */
    } rows[TOOL_BUDGET_ROWS];
    uint32_t row_count;
} tool_budget;

/* ---- virga bench */

struct bench;

typedef struct tool_bench {
    const char *name;              /* NULL: that of the effect */
    const struct tool_bench *next; /* a further bench of the effect; NULL: none */
    const char *help;              /* lines, each ends with a newline */
    const option_row *rows;        /* its options */
    size_t row_count;
    bool (*check)(const options *parsed); /* checks its options before a device is opened; may be NULL */
    bool (*run)(struct bench *b, const options *parsed);
} tool_bench;

/* The fields of a bench with options: a table `option_rows`, and these functions. */
#define TOOL_BENCH(check_function, run_function)                                                           \
    .rows = option_rows, .row_count = sizeof option_rows / sizeof option_rows[0], .check = check_function, \
    .run = run_function

/* ---- the effect */

typedef struct tool_effect {
    const char *name;    /* used in its keys, layers and files */
    scene_section scene; /* its keys in scene files; see scene_schema.h */

    /* Whether the scene uses it. NULL: always. If not, `missing` names what the scene lacks. */
    bool (*is_used)(const scene_file *scene);
    const char *missing; /* "panes; expected a list of them, glass" */
    /* Whether a step of it takes longer than to draw a frame: several processes, each of which steps through all
     * frames, are no quicker then. NULL: never. */
    bool (*has_slow_steps)(const scene_file *scene);

    /* The key and the value of the random seed. Only one effect has them; the others use its seed. */
    const char *seed_key;
    uint32_t (*seed)(const scene_file *scene);

    /* ---- virga check, and before a device is opened */

    /* Checks what the schema can not express. Reports errors by scene_file_refuse. */
    bool (*check)(const scene_file *scene, char *error, size_t error_size);
    /* Reads the pictures that its keys name: small files, for a shot that is about to begin. */
    bool (*check_pictures)(const scene_file *scene, char *error, size_t error_size);
    /* (virga check) Reads all files that its keys name, and prints a line for each. */
    bool (*check_files)(const scene_file *scene, char *error, size_t error_size);
    void (*print)(const scene_file *scene);

    /* ---- create and destroy */

    size_t state_size; /* 0: no state */
    /* Fills its part of the simulation's definition. What the definition points to must live until `close`. */
    bool (*define)(shot *s, void *state, virga_scene_def *def, char *error, size_t error_size);
    /* Called after a mesh of the scene is loaded. */
    void (*mark_mesh)(const scene_file *scene, host_mesh *mesh);
    /* Called then too, with its geometry. */
    bool (*read_mesh)(shot *s, const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices, char *error,
                      size_t error_size);
    /* Called after the simulation is created. */
    bool (*open)(shot *s, void *state, char *error, size_t error_size);
    /* Called at the start and when the size of the target changes. Only for shots that draw. */
    bool (*resize)(shot *s, void *state, char *error, size_t error_size);
    /* Creates its own targets. Only for shots that draw, after all `open` and `resize`. */
    bool (*attach)(shot *s, void *state, char *error, size_t error_size);
    void (*close)(shot *s, void *state);

    /* ---- time */

    /* Applies the settings of a time. */
    bool (*apply)(shot *s, void *state, double time_s, char *error, size_t error_size);
    /* Records what comes before the step of the simulation, which ends at `time_s` and takes `dt_s`. */
    bool (*before_step)(shot *s, void *state, VkCommandBuffer cmd, double time_s, double dt_s, char *error,
                        size_t error_size);
    /* Fills its part of the simulation's input for a step. */
    bool (*fill_frame)(shot *s, void *state, double time_s, const host_camera *camera, virga_scene_frame *frame,
                       char *error, size_t error_size);
    /* Records passes that are not part of the simulation. */
    bool (*step)(shot *s, void *state, VkCommandBuffer cmd, double dt_s, char *error, size_t error_size);

    /* ---- checkpoints: states of its own, besides that of the simulation. They are as virga/state.h has them. */

    /* Bytes of its state. 0: the scene has none. */
    VkDeviceSize (*saved_bytes)(const void *state);
    bool (*save)(shot *s, void *state, VkCommandBuffer cmd, const virga_state_range *to, char *error,
                 size_t error_size);
    /* Goes on from it; it is the state at `time_s`. */
    bool (*load)(shot *s, void *state, VkCommandBuffer cmd, const virga_state_source *from, double time_s, char *error,
                 size_t error_size);

    /* ---- image: called in the order of the effects' layers */

    const tool_layer *layers;
    uint32_t layer_count;
    bool after_plate;  /* it is prepared after the opaque scene is drawn, and may read its color and depth then */
    bool shows_behind; /* it is prepared after all layers of a lower order are drawn, and view.color contains them */
    bool in_air;       /* (shows_behind) that is as sharp as it is; else a lens has blurred it before */
    /* Updates what changes in the opaque scene. */
    bool (*before_plate)(shot *s, void *state, VkCommandBuffer cmd, double camera_s, char *error, size_t error_size);
    bool (*prepare)(shot *s, void *state, VkCommandBuffer cmd, const tool_moment *at, char *error, size_t error_size);

    /* ---- files of a frame */

    const tool_points *points;
    const tool_mesh *mesh;
    const tool_volume *volume;
    /* Finds something by name that a camera can focus on, for a camera at a time of its path: a point of it, and the
     * normal of its surface there, or all zero. NULL: it has nothing that has a name. */
    bool (*find)(shot *s, void *state, const char *name, double camera_s, double point_m[3], double normal[3]);

    /* Whether a scene has such a thing. */
    bool (*has)(const scene_file *scene, const char *name);

    /* Writes its object in a line of stats.jsonl. */
    void (*write_stats)(shot *s, void *state, jsonl *stats);
    /* Writes sums over several effects, after the objects of all effects. */
    void (*write_totals)(shot *s, void *state, jsonl *stats);

    const tool_bench *bench;

    /* ---- virga view */

    const char *title; /* title of its settings on the panel; NULL: none */
    /* (its keys are a list) Title of an entry's settings. False after the last. */
    bool (*print_entry)(const scene_file *scene, uint32_t entry, char *title, size_t size);
    bool lists_restart; /* it restarts when the length of one of its lists changes */
    /* The settings at the top of the panel, by index: a path, and a caption or "". False after the last. */
    bool (*main_setting)(const scene_file *scene, uint32_t index, char *path, size_t path_size, char *caption,
                         size_t caption_size);
    /* Whether keys of the scene animate settings. `stop_animation` replaces them by their values at a time. */
    bool (*is_animated)(const scene_file *scene);
    void (*stop_animation)(scene_file *scene, double time_s);
    const char *animation_hint;
    /* The weather in a few words, for a script's `print`. */
    void (*print_state)(const scene_file *scene, char *text, size_t size);
    const tool_view *views;
    uint32_t view_count;
    const tool_count *counts;
    uint32_t count_count;
    const char *water_text; /* label of the line with its water */
    uint64_t (*water_nl)(const void *state);
    /* Fills a table, by index. False after the last. */
    bool (*fill_budget)(const void *state, uint32_t index, tool_budget *budget);
} tool_effect;

/* The fields that are the same for all effects, for one that names its parts like the others: NAME_state, NAME_bench,
 * a table `layers`, and the functions print, define, open_state and close_state. */
#define TOOL_EFFECT(effect, effect_title)                                                                           \
    .name = #effect, .title = effect_title, .print = print, .state_size = sizeof(effect##_state), .define = define, \
    .open = open_state, .close = close_state, .layers = layers, .layer_count = sizeof layers / sizeof layers[0],    \
    .bench = &effect##_bench

/* The fields of an effect that only some scenes use. */
#define TOOL_USED_IF(function, what_is_missing) .is_used = function, .missing = what_is_missing

/* A table and its number of rows: TOOL_ROWS(view, rain_views) sets .views and .view_count. */
#define TOOL_ROWS(row, table) .row##s = table, .row##_count = sizeof table / sizeof table[0]

/* Defines scene_NAME_of, which returns the effect's settings in a scene. */
#define TOOL_SECTION_OF(effect)                                   \
    scene_##effect *scene_##effect##_of(const scene_file *scene)  \
    {                                                             \
        return scene_file_section(scene, &effect##_effect.scene); \
    }

/* rain_effect, ground_effect, ... */
#define EFFECT(name) extern const tool_effect name##_effect;
#include "effect_list.h"
#undef EFFECT

/* All effects, in the order of their keys in scene files. NULL after the last. */
extern const tool_effect *const tool_effects[];

/* Their sections, for scene_file_load. NULL after the last. */
extern const scene_section *const tool_effect_sections[];

/* The seed of a scene, and its key. */
uint32_t tool_seed(const scene_file *scene);
const char *tool_seed_key(void);

/* Whether a scene uses an effect. */
bool tool_effect_is_used(const tool_effect *effect, const scene_file *scene);

#ifdef __cplusplus
}
#endif
#endif
