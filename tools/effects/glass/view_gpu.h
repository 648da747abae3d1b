/* glass/view_gpu.h - uniforms of the views of panes, for C and for GLSL. */
#ifndef GLASS_VIEW_GPU_H
#define GLASS_VIEW_GPU_H

#include "../views/view_gpu.h"

#define GLASS_VIEW_AFFINITY 0
#define GLASS_VIEW_HEIGHT   1

#define GLASS_VIEW_BLADES 8

struct glass_view_gpu {
    VIEW_VEC4 pane;                      /* width, height (m), side of a cell (m), width of the particles' band (m) */
    VIEW_UVEC4 cells;                    /* columns, rows, blades; 1 where there is a height map */
    VIEW_VEC4 drop;                      /* water (nl) of a drop with a base of 1 m radius, radius of a particle (m) */
    VIEW_VEC4 height_map;                /* columns and rows in use, threshold */
    VIEW_VEC4 blades[GLASS_VIEW_BLADES]; /* both ends, metres on the pane */
};

#endif
