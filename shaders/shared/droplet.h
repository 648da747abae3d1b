/* droplet.h - splashes and their droplets: the state of the splash effect, which point caches read. */
#ifndef VIRGA_SHARED_DROPLET_H
#define VIRGA_SHARED_DROPLET_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_droplet_gpu virga_droplet_gpu;
typedef struct virga_splash_gpu virga_splash_gpu;
#endif

/* A droplet, 64 bytes. While it is the tip of a pile, it describes the pile too. Positions are relative to the anchor,
 * see virga_splash_droplets. */
struct virga_droplet_gpu {
    float position[3]; /* m */
    float age_s;       /* s; < 0: its pile does not rise yet */
    float velocity[3]; /* m/s */
    float diameter_m;  /* m */
    float base[3];     /* m, foot of its pile: on the surface that it comes from and falls back on */
    uint slopes;       /* slope of that surface along x and z, rise over run; two half floats */
    uint kind;         /* bit fields, see VIRGA_DROPLET_... below */
    /* id of the drop, or of the particle, that it comes from. The droplet's own id is
     * virga_hash2(id, VIRGA_DROPLET_NUMBER(kind)). */
    uint id;
    uint water_nl;    /* nl */
    uint weight_free; /* two half floats: droplets that it represents in the picture; age when it left its pile (s) */
};

#define VIRGA_DROPLET_MODEL(kind)    ((kind)&7u) /* VIRGA_SPLASH_..., see splash_rule.h */
#define VIRGA_DROPLET_MATERIAL(kind) (((kind) >> 3) & 31u)
/* state of the ground that it comes from, see ground_limits.h */
#define VIRGA_DROPLET_STATE(kind) (((kind) >> 8) & 7u)
#define VIRGA_DROPLET_INDEX(kind) (((kind) >> 16) & 255u) /* index among the droplets of its splash */
/* index among all droplets of its drop, over all splashes of the drop */
#define VIRGA_DROPLET_NUMBER(kind) (((kind) >> 16) & 8191u)
#define VIRGA_SPLASH_OF_FOOT       0x00000800u            /* (splash) see VIRGA_SPAWN_SHEET */
#define VIRGA_DROPLET_SPRAY        0x00000800u            /* it was handed over, see handed_droplet.h */
#define VIRGA_DROPLET_PANE(kind)   (((kind) >> 12) & 15u) /* 1 + number of the pane that it has hit; 0: none */
#define VIRGA_DROPLET_ALIVE        0x80000000u
#define VIRGA_DROPLET_FREE         0x40000000u /* it has left its pile */
#define VIRGA_DROPLET_FALLEN       0x20000000u /* it has landed; its water will be returned to the ground */

/* A splash, 64 bytes. */
struct virga_splash_gpu {
    float position[3]; /* m, relative to the anchor */
    /* fraction of its tick that had passed at the impact. 1 or more: the impact is that many ticks later. */
    float share;
    uint tick;        /* tick of the impact */
    float diameter_m; /* m, of the drop */
    float speed_m_s;  /* m/s, of the drop */
    /* two half floats: depth of the water below (mm); splashes that it represents in the picture */
    uint depth_weight;
    float normal[3]; /* of the surface, unit length; (sheet of a foot) level direction of its long axis */
    uint random;     /* a hash of its own */
    float life_s;    /* s, lifetime */
    /* two half floats: velocity in x and z (m/s) that the drop's direction adds to its piles, so that they lean; (sheet
     * of a foot) half of its long and of its short axis when it is highest (m) */
    uint lean;
    /* model, material and state as in VIRGA_DROPLET_...; bit 11: the sheet of a foot, see VIRGA_SPAWN_SHEET; bits 16 to
     * 23: number of droplets; 24 to 31: their water over that of the crown, in units of 1 / 256 */
    uint kind;
    uint id; /* of the drop */
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
