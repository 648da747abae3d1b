/* glass_drop.h - a slot for water on a pane: a drop of the mesh model or a particle beside a blade. */
#ifndef VIRGA_SHARED_GLASS_DROP_H
#define VIRGA_SHARED_GLASS_DROP_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_glass_drop_gpu virga_glass_drop_gpu;
#endif

/* What a slot holds, in the low bits of `kind`. */
#define VIRGA_GLASS_FREE     0 /* nothing */
#define VIRGA_GLASS_DROP     1 /* a drop of the mesh model (Goto et al. 2009, section 4.1) */
#define VIRGA_GLASS_PARTICLE 2 /* a particle (section 4.2) */
#define VIRGA_GLASS_KIND     3 /* mask of the above */
/* Flags. */
#define VIRGA_GLASS_RUNNING     4   /* (drop) it moved in the newest tick */
#define VIRGA_GLASS_TAIL        8   /* (drop) left behind by one that ran; it shrinks */
#define VIRGA_GLASS_WAITING     16  /* (particle) out of its blade's band, but a large drop is too near (section 4.6) */
#define VIRGA_GLASS_PUSHED      32  /* (particle) a blade pushed it in the newest tick */
#define VIRGA_GLASS_CHANGED     64  /* (drop) it landed, took water in or stopped in the newest tick */
#define VIRGA_GLASS_MERGE_CHECK 128 /* (drop) it had in the tick before, and looked whom it touches */

#define VIRGA_GLASS_MOMENTUM 8 /* nl mm/s: the unit that momenta are added up in */

/* One drop, 88 bytes. Places on the pane are in metres, u to the right and v up, seen from outside; (0, 0) is its lower
 * left corner. */
struct virga_glass_drop_gpu {
    float position[2];          /* m, of its middle at the newest tick, where it is drawn */
    float previous_position[2]; /* m, the same a tick before */
    float velocity[2];          /* m/s */
    uint water_nl;              /* 1e-9 l */
    uint kind;                  /* VIRGA_GLASS_... */
    uint cell;                  /* (drop) that it is in: column + row x columns */
    uint from_cell;             /* (drop) that it came from */
    float progress_m;           /* (drop) how far it has come towards the next cell */
    float tail_spacing_m;       /* (drop) way since it last left a drop behind */
    float age_s;                /* since it landed, or was left behind */
    /* of the rain's drop, or a hash for those that were left behind; a merged one keeps the heavier's */
    uint id;
    uint random;            /* a hash of its own */
    uint merged_nl;         /* water that came in this tick, counted in at the tick's end */
    int merged_momentum[2]; /* its momentum: VIRGA_GLASS_MOMENTUM nl mm/s */
    int merged_nl_10um[2];  /* and how far from this drop it was: nl x 10 um */
    uint target;            /* (drop) cell that it enters in this round; VIRGA_GLASS_NONE: it stays */
    uint absorbed_by;       /* (drop) slot of the drop that absorbs it, or VIRGA_GLASS_NONE */
};

#define VIRGA_GLASS_NONE 0xffffffffu

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_glass_drop_gpu, 88);
VIRGA_ASSERT_OFFSET(virga_glass_drop_gpu, water_nl, 24);
VIRGA_ASSERT_OFFSET(virga_glass_drop_gpu, target, 80);
#undef uint
#endif

#endif
