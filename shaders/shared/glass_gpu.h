/* glass_gpu.h - what glass's passes share with the C code that feeds them. Internal to Virga. */
#ifndef VIRGA_SHARED_GLASS_GPU_H
#define VIRGA_SHARED_GLASS_GPU_H

#include "compact.h"
#include "glass_drop.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_glass_blade_gpu virga_glass_blade_gpu;
typedef struct virga_glass_pane_gpu virga_glass_pane_gpu;
typedef struct virga_glass_tick_gpu virga_glass_tick_gpu;
typedef struct virga_glass_count_gpu virga_glass_count_gpu;
typedef struct virga_glass_state_gpu virga_glass_state_gpu;
typedef struct virga_glass_seed_gpu virga_glass_seed_gpu;
typedef struct virga_glass_ball_gpu virga_glass_ball_gpu;
typedef struct virga_glass_node_gpu virga_glass_node_gpu;
typedef struct virga_glass_breath_gpu virga_glass_breath_gpu;
#endif

#define VIRGA_GLASS_GROUP            256
#define VIRGA_GLASS_SMALL_GROUP      64 /* workgroup size of passes over active slots and over seeds */
#define VIRGA_GLASS_BLADES           8  /* equal to VIRGA_GLASS_MAX_WIPERS */
#define VIRGA_GLASS_SIZES            64 /* bins of the sizes of drops that land */
#define VIRGA_GLASS_NODES            33 /* along each side of the grid that defines a pane's shape */
#define VIRGA_GLASS_BINS             64 /* along a blade, for the film that it collects */
#define VIRGA_GLASS_ROUNDS           8  /* max cells that a drop moves in a tick; even */
#define VIRGA_GLASS_MAX_PARTS        64 /* max particles that one drop becomes */
#define VIRGA_GLASS_RELAX_ROUNDS     8  /* in which particles push each other in a tick */
#define VIRGA_GLASS_BLOCKS_PER_GROUP 8  /* blocks of cells per workgroup of the measuring pass */
#define VIRGA_GLASS_FILM_BLOCK       16 /* cells along the side of a block; blocks without film are skipped */
#define VIRGA_GLASS_SITE_SPAN        4  /* sites along the side of the largest area whose film becomes one drop */
#define VIRGA_GLASS_FOG_TURNS        16 /* ticks in which all blocks of cells have their turn to fog and to dry */
#define VIRGA_GLASS_FOG_SITE         4  /* cells along the side of a square in which one drop at a time forms of fog */
#define VIRGA_GLASS_WETTED           0x0fffffffu /* bits of the word of a wetted cell: the tick */
#define VIRGA_GLASS_LINK_BIT         28 /* bits above: 5 + x + 3 y, the way of the drop that left its film; 0: none */
#define VIRGA_GLASS_HEAT_WAVES       13 /* of the heater's field: its mean and twelve cosines */
#define VIRGA_GLASS_BREATHS          16 /* equal to VIRGA_GLASS_MAX_BREATHS */

/* Sides of virga_glass_tick_gpu.fog_side, as in virga_glass_fog_side. */
#define VIRGA_GLASS_NO_FOG      0u
#define VIRGA_GLASS_FOG_OUTSIDE 1u
#define VIRGA_GLASS_FOG_INSIDE  2u

/* The pane. */
struct virga_glass_pane_gpu {
    uint columns;   /* cells along u */
    uint rows;      /* cells along v */
    float cell_m;   /* m, side of a cell */
    float width_m;  /* m */
    float height_m; /* m */
    uint max_drops; /* slots, a multiple of the workgroup size */
    uint seed;
    uint pad;
};

/* A node of the grid that defines a pane's shape, in the pane's own frame. Its index is column + row x
 * VIRGA_GLASS_NODES. */
struct virga_glass_node_gpu {
    float position[3]; /* m */
    float along_u[3];  /* unit length */
    float along_v[3];  /* unit length, perpendicular to along_u */
    float normal[3];   /* unit length, outward */
};

/* A wiper blade in a tick: a rectangle that moves from one pose to another. */
struct virga_glass_blade_gpu {
    float middle[2];        /* m, centre at the tick's end */
    float along[2];         /* unit length, from the pivot outwards, at the tick's end */
    float before_middle[2]; /* the same at the tick's start */
    float before_along[2];
    float half_length_m; /* m */
    float half_width_m;  /* m */
    /* the leading side: 1 to the left of `along` (counter-clockwise), -1 to the right, 0: the blade does not move */
    float side;
    float wear;   /* [0; 1], 1: worn out */
    float film_m; /* m, thickness of the film that it leaves behind */
    uint random;
};

