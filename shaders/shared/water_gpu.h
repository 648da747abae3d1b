/* water_gpu.h - the water effect's uniform blocks and state. Internal to Virga. */
#ifndef VIRGA_SHARED_WATER_GPU_H
#define VIRGA_SHARED_WATER_GPU_H

#include "leaver.h"
#include "particle_grid.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_water_step_gpu virga_water_step_gpu;
typedef struct virga_water_state_gpu virga_water_state_gpu;
typedef struct virga_water_piece_gpu virga_water_piece_gpu;
#endif

#define VIRGA_WATER_LANES  VIRGA_GRID_LANES
#define VIRGA_WATER_SIDE   4  /* grid points of a block along each axis: its cell is four steps wide */
#define VIRGA_WATER_POINTS 64 /* grid points of a block */

/* Shapes of kernels: the passes that depend on it are built once for each. */
#define VIRGA_WATER_ISOTROPIC   0
#define VIRGA_WATER_ANISOTROPIC 1

/* Anisotropic kernels: how much of the neighbours' mean shift is subtracted, so that the surface of flat water stays in
 * its position; and how far a center moves at most, in h. */
#define VIRGA_WATER_UNSHIFT   1.35
#define VIRGA_WATER_MAX_SHIFT 0.3

/* Up to this distance a neighbour counts in full for the cover of a particle, in h: see surface/cover.comp. */
#define VIRGA_WATER_COVER_NEAR 0.6

#define VIRGA_WATER_PIECES          32   /* droplets of a particle at most */
#define VIRGA_WATER_SPRAY_REACH     4    /* distance of a droplet from its particle at most, in spacings */
#define VIRGA_WATER_DROPLET_SURFELS 16   /* surfels of a droplet */
#define VIRGA_WATER_DROPLET_SURFEL  0.7f /* their radius, in radii of the droplet */

#define VIRGA_WATER_FOAM_EACH 64 /* particles of foam that a particle of water makes in a step at most */

/* One step. Lengths in m. The first members are those of virga_particle_step_gpu. */
struct virga_water_step_gpu {
    float cell_m;     /* side of a cell: the kernel's radius h */
    float inv_cell_m; /* 1/m */
    uint particles;
    uint max_cells;
    uint max_blocks;
    uint max_surfels;
    float kernel;          /* factor of the density function, equation 2: 315 v / (64 pi h^3), without unit */
    float kernel_gradient; /* 1/m^2, -6 kernel / h^2 */
    float inv_h2;          /* 1/m^2, 1 / h^2 */
    float level;           /* density of the surface; 1 is inside the water */
    float full;            /* particles with less than this density are near the surface */
    float reach;           /* distance of the surface from such particles at most, in cells */
    float point_m;         /* distance of grid points */
    float surfel_m;        /* radius of a surfel */
    /* Anisotropic kernels, see shaders/water/surface/kernel.comp. */
    float smoothing; /* [0; 1] how far a kernel's center moves towards the mean of its neighbours */
    float stretch2;  /* largest ratio of two axes, squared */
    float lonely_m;  /* radius of the kernel of a particle without neighbours */
    float crowd;     /* 1 / weight of the neighbours in the middle of water at rest */
    /* Spray, see shaders/water/spray. */
    float spray_low;      /* particles with less density are splash particles */
    float spray_high;     /* those with more are none; in between a part of the particle. 0: no spray */
    float volume;         /* m^3, of a particle */
    float spray_kernel;   /* radius of the kernel of a droplet, in radii of the droplet: h' / R_s */
    float spray_factor;   /* density in the center of a droplet */
    float spray_level;    /* density of the surface of droplets */
    float spray_pattern;  /* m, radius of the ball in which the droplets of a particle are */
    float inv_full_speed; /* s/m, 1 / speed at which a particle has all its droplets */
    uint max_pieces;      /* droplets of a particle at most */
    uint max_splashes;    /* splash particles at most */
    uint max_droplets;
    uint splash_mask;   /* entries of the table of ids - 1 */
    uint serial;        /* of this step; 0: a sub-frame, whose states do not go on */
    uint serial_before; /* of the step before; 0: no states go on */
    uint serial_first;  /* states of this step and of later ones go on */
    float time_s;       /* s, since step serial_first */
    /* Droplets on orbits, see shaders/water/spray/fly.comp. */
    float gap_s;      /* s, since step serial_before */
    float turbulence; /* part of its speed with which the pieces of a particle fly apart */
    float spacing;    /* m, of particles */
    /* Droplets that are handed over, see shaders/water/spray/leaver.glsl. */
    uint hands_over;  /* 1: there is a list for them */
    uint looks_back;  /* 1: a step may have handed droplets over */
    float hand_age_s; /* s, since the particle left the water, from which on it is handed over */
    float volume_nl;  /* nl, of a particle */
    /* Foam, see shaders/water/foam. */
    uint max_foam;
    uint foam_now_us;       /* time of the step, in microseconds modulo 2^32 */
    float foam_energy[2];   /* m^2/s^2, kinetic energy of a kilogram: where its potential begins; 1 / range */
    float foam_air[2];      /* m/s, the same of trapped air */
    float foam_crest[2];    /* the same of wave crests */
    float foam_rates[2];    /* 1/s, particles that a particle of water makes by trapped air, and by wave crests */
    float foam_life_s[2];   /* s, by the smallest and by the largest potential */
    float foam_radius;      /* m, mean */
    float foam_few;         /* spray has fewer particles of water around it */
    float foam_many;        /* bubbles have more */
    float foam_inv_weights; /* 1 / sum of the weights 1 - r / h of neighbours in water at rest */
    float foam_drag;        /* 1/s, rate at which a bubble takes on the velocity of the water */
    float foam_buoyancy;    /* m/s^2, of bubbles */
    float foam_low[3];      /* m, walls */
    float foam_high[3];
    uint bodies_given; /* 1: there is a virga_body_near_gpu for each particle */
};

