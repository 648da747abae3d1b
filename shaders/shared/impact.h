/* impact.h - the impact of a falling drop on a surface: rain writes it; ground, splash and glass read it. */
#ifndef VIRGA_SHARED_IMPACT_H
#define VIRGA_SHARED_IMPACT_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_impact_gpu virga_impact_gpu;
typedef struct virga_impacts_gpu virga_impacts_gpu;
#endif

/* One impact, 64 bytes. */
struct virga_impact_gpu {
    float position[3]; /* m, relative to virga_impacts_gpu.origin */
    float time_s;      /* s, [0; ticks * tick_s), since the start of the step that wrote it */
    float velocity[3]; /* m/s, of the drop just before the impact */
    float diameter_m;  /* m, of one drop */
    float normal[3];   /* of the surface, unit length, towards the side that the drop came from */
    float weight;      /* > 0, number of drops that this one represents */
    uint id;           /* of the drop; its streak and its entry in the list of drops have the same id */
    /* [0; 255], of the surface, as given with its occluder. (returns) With VIRGA_IMPACT_SPRAY where it comes from water
     * that was simulated. */
    uint material;
    uint water_nl; /* nl (1e-9 l), of all drops that it represents; rounded so that sums are unbiased */
    uint tick;     /* tick of the impact, counted from creation (low 32 bits) */
};

#define VIRGA_IMPACT_SPRAY 0x100u
/* (returns) 1 + number of the pane that it has hit; 0: it falls on the ground. Ground leaves those of panes out. */
#define VIRGA_IMPACT_PANE(material)  ((material) >> 16)
#define VIRGA_IMPACT_ON_PANE(number) (((number) + 1u) << 16)

/* Head of the impact buffer, 64 bytes. The impacts follow. */
struct virga_impacts_gpu {
    uint count;        /* number of impacts that follow */
    uint dropped;      /* impacts that were dropped because the buffer was full */
    uint water_nl_low; /* nl, water of all impacts, dropped ones included; 64-bit */
    uint water_nl_high;
    uint group_count[3]; /* ceil(count / 64), 1, 1: for an indirect dispatch */
    uint capacity;       /* max number of impacts */
    float origin[3];     /* m, origin of positions: camera_m of the step, rounded to float; see virga_rain_step */
    float tick_s;        /* s, length of a tick */
    uint ticks;          /* ticks run in this step */
    uint first_tick;     /* number of the first of them */
    /* 1: returns, the water of droplets that fell back. A return lands in the tick in which it is read, whatever its
     * tick. It makes no new splash except a dot. */
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
