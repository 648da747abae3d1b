/* splash_gpu.h - what splash's passes share with the C code that feeds them. Internal to Virga. */
#ifndef VIRGA_SHARED_SPLASH_GPU_H
#define VIRGA_SHARED_SPLASH_GPU_H

#include "compact.h"
#include "splash_rule.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_splash_pane_gpu virga_splash_pane_gpu;
typedef struct virga_splash_tick_gpu virga_splash_tick_gpu;
typedef struct virga_splash_count_gpu virga_splash_count_gpu;
typedef struct virga_splash_state_gpu virga_splash_state_gpu;
typedef struct virga_splash_look_gpu virga_splash_look_gpu;
typedef struct virga_sprite_gpu virga_sprite_gpu;
typedef struct virga_splash_draw_gpu virga_splash_draw_gpu;
typedef struct virga_splash_prepared_gpu virga_splash_prepared_gpu;
#endif

#define VIRGA_SPLASH_BLOCK 256 /* sizes of ring buffers and buffers are multiples of this */
/* Invocations per workgroup of a pass over slots: few, so that a few splashes keep all cores busy. */
#define VIRGA_SPLASH_GROUP 64
/* Invocations of the passes with a single workgroup. A million droplets on a GPU could use more. Software Vulkan runs
 * idle invocations through the whole program, and 256 were 50 us slower. */
#define VIRGA_SPLASH_LANES 64
/* max droplets that a single workgroup moves; for more a dispatch is faster */
#define VIRGA_SPLASH_SINGLE_GROUP_DROPLETS 512
#define VIRGA_SPLASH_MAX_COUNT             64 /* droplets per splash */
#define VIRGA_SPLASH_MATERIALS             32
#define VIRGA_SPLASH_PANES                 8 /* that droplets may hit */

/* Flags of a view's passes, their specialisation constant 0. They are not branches, because software Vulkan runs every
 * invocation through what a branch would skip. The culling passes use the first bit only. */
#define VIRGA_SPLASH_FORM_FILM 1 /* the film style, not the paper's */
#define VIRGA_SPLASH_FORM_FULL 2 /* with lights, and with motion vectors if requested */

/* Flags of the sprite pipelines. */
#define VIRGA_SPLASH_SPRITES_DEPTH 1 /* the scene's depth can be read */
#define VIRGA_SPLASH_SPRITES_LINES 2 /* droplets as line primitives instead of quads of two triangles */
#define VIRGA_SPLASH_SPRITES_PUFFS 4 /* puffs only; without it: everything else */
#define VIRGA_SPLASH_FORMS         4

/* A pane that droplets may hit, as it is at the end of a tick. */
struct virga_splash_pane_gpu {
    float corner[3];  /* m, relative to the anchor */
    float width_m;    /* along along_u */
    float along_u[3]; /* unit length */
    float height_m;   /* along along_v */
    float along_v[3];
    float pad;
    float velocity[3]; /* m/s */
    float pad_too;
};

/* Parameters of all passes of a tick. */
struct virga_splash_tick_gpu {
    uint tick;
    uint tick_in_step;
    uint ticks;   /* of the step */
    float tick_s; /* s, length of a tick */
    uint max_spawns;
    float anchor[3];   /* m, origin of positions, in the world */
    float air_density; /* kg/m^3 */
    float shift[3];    /* m, (rebase) anchor before minus anchor now: added to positions */
    float bounce;      /* [0; 1], fraction of the drop's velocity along the surface that its droplets keep */
    float wind[3];     /* m/s */
    float pile_max_s;  /* s, a pile that exceeds this age releases its droplet */
    float pile_max_m;  /* m, the same for its distance */
    uint max_splashes; /* a power of two */
    uint max_droplets;
    uint max_returned_droplets;
    /* Droplets that water hands over. */
    uint max_handed;        /* in a step; 0: there is no list */
    float handed_offset[3]; /* m, from the anchor to the origin of their positions */
    float handed_late_s;    /* s, how much later than the end of the newest tick they are where the list says */
    /* The ground that they fall on: its floors, see ground_cell.h and ground_window.glsl. */
    uint tiles;      /* along a side of the window; 0: there is no ground */
    int low_tile[2]; /* low corner of the window, in tiles */
    float low[2];    /* m, the same corner, relative to the anchor */
    float inv_cell_m;
    float base; /* m, height from which floors count, relative to the anchor */
    uint pane_count;
    /* Places from which rain water drips. */
    uint drip_sites;
    uint drip_wet;        /* 1: sites begin with the film of steady rain */
    float drip_nl;        /* of rain that falls on a level square metre in a tick */
    float drip_m[2];      /* m, diameters of the smallest and the largest drop */
    float drip_offset[3]; /* m, from the origin of handed positions to that of sites */
    virga_splash_pane_gpu panes[VIRGA_SPLASH_PANES];
};

