/* ground_gpu.h - what ground's passes share with the C code that feeds them. Internal to Virga.
 *
 * Water is in whole nanolitres, so that it is conserved exactly: no rounding. Heights are in whole micrometres. */
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
typedef struct virga_contact_gpu virga_contact_gpu;
typedef struct virga_far_floor_gpu virga_far_floor_gpu;
typedef struct virga_ground_tick_gpu virga_ground_tick_gpu;
typedef struct virga_ground_count_gpu virga_ground_count_gpu;
typedef struct virga_ring_gpu virga_ring_gpu;
typedef struct virga_rings_gpu virga_rings_gpu;
typedef struct virga_stream_gpu virga_stream_gpu;
typedef struct virga_streams_gpu virga_streams_gpu;
typedef struct virga_ground_blocks_gpu virga_ground_blocks_gpu;
#endif

#define VIRGA_GROUND_GROUP        256
#define VIRGA_GROUND_IMPACTS_EACH 64  /* of a workgroup: as the head of a list of impacts counts them */
#define VIRGA_GROUND_PAIRS_EACH   4   /* blocks of a workgroup of a flow pass */
#define VIRGA_GROUND_BLOCK        512 /* cells of a block: eight rows of a tile, so that a workgroup has its pairs */
/* mean height of each quarter of all bumps, in units of bumps_um */
#define VIRGA_GROUND_QUARTERS  -1.52, -0.42, 0.42, 1.52
#define VIRGA_GROUND_FAR_SHIFT 3
#define VIRGA_GROUND_CONTACTS  64 /* wheels and feet in a step */
#define VIRGA_GROUND_LANES     64 /* invocations of the workgroup that moves their water */
#define VIRGA_GROUND_FAR_CELL  8  /* window cells along the side of a cell of the far map: 1 << FAR_SHIFT */

/* Waves on water that runs, see shaders/ground/stream.glsl. */
#define VIRGA_STREAM_OCTAVES   3                   /* wavelengths, each twice the one before */
#define VIRGA_STREAM_WAVE_LIST 0.016, 0.032, 0.064 /* m */
/* cosine and sine of the angle by which the picture of each is turned: 0.5, 1.6 and 2.9 rad */
#define VIRGA_STREAM_TURN_0     0.877583, 0.479426
#define VIRGA_STREAM_TURN_1     -0.0292, 0.999574
#define VIRGA_STREAM_TURN_2     -0.970958, 0.239249
#define VIRGA_STREAM_LAYERS     2     /* of waves that are carried along and renewed by turns */
#define VIRGA_STREAM_TILE       256   /* texels along the side of a picture of waves */
#define VIRGA_STREAM_TILE_WAVES 8.3   /* wavelengths along that side */
#define VIRGA_STREAM_TILE_SLOPE 160.0 /* largest slope in it, where a side is as long as a wave is high: 127 of 128 */
#define VIRGA_STREAM_BLOCK      4     /* cells along the side of the blocks in which they are drawn */
#define VIRGA_STREAM_MAX_SIDE   512   /* cells along the side of the area with such waves */
#define VIRGA_STREAM_BLOCKS     16384 /* MAX_SIDE / BLOCK, squared */

/* Water that arrives in a tick. Zero between ticks. */
struct virga_arrivals_gpu {
    uint landed_nl; /* nl, of the drops that hit the cell */
    uint given_nl;  /* nl, the cell's share of the water of all drops */
};

/* A material, scaled to the size of a cell. */
struct virga_soil_gpu {
    uint capacity_nl;  /* nl, max in its pores */
    uint retention_nl; /* nl, retained by its roughness when the rest runs off */
    float sink_nl_s;   /* nl/s, infiltration from the cell downwards */
    float drying;      /* factor of the evaporation */
    float inv_manning; /* s^-1 m^(1/3), 1 / Manning's roughness coefficient */
    float bumps_um;    /* um, standard deviation of its unevenness */
    float bump_cells;  /* width of a bump, in cells */
    uint drain;        /* 1: a drain, removes all water */
};

/* The initial water of a cell of a material, where no drops were counted: as much as other ground has after the same
 * rain. */
