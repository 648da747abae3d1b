/* effect.h - what the program knows of an effect, as one table.
 *
 * Every effect has one file here that defines its table, and one entry in the list in meson.build. Everything else
 * walks the tables: no other file of the program has to know a new effect. All but `name` may be left out.
 *
 * Functions get the effect's own state, which is all zero when a shot opens. They are called for effects that the scene
 * does not use too, unless it says otherwise. Those that return bool write one line into `error` where they fail. */
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

/* One layer of a frame: channels in its EXR. */
typedef struct tool_layer {
    const char *name;        /* for --layers */
    const char *channels[4]; /* NULL behind the last */
    exr_sample type;
    const char *help;
    /* Draws into a picture of its own over the plate. NULL: the layer is part of the plate. Inside rendering. */
    virga_result (*draw)(void *state, VkCommandBuffer cmd, const virga_target *target);
    int order;         /* layers with a higher order cover those with a lower one */
    bool is_data;      /* no color: it is not part of the beauty, and of several sub-frames one counts */
    host_output plate; /* (no draw) the output that holds it, */
    uint32_t value;    /* from this value of each pixel on */
    /* (draw) In `virga view`. */
    const char *view_title, *view_help;
} tool_layer;

/* A cache of points, a file per frame: NAME.%04u.ply. */
typedef struct tool_points {
    const ply_property *properties;
    uint32_t property_count;
    size_t stride;       /* of a row, bytes */
    const char *comment; /* first line of the file */
    const char *help;
    /* Records the copies for `read`, after each step. */
    bool (*record)(shot *s, void *state, VkCommandBuffer cmd, char *error, size_t error_size);
    /* Rows of the newest step, which need free(). */
    bool (*read)(shot *s, void *state, void **rows, uint32_t *count, char *error, size_t error_size);
} tool_points;

/* When and through which cameras a picture is taken. */
typedef struct tool_moment {
    const virga_view *jittered; /* with the jitter of its sub-frame, */
    const virga_view *steady;   /* and without: streaks are smooth, jitter would make kinks of them */
    double camera_s;            /* time on the camera's path */
    double late_s;              /* before the newest tick */
} tool_moment;

/* ---- virga view */

/* In the order of the list of views. */
typedef enum tool_view_kind {
    TOOL_VIEW_PLATE,   /* an output of the plate */
    TOOL_VIEW_PICTURE, /* something where the picture shows it */
    TOOL_VIEW_FLAT,    /* a map of its own */
    TOOL_VIEW_KINDS,
} tool_view_kind;

/* What the shader of a view reads beside the outputs, see views/view_common.glsl. What is left out is blank. */
typedef struct tool_view_data {
    const host_camera *camera;
    uint32_t item;
    void *own; /* TOOL_VIEW_BYTES of uniforms, all zero before */
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
    uint32_t mode;                        /* for its shader */
    host_code fragment;                   /* draws it */
    host_code quad_vertex, quad_fragment; /* and, over it, quads: */
    uint32_t (*quad_count)(const void *state, uint32_t item);
    void (*fill)(shot *s, void *state, tool_view_data *data);
    /* How many there are of it; NULL: one. 0: it shows nothing here. */
    uint32_t (*item_count)(const void *state);
    /* (two and more) Text of the control that chooses one, with %d for its number. */
    void (*print_item)(const void *state, uint32_t item, char *text, size_t size);
    /* Colors that it shows by number, and what they stand for; NULL behind the last. */
    const char *(*legend)(uint32_t index, float color[3]);
    bool wide_legend; /* in two columns */
    bool debug_map;   /* needs shot_options.debug_maps */
} tool_view;

/* A graph of a count. */
typedef struct tool_count {
    const char *what;
    double (*value)(const void *state);
} tool_count;

#define TOOL_BUDGET_ROWS 12

/* A budget of water, in nanolitres. */
typedef struct tool_budget {
    const char *title;
    struct tool_budget_row {
        const char *what;
        uint64_t nl, of_nl; /* the whole; 0: no share is shown */
    } rows[TOOL_BUDGET_ROWS];
    uint32_t row_count;
} tool_budget;

/* ---- virga bench */

struct bench;

typedef struct tool_bench {
    const char *help;       /* lines, each with its end */
    const option_row *rows; /* its options */
    size_t row_count;
    bool (*check)(const options *parsed); /* its options, before a device is opened; may be NULL */
    bool (*run)(struct bench *b, const options *parsed);
} tool_bench;

/* ---- the effect */

