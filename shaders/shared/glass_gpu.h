/* glass_gpu.h - what glass's passes share with the C that feeds them. Internal to Virga. */
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
#endif

#define VIRGA_GLASS_GROUP            256
#define VIRGA_GLASS_SMALL_GROUP      64 /* of passes over what happens to something in a tick, and over seeds */
#define VIRGA_GLASS_BLADES           8  /* the same as VIRGA_GLASS_MAX_WIPERS */
#define VIRGA_GLASS_SIZES            64 /* bins of the sizes that land */
#define VIRGA_GLASS_NODES            33 /* along each side of the grid that a pane's shape is given on */
#define VIRGA_GLASS_BINS             64 /* along a blade, of the film that it gathers */
#define VIRGA_GLASS_ROUNDS           8  /* cells that a drop may go in a tick; even */
#define VIRGA_GLASS_MAX_PARTS        64 /* particles that one drop becomes */
#define VIRGA_GLASS_BLOCKS_PER_GROUP 8  /* blocks of cells that a workgroup measures */
#define VIRGA_GLASS_FILM_BLOCK       16 /* cells a side of the blocks that are told apart by whether they have film */

/* The pane. */
struct virga_glass_pane_gpu {
    uint columns; /* cells along u, along v */
    uint rows;
    float cell_m;
    float width_m;
    float height_m;
    uint max_drops; /* slots, whole workgroups */
    uint seed;
    uint pad;
};

/* A corner of the grid that a pane's shape is given on; by column + row x VIRGA_GLASS_NODES, in the pane's own frame.
 * */
struct virga_glass_node_gpu {
    float position[3]; /* m */
    float along_u[3];  /* unit length */
    float along_v[3];  /* unit length, at right angles to along_u */
    float normal[3];   /* outward */
};

/* A blade in a tick: a rectangle that moves from one pose to another. */
struct virga_glass_blade_gpu {
    float middle[2];        /* m, at the tick's end */
    float along[2];         /* unit length, from the pivot outwards */
    float before_middle[2]; /* the same at its start */
    float before_along[2];
    float half_length_m;
    float half_width_m;
    float side;   /* that leads: 1 to the left of `along` (counter-clockwise), -1 to the right, 0: it stands */
    float wear;   /* [0; 1] */
    float film_m; /* thickness of the film that it leaves */
    uint random;
};

/* All that a tick's passes need. Vectors are in the pane's own frame. */
struct virga_glass_tick_gpu {
    virga_glass_pane_gpu pane;
    uint tick;
    uint tick_in_step;
    float tick_s;
    uint arrivals;          /* drops that may land in this tick, of the rate */
    uint impacts;           /* and of the host's list */
    float max_acceleration; /* m/s^2, that acts anywhere on the pane, at most; and of the air (m/s) */
    float max_air_m_s;
    float force[3];      /* m/s^2, gravity less the pane's own acceleration, at its origin */
    float drop_nl_of_m3; /* cap: water (nl) of a drop whose base has a radius of 1 m: pi f(angle) 1e12 */
    float spin[3];       /* rad/s, the pane's turning */
    float drag;          /* N s/m per metre of radius: resistance of a running drop */
    float air[3];        /* m/s, of the air against the pane, far from it */
    float air_share;
    float air_drag;     /* N of a drop with a base of 1 m radius in an air of 1 m/s */
    float fall[3];      /* direction that drops land in, unit length */
    float fall_cosine;  /* largest cosine between the way back and the pane's normals */
    float hold;         /* N per metre of radius: largest force that contact-angle hysteresis withstands */
    float kinetic_hold; /* share of it that a running drop still feels */
    float affinity_sigma;
    float meander;
    float path_ease; /* share of hold that a wet path takes off */
    float path_dry_s;
    float merge_distance;    /* of the sum of both radii, at which drops flow together */
    float tail_spacing_m;    /* way between drops left behind */
    float tail_share;        /* of the runner's water that one gets, at most */
    float tail_max_radius_m; /* and its largest radius */
    float shrink_nl_s;       /* tails' loss, per square metre of their base */
    float film_m;            /* thickness of the trail's film */
    float evaporation_m_s;
    float mist_nl; /* smaller drops join the film */
    uint cells_per_tick;
    float particle_m; /* radius */
    uint particle_nl;
    float penalty;
    float band_m;         /* on each side of a blade */
    uint hold_back_nl;    /* drops as heavy hold particles back */
    uint hold_back_cells; /* on each side */
    uint blade_count;
    uint grid_columns; /* of the particles' grid */
    uint grid_rows;
    float grid_m;
    uint rolling_row; /* (film) first row of this tick's share, and rows */
    uint rolling_rows;
    float rolling_s; /* time since they were last worked on */
    virga_glass_blade_gpu blades[VIRGA_GLASS_BLADES];
    float sizes_m[VIRGA_GLASS_SIZES]; /* diameters that land, by equal shares of their number */
};