struct virga_standing_gpu {
    float held;     /* [0; 1], filled fraction of its pores */
    float film_nl;  /* nl, on the surface, the same on humps and in hollows */
    float level_um; /* um, height up to which hollows are full; humps are higher */
    float spots;    /* >= 0, total area of the dark spots of first drops, relative to the ground's area */
};

/* A cell of the far map: the coarse map of the ground outside the window. */
struct virga_far_floor_gpu {
    int height_um; /* um, above the ground's base_m, without the unevenness */
    /* from the lowest bit on: material (8 bits); fraction of the rain that reaches it (4 bits); fraction that is level
     * enough for puddles (4 bits); unevenness (16 bits, signed, in units of FAR_BUMP_UM) */
    uint traits;
};

/* A wheel or a foot in a tick. Its patch is a rectangle on the ground, which moves along `ahead`; across is ahead,
 * turned by 90 degrees from x to z. */
struct virga_contact_gpu {
    float middle[2]; /* m, x and z of the patch at the end of the tick, from the window's low corner */
    float ahead[2];  /* x and z, unit length */
    float half_m[2]; /* half of its length along and across */
    float swept_m;   /* way that it has moved in the tick */
    float height_m;  /* above base_m */
    float speed;     /* m/s, over the ground */
    float press;     /* m/s, (foot) downwards */
    float tread;     /* m/s, (wheel) of the tread around its axle */
    float radius_m;  /* (wheel); 0: a foot */
    float open_rad;  /* (wheel) angle behind the patch from which on the tread is covered */
    uint id;
    int low[2]; /* cells of the world around it, low corner */
    uint width; /* of that rectangle, in cells */
    uint end;   /* cells of this and all contacts before it */
    uint pad[2];
};

/* Parameters of all passes of a tick. */
struct virga_ground_tick_gpu {
    int low_tile[2]; /* low corner of the window, in tiles from the world's origin */
    uint tiles;      /* along the window's side, a power of two */
    uint tick;       /* the tick that the passes compute; impacts of other ticks are ignored */
    /* m, low corner of the window in the world: high + low, a sum of two floats for precision; y is 0 */
    float window_high[3];
    float window_low[3];
    float cell_m; /* m, side of a cell */
    float inv_cell_m;
    int nl_per_um; /* water that raises the level of a cell by 1 um */
    float m_per_nl;
    uint seed;
    float flow_s;             /* s, time step of a flow pass */
    float evaporation_nl_s;   /* nl/s, per cell */
    float height_map_top_m;   /* m, height above base_m of depth 0 in the height map */
    float height_map_depth_m; /* m, from depth 0 to depth 1 */
    float base_m;             /* m, height in the world from which the heights of floors count */
    float ripple_low_m[2];    /* m, low corner of the ripple map, relative to the window's */
    float ripple_side_m;      /* m, side of the ripple map */
    float tick_s;             /* s, length of a tick */
    float wake_waves;         /* how high wakes are drawn; 1: as they are, 0: not at all */
    uint last_tick;           /* the newest tick */
    uint max_spawns;          /* 0: no splashes */
    uint max_impacts;         /* landings of returns start at this index */
    uint max_returned_droplets;
    float camera[3]; /* m, in the world */
    uint tick_in_step;
    float material_scale[2]; /* from cells relative to the window's low corner to the material map's [0; 1) */
    float material_offset[2];
    int far_low[2];               /* low corner of the far map, in far cells from the world's origin */
    uint far_cells;               /* along the far map's side; 0: no far map */
    float far_material_offset[2]; /* as material_offset, but from the far map's low corner */
    float far_camera[2];          /* in far cells, from the far map's low corner */
    /* in far cells, distances from the camera between which single puddles fade into their average */
    float far_even[2];
    float rain_per_m2_s; /* drops per m^2 and s that land on open ground */
    float rain_drop_m;   /* m, diameter of those drops */
    /* Simulated water that may touch the ground. */
    uint water_count;      /* particles */
    float water_offset[3]; /* m, from the window's low corner, at the height base_m, to the origin of their positions */
    float water_reach_m;   /* height of their centers above the ground up to which they touch it */
    /* Water that becomes particles of a simulation. */
    float exchange_offset[3]; /* as water_offset, to the origin of that simulation */
    int region_low[2];        /* cells of the world that give it, low corner */
    int region_high[2];       /* behind the last ones; not above region_low: none does */
    /* What rolls and walks. */
    /* Water that runs. */
    int stream_low[2];    /* cell of the world, low corner of the area with its waves; a multiple of BLOCK */
    uint stream_blocks;   /* blocks along its side */
    uint stream_period;   /* ticks for which a layer of waves lasts, even */
    float stream_waves;   /* how high they are drawn; 1: as they are, 0: not at all */
    float stream_texel_m; /* of the ripple map */
    /* where the window's low corner lies in the picture of waves of each octave, in [0; 1) */
    float stream_corner[2 * VIRGA_STREAM_OCTAVES];
    float stream_age_s[VIRGA_STREAM_LAYERS];  /* since each layer of waves began */
    float stream_weight[VIRGA_STREAM_LAYERS]; /* of each; the squares add up to 1 */
    /* where a layer began in the picture of each octave, in [0; 1) */
    float stream_place[2 * VIRGA_STREAM_LAYERS * VIRGA_STREAM_OCTAVES];
    uint contact_count;
    uint contact_droplets;  /* that may fly out of a cell; 0: none */
    float handed_offset[3]; /* from the origin of droplets to the window's low corner at the height base_m */
    float handed_late_s;    /* s, how much later than the end of this tick they are where the list says */
    virga_contact_gpu contacts[VIRGA_GROUND_CONTACTS];
    virga_soil_gpu soils[VIRGA_GROUND_MATERIALS];
    virga_standing_gpu standing[2 * VIRGA_GROUND_MATERIALS]; /* by material: first in the open, then sheltered */
};

