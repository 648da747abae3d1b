/* surfel.h - a surfel of the water effect: a disk on the surface of the water. */
#ifndef VIRGA_SHARED_SURFEL_H
#define VIRGA_SHARED_SURFEL_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_surfel_gpu virga_surfel_gpu;
#endif

/* 32 bytes. */
struct virga_surfel_gpu {
    float position[3]; /* m, relative to virga_water_step_info.origin_m */
    uint normal;       /* out of the water; octahedral, two signed 16-bit integers, see shaders/water/octahedron.glsl */
    float velocity[3]; /* m/s */
    float radius;      /* m. The lowest eight bits are 255 x (1 - the share of the water around it) */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_surfel_gpu, 32);
#undef uint
#endif

#endif
