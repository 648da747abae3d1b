/* body_near.h - the solid body beside a particle of simulated water, as the foam of the water effect reads it. */
#ifndef VIRGA_SHARED_BODY_NEAR_H
#define VIRGA_SHARED_BODY_NEAR_H

#include "types.h"

#ifndef VIRGA_GLSL
typedef struct virga_body_near_gpu virga_body_near_gpu;
#endif

/* 32 bytes. The body's surface is taken as a plane. */
struct virga_body_near_gpu {
    float normal[3];   /* out of the body, of length 1 */
    float distance_m;  /* of the particle's center from the surface; below 0 in the body. Far away, say 1e9: none */
    float velocity[3]; /* of the body there (m/s) */
    float share; /* [0; 1] how much of what lies behind the plane is body: 1 at a flat side, 1/2 at a right edge */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_body_near_gpu, 32);
VIRGA_ASSERT_OFFSET(virga_body_near_gpu, velocity, 16);
#endif

#endif