/* Breath on the pane: at a distance d from its middle, `share` exp(-d^2 / radius^2) of the air before the glass. */
struct virga_glass_breath_gpu {
    float middle[2];   /* m */
    float inv_radius2; /* 1/m^2 */
    float share;       /* [0; 1], in its middle */
    float lasts;       /* [0; 1], the part of the time since a block's last turn in which it blows */
};

/* Parameters of all passes of a tick. Vectors are in the pane's own frame. */
struct virga_glass_tick_gpu {
    virga_glass_pane_gpu pane;
    uint tick;
    uint tick_in_step;
    float tick_s;            /* s, length of a tick */
    uint arrivals;           /* max drops that land in this tick from the rain rate */
    uint impacts;            /* max drops that land in this tick from the host's list */
    float max_acceleration;  /* m/s^2, max over the pane */
    float max_air_m_s;       /* m/s, max speed of the air that acts on drops: includes air_share */
    float force[3];          /* m/s^2, gravity minus the acceleration of the pane's origin */
    float drop_nl_of_m3;     /* spherical cap: water (nl) of a drop with a base of 1 m radius, pi f(angle) 1e12 */
    float spin[3];           /* rad/s, angular velocity of the pane */
    float drag;              /* N s/m per metre of base radius: viscous resistance of a running drop */
    float air[3];            /* m/s, velocity of the free air relative to the pane */
    float air_share;         /* [0; 2], speed of the air at the drops over that of the free air */
    float air_outward[2];    /* 1/s, along u and v: speed of the air that spreads from the middle, over the distance */
    float air_drag;          /* N, force on a drop with a base of 1 m radius in air of 1 m/s */
    float fall[3];           /* unit length, direction of the drops that land */
    float fall_cosine;       /* max cosine between the opposite of `fall` and the pane's normals */
    float hold;              /* N per metre of base radius: max force that contact-angle hysteresis resists */
    float kinetic_hold;      /* fraction of `hold` that acts on a running drop */
    float affinity_sigma;    /* >= 0, standard deviation of the logarithm of the cells' affinity */
    float meander;           /* [0; 1], fraction of sideways steps */
    float path_ease;         /* [0; 1], fraction by which a wet path lowers `hold` */
    float path_dry_s;        /* s, time in which a path dries */
    float merge_distance;    /* drops merge at this distance, in units of the sum of their radii */
    float tail_spacing_m;    /* m, distance between drops left behind */
    float tail_share;        /* max fraction of the runner's water that one of them gets */
    float tail_max_radius_m; /* m, max radius of one of them */
    float shrink_nl_s;       /* nl/s, loss of tail drops per square metre of their base */
    float trail_m;           /* m: film that a drop leaves at 1 m/s; it grows with the power of 2/3 of its speed */
    float left_from_m_s;     /* m/s: slower water leaves none */
    float evaporation_m_s;   /* m/s */
    float mist_nl;           /* nl, smaller drops become part of the film */
    uint cells_per_tick;     /* max cells that a drop moves in a tick */
    float particle_m;        /* m, radius of a particle */
    uint particle_nl;        /* nl, water of a particle */
    float penalty;           /* [0; 1], extra push between particles, as a fraction of their overlap */
    uint crowd;              /* a particle that overlaps so many others may merge with one */
    float band_m;            /* m, width of the band of particles on each side of a blade */
    uint hold_back_nl;       /* nl, drops of at least this water keep particles near them from becoming drops */
    uint hold_back_cells;    /* reach of that effect, in cells on each side */
    uint blade_count;
    uint grid_columns; /* of the grid for neighbour search among particles */
    uint grid_rows;
    float grid_m;      /* m, side of a cell of that grid */
    uint rolling_row;  /* (film) a tick dries only some rows: the first of them */
    uint rolling_rows; /* (film) their number */
    float rolling_s;   /* (film) s, time since these rows were last dried */
    /* Simulated water. */
    uint flooded;          /* 1: it may stand against the pane, or have left film that has not broken yet */
    uint water_count;      /* particles that may touch the pane in this step */
    float water_spacing_m; /* m, their distance at rest */
    uint water_rounds;     /* steps of the search for the point of the surface below a particle; 1: it is flat */
    float water_offset[3]; /* m, in the world: from the pane's origin to the origin of the particles */
    float world_from_pane[9];
    float pane_velocity[3]; /* m/s */
    float low[3];           /* m, corners of a box around the surface */
    float high[3];
    float left_m;      /* m: the same that water leaves at a receding speed of 1 m/s */
    uint recede_ticks; /* a cell that nothing touches for so long is no more under water */
    float break_ticks; /* mean time until the film of a site becomes a drop */
    uint sites;        /* areas of cells whose film may become drops in this tick */
    uint site_columns;
    uint first_site_row;
    uint site_cells; /* along a side of a site */
    /* Condensation: fog is water in picolitres per cell. */
    uint fog_side;       /* VIRGA_GLASS_NO_FOG: nothing condenses or dries */
    uint fog_groups;     /* workgroups of a turn: one per block of cells, of which the last may be beyond the pane */
    uint fog_sites;      /* seeds of drops that form of fog; 0: none in this tick */
    float fog_pl;        /* pl that condense on a cell per kg/m^3 of excess vapour, since its last turn */
    float breath_pl;     /* the same in the middle of a breath that is the only air there */
    float air_vapour;    /* kg/m^3, of the room or the open air */
    float breath_vapour; /* kg/m^3, of breath */
    float glass_c;       /* degrees, of glass that is not heated */
    float fog_drop_pl;   /* pl on a cell whose droplets have the radius from which they are drops of their own */
    float fog_start_pl;  /* pl on each cell at the start */
    float heat_wave;     /* 1/m, along v: 2 pi over the distance of the heater's wires; 0: it has none */
    float heat_phase;    /* rad, at v = 0 */
    /* of the rise in temperature since the last turn of the blocks that have theirs: mean, then amplitudes of cosines
     * */
    float heat_k[VIRGA_GLASS_HEAT_WAVES];
    uint breath_count;
    virga_glass_breath_gpu breaths[VIRGA_GLASS_BREATHS];
    virga_glass_blade_gpu blades[VIRGA_GLASS_BLADES];
    float sizes_m[VIRGA_GLASS_SIZES]; /* m, diameters of drops that land: quantiles of their distribution by number */
};

