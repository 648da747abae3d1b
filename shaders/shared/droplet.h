/* droplet.h - splashes and their droplets: what splash keeps, and point caches read. */
#ifndef VIRGA_SHARED_DROPLET_H
#define VIRGA_SHARED_DROPLET_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_droplet_gpu virga_droplet_gpu;
typedef struct virga_splash_gpu virga_splash_gpu;
#endif

/* A droplet, 64 bytes; while it is a pile's tip, the pile too. Positions are relative to the anchor, see
 * virga_splash_droplets. */
struct virga_droplet_gpu {
    float position[3]; /* m */
    float age_s;       /* < 0: its pile has not risen yet */
    float velocity[3]; /* m/s */
    float diameter_m;
    float base[3]; /* of its pile: on the surface that it came from, and falls back on */
    uint slopes;   /* of that surface: height a metre in x and z, two halves */
    uint kind;     /* VIRGA_DROPLET_... below */
    uint id;       /* of the drop that it came from; its own is virga_hash2(id, VIRGA_DROPLET_NUMBER(kind)) */
    uint water_nl;
    uint weight_free; /* two halves: how many it stands for in the picture; age at which it left its pile (s) */
};

#define VIRGA_DROPLET_MODEL(kind)    ((kind)&7u) /* splash_rule.h */
#define VIRGA_DROPLET_MATERIAL(kind) (((kind) >> 3) & 31u)
#define VIRGA_DROPLET_STATE(kind)    (((kind) >> 8) & 7u)     /* ground_limits.h, where it came from */
#define VIRGA_DROPLET_INDEX(kind)    (((kind) >> 16) & 255u)  /* among those of its splash */
#define VIRGA_DROPLET_NUMBER(kind)   (((kind) >> 16) & 8191u) /* among all of its drop, which may be many splashes */
#define VIRGA_DROPLET_ALIVE          0x80000000u
#define VIRGA_DROPLET_FREE           0x40000000u /* has left its pile */
#define VIRGA_DROPLET_FALLEN         0x20000000u /* down again: its water is about to be given back */

/* A splash, 64 bytes. */
struct virga_splash_gpu {
    float position[3]; /* m, relative to the anchor */
    float share;       /* of its tick that had passed; 1 and more: it falls so many ticks later */
    uint tick;
    float diameter_m;  /* of the drop */
    float speed_m_s;   /* of the drop */
    uint depth_weight; /* two halves: water under it (mm); how many it stands for in the picture */
    float normal[3];   /* of the surface, unit length */
    uint random;
    float life_s;
    uint lean; /* two halves: what its piles lean by, x and z of the velocity that the drop's way adds (m/s) */
    uint kind; /* model, material, state as VIRGA_DROPLET_...; droplets from bit 16 */
    uint id;   /* of the drop */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_droplet_gpu, 64);
VIRGA_ASSERT_OFFSET(virga_droplet_gpu, base, 32);
VIRGA_ASSERT_OFFSET(virga_droplet_gpu, kind, 48);
VIRGA_ASSERT_SIZE(virga_splash_gpu, 64);
VIRGA_ASSERT_OFFSET(virga_splash_gpu, normal, 32);
#undef uint
#endif

#endif
