/* scene/scene_internal.h - a scene as a list of effects, and the table that says how they meet. Internal.
 *
 *   scene.c          the life of a scene: every function walks the table
 *   scene_effects.c  the table: which effects there are, and the events between them
 */
#ifndef VIRGA_SCENE_INTERNAL_H
#define VIRGA_SCENE_INTERNAL_H

#include "gpu/effect.h"

#include <virga/scene.h>

#define SCENE_MAX_KINDS   16
#define SCENE_MAX_EFFECTS (SCENE_MAX_KINDS + VIRGA_SCENE_MAX_PANES)

/* A kind of effect, as scenes know it. Rows stand in the order in which a frame steps them. What a row leaves out is
 * as the effect's own type has it. */
typedef struct scene_kind {
    const virga_effect_type *type;
    uint32_t draw_order; /* lower ones are attached, prepared and drawn first */

    /* How many of these a definition asks for. NULL: one. */
    uint32_t (*count)(const virga_scene_def *def);
    /* Fills the definition of one of them: its own, with what it shares with others copied from theirs. NULL: the
     * default. */
    void (*define)(const virga_scene_def *def, uint32_t index, void *effect_def);
    /* Checks what a frame says for it, before anything is recorded. NULL: nothing. */
    virga_result (*check_frame)(const virga_scene *scene, uint32_t index, const virga_scene_frame *frame);
    /* Records its step, with the events of those before it. NULL: it needs none. */
    virga_result (*step)(virga_scene *scene, uint32_t index, VkCommandBuffer cmd, const virga_scene_frame *frame);
} scene_kind;

/* In scene_effects.c. */
extern const scene_kind scene_kinds[];
extern const uint32_t scene_kind_count;

/* An effect of a scene. */
typedef struct scene_effect {
    const scene_kind *kind;
    uint32_t index; /* among those of its kind */
    virga_effect *effect;
} scene_effect;

struct virga_scene {
    virga_context *context;
    scene_effect effects[SCENE_MAX_EFFECTS]; /* by kind, in the order of the table */
    uint32_t effect_count;
    uint32_t draw_order[SCENE_MAX_EFFECTS]; /* indices of effects in the order in which they are drawn */
    uint32_t catching_panes; /* so many panes, from the first on, catch the rain's drops; the others get its rate */
    bool far_logged;         /* that the view's camera is beyond the rain, since it was within */
};

/* An effect of a type; NULL where the scene has none of that number. */
void *scene_find(const virga_scene *scene, const virga_effect_type *type, uint32_t index);

/* The first error, else the last remark. */
virga_result scene_merge_results(virga_result a, virga_result b);

#endif
