/* foam.h - a particle of the water effect's foam: a small cluster of bubbles, or of fine drops. */
#ifndef VIRGA_SHARED_FOAM_H
#define VIRGA_SHARED_FOAM_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_foam_gpu virga_foam_gpu;
#endif

/* What a particle of foam is, by the water around it. */
#define VIRGA_FOAM_SPRAY   0 /* above the water: flies */
#define VIRGA_FOAM_SURFACE 1 /* on the water: drifts with it, and dissolves */
#define VIRGA_FOAM_BUBBLE  2 /* in the water: rises */

/* 64 bytes. A slot with life_s 0 has no particle. */
struct virga_foam_gpu {
    float position[3]; /* m, relative to virga_water_step_info.origin_m */
    float radius;      /* m */
    float velocity[3]; /* m/s */
    float life_s;      /* that is left */
    float age_s;
    uint kind;      /* VIRGA_FOAM_... */
    uint id;        /* virga_hash3(id of the particle of water, time in microseconds, number) */
    float around;   /* particles of water around it */
    float moved[3]; /* m/s, mean over the newest step: what motion vectors show. It follows the surface, too */
    float pad;
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_foam_gpu, 64);
VIRGA_ASSERT_OFFSET(virga_foam_gpu, velocity, 16);
#undef uint
#endif

#endif
