/* ground_gpu.h - what ground's passes share with the C that feeds them. Internal to Virga.
 *
 * Water is in whole nanolitres, so that it is counted and never rounded away. Heights are in whole micrometres. */
#ifndef VIRGA_SHARED_GROUND_GPU_H
#define VIRGA_SHARED_GROUND_GPU_H

#include "ground_cell.h"
#include "ground_limits.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_arrivals_gpu virga_arrivals_gpu;
typedef struct virga_soil_gpu virga_soil_gpu;
typedef struct virga_standing_gpu virga_standing_gpu;
typedef struct virga_far_floor_gpu virga_far_floor_gpu;
typedef struct virga_ground_tick_gpu virga_ground_tick_gpu;
typedef struct virga_ground_count_gpu virga_ground_count_gpu;
typedef struct virga_ring_gpu virga_ring_gpu;
typedef struct virga_rings_gpu virga_rings_gpu;
#endif

#define VIRGA_GROUND_GROUP      256
#define VIRGA_GROUND_PAIRS_EACH 4                        /* pairs of cells for an invocation of a flow pass */
#define VIRGA_GROUND_QUARTERS   -1.52, -0.42, 0.42, 1.52 /* means of quarters of all bumps, over their bumps_um */
#define VIRGA_GROUND_FAR_SHIFT  3
#define VIRGA_GROUND_FAR_CELL   8 /* cells of the window along the side of one of the far map: 1 << FAR_SHIFT */

/* Water on its way within a tick; zero between ticks. */
struct virga_arrivals_gpu {
    uint landed_nl; /* of drops that fell on the cell */
    uint given_nl;  /* what of all drops comes to it */
};

/* A material as cells of this size have it. */
struct virga_soil_gpu {
    uint capacity_nl;  /* that its pores hold */
    uint retention_nl; /* that its roughness holds back when the rest runs off */
    float sink_nl_s;   /* infiltration out of the cell, downwards */
    float drying;      /* times the evaporation */
    float inv_manning; /* s^-1 m^(1/3) */
    float bumps_um;    /* standard deviation of its unevenness, and how many cells a bump is wide */
    float bump_cells;
    uint drain; /* 1: takes all water away */
};

/* What a cell of a material has on it and in it that no drop was counted for: that stood in the same rain elsewhere. */
struct virga_standing_gpu {
    float held;     /* [0; 1] share of its pores that is full */
    float film_nl;  /* on it, humps and hollows alike */
    float level_um; /* up to which hollows are full, from where humps begin */
    float spots;    /* dark spots of first drops, by their area: [0; ...) times the ground's */
};

/* What a cell of the far map is. */
struct virga_far_floor_gpu {
    int height_um; /* above the ground's base_m, without its unevenness */
    /* material (8 bits), share that rain reaches and that is level enough for puddles (4 bits each), and its unevenness
     * (16 bits, signed, FAR_BUMP_UM) */
    uint traits;
};