typedef struct tool_effect {
    const char *name;    /* of its keys, layers and files */
    scene_section scene; /* keys of scene files; see scene_schema.h */

    /* Whether the scene uses it; NULL: always. Else `missing` says what the scene has none of. */
    bool (*is_used)(const scene_file *scene);
    const char *missing; /* "panes; expected a list of them, glass" */

    /* The key of the seed of all that is random, and its value: of the effect that the others get it from. */
    const char *seed_key;
    uint32_t (*seed)(const scene_file *scene);

    /* ---- virga check, and before a device is opened */

    /* What only the effect can judge. Calls scene_file_refuse. */
    bool (*check)(const scene_file *scene, char *error, size_t error_size);
    /* Reads the files that its keys name, and prints a line for each. */
    bool (*check_files)(const scene_file *scene, char *error, size_t error_size);
    void (*print)(const scene_file *scene);

    /* ---- life */

    size_t state_size; /* 0: no state */
    /* Its part of the simulation's definition; what that points to lives until `close`. */
    bool (*define)(shot *s, void *state, virga_scene_def *def, char *error, size_t error_size);
    /* A mesh of the scene was loaded. */
    void (*mark_mesh)(const scene_file *scene, host_mesh *mesh);
    /* The simulation was created. */
    bool (*open)(shot *s, void *state, char *error, size_t error_size);
    /* The target has another size, at the start too. Only where something is drawn. */
    bool (*resize)(shot *s, void *state, char *error, size_t error_size);
    /* Targets of its own. Only where something is drawn, after all `open` and `resize`. */
    bool (*attach)(shot *s, void *state, char *error, size_t error_size);
    void (*close)(shot *s, void *state);

    /* ---- time */

    /* Settings of a time. */
    bool (*apply)(shot *s, void *state, double time_s, char *error, size_t error_size);
    /* Its part of what the simulation gets for a step. */
    bool (*fill_frame)(shot *s, void *state, double time_s, const host_camera *camera, virga_scene_frame *frame,
                       char *error, size_t error_size);
    /* Records passes that are not the simulation's. */
    bool (*step)(shot *s, void *state, VkCommandBuffer cmd, double dt_s, char *error, size_t error_size);

    /* ---- picture: of effects in the order of their layers */

    const tool_layer *layers;
    uint32_t layer_count;
    bool shows_behind; /* it is prepared after all layers of a lower order are drawn, and view.color has them in it */
    /* What changes in the opaque scene. */
    bool (*before_plate)(shot *s, void *state, VkCommandBuffer cmd, double camera_s, char *error, size_t error_size);
    bool (*prepare)(shot *s, void *state, VkCommandBuffer cmd, const tool_moment *at, char *error, size_t error_size);

    /* ---- files of a frame */

    const tool_points *points;
    /* Its object in a line of stats.jsonl. */
    void (*write_stats)(shot *s, void *state, jsonl *stats);
    /* Sums over several effects, behind the objects of all. */
    void (*write_totals)(shot *s, void *state, jsonl *stats);

    const tool_bench *bench;

    /* ---- virga view */

    const char *title; /* of its settings on the panel; NULL: none */
    /* (its keys are a list) Title of an entry's settings; false behind the last. */
    bool (*print_entry)(const scene_file *scene, uint32_t entry, char *title, size_t size);
    bool lists_restart; /* it starts again where one of its lists has another length */
    /* Settings that stand first on the panel, by index: a path, and a caption or "". False behind the last. */
    bool (*main_setting)(const scene_file *scene, uint32_t index, char *path, size_t path_size, char *caption,
                         size_t caption_size);
    /* Whether keys of the scene animate settings; and the end of that, with their values at a time. */
    bool (*is_animated)(const scene_file *scene);
    void (*stop_animation)(scene_file *scene, double time_s);
    const char *animation_hint;
    /* The weather in a few words, for a script's `print`. */
    void (*print_state)(const scene_file *scene, char *text, size_t size);
    const tool_view *views;
    uint32_t view_count;
    const tool_count *counts;
    uint32_t count_count;
    const char *water_text; /* a line with its water */
    uint64_t (*water_nl)(const void *state);
    /* Tables by index; false behind the last. */
    bool (*fill_budget)(const void *state, uint32_t index, tool_budget *budget);
} tool_effect;

/* rain_effect, ground_effect, ... */
#define EFFECT(name) extern const tool_effect name##_effect;
#include "effect_list.h"
#undef EFFECT

/* All effects, in the order of their keys in scene files; NULL behind the last. */
extern const tool_effect *const tool_effects[];

/* Their sections, for scene_file_load; NULL behind the last. */
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
