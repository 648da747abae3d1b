/* landing.h - what an impact met on the ground: what ground writes beside rain's impacts, for hosts. */
#ifndef VIRGA_SHARED_LANDING_H
#define VIRGA_SHARED_LANDING_H

#include "ground_limits.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_landing_gpu virga_landing_gpu;
#endif

/* The landing of the impact of the same index, 24 bytes; those of returns lie behind max_impacts of drops. What was
 * there before this tick's drops. */
struct virga_landing_gpu {
    uint cell;        /* its index in the ground's buffers; 0xffffffff: not on the ground */
    uint state;       /* VIRGA_GROUND_NONE to VIRGA_GROUND_PUDDLE_10 */
    float depth_m;    /* of the water */
    uint material;    /* [0; 31] of the cell; of the impact where there is no ground */
    uint first_spawn; /* where among the spawns its first splash is; 0xffffffff: none */
    /* which of its pieces splash, a bit each: decided once, as floats may come out otherwise elsewhere */
    uint splashing;
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_landing_gpu, 24);
#undef uint
#endif

#endif
