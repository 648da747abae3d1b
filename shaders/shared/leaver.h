/* leaver.h - particles that leave the water: their states, which go on from step to step. The water effect writes them.
 * Splash reads which of them have fallen back, and tells how much of their water was still in the air; a simulation
 * reads which of them it may take out. */
#ifndef VIRGA_SHARED_LEAVER_H
#define VIRGA_SHARED_LEAVER_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_leaver_gpu virga_leaver_gpu;
typedef struct virga_leavers_gpu virga_leavers_gpu;
#endif

#define VIRGA_LEAVER_LEAVING  1u /* its droplets are handed over in this step, if there is room for them */
#define VIRGA_LEAVER_HANDED   2u /* its droplets fly on their own; it is neither water nor spray */
#define VIRGA_LEAVER_RETURNED 4u /* in this step it has fallen back into the water: its droplets end */

/* One particle, 48 bytes. */
struct virga_leaver_gpu {
    uint id;           /* of the particle */
    float max_speed;   /* m/s, since it left the water */
    float age;         /* s, since then */
    uint pieces;       /* droplets that the water effect draws */
    float velocity[3]; /* m/s, of the particle */
    uint particle;     /* its index among the particles of the step */
    uint given_nl;     /* nl of its water that others have: in the air, landed, or gone */
    uint taken_nl;     /* (splash) nl of it that was still in the air when it fell back; subtracted in the next step */
    uint flags;        /* VIRGA_LEAVER_... */
    uint first;        /* index of its first droplet among those that are handed over */
};

/* Head, 32 bytes. Two halves of `max` leavers follow, that of the newest step and that of the one before. Another
 * buffer, the table, has two halves of mask + 1 words: 1 + index of a leaver of that half, 0 where there is none. A
 * leaver stands behind virga_hash1(id) & mask, at the first word that has it before one that is 0. */
struct virga_leavers_gpu {
    uint half_now; /* 0 or 1: the half of the newest step */
    uint max;
    uint mask;
    uint count; /* leavers of the newest step */
    uint pad[4];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_leaver_gpu, 48);
VIRGA_ASSERT_OFFSET(virga_leaver_gpu, given_nl, 32);
VIRGA_ASSERT_SIZE(virga_leavers_gpu, 32);
#undef uint
#endif

#endif
