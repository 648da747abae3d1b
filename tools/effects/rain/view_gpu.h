/* rain/view_gpu.h - uniforms of the view of occlusion maps, for C and for GLSL. */
#ifndef RAIN_VIEW_GPU_H
#define RAIN_VIEW_GPU_H

#include "../views/view_gpu.h"

struct rain_view_gpu {
    /* of occlusion maps: top, from there to the bottom; lowest that has a color of its own (m); 1 where there
     * are maps */
    VIEW_VEC4 heights;
};

#endif
