/* splash_gpu.h - what splash's passes share with the C that feeds them. Internal to Virga. */
#ifndef VIRGA_SHARED_SPLASH_GPU_H
#define VIRGA_SHARED_SPLASH_GPU_H

#include "splash_rule.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_splash_tick_gpu virga_splash_tick_gpu;
typedef struct virga_splash_count_gpu virga_splash_count_gpu;
typedef struct virga_splash_state_gpu virga_splash_state_gpu;
#endif

#define VIRGA_SPLASH_GROUP      256
#define VIRGA_SPLASH_MOST_COUNT 64 /* droplets of one splash */
#define VIRGA_SPLASH_MATERIALS  32

/* All that a tick's passes need. */
struct virga_splash_tick_gpu {
    uint tick;
    uint tick_in_step;
    float tick_s;
    float age_after_s;   /* time since the end of this tick that the state is of; 0 */
    float anchor[3];     /* of positions, in the world */
    float air_density;
    float shift[3];      /* (rebase) anchor before minus anchor now: added to positions */
    float bounce;
    float wind[3];       /* m/s */
    float pile_s;
    float pile_m;
    uint max_splashes;   /* powers of two */
    uint max_droplets;
    uint max_returns;
};

/* A count of 64 bits. */
struct virga_splash_count_gpu {
    uint low;
    uint high;
};

/* Indices into the counts; from VIRGA_SPLASH_BY_MODEL on by model x VIRGA_SPLASH_MATERIALS + material. */
#define VIRGA_SPLASH_DROPLETS 0
#define VIRGA_SPLASH_FALLEN   1
#define VIRGA_SPLASH_FLOWN    2 /* nl */
#define VIRGA_SPLASH_RETURNED 3 /* nl */
#define VIRGA_SPLASH_CROWDED  4
#define VIRGA_SPLASH_BY_MODEL 5
#define VIRGA_SPLASH_COUNTS   165

/* Splashes and droplets lie in rings: places count up for ever (modulo 2^32) and are taken modulo the rings' sizes. */
struct virga_splash_state_gpu {
    uint first_droplet;     /* the oldest that is alive */
    uint end_droplet;       /* behind the newest */
    uint first_splash;
    uint end_splash;
    uint tick_droplet;      /* the first of this tick */
    uint tick_splash;
    uint crowded_from;      /* rank among this tick's spawns from which on there is no room for droplets */
    uint returns;           /* of this step */
    uint returns_before;    /* of this tick's falls */
    uint droplet_groups[3]; /* of a dispatch over the droplets from the oldest alive on */
    uint splash_groups[3];
    uint fall_start;        /* place of the first droplet that step.comp went over in this tick */
    virga_splash_count_gpu counts[165];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_splash_tick_gpu, 80);
VIRGA_ASSERT_SIZE(virga_splash_state_gpu, 64 + 8 * VIRGA_SPLASH_COUNTS);
VIRGA_ASSERT_OFFSET(virga_splash_state_gpu, droplet_groups, 36);
VIRGA_ASSERT_OFFSET(virga_splash_state_gpu, splash_groups, 48);
#undef uint
#endif

#endif
