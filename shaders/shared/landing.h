/* landing.h - what an impact hit on the ground: ground writes one landing for each impact of rain. For hosts. */
#ifndef VIRGA_SHARED_LANDING_H
#define VIRGA_SHARED_LANDING_H

#include "ground_limits.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_landing_gpu virga_landing_gpu;
#endif

/* The landing of the impact of the same index, 24 bytes. Landings of returns start at index max_impacts. State and
 * depth are those before this tick's drops. */
struct virga_landing_gpu {
    uint cell;        /* index in the ground's buffers; 0xffffffff: not on the ground */
    uint state;       /* VIRGA_GROUND_NONE to VIRGA_GROUND_PUDDLE_10 */
    float depth_m;    /* m, of the water */
    uint material;    /* [0; 31], of the cell; where there is no ground: of the impact */
    uint first_spawn; /* index of its first splash among the spawns; 0xffffffff: none */
    /* one bit per piece: 1 if the piece splashes. Decided in one pass only, because floats may differ slightly in
     * another. */
    uint splashing;
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_landing_gpu, 24);
#undef uint
#endif

#endif