/* A count of 64 bits. */
struct virga_glass_count_gpu {
    uint low;
    uint high;
};

#define VIRGA_GLASS_LANDED       0 /* nl */
#define VIRGA_GLASS_RUN_OFF      1 /* nl, over an edge */
#define VIRGA_GLASS_WIPED        2 /* nl, pushed over an edge by a blade, or fallen on one */
#define VIRGA_GLASS_EVAPORATED   3 /* nl */
#define VIRGA_GLASS_ARRIVED      4 /* drops */
#define VIRGA_GLASS_MERGED       5 /* drops */
#define VIRGA_GLASS_TO_PARTS     6 /* drops that became particles */
#define VIRGA_GLASS_TO_DROPS     7 /* particles that became drops */
#define VIRGA_GLASS_WITHOUT_SLOT 8 /* drops that found no slot: their water joined the film */
#define VIRGA_GLASS_COUNTS       9

struct virga_glass_state_gpu {
    uint alive;   /* entries of the list of live slots */
    uint free;    /* free slots */
    uint spawned; /* of those, taken in this tick */
    uint drops;   /* on the pane, when last counted */
    uint particles;
    uint particles_waiting;
    uint alive_groups[3]; /* of a dispatch over the list */
    uint seed_groups[3];  /* of one over all seeds */
    /* Slots that something happens to in this tick: particles, then drops that may move or meet a blade. */
    uint active_count;
    uint active_particles;
    uint active_groups[3]; /* of a dispatch over all of them, and over the particles */
    uint particle_groups[3];
    uint settle_groups[3]; /* over whichever are more, seeds or live slots */
    uint round_groups[24]; /* over the active ones, for each round that some drop has way left for; else none */
    uint max_rounds;       /* of any drop in this tick */
    uint max_nl;           /* water of any drop as it begins */
    uint impacts;          /* of the host's list in this step */
    virga_glass_count_gpu counts[VIRGA_GLASS_COUNTS];
    virga_glass_count_gpu measured[3]; /* nl in drops, in particles, in the film (blades' bins too) */
    uint bins_nl[512];                 /* VIRGA_GLASS_BLADES x VIRGA_GLASS_BINS: film gathered along each blade */
    uint shown;                        /* slots from the list's first on that may hold drops at the tick's end */
    uint shown_groups[3];              /* of a dispatch over them */
    uint film_blocks;                  /* blocks listed as they may have film */
    uint measure_groups[3];            /* of the pass that measures: over these, and over all that holds drops */
    uint live_list_groups[3]; /* of the passes that make the live list: up to the last live slot as a tick begins */
    uint free_listed;         /* slots in the list after the live ones; the free ones beyond follow in order */
};

/* Water that needs a slot at the tick's end: first the tick's arrivals, then one for each active slot, then the blades'
 * bins. 40 bytes. */
struct virga_glass_seed_gpu {
    float position[2];
    float velocity[2];
    uint water_nl; /* of each; 0: nothing */
    uint count;    /* (particles) how many, the first `extra_nl` with 1 nl more */
    uint extra_nl;
    uint cell; /* (drop); VIRGA_GLASS_NONE: particles */
    uint id;
    uint kind;
};

/* One two-dimensional metaball of the height map, 36 bytes. */
struct virga_glass_ball_gpu {
    float middle[2]; /* m on the pane */
    float radius_m;  /* where one alone has the density 0.5; its water is so high by the cap's shape */
    float mist;      /* texels that it covers besides its shape, as it is hardly larger than one */
    float sag[2];    /* height is multiplied by 1 + dot(sag, offset / radius): fatter to that side */
    float peak;      /* density in its middle: 1, or less for what is hardly larger than a texel; 0: no shape */
    uint tiles[2];   /* that it reaches along u, along v: the first | how many << 16 */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_glass_pane_gpu, 32);
VIRGA_ASSERT_SIZE(virga_glass_node_gpu, 48);
VIRGA_ASSERT_SIZE(virga_glass_blade_gpu, 56);
VIRGA_ASSERT_SIZE(virga_glass_seed_gpu, 40);
VIRGA_ASSERT_SIZE(virga_glass_ball_gpu, 36);
VIRGA_ASSERT_OFFSET(virga_glass_state_gpu, alive_groups, 24);
VIRGA_ASSERT_OFFSET(virga_glass_state_gpu, counts, 200);
VIRGA_ASSERT_OFFSET(virga_glass_state_gpu, bins_nl, 296);
VIRGA_ASSERT_OFFSET(virga_glass_state_gpu, shown_groups, 2348);
VIRGA_ASSERT_OFFSET(virga_glass_state_gpu, measure_groups, 2364);
#undef uint
#endif

#endif