/* Written by the passes of a step; read back as statistics. */
struct virga_water_state_gpu {
    uint block_groups[3];      /* indirect arguments: a workgroup for each block */
    uint block_lane_groups[3]; /* an invocation for each block */
    uint blocks;               /* blocks of the surface */
    uint blocks_wanted;        /* blocks that the surface needs, without the limit of max_blocks */
    uint surfels;              /* surfels of the surface */
    uint surfels_wanted;       /* without the limit of max_surfels */
    uint surfel_groups[3];     /* an invocation for each surfel */
    uint splashes;             /* splash particles */
    uint splashes_wanted;      /* without the limit of max_splashes */
    uint droplets;             /* droplets that they became */
    uint droplets_wanted;      /* without the limit of max_droplets */
    uint spray_word_groups[3]; /* an invocation for every 32 sorted particles */
    uint first_spray_surfel;
    uint spray_surfels;
    uint spray_surfel_groups[3]; /* an invocation for each of them */
    uint splash_half;            /* half of the splash particles that this step writes: 0 or 1 */
    uint splash_serials[2];      /* the step that has written each half; 0: none */
    float splash_times[2];       /* s, its time */
    /* Counts of 64 bits (nl), since creation: low words, then high words. */
    uint handed_nl[2]; /* handed over */
    uint taken_nl[2];  /* taken back: in the air when its particle fell back into the water */
    /* Foam. Steps go on from what they find here. */
    uint foam_started;     /* 1 after the first step */
    uint foam_clock_us;    /* time of the newest step */
    float foam_gap_s;      /* from the step before to it */
    uint foam;             /* particles */
    uint foam_first;       /* of them those that are older than the newest step */
    uint foam_wanted;      /* new ones, without the limit of max_foam */
    uint foam_vertices[4]; /* indirect arguments of their draw */
    uint foam_groups[3];   /* an invocation for each of them */
    uint foam_word_groups[3];
    uint foam_kinds[3]; /* by VIRGA_FOAM_..., without new ones */
};

/* A droplet of a splash particle, from frame to frame. */
struct virga_water_piece_gpu {
    float offset[3]; /* m, from the particle */
    float part;      /* of the particle's volume */
    float drift[3];  /* m/s, its velocity less the particle's */
    float wear;      /* part of the time that it takes to break */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_water_piece_gpu, 32);
VIRGA_ASSERT_SIZE(virga_water_step_gpu, 264);
VIRGA_ASSERT_OFFSET(virga_water_step_gpu, max_blocks, sizeof(virga_particle_step_gpu));
VIRGA_ASSERT_SIZE(virga_water_state_gpu, 212);
#undef uint
#endif

#endif
