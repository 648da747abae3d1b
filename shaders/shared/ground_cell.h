/* ground_cell.h - a cell of the ground and its water, as ground's passes write them. Hosts may read them, see
 * virga_ground_cells. Water is in whole nanolitres, heights are in whole micrometres. */
#ifndef VIRGA_SHARED_GROUND_CELL_H
#define VIRGA_SHARED_GROUND_CELL_H

#include "ground_limits.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_floor_gpu virga_floor_gpu;
typedef struct virga_cell_gpu virga_cell_gpu;
#endif

/* The floor of a cell. */
struct virga_floor_gpu {
    /* um, height of the cell's centre above the ground's base_m; includes the unevenness of the material */
    int height_um;
    uint material; /* [0; 31]; 0xff: no ground */
};

/* The water of a cell. */
struct virga_cell_gpu {
    uint free_nl; /* nl, on the surface */
    uint held_nl; /* nl, in the pores */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_floor_gpu, 8);
VIRGA_ASSERT_SIZE(virga_cell_gpu, 8);
#undef uint
#endif

#endif
