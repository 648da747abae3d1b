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
#endif

#define VIRGA_GLASS_TILE        14 /* texels a side; a workgroup of the gathering pass makes one, and a texel more on each side
                                    * for the slopes */
#define VIRGA_GLASS_DROP_BALLS  4  /* at most, of one place */
#define VIRGA_GLASS_FILL_GROUP  64 /* balls of a workgroup that fills lists */
#define VIRGA_GLASS_COPY        256 /* texels a side of the plate's largest copy; the others lie to its right */
#define VIRGA_GLASS_COPY_WIDTH  392 /* 256 and 128 and 8 */
#define VIRGA_GLASS_COPY_LEVELS 7   /* down to 4 x 4 */
#define VIRGA_GLASS_COPY_PAPER  2   /* that of 64 x 64 */
#define VIRGA_GLASS_MIST_ONE    65536 /* a texel that is all covered, in the mist's whole numbers */

/* A view of the pane: its pose, its map's resolution, and the settings that matter to it. */
struct virga_glass_picture_gpu {
    virga_glass_pane_gpu pane;
    float world_from_pane[9];
    float origin[3];        /* of the pane's frame, relative to the camera */
    uint map_columns;       /* texels in use */
    uint map_rows;
    uint tile_columns;
    uint tile_rows;
    float texel_m[2];
    float share;            /* of the newest tick that has passed at the time drawn */
    float late_s;           /* time drawn less that of the newest tick: 0 or less */
    uint tick;
    float tick_s;
    float gravity[3];       /* m/s^2, in the pane's frame */
    float drop_nl_of_m3;    /* cap: see virga_glass_tick_gpu */
    float cap_height;       /* of a cap over the radius of its base */
    float particle_m;       /* radius */
    float impact_s;
    float film_break_s;
    uint density;           /* virga_glass_density */
    uint weighted;          /* virga_glass_blend */
    uint compress_steps;
    float compress_from;
    float compress_step;
    float compress_k;
    float threshold;
    uint style;             /* virga_glass_style */
    float paper_shift;
    float thickness_m;
    float tint[3];
    uint opaque;
    float gain;
    uint max_tiles;         /* tiles that the lists have places for */
    uint max_entries;       /* of the tiles' lists, all together */
    uint written_columns;   /* tiles in a row of the list that says what the map holds of them, see below */
    uint masked;            /* the pane has a mask */
    float previous_from_here[16]; /* to the previous frame's clip coordinates, from where something is relative to the
                                   * camera that has kept its place on the pane */
    float eye_before[3];    /* where the camera was then, likewise */
};

/* What the map holds of a tile: the lowest bit: anything; the next four: each quarter that has something to show; and the next
 * four: each that has drops. */
#define VIRGA_GLASS_WRITTEN 1u
#define VIRGA_GLASS_QUARTER 2u

/* What a draw's pipeline is made for. The pane's side: seen from behind or before all over, or it is not glass; else either. */
#define VIRGA_GLASS_DRAW_DEPTH   1u  /* the scene's depth is there to read */
#define VIRGA_GLASS_DRAW_LAMPS   2u  /* there are any */
#define VIRGA_GLASS_DRAW_BEHIND  4u
#define VIRGA_GLASS_DRAW_BEFORE  8u
#define VIRGA_GLASS_DRAW_OPAQUE  12u
#define VIRGA_GLASS_DRAW_SIDE    12u /* mask of the three */
#define VIRGA_GLASS_DRAW_BY_HAND 16u /* the device does not filter the map */

/* A tile's `film`. */
#define VIRGA_GLASS_HAS_FILM 1u
#define VIRGA_GLASS_HAS_MIST 2u

/* How much there is to do: what indirect dispatches and draws read. Followed by the numbers of tiles to be worked on. */
struct virga_glass_work_gpu {
    uint tile_groups[3];    /* of the gathering pass, over tiles without film */
    uint film_groups[3];    /* and over those with; their numbers begin in the middle of the list */
    uint ball_groups[3];    /* of the pass that fills the lists */
    uint index_count;       /* of the quarters to be drawn */
    uint instance_count;
    uint first_index;
    int vertex_offset;
    uint first_instance;
};

/* What lies over a tile of the map. */
struct virga_glass_tile_gpu {
    uint count;             /* balls that reach it */
    uint first;             /* entry of its list */
    uint filled;            /* entries so far */
    uint film;              /* VIRGA_GLASS_HAS_... */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_glass_tile_gpu, 16);
VIRGA_ASSERT_SIZE(virga_glass_work_gpu, 56);
VIRGA_ASSERT_OFFSET(virga_glass_work_gpu, index_count, 36);
VIRGA_ASSERT_OFFSET(virga_glass_picture_gpu, map_columns, 80);
#undef uint
#endif

#endif