/* A 64-bit count. */
struct virga_glass_count_gpu {
    uint low;
    uint high;
};

#define VIRGA_GLASS_LANDED       0  /* nl */
#define VIRGA_GLASS_RUN_OFF      1  /* nl, over an edge */
#define VIRGA_GLASS_WIPED        2  /* nl, pushed over an edge by a blade, or landed on a blade */
#define VIRGA_GLASS_EVAPORATED   3  /* nl */
#define VIRGA_GLASS_ARRIVED      4  /* drops */
#define VIRGA_GLASS_MERGED       5  /* drops */
#define VIRGA_GLASS_TO_PARTS     6  /* drops that became particles */
#define VIRGA_GLASS_TO_DROPS     7  /* particles that became drops */
#define VIRGA_GLASS_WITHOUT_SLOT 8  /* drops without a free slot: their water became part of the film */
#define VIRGA_GLASS_TOUCHED      9  /* nl, left by simulated water that receded */
#define VIRGA_GLASS_JOINED       10 /* nl, taken up by simulated water */
#define VIRGA_GLASS_CONDENSED    11 /* pl, of vapour that became fog */
#define VIRGA_GLASS_FOG_DRIED    12 /* pl, of fog that evaporated */
#define VIRGA_GLASS_FOG_GIVEN    13 /* nl, of fog that became part of drops, blades' water or film, or ran off */
#define VIRGA_GLASS_COUNTS       14

/* What simulated water does to a cell: a word with one of these in the two highest bits. */
#define VIRGA_GLASS_DRY     0u
#define VIRGA_GLASS_BREAKS  1u /* it has left film that has not broken yet; below: the tick */
#define VIRGA_GLASS_UNDER   2u /* it stands there; below: ticks since a particle touched, and its speed */
#define VIRGA_GLASS_REACHED 3u /* a particle touched in this step; below: the highest speed along the pane (mm/s) */
#define VIRGA_GLASS_PHASE   30 /* bits below them */
#define VIRGA_GLASS_SPEED   12 /* bits of the speed */

