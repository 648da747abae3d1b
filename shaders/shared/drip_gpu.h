/* drip_gpu.h - places from which rain water drips. Internal to Virga. */
#ifndef VIRGA_SHARED_DRIP_GPU_H
#define VIRGA_SHARED_DRIP_GPU_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_drip_site_gpu virga_drip_site_gpu;
typedef struct virga_drip_gpu virga_drip_gpu;
#endif

#define VIRGA_DRIP_SITES_PER_BLOCK 16 /* of 768 bytes, in which the host sends them */

/* A place, 48 bytes. */
struct virga_drip_site_gpu {
    float position[3]; /* m, relative to the first site */
    float catch_m2;    /* level area whose rain drains to it, without what is sheltered of it */
    float drain;       /* nl/s that leave a film of n nl, over n^3, see engine/splash/splash_drips.c */
    uint seed;         /* a number of its own */
    float drops;       /* that fly as one */
    float jet;         /* 1: they fly from a place that stands; 0: the place has their velocity too */
    float velocity[3]; /* m/s, with which they leave */
    uint owner;        /* whose water this index has: virga_drip_site.place + 1 */
};

/* Its water, 16 bytes. */
struct virga_drip_gpu {
    uint film_nl; /* on the surface that drains to it */
    uint hang_nl; /* at the edge */
    uint drops;   /* that have fallen */
    uint owner;   /* the site's when this was written; 0: nothing of this is written yet */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_drip_site_gpu, 48);
VIRGA_ASSERT_SIZE(virga_drip_gpu, 16);
#undef uint
#endif

#endif
