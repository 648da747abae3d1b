/* point.h - a drop with all its properties, for point caches and hosts' own renderers. */
#ifndef VIRGA_SHARED_POINT_H
#define VIRGA_SHARED_POINT_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_point_gpu virga_point_gpu;
#endif

/* One drop, 48 bytes. */
struct virga_point_gpu {
    float position[3]; /* m, relative to the origin of the step */
    float diameter_m;  /* m */
    float velocity[3]; /* m/s */
    float weight;      /* number of drops that it represents; 0: none, the slot is unused or sheltered */
    uint id;           /* as in virga_drop_gpu */
    float age_s;       /* s, time that it has been falling through its box at its present speed */
    uint pad[2];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_point_gpu, 48);
#undef uint
#endif

#endif
