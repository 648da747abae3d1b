/* ground_wet_gpu.h - what the draw of wet ground reads besides the view. Internal to Virga. */
#ifndef VIRGA_SHARED_GROUND_WET_GPU_H
#define VIRGA_SHARED_GROUND_WET_GPU_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_ground_wet_gpu virga_ground_wet_gpu;
#endif

/* Corners of maps are relative to the camera. */
struct virga_ground_wet_gpu {
    float low[2];        /* m, of the window, in x and z */
    float middle[2];     /* m, of the area that gets impacts */
    float far_low[2];    /* m, of the far map */
    float ripple_low[2]; /* m, of the ripple map */
    int low_cell[2];     /* of the window's low corner, modulo cells */
    int cells;           /* along a side of the window */
    int far_cells;       /* along a side of the far map */
    float cell_m;
    float far_cell_m;
    float ripple_m;    /* m, side of the ripple map */
    float base_m;      /* m, height 0 of the maps above the camera */
    float reach_m;     /* m, from `middle` on, within which the window has impacts; 0: everywhere */
    uint far_material; /* of the ground beyond the maps */
    float strength;
    float darkening;
    float mirror_reach_m;
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_ground_wet_gpu, 84);
#undef uint
#endif

#endif
