/* glass_picture_gpu.h - what the passes that make and draw the height map share with the C that feeds them.
 * Internal to Virga. */
#ifndef VIRGA_SHARED_GLASS_PICTURE_GPU_H
#define VIRGA_SHARED_GLASS_PICTURE_GPU_H

#include "glass_gpu.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_glass_picture_gpu virga_glass_picture_gpu;
typedef struct virga_glass_tile_gpu virga_glass_tile_gpu;
typedef struct virga_glass_work_gpu virga_glass_work_gpu;
typedef struct virga_glass_corners_gpu virga_glass_corners_gpu;
#endif

#define VIRGA_GLASS_TILE            8     /* texels a side; a workgroup of the gathering pass makes one */
#define VIRGA_GLASS_TILE_ROW        32768 /* workgroups along x of a dispatch over tiles, at most */
#define VIRGA_GLASS_MIST_BLOCK      16    /* texels a side of the mist's map that a workgroup makes; drawn as one */
#define VIRGA_GLASS_BEAD_CELLS      0.33f /* largest radius of a bead in cells: none reaches beyond the next */
#define VIRGA_GLASS_BEAD_SEEN       0.75f /* least radius in texels of one that has a shape */
#define VIRGA_GLASS_MAX_MIST_TEXELS 8192  /* texels a side of it, at most */
/* of compression: gathers are also made for no more than these, the usual number */
#define VIRGA_GLASS_USUAL_STEPS 5
#define VIRGA_GLASS_DROP_BALLS  4   /* at most, of one slot */
#define VIRGA_GLASS_FILL_GROUP  64  /* balls of a workgroup that fills lists */
#define VIRGA_GLASS_COPY        256 /* texels a side of the plate's largest copy; the others lie to its right */
#define VIRGA_GLASS_COPY_WIDTH  392 /* 256 and 128 and 8 */
#define VIRGA_GLASS_COPY_LEVELS 7   /* down to 4 x 4 */
#define VIRGA_GLASS_COPY_PAPER  2   /* that of 64 x 64 */

/* A view of the pane: its pose, its map's resolution, and the settings that matter to it. */
struct virga_glass_picture_gpu {
    virga_glass_pane_gpu pane;
    float world_from_pane[9];
    float origin[3];  /* of the pane's frame, relative to the camera */
    uint map_columns; /* texels in use */
    uint map_rows;
    uint tile_columns;
    uint tile_rows;
    float texel_m[2];
    float share;  /* of the newest tick that has passed at the time drawn */
    float late_s; /* time drawn less that of the newest tick: 0 or less */
    uint tick;
    float tick_s;
    float gravity[3];    /* m/s^2, in the pane's frame */
    float drop_nl_of_m3; /* cap: see virga_glass_tick_gpu */
    float cap_height;    /* of a cap over the radius of its base */
    float particle_m;    /* radius */
    float impact_s;
    float film_break_s;
    uint density;  /* virga_glass_density */
    uint weighted; /* virga_glass_blend */
    uint compress_steps;
    float compress_from;
    float compress_step;
    float compress_k;
    float threshold;
    float paper_shift;
    float thickness_m;
    float tint[3];
    uint opaque;
    float gain;
    uint max_tiles;       /* tiles that the lists have room for */
    uint max_entries;     /* of the tiles' lists, all together */
    uint written_columns; /* tiles in a row of the list that says which ones the map holds anything of */
    uint max_blocks;      /* of the mist's map that the list of those with film has room for */
    uint mist_columns;    /* texels of the mist's map, of mist_cells x mist_cells cells each */
    uint mist_rows;
    uint mist_cells;
    uint mist_pitch;     /* texels from one row to the next: whole blocks */
    float mist_scale[2]; /* of its texture, per metre */
    uint sheets;         /* sheets of film are shown */
    uint whole_map;      /* the host wants the map: all of it */
    uint masked;         /* the pane has a mask */
    /* to the previous frame's clip coordinates, from where something is relative to the camera that has kept its
     * position on the pane */
    float previous_from_here[16];
    float previous_eye[3]; /* where the camera was then, likewise */
    uint view_texel;       /* first of the view among the texels that all views' blocks are */
    float beside;          /* texels beside one with water that it may show in */
    uint bounds_offset;    /* (even) first of the boxes of tiles, two words each, behind all indices of corners */
};

