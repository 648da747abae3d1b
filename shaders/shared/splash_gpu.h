/* splash_gpu.h - what splash's passes share with the C that feeds them. Internal to Virga. */
#ifndef VIRGA_SHARED_SPLASH_GPU_H
#define VIRGA_SHARED_SPLASH_GPU_H

#include "compact.h"
#include "splash_rule.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_splash_tick_gpu virga_splash_tick_gpu;
typedef struct virga_splash_count_gpu virga_splash_count_gpu;
typedef struct virga_splash_state_gpu virga_splash_state_gpu;
typedef struct virga_splash_look_gpu virga_splash_look_gpu;
typedef struct virga_sprite_gpu virga_sprite_gpu;
typedef struct virga_splash_draw_gpu virga_splash_draw_gpu;
typedef struct virga_splash_prepared_gpu virga_splash_prepared_gpu;
#endif

#define VIRGA_SPLASH_BLOCK 256 /* rings and buffers hold whole blocks of so many */
/* A workgroup of a pass over slots: small, so that few splashes keep all cores busy. */
#define VIRGA_SPLASH_GROUP 64
/* That of the passes with one for all. A million droplets on a GPU could use more; software Vulkan runs idle lanes
 * through all that one does, and 256 cost it 50 us more. */
#define VIRGA_SPLASH_LANES 64
/* droplets, which one workgroup flies: more are worth a dispatch */
#define VIRGA_SPLASH_SINGLE_GROUP_DROPLETS 512
#define VIRGA_SPLASH_MAX_COUNT             64 /* droplets of one splash */
#define VIRGA_SPLASH_MATERIALS             32

/* Forms of a view's passes, their specialisation constant 0: software Vulkan runs every lane through what a branch
 * would skip. Those that find know of the first bit alone. */
#define VIRGA_SPLASH_FORM_FILM 1 /* the film's style, not the paper's */
#define VIRGA_SPLASH_FORM_FULL 2 /* there may be lamps, and motions are written where they are wanted */

/* And what pipelines of sprites are made for. */
#define VIRGA_SPLASH_SPRITES_DEPTH 1 /* the scene's depth is there to be read */
#define VIRGA_SPLASH_SPRITES_LINES 2 /* lines from end to end, of droplets, instead of two triangles around them */
#define VIRGA_SPLASH_SPRITES_PUFFS 4 /* of puffs alone; without it, of all else */
#define VIRGA_SPLASH_FORMS         4

/* All that a tick's passes need. */
struct virga_splash_tick_gpu {
    uint tick;
    uint tick_in_step;
    float tick_s;
    uint max_spawns;
    float anchor[3]; /* of positions, in the world */
    float air_density;
    float shift[3]; /* (rebase) anchor before minus anchor now: added to positions */
    float bounce;
    float wind[3]; /* m/s */
    float pile_max_s;
    float pile_max_m;
    uint max_splashes; /* a power of two */
    uint max_droplets;
    uint max_returned_droplets;
};

/* A count of 64 bits. */
struct virga_splash_count_gpu {
    uint low;
    uint high;
};

/* Indices into the counts; from VIRGA_SPLASH_BY_MODEL on by model x VIRGA_SPLASH_MATERIALS + material. */
#define VIRGA_SPLASH_DROPLETS         0
#define VIRGA_SPLASH_FALLEN           1
#define VIRGA_SPLASH_FLOWN            2 /* nl */
#define VIRGA_SPLASH_RETURNED         3 /* nl */
#define VIRGA_SPLASH_WITHOUT_DROPLETS 4
#define VIRGA_SPLASH_BY_MODEL         5
#define VIRGA_SPLASH_COUNTS           165

/* Splashes lie in a ring: slot numbers count up for ever (modulo 2^32) and are taken modulo its size. Droplets lie one
 * behind the other, the oldest first; a tick moves those that stay from one buffer into another. */
