/* ground_state.h - the ground of a shot: what the files of the effect `ground` share. */
#ifndef VIRGA_EFFECTS_GROUND_STATE_H
#define VIRGA_EFFECTS_GROUND_STATE_H

#include "effect.h"

typedef struct ground_state {
    virga_ground *ground;                /* NULL: none */
    virga_rain *rain;                    /* for the sums of water */
    host_image material_image;           /* of ground.material_map; none: all 0 */
    virga_ground_material_map materials; /* likewise */
} ground_state;

/* ---- bench.c */

extern const tool_bench ground_bench;

/* ---- view.c */

#define GROUND_VIEWS 4

extern const tool_view ground_views[GROUND_VIEWS];
bool ground_fill_budget(const void *state, uint32_t index, tool_budget *budget);

#endif
