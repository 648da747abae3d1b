/* impact.h - where a falling drop met a surface: what rain writes and ground, splash and glass read. */
#ifndef VIRGA_SHARED_IMPACT_H
#define VIRGA_SHARED_IMPACT_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_impact_gpu virga_impact_gpu;
typedef struct virga_impacts_gpu virga_impacts_gpu;
#endif

/* One impact, 64 bytes. Positions are relative to virga_impacts_gpu's origin. */
struct virga_impact_gpu {
    float position[3]; /* m, relative to origin */
    float time_s;      /* since the start of the step that wrote it [0; ticks * tick_s) */
    float velocity[3]; /* m/s, of the drop on its way in */
    float diameter_m;  /* of one drop */
    float normal[3];   /* of the surface, unit length, to the side that the drop came from */
    float weight;      /* drops that this one stands for, > 0 */
    uint id;           /* of the drop; its streak and its entry among the drops carry the same */
    uint material;     /* [0; 255] of the surface, as its occluder said */
    uint water_nl;     /* 1e-9 l, of all the drops it stands for; rounded so that sums are unbiased */
    uint tick;         /* that it fell in, counted from creation (low 32 bits) */
};

/* Head of the impact buffer, 64 bytes; impacts follow. */
struct virga_impacts_gpu {
    uint count;        /* impacts that follow */
    uint dropped;      /* that found no room */
    uint water_nl_low; /* water of all of them, the dropped ones too; 64 bit */
    uint water_nl_high;
    uint group_count[3]; /* ceil(count / 64), 1, 1: for an indirect dispatch */
    uint capacity;
    float origin[3]; /* of positions: camera_m of the step, rounded to float; see virga_rain_step */
    float tick_s;
    uint ticks; /* run in this step */
    uint first_tick;
    /* 1: water that splashes give back. It lands in whatever tick it is read, and does not splash again but as a dot */
    uint is_return;
    uint pad;
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_impact_gpu, 64);
VIRGA_ASSERT_OFFSET(virga_impact_gpu, normal, 32);
VIRGA_ASSERT_OFFSET(virga_impact_gpu, id, 48);
VIRGA_ASSERT_SIZE(virga_impacts_gpu, 64);
VIRGA_ASSERT_OFFSET(virga_impacts_gpu, group_count, 16);
VIRGA_ASSERT_OFFSET(virga_impacts_gpu, origin, 32);
#undef uint
#endif

#endif