/* A ring wave on a puddle, 48 bytes. Of a drop, or one of those that a wake is made of. */
struct virga_ring_gpu {
    int cell[2];      /* cell of the world where the drop fell */
    float in_cell[2]; /* [0; 1), position in that cell */
    uint tick;        /* tick in which the drop fell */
    float share;      /* fraction of that tick that had passed; 1 or more: the ring starts later */
    /* m, depth of the crater; larger if the ring represents several. 0: this entry was never used. */
    float crater_m;
    float depth_m;  /* m, of the water */
    uint width;     /* index of the crater's width in VIRGA_RING_WIDTH_LIST */
    uint id;        /* of the drop, the wheel or the foot */
    float drift[2]; /* m/s, along x and z, of the water's surface: it carries the ring along */
};

/* Head of the list of ring waves: a ring buffer of drops' rings, and behind it one of wakes. */
struct virga_rings_gpu {
    uint total; /* rings ever added; the newest is at index (total - 1) modulo VIRGA_MAX_RINGS */
    uint wakes; /* the same of wakes: (wakes - 1) modulo VIRGA_MAX_WAKES, behind VIRGA_MAX_RINGS */
    uint pad[2];
};

/* Running water of a cell, and the waves on it. */
struct virga_stream_gpu {
    int cell[2];   /* of the world; another cell: what is here is of the one that was here before */
    float flow[2]; /* m/s, along x and z, of the surface, as a mean over time */
    float depth_m; /* of what runs, as a mean over time */
    float moved_m[2 * VIRGA_STREAM_LAYERS]; /* how far it has run since each layer of waves began */
    float standing_m[VIRGA_STREAM_OCTAVES]; /* standard deviation of the surface's height: of waves that stand still */
    float height_m[VIRGA_STREAM_OCTAVES];   /* and of those that the water carries along */
    float turn_rad_s[VIRGA_STREAM_OCTAVES]; /* their angular frequency, for one who goes with the water */
};

/* Head of the running water: its blocks that have waves, as arguments of an indirect draw. */
struct virga_streams_gpu {
    uint vertices;                   /* of a block */
    uint blocks;                     /* in the list */
    uint first[2];                   /* 0 */
    uint shown[VIRGA_STREAM_BLOCKS]; /* bits of the octaves that some cell of the block has; by rows of stream_blocks */
    uint list[VIRGA_STREAM_BLOCKS];  /* their numbers, and the octaves that are drawn: number | bits << 16 */
};