/* What a draw's pipeline is made for. The pane's side: seen from behind or before all over, or it is not glass; else
 * either. */
#define VIRGA_GLASS_DRAW_DEPTH   1u /* the scene's depth is there to read */
#define VIRGA_GLASS_DRAW_LAMPS   2u /* there are any */
#define VIRGA_GLASS_DRAW_BEHIND  4u
#define VIRGA_GLASS_DRAW_BEFORE  8u
#define VIRGA_GLASS_DRAW_OPAQUE  12u
#define VIRGA_GLASS_DRAW_SIDE    12u /* mask of the three */
#define VIRGA_GLASS_DRAW_BY_HAND 16u /* the device does not filter the map */
#define VIRGA_GLASS_DRAW_PLATE   32u /* the host's picture is there to read; neither this nor the next: the view says */
#define VIRGA_GLASS_DRAW_ALONE   64u /* it is not */
#define VIRGA_GLASS_DRAW_PAPER   128u /* (refraction vectors) the paper's style */

/* For the pass that makes slopes; and there is something to draw. */
#define VIRGA_GLASS_LISTED    2u
#define VIRGA_GLASS_SHOWN     4u
#define VIRGA_GLASS_SPANS_BIT 8 /* first of the columns, and behind these of the rows, that have water */

/* What the images hold of a tile since it was last written, and so has to be taken away. */
#define VIRGA_GLASS_HOLDS_WATER  1u /* the map */
#define VIRGA_GLASS_HOLDS_RELIEF 2u /* what draws by Snell read */

/* The arguments of an indirect draw, as Vulkan has them. */
struct virga_glass_corners_gpu {
    uint index_count;
    uint instance_count;
    uint first_index;
    int vertex_offset;
    uint first_instance;
};

/* How much there is to do: what indirect dispatches and draws read. Followed by numbers: of tiles without film; from
 * look.max_tiles on of tiles with film; from 2 look.max_tiles on of the mist's blocks with film that has a shape;
 * look.max_blocks behind these of tiles with something to show; and look.max_tiles behind these of the mist's blocks
 * that may have any film. Lists are in any order: what is done for one of their entries does not
 * depend on another. All zero as a view's passes begin. */
struct virga_glass_work_gpu {
    uint tile_groups[3];           /* of the gathering pass, over tiles without film */
    uint film_groups[3];           /* and over those with */
    uint ball_groups[3];           /* of the pass that fills the lists */
    uint block_groups[3];          /* of the pass over blocks with film that has a shape */
    uint relief_groups[3];         /* of the pass over tiles that have something to show, or had */
    virga_glass_corners_gpu drops; /* tiles to be drawn */
    virga_glass_corners_gpu mist;  /* blocks to be drawn */
    uint tiles;                    /* in each of the first two lists */
    uint film_tiles;
    uint relief_tiles;
    uint shaped; /* balls with a shape, for the statistics; and entries that tiles were left without */
    uint cut;
    uint balls;
    uint entries;        /* of the lists of all tiles, were there room for any number */
    uint used;           /* that they were given */
    uint highest;        /* a float's bits: the largest radius of a ball */
    uint mist_groups[3]; /* of the pass over the mist's blocks that may have any film */
};

/* What lies over a tile of the map. */
struct virga_glass_tile_gpu {
    uint count;  /* balls that reach it */
    uint first;  /* entry of its list */
    uint filled; /* entries so far */
    uint film;   /* 1: film with a shape, or a sheet of it; and VIRGA_GLASS_LISTED, _SHOWN and spans */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_glass_tile_gpu, 16);
VIRGA_ASSERT_SIZE(virga_glass_corners_gpu, 20);
VIRGA_ASSERT_SIZE(virga_glass_work_gpu, 148);
VIRGA_ASSERT_OFFSET(virga_glass_work_gpu, drops, 60);
VIRGA_ASSERT_OFFSET(virga_glass_work_gpu, mist, 80);
VIRGA_ASSERT_OFFSET(virga_glass_work_gpu, shaped, 112);
VIRGA_ASSERT_OFFSET(virga_glass_picture_gpu, map_columns, 80);
#undef uint
#endif

#endif
