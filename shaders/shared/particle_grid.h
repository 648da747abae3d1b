/* particle_grid.h - the neighbour grid of particles: cubic cells in a box around them. Internal to Virga. */
#ifndef VIRGA_SHARED_PARTICLE_GRID_H
#define VIRGA_SHARED_PARTICLE_GRID_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_particle_step_gpu virga_particle_step_gpu;
typedef struct virga_particle_grid_gpu virga_particle_grid_gpu;
#endif

#define VIRGA_GRID_LANES       256    /* invocations of a workgroup in passes over particles and cells */
#define VIRGA_GRID_BOUNDS_EACH 16     /* particles of an invocation of bounds.comp */
#define VIRGA_GRID_SCAN_CELLS  2048   /* cells of a workgroup of the prefix sum: 8 for each invocation */
#define VIRGA_GRID_CELL_MAX    512    /* more particles in one cell are thinned out to about this many */
#define VIRGA_GRID_MARGIN      2      /* empty cells around the particles on each side */
#define VIRGA_GRID_COORDINATE  262144 /* cells are within +- this number of cells from the origin */
#define VIRGA_GRID_BINS        1024   /* of a histogram; two rounds of it tell all cells apart */
#define VIRGA_GRID_NO_CELL     0xffffffffu

/* What the passes of the grid read. The uniform block of an effect that uses the grid begins with the same members. */
struct virga_particle_step_gpu {
    float cell_m;     /* side of a cell (m) */
    float inv_cell_m; /* 1/m */
    uint particles;
    uint max_cells;
};

/* State of the grid, rebuilt in every step. */
struct virga_particle_grid_gpu {
    int low[3]; /* first cell of the particles on each axis */
    int high[3];
    uint valid; /* particles with finite positions near the origin */
    /* The search for the median of the cells' numbers on each axis, by a histogram. */
    int from[3];           /* first cell of the histogram */
    uint width[3];         /* cells of a bin */
    uint below[3];         /* particles before the histogram's first cell */
    uint search_groups[3]; /* indirect arguments: 0 workgroups if no median is needed */
    int first[3];          /* number of the grid's first cell on each axis */
    uint dims[3];          /* cells on each axis */
    uint cells;            /* cells in the grid */
    uint sorted;           /* particles in the sorted list */
    uint scan_groups[3];   /* indirect arguments: workgroups of the prefix sum */
    uint cell_groups[3];   /* an invocation for each cell */
    uint word_groups[3];   /* an invocation for every 32 cells */
    uint sorted_groups[3]; /* an invocation for each sorted particle */
    uint fading_groups[3]; /* the same if there is a particle with a share below 1; else 0 workgroups */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_particle_step_gpu, 16);
VIRGA_ASSERT_SIZE(virga_particle_grid_gpu, 168);
#undef uint
#endif

#endif
