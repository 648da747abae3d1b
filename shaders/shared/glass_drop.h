/* glass_drop.h - a slot for water on a pane: a drop of the mesh model or a particle next to a wiper blade. */
#ifndef VIRGA_SHARED_GLASS_DROP_H
#define VIRGA_SHARED_GLASS_DROP_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_glass_drop_gpu virga_glass_drop_gpu;
#endif

/* What a slot holds: the low bits of `kind`. */
#define VIRGA_GLASS_FREE     0 /* nothing */
#define VIRGA_GLASS_DROP     1 /* a drop of the mesh model (Goto et al. 2009, section 4.1) */
#define VIRGA_GLASS_PARTICLE 2 /* a particle (section 4.2) */
#define VIRGA_GLASS_KIND     3 /* mask of the above */
/* Flags. */
#define VIRGA_GLASS_RUNNING 4 /* (drop) it moved in the newest tick */
#define VIRGA_GLASS_TAIL    8 /* (drop) left behind by a running drop; it shrinks */
/* (particle) outside its blade's band, but too near to a large drop (section 4.6) */
#define VIRGA_GLASS_WAITING     16
#define VIRGA_GLASS_PUSHED      32  /* (particle) a blade pushed it in the newest tick */
#define VIRGA_GLASS_CHANGED     64  /* (drop) it landed, absorbed water or stopped in the newest tick */
#define VIRGA_GLASS_MERGE_CHECK 128 /* (drop) it changed in the tick before; now tested for drops that it touches */

#define VIRGA_GLASS_MOMENTUM 8 /* nl mm/s: the unit in which momenta are summed */

/* One drop, 100 bytes. Positions on the pane are in metres, u to the right and v up, seen from outside. (0, 0) is the
 * pane's lower left corner. */
struct virga_glass_drop_gpu {
    float position[2];          /* m, centre at the newest tick, where it is drawn */
    float previous_position[2]; /* m, centre one tick before */
    float velocity[2];          /* m/s */
    uint water_nl;              /* nl (1e-9 l) */
    uint kind;                  /* VIRGA_GLASS_... */
    uint cell;                  /* (drop) its cell: column + row x columns */
    uint from_cell;             /* (drop) the cell that it came from */
    float progress_m;           /* (drop) m, distance covered towards the next cell */
    float tail_spacing_m;       /* (drop) m, distance since it last left a drop behind */
    float age_s;                /* s, since it landed or was left behind */
    /* of the drop of rain; a hash for drops that were left behind. After a merge: the id of the heavier one. */
    uint id;
    uint random;            /* a hash of its own */
    uint merged_nl;         /* nl, water absorbed in this tick; added to water_nl at the tick's end */
    int merged_momentum[2]; /* momentum of that water, in units of VIRGA_GLASS_MOMENTUM nl mm/s */
    int merged_nl_10um[2];  /* offset of that water from this drop, weighted by its amount: nl x 10 um */
    uint target;            /* (drop) the cell that it enters in this round; VIRGA_GLASS_NONE: it stays */
    uint absorbed_by;       /* (drop) slot of the drop that absorbs it, or VIRGA_GLASS_NONE */
    /* (drop) its outline, see outline.glsl: strain and tail, two snorm16 each, as they were in a tick */
    uint strain;
    uint tail;
    uint outline_tick;
};

#define VIRGA_GLASS_NONE 0xffffffffu

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_glass_drop_gpu, 100);
VIRGA_ASSERT_OFFSET(virga_glass_drop_gpu, water_nl, 24);
VIRGA_ASSERT_OFFSET(virga_glass_drop_gpu, target, 80);
#undef uint
#endif

#endif