/* All that a tick's passes need. */
struct virga_ground_tick_gpu {
    int low_tile[2];      /* of the window, in tiles from the world's origin */
    uint tiles;           /* along the window's side, a power of two */
    uint tick;            /* that the passes are for: impacts of others are left alone */
    float window_high[3]; /* low corner of the window in the world, as the sum of two floats; y: 0 */
    float window_low[3];
    float cell_m;
    float inv_cell_m;
    int nl_per_um; /* water that raises a cell by a micrometre */
    float m_per_nl;
    uint seed;
    float flow_s; /* time that a flow pass stands for */
    float evaporation_nl_s;
    float height_map_top_m; /* height above the base of depth 0 in the survey, and metres to depth 1 */
    float height_map_depth_m;
    float base_m;          /* height in the world that those of floors count from */
    float ripple_low_m[2]; /* low corner of the ripple map from the window's, and its side */
    float ripple_side_m;
    float tick_s;
    uint rings;       /* 0: no ripple map */
    uint last_tick;   /* the newest tick */
    uint max_spawns;  /* 0: nothing splashes */
    uint max_impacts; /* landings of returns lie behind so many */
    uint max_returned_droplets;
    float camera[3]; /* in the world */
    uint tick_in_step;
    float material_scale[2]; /* from cells behind the window's low corner to the material map [0; 1) */
    float material_offset[2];
    int far_low[2];               /* low corner of the far map, in its cells from the world's origin */
    uint far_cells;               /* along its side; 0: none */
    float far_material_offset[2]; /* as above, from the far map's low corner */
    float far_camera[2];          /* in cells of the far map, from its low corner */
    float far_even[2];            /* as far from there, in such cells: puddles begin to even out, and have */
    float rain_per_m2_s;          /* drops that land on open ground, and their diameter */
    float rain_drop_m;
    virga_soil_gpu soils[VIRGA_GROUND_MATERIALS];
    virga_standing_gpu standing[2 * VIRGA_GROUND_MATERIALS]; /* in the open, then under cover */
};

/* A ring on a puddle, 36 bytes. */
struct virga_ring_gpu {
    int cell[2];      /* of the world, where the drop fell */
    float in_cell[2]; /* [0; 1) */
    uint tick;        /* in which its drop fell, and what share of it had passed; above 1: it begins later */
    float share;
    float crater_m; /* depth of the crater, more where it stands for several; 0: none has been here yet */
    float depth_m;  /* of the water */
    uint id;        /* of the drop */
};

/* Head of the rings: a ring buffer in the other sense too. */
struct virga_rings_gpu {
    uint total; /* that ever were; the newest lies at (total - 1) modulo VIRGA_MAX_RINGS */
    uint pad[3];
};

/* A count of water, 64 bits. */
struct virga_ground_count_gpu {
    uint low;
    uint high;
};

/* Indices into the counts. First those that only grow, then those that measure.comp makes anew. */
#define VIRGA_GROUND_LANDED         0 /* and did not fly up again, or fell back */
#define VIRGA_GROUND_OFF_GROUND     1 /* the same on what is not ground, or outside of the window */
#define VIRGA_GROUND_INFILTRATED    2
#define VIRGA_GROUND_RUN_OFF        3 /* into drains */
#define VIRGA_GROUND_EVAPORATED     4
#define VIRGA_GROUND_EVICTED        5 /* with tiles that there was no room to keep */
#define VIRGA_GROUND_STARTED        6 /* that cells came with */
#define VIRGA_GROUND_FLOWN          7 /* up in splashes */
#define VIRGA_GROUND_RETURNED       8 /* of that, fallen back */
#define VIRGA_GROUND_FIRST_MEASURED 9
#define VIRGA_GROUND_FILM           9  /* free water of wet and dry cells */
#define VIRGA_GROUND_PUDDLES        10 /* free water of puddles */
#define VIRGA_GROUND_HELD           11
#define VIRGA_GROUND_CACHED         12 /* all water of tiles outside of the window */
#define VIRGA_GROUND_CELLS          13 /* cells by state: VIRGA_GROUND_STATES counts */
#define VIRGA_GROUND_COUNTS         19

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_arrivals_gpu, 8);
VIRGA_ASSERT_SIZE(virga_soil_gpu, 32);
VIRGA_ASSERT_SIZE(virga_ring_gpu, 36);
VIRGA_ASSERT_SIZE(virga_rings_gpu, 16);
VIRGA_ASSERT_SIZE(virga_standing_gpu, 16);
VIRGA_ASSERT_SIZE(virga_far_floor_gpu, 8);
VIRGA_ASSERT_SIZE(virga_ground_tick_gpu, 192 + (32 + 2 * 16) * VIRGA_GROUND_MATERIALS);
VIRGA_ASSERT_SIZE(virga_ground_count_gpu, 8);
#undef uint
#endif

#endif