struct virga_splash_state_gpu {
    uint end_droplet; /* droplets of this tick, those that fall in it too */
    uint staying;     /* that are there after it */
    uint first_splash;
    uint end_splash;
    uint tick_droplet; /* the first of this tick */
    uint tick_splash;
    uint full_from;         /* rank among this tick's spawns from which on there is no room for droplets */
    uint returns;           /* of this step */
    uint returns_before;    /* of this tick's falls */
    uint droplet_groups[3]; /* of a dispatch over all droplets of this tick; 0 where they are few */
    uint splash_groups[3];
    uint pad;
    uint spawn_groups[3]; /* of the passes that start splashes and store what falls; 0 where their scan has done so */
    uint fall_groups[3];
    uint find_groups[3];         /* of the pass that finds what a view may see of few droplets and splashes */
    uint find_droplet_groups[3]; /* of those for many */
    uint find_splash_groups[3];
    uint sprite_groups[3]; /* of a dispatch over all that a view may see: droplets as lines, others, piles, splashes */
    uint view_groups[3];   /* the same over droplets alone */
    virga_splash_count_gpu counts[165];
};

/* What a view's passes need beside the view. */
struct virga_splash_look_gpu {
    uint tick; /* the newest */
    float tick_s;
    uint style; /* 0 paper, 1 film */
    float gain;
    uint max_splashes;
    uint max_droplets;
    uint max_sprites;
    uint max_crowns;
    uint physical;
    uint lines;   /* 1: the thinnest droplets are lines */
    uint motion;  /* 1: motions are written behind the sprites, a vec4 each: of head and tail (px) */
    float handed; /* 1, or -1 where the picture is mirrored: which way round faces are the front */
};

/* Something long and thin on the picture: a droplet on its way, a pile, or a splash seen from afar. 64 bytes. Pairs in
 * a word are two half floats, the first in the low bits. */
struct virga_sprite_gpu {
    float head[2]; /* ends, normalised device x, y */
    float tail[2];
    float depth[2];    /* head, tail: in the buffer's terms */
    float distance[2]; /* head, tail: view depth (m) */
    /* drawn (px): head, tail; (puff) instead of the tail's the sine of how far from above it is seen */
    uint widths;
    uint alpha_body; /* coverage; length of the thing itself (px) */
    uint light[3];   /* radiance in the middle (rgb), then at the edge (rgb) */
    uint kind;       /* VIRGA_SPRITE_... */
    /* (pile) share of its length that is there all of the time; (puff) share of its way that each of those side by side
     * is high. Then the number of columns plus 32 times that of rows */
    uint shares;
    uint id; /* (puff) its low ten bits, then the share of its life, of 1023 */
};

#define VIRGA_SPRITE_DROPLET 0
#define VIRGA_SPRITE_PILE    1
#define VIRGA_SPRITE_PUFF    2

/* Arguments of an indexed indirect draw, as Vulkan lays them out. */
struct virga_splash_draw_gpu {
    uint index_count;
    uint instance_count;
    uint first_index;
    int vertex_offset;
    uint first_instance;
};

/* What a prepare found. */
struct virga_splash_prepared_gpu {
    virga_splash_draw_gpu lines;      /* of those that show one colour droplets that are lines */
    virga_splash_draw_gpu thin_quads; /* and other droplets and piles; */
    virga_splash_draw_gpu puffs;      /* splashes from afar */
    virga_splash_draw_gpu wide_quads; /* sprites that show what is behind them; (paper) pyramids */
    virga_splash_draw_gpu crowns;     /* sheets; (paper) pyramids of crowns */
    uint sprites;
    uint list_groups[3]; /* of the pass that lists; 0 where the scan has done so */
    uint cut[2];         /* sprites and sheets that there was no room for */
};

/* A sheet's mesh: columns around, rows up; and the pyramids that stand for it in the paper's style. */
#define VIRGA_CROWN_COLUMNS  60
#define VIRGA_CROWN_ROWS     4
#define VIRGA_CROWN_INDICES  1440 /* columns x rows x 6 */
#define VIRGA_CROWN_PYRAMIDS 10

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_splash_look_gpu, 48);
VIRGA_ASSERT_SIZE(virga_sprite_gpu, 64);
VIRGA_ASSERT_SIZE(virga_splash_prepared_gpu, 124);
VIRGA_ASSERT_SIZE(virga_splash_tick_gpu, 80);
VIRGA_ASSERT_SIZE(virga_splash_state_gpu, 148 + 8 * VIRGA_SPLASH_COUNTS);
VIRGA_ASSERT_OFFSET(virga_splash_state_gpu, droplet_groups, 36);
VIRGA_ASSERT_OFFSET(virga_splash_state_gpu, splash_groups, 48);
#undef uint
#endif

#endif
