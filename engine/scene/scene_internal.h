/* scene/scene_internal.h - a scene as a list of effects, and the table of how they interact. Internal.
 *
 *   scene.c          creates, runs and destroys a scene: every function loops over the table
 *   scene_budget.c   how many ticks fit into a frame's time budget
 *   scene_cost.c     what a definition takes on a kind of device
 *   scene_effects.c  the table: which effects exist, and the events between them */
#ifndef VIRGA_SCENE_INTERNAL_H
#define VIRGA_SCENE_INTERNAL_H

#include "gpu/effect.h"

#include <virga/scene.h>

#define SCENE_MAX_KINDS 16
/* Times are late by the frames in flight. */
#define SCENE_KNOWN_FRAMES 16
#define SCENE_MAX_EFFECTS  (SCENE_MAX_KINDS + VIRGA_SCENE_MAX_PANES)

/* A kind of effect in a scene. The table has one row for each, in the order in which a frame steps them. For a NULL
 * member the default of the effect's type is used. */
/* Which effects have nothing to do with each other in a frame, once the rain has fallen: see gpu/lanes.h. */
typedef enum scene_lane {
    SCENE_ON_GROUND, /* what rain does on the ground, and effects that exchange nothing with others */
    SCENE_ON_PANES,
    SCENE_FIRST, /* others read what it writes. First in the table */
} scene_lane;

typedef struct scene_kind {
    const virga_effect_type *type;
    uint32_t draw_order; /* effects with lower numbers are attached, prepared and drawn first */

    /* The number of effects of this kind in a definition. NULL: one. */
    uint32_t (*count)(const virga_scene_def *def);
    /* Offset of its definition in the scene's. 0: the default definition. */
    size_t def;
    /* Changes the definition of one effect: values that it shares with other effects are copied from theirs. NULL: it
     * shares none. */
    void (*share)(const virga_scene_def *def, uint32_t index, void *effect_def);
    /* Checks the effect's part of a frame, before anything is recorded. NULL: nothing to check. */
    virga_result (*check_frame)(const virga_scene *scene, uint32_t index, const virga_scene_frame *frame);
    /* Records the effect's step, with events from earlier effects. NULL: the step of its type, without events. */
    virga_result (*step)(virga_scene *scene, uint32_t index, VkCommandBuffer cmd, const virga_scene_frame *frame);
    scene_lane lane;
} scene_kind;

/* Defined in scene_effects.c. */
extern const scene_kind scene_kinds[];
extern const uint32_t scene_kind_count;

/* The lane of a pane's step. In lane 0 are the ground and the splashes, whose spray it may catch. Panes that catch the
 * rain's drops are all in one, as the rain finds them one pane after the other. */
uint32_t scene_lane_of_pane(const virga_scene *scene, uint32_t index, const virga_scene_frame *frame);

/* An effect of a scene. */
typedef struct scene_effect {
    const scene_kind *kind;
    uint32_t index; /* index among the effects of its kind */
    virga_effect *effect;
} scene_effect;

struct virga_scene {
    virga_context *context;
    scene_effect effects[SCENE_MAX_EFFECTS]; /* by kind, in the order of the table */
    uint32_t effect_count;
    uint32_t draw_order[SCENE_MAX_EFFECTS]; /* indices of effects in the order in which they are drawn */
    /* The first panes, this many of them, catch the rain's drops. The others use its rate. */
    uint32_t catching_panes;
    /* It was logged that the view's camera is beyond the rain. Reset when it is inside. */
    bool far_logged;
    /* The frame that was recorded last, and the last frame in which it was logged that it was recorded again. */
    uint64_t recorded_frame, twice_frame;
    /* The views of the frame that was recorded last, as each effect has prepared them, by index of the effect. */
    virga_prepared views[VIRGA_MAX_VIEWS][SCENE_MAX_EFFECTS];
    uint32_t view_count, max_views;
    /* The ticks of the frames in flight, and of a few before them, to know what a tick takes. */
    struct {
        uint64_t frame;
        uint32_t ticks;
    } ticks_of[SCENE_KNOWN_FRAMES];
};

/* The ticks that a frame may run with that budget (ms); 0: any number. */
uint32_t scene_ticks_in_budget(virga_scene *scene, float budget_ms);

/* Remembers how many ticks this frame has run. */
void scene_note_ticks(virga_scene *scene, uint32_t ticks);

/* Effect number `index` of a type; NULL if the scene has no such effect. */
void *scene_find(const virga_scene *scene, const virga_effect_type *type, uint32_t index);

/* The first error; without one, the last result that is not VIRGA_OK. */
virga_result scene_merge_results(virga_result a, virga_result b);

#endif