struct virga_glass_state_gpu {
    uint alive;   /* entries of the list of live slots */
    uint free;    /* free slots */
    uint spawned; /* free slots that were used in this tick */
    uint drops;   /* on the pane, when last counted */
    uint particles;
    uint particles_waiting;
    uint alive_groups[3]; /* workgroups of a dispatch over the list of live slots */
    uint seed_groups[3];  /* over all seeds */
    /* Active slots of this tick: all particles, then the drops that may move or meet a blade. */
    uint active_count;
    uint active_particles;
    uint active_groups[3];   /* over all active slots */
    uint particle_groups[3]; /* over the particles */
    uint settle_groups[3];   /* over seeds or live slots, whichever are more */
    /* one dispatch per round, over the active slots; 0 workgroups if no drop moves in the round */
    uint round_groups[24];
    uint max_rounds; /* max over all drops in this tick */
    uint max_nl;     /* nl, max water of a drop at the tick's start */
    uint impacts;    /* in the host's list in this step */
    virga_glass_count_gpu counts[VIRGA_GLASS_COUNTS];
    virga_glass_count_gpu measured[3]; /* nl in drops, in particles, in the film (bins of the blades included) */
    /* nl, film collected along each blade: VIRGA_GLASS_BLADES x VIRGA_GLASS_BINS */
    uint bins_nl[512];
    uint asked_nl[512];   /* nl of film that cells behind the blades need in this tick, by bin */
    uint given_nl[512];   /* nl of it that the bins have given; still in bins_nl until they are emptied */
    uint shown;           /* the first so many slots of the list may hold drops at the tick's end */
    uint shown_groups[3]; /* workgroups of a dispatch over them */
    uint film_blocks;     /* listed blocks, which may have film */
    /* of the measuring pass: over these blocks and over all slots that may hold drops */
    uint measure_groups[3];
    /* of the passes that make the list of live slots: up to the last live slot at the tick's start */
    uint live_list_groups[3];
    /* free slots in the list, after the live ones; the free slots behind them follow in order */
    uint free_listed;
};

/* A seed: water that needs a slot at the tick's end, 40 bytes. First the drops that land in the tick, then one seed per
 * active slot, then the bins of the blades, sites whose film breaks, sites of fog. */
struct virga_glass_seed_gpu {
    float position[2];
    float velocity[2];
    uint water_nl; /* nl, of each; 0: nothing */
    uint count;    /* (particles) how many; the first `extra_nl` of them have 1 nl more */
    uint extra_nl;
    uint cell; /* (drop) its cell; VIRGA_GLASS_NONE: particles */
    uint id;
    uint kind;
};

/* A two-dimensional metaball of the height map, 44 bytes. */
struct virga_glass_ball_gpu {
    float middle[2]; /* m, centre on the pane, displaced as texels are (pinning.glsl) */
    float radius_m;  /* m, where a single ball has the density 0.5; its water has the height of a spherical cap */
    /* area in texels that it covers in addition to its shape, because it is hardly larger than a texel */
    float mist;
    float sag[2];  /* the height is multiplied by 1 + dot(sag, offset / radius): thicker on that side */
    float peak;    /* density at its centre: 1; less if it is hardly larger than a texel; 0: no shape */
    uint tiles[2]; /* tiles that it touches along u and v: first | count << 16 */
    /* its outline is an ellipse: with s the logarithm of its length over its width, and p the angle of its length from
     * u towards v, -sinh s cos 2p and -sinh s sin 2p */
    float stretch[2];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_glass_pane_gpu, 32);
VIRGA_ASSERT_SIZE(virga_glass_node_gpu, 48);
VIRGA_ASSERT_SIZE(virga_glass_blade_gpu, 56);
VIRGA_ASSERT_SIZE(virga_glass_breath_gpu, 20);
VIRGA_ASSERT_SIZE(virga_glass_seed_gpu, 40);
VIRGA_ASSERT_SIZE(virga_glass_ball_gpu, 44);
VIRGA_ASSERT_OFFSET(virga_glass_state_gpu, alive_groups, 24);
VIRGA_ASSERT_OFFSET(virga_glass_state_gpu, counts, 200);
VIRGA_ASSERT_OFFSET(virga_glass_state_gpu, bins_nl, 336);
VIRGA_ASSERT_OFFSET(virga_glass_state_gpu, shown_groups, 6484);
VIRGA_ASSERT_OFFSET(virga_glass_state_gpu, measure_groups, 6500);
#undef uint
#endif

#endif