/* A 64-bit count. */
struct virga_splash_count_gpu {
    uint low;
    uint high;
};

/* Indices into the counts. Splashes by model and material: VIRGA_SPLASH_BY_MODEL + model x VIRGA_SPLASH_MATERIALS +
 * material. */
#define VIRGA_SPLASH_DROPLETS         0 /* droplets */
#define VIRGA_SPLASH_FALLEN           1 /* droplets that landed */
#define VIRGA_SPLASH_FLOWN            2 /* nl that flew up */
#define VIRGA_SPLASH_RETURNED         3 /* nl of it that returned */
#define VIRGA_SPLASH_WITHOUT_DROPLETS 4
/* Of spray (nl): taken over from water; taken back by it; returned to the ground; given to panes. */
#define VIRGA_SPLASH_SPRAY_IN       5
#define VIRGA_SPLASH_SPRAY_BACK     6
#define VIRGA_SPLASH_SPRAY_RETURNED 7
#define VIRGA_SPLASH_SPRAY_PANES    8
#define VIRGA_SPLASH_CUT_SHORT      9 /* splashes that newer ones replaced before their end */
/* Of drips: nl of rain that drains to them; nl that fell as drops; these drops; nl of places that lost their index. */
#define VIRGA_SPLASH_DRIP_IN       10
#define VIRGA_SPLASH_DRIP_OUT      11
#define VIRGA_SPLASH_DRIPS         12
#define VIRGA_SPLASH_DRIP_LEFT     13
#define VIRGA_SPLASH_DRIPS_HELD    14 /* drops of edges that were due and found no room, counted in each step */
#define VIRGA_SPLASH_DROPLETS_HELD 15 /* landed droplets that found no room among the returns, counted in each tick */
#define VIRGA_SPLASH_BY_MODEL      16
#define VIRGA_SPLASH_COUNTS        176

/* State of splashes and droplets. Splashes are in a ring buffer: splash numbers increase forever (modulo 2^32), and the
 * slot is the number modulo the buffer's size. Droplets are contiguous, the oldest first. A tick copies those that stay
 * from one buffer to the other. */
struct virga_splash_state_gpu {
    uint end_droplet;    /* number of droplets in this tick, including those that land in it */
    uint staying;        /* number of droplets that are still in flight after it */
    uint first_splash;   /* number of the oldest splash */
    uint end_splash;     /* number after the newest splash */
    uint tick_droplet;   /* first droplet of this tick */
    uint tick_splash;    /* first splash of this tick */
    uint full_from;      /* rank among this tick's spawns from which on the droplet buffer is full */
    uint returns;        /* number of returns in this step so far */
    uint returns_before; /* the same before the droplets that land in this tick */
    /* workgroups of a dispatch over all droplets of this tick; 0: few droplets, the prefix sum pass has moved them */
    uint droplet_groups[3];
    uint splash_groups[3];
    uint alive; /* splashes that have begun and are not over, at the end of the step */
    /* of the passes that start splashes and store landed droplets; 0: the prefix sum pass has done so */
    uint spawn_groups[3];
    uint fall_groups[3];
    uint find_groups[3];         /* of the culling pass for a view, if droplets and splashes are few */
    uint find_droplet_groups[3]; /* of the culling passes if they are many */
    uint find_splash_groups[3];
    /* of a dispatch over everything that a view may show: droplets as lines, other droplets, piles, splashes */
    uint sprite_groups[3];
    uint view_groups[3]; /* the same, over droplets only */
    virga_splash_count_gpu counts[176];
};

/* Parameters of a view's passes, in addition to virga_view_gpu. */
struct virga_splash_look_gpu {
    uint tick;         /* the newest tick */
    float tick_s;      /* s, length of a tick */
    uint style;        /* 0: paper, 1: film */
    float gain;        /* factor of the coverage */
    uint max_splashes; /* a power of two */
    uint max_droplets;
    uint max_sprites;
    uint max_crowns;
    uint physical;
    uint lines;     /* 1: the thinnest droplets are drawn as lines */
    uint motion;    /* 1: motion vectors are written after the sprites, one vec4 each: of head and tail (px) */
    float handed;   /* 1, or -1 if the picture is mirrored: the winding of front faces */
    float parts_px; /* min half width of a puff that shows its parts */
    float hole_m;   /* m, thickness of a crown's wall below which holes open; 0: none do */
};

