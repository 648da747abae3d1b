/* water/view_gpu.h - uniforms of the views of water, for C and for GLSL. */
#ifndef WATER_VIEW_GPU_H
#define WATER_VIEW_GPU_H

#include "../views/view_gpu.h"

#define WATER_VIEW_DENSITY 0
#define WATER_VIEW_SPRAY   1
#define WATER_VIEW_SURFELS 2

struct water_view_gpu {
    VIEW_VEC4 origin; /* of the particles, from the camera (m); spacing of particles (m) */
    VIEW_VEC4 spray;  /* density of splash particles at most, and of those that are partly spray */
    VIEW_UVEC4 first; /* index of the first particle in its buffer */
};

#endif
