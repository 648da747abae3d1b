/* particle.h - a particle of simulated water, as the water effect reads it. */
#ifndef VIRGA_SHARED_PARTICLE_H
#define VIRGA_SHARED_PARTICLE_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_particle_gpu virga_particle_gpu;
#endif

/* 32 bytes. A particle with a position that is not finite is left out. */
struct virga_particle_gpu {
    float position[3]; /* m, relative to virga_water_step_info.origin_m */
    /* [0; 1] part of its volume that counts: lets particles appear and vanish without a jump, e.g. over a tenth of a
     * second. Among others, a particle makes the surface higher by its share. Where all particles of a body of water
     * have a share, its surface stays where it is and covers so much of what is behind it: see virga_water_fading.
     * Spray is drawn in full size with so much of its coverage, and is not handed over below 1. */
    float share;
    float velocity[3]; /* m/s */
    uint id;           /* the same in all frames; its random numbers depend on it */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_particle_gpu, 32);
VIRGA_ASSERT_OFFSET(virga_particle_gpu, velocity, 16);
#undef uint
#endif

#endif
