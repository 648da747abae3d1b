/* spray.h - a droplet of the water effect's spray. */
#ifndef VIRGA_SHARED_SPRAY_H
#define VIRGA_SHARED_SPRAY_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_spray_gpu virga_spray_gpu;
#endif

/* 32 bytes. A sphere of water. The droplets of a particle follow each other. */
struct virga_spray_gpu {
    float position[3]; /* m, relative to virga_water_step_info.origin_m */
    float radius;      /* m */
    float velocity[3]; /* m/s */
    uint id;           /* the same in all frames: virga_hash2(id of the particle, number of the droplet) */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_spray_gpu, 32);
VIRGA_ASSERT_OFFSET(virga_spray_gpu, velocity, 16);
#undef uint
#endif

#endif