/* A sprite: a long, thin shape in the picture, 64 bytes. It is a droplet in motion, a pile, or a distant splash (puff).
 * Pairs are two half floats, the first in the low bits. */
struct virga_sprite_gpu {
    float head[2];     /* NDC x, y of one end */
    float tail[2];     /* NDC x, y of the other end */
    float depth[2];    /* head, tail: depth buffer value */
    float distance[2]; /* head, tail: view depth (m) */
    /* drawn widths (px) at head and tail; (puff) at the head, then the sine of the angle from above at which it is
     * seen */
    uint widths;
    uint alpha_body; /* coverage; length of the object itself (px) */
    uint light[3];   /* radiance at the centre (rgb), then at the edge (rgb) */
    uint kind;       /* VIRGA_SPRITE_... */
    /* (pile) fraction of its length that is solid all of the time; (puff) height of each puff as a fraction of the
     * sprite's path. Then columns + 32 x rows of puffs. */
    uint shares;
    /* (puff) a random number of ten bits; the elapsed fraction of its life, in units of 1 / 1023; and the radius of its
     * ring over that of the droplets around it, in units of 1 / 255 (0: a disk) */
    uint id;
};

#define VIRGA_SPRITE_DROPLET 0
#define VIRGA_SPRITE_PILE    1
#define VIRGA_SPRITE_PUFF    2
#define VIRGA_SPRITE_CLOUD   3 /* mist: droplets that one stands for, too many to be seen one by one */

/* Puffs whose crowns are drawn one by one have a quad for each of as many as a puff may have. Their vertices begin at
 * this one, so that the pass of the others can draw them, too. */
#define VIRGA_SPLASH_MAX_CROWNS   64
#define VIRGA_SPLASH_CROWN_VERTEX 0x40000000

/* Arguments of an indexed indirect draw, in Vulkan's layout. */
struct virga_splash_draw_gpu {
    uint index_count;
    uint instance_count;
    uint first_index;
    int vertex_offset;
    uint first_instance;
};

/* Result of a prepare. */
struct virga_splash_prepared_gpu {
    virga_splash_draw_gpu lines;       /* droplets of one colour, drawn as lines */
    virga_splash_draw_gpu thin_quads;  /* other sprites of one colour: droplets and piles */
    virga_splash_draw_gpu puffs;       /* distant splashes */
    virga_splash_draw_gpu puff_crowns; /* those whose crowns are drawn one by one, an instance each */
    virga_splash_draw_gpu wide_quads;  /* sprites that refract what is behind them; (paper) pyramids */
    virga_splash_draw_gpu crowns;      /* sheets of crowns; (paper) pyramids of crowns */
    uint sprites;
    uint list_groups[3]; /* of the pass that writes the list; 0: the prefix sum pass has done so */
    uint cut[2];         /* sprites and sheets that were dropped because the buffer was full */
};

/* The mesh of a sheet: columns around it, rows upwards. In the paper's style pyramids replace it. */
#define VIRGA_CROWN_COLUMNS  60
#define VIRGA_CROWN_ROWS     4
#define VIRGA_CROWN_INDICES  1440 /* columns x rows x 6 */
#define VIRGA_CROWN_PYRAMIDS 10

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_splash_look_gpu, 56);
VIRGA_ASSERT_SIZE(virga_sprite_gpu, 64);
VIRGA_ASSERT_SIZE(virga_splash_prepared_gpu, 144);
VIRGA_ASSERT_SIZE(virga_splash_tick_gpu, 168 + 64 * VIRGA_SPLASH_PANES);
VIRGA_ASSERT_SIZE(virga_splash_pane_gpu, 64);
VIRGA_ASSERT_SIZE(virga_splash_state_gpu, 148 + 8 * VIRGA_SPLASH_COUNTS);
VIRGA_ASSERT_OFFSET(virga_splash_state_gpu, droplet_groups, 36);
VIRGA_ASSERT_OFFSET(virga_splash_state_gpu, splash_groups, 48);
#undef uint
#endif

#endif
