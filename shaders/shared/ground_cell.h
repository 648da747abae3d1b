/* ground_cell.h - what a cell of the ground is and holds, as its passes leave it and hosts may read it, see
 * virga_ground_cells. Water is in whole nanolitres, heights in whole micrometres. */
#ifndef VIRGA_SHARED_GROUND_CELL_H
#define VIRGA_SHARED_GROUND_CELL_H

#include "ground_limits.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_floor_gpu virga_floor_gpu;
typedef struct virga_cell_gpu virga_cell_gpu;
#endif

/* What a cell is. */
struct virga_floor_gpu {
    int height_um; /* of its middle above the ground's base_m, its material's unevenness in it */
    uint material; /* [0; 31]; 0xff: there is no ground */
};

/* What a cell holds. */
struct virga_cell_gpu {
    uint free_nl; /* on it */
    uint held_nl; /* in its pores */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_floor_gpu, 8);
VIRGA_ASSERT_SIZE(virga_cell_gpu, 8);
#undef uint
#endif

#endif