/* Head of the list of blocks of cells that have ground: what is below houses has none. It lies behind the floors;
 * behind it are a mark for each block, and the numbers of the marked blocks, in order. */
struct virga_ground_blocks_gpu {
    uint flow_groups[3]; /* workgroups of a flow pass, as arguments of an indirect dispatch */
    uint map_groups[3];  /* the same of map.comp: one in x for each block, a block's halves in y */
    uint count;          /* blocks in the list */
    uint pad;
};
/* Its members, counted in words, and where the marks begin. */
#define VIRGA_GROUND_FLOW_GROUPS 0
#define VIRGA_GROUND_MAP_GROUPS  3
#define VIRGA_GROUND_BLOCK_COUNT 6
#define VIRGA_GROUND_BLOCK_MARKS 8

/* A 64-bit count of water (nl). */
struct virga_ground_count_gpu {
    uint low;
    uint high;
};

/* Indices into the counts, all in nl except VIRGA_GROUND_CELLS. The first ones only grow. From
 * VIRGA_GROUND_FIRST_MEASURED on, measure.comp computes them anew. */
#define VIRGA_GROUND_LANDED         0 /* landed and did not fly up again; returns included */
#define VIRGA_GROUND_OFF_GROUND     1 /* the same on surfaces that are not ground, or outside the window */
#define VIRGA_GROUND_INFILTRATED    2
#define VIRGA_GROUND_RUN_OFF        3 /* into drains */
#define VIRGA_GROUND_EVAPORATED     4
#define VIRGA_GROUND_EVICTED        5  /* with cached tiles that were discarded because the cache was full */
#define VIRGA_GROUND_STARTED        6  /* initial water of new cells */
#define VIRGA_GROUND_FLOWN          7  /* flew up in splashes */
#define VIRGA_GROUND_RETURNED       8  /* part of FLOWN that fell back */
#define VIRGA_GROUND_SPRAY          9  /* part of LANDED that is spray of simulated water, wheels and feet */
#define VIRGA_GROUND_SPRAY_OFF      10 /* part of OFF_GROUND that is */
#define VIRGA_GROUND_TOUCHED        11 /* from simulated water that touched it */
#define VIRGA_GROUND_TAKEN          12 /* became particles of a simulation */
#define VIRGA_GROUND_GIVEN          13 /* came back from it */
#define VIRGA_GROUND_GIVEN_OFF      14 /* came back where there is no ground */
#define VIRGA_GROUND_THROWN         15 /* thrown by wheels and feet */
#define VIRGA_GROUND_FIRST_MEASURED 16
#define VIRGA_GROUND_FILM           16 /* free water of wet and dry cells */
#define VIRGA_GROUND_PUDDLES        17 /* free water of puddles */
#define VIRGA_GROUND_HELD           18 /* in pores */
#define VIRGA_GROUND_CACHED         19 /* all water of cached tiles, which are outside the window */
#define VIRGA_GROUND_CELLS          20 /* number of cells by state: VIRGA_GROUND_STATES counts */
#define VIRGA_GROUND_COUNTS         26

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_arrivals_gpu, 8);
VIRGA_ASSERT_SIZE(virga_soil_gpu, 32);
VIRGA_ASSERT_SIZE(virga_ring_gpu, 48);
VIRGA_ASSERT_SIZE(virga_rings_gpu, 16);
VIRGA_ASSERT_SIZE(virga_stream_gpu, 72);
VIRGA_ASSERT_SIZE(virga_streams_gpu, 16 + 8 * VIRGA_STREAM_BLOCKS);
VIRGA_ASSERT_SIZE(virga_standing_gpu, 16);
VIRGA_ASSERT_SIZE(virga_far_floor_gpu, 8);
VIRGA_ASSERT_SIZE(virga_contact_gpu, 80);
VIRGA_ASSERT_SIZE(virga_ground_tick_gpu, 376 + 80 * VIRGA_GROUND_CONTACTS + (32 + 2 * 16) * VIRGA_GROUND_MATERIALS);
VIRGA_ASSERT_SIZE(virga_ground_count_gpu, 8);
#undef uint
#endif

#endif
