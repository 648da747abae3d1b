/* ground/view_gpu.h - uniforms of the views of the ground, for C and for GLSL. */
#ifndef GROUND_VIEW_GPU_H
#define GROUND_VIEW_GPU_H

#include "../views/view_gpu.h"

#define GROUND_VIEW_WETNESS  0
#define GROUND_VIEW_DEPTH    1
#define GROUND_VIEW_STATE    2
#define GROUND_VIEW_MATERIAL 3

#define GROUND_VIEW_PALETTE 32

struct ground_view_gpu {
    /* low corner of the window of cells relative to the camera (x, z), 1 / side of a cell, cells; 0: no ground */
    VIEW_VEC4 ground;
    VIEW_IVEC4 cells;                       /* first tile of the window (x, z), tiles, nl of a micrometre on a cell */
    VIEW_VEC4 heights;                      /* of the camera above the base of the ground's floors */
    VIEW_UVEC4 capacity[8];                 /* nl that pores hold, by material */
    VIEW_VEC4 palette[GROUND_VIEW_PALETTE]; /* by state or material */
};

#endif
