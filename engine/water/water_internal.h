/* water/water_internal.h - defines the struct of virga_water and the functions its files share. Internal.
 *
 *   water.c          create, destroy, settings, queries
 *   water_surface.c  a step: particles become surfels
 */
#ifndef VIRGA_WATER_WATER_INTERNAL_H
#define VIRGA_WATER_WATER_INTERNAL_H

#include "gpu/context.h"
#include "gpu/effect.h"
#include "particles/particle_grid.h"
#include "water/water.h"

#include <virga/shared/water_gpu.h>

/* The data that is read back for one frame. */
typedef struct water_readback {
    virga_particle_grid_gpu grid;
    virga_water_state_gpu state;
} water_readback;

enum { WATER_LAYOUT_GRID, WATER_LAYOUT_KERNELS, WATER_LAYOUT_SURFACE };

/* Bindings of the kernels' and the surface's passes that the effect binds itself. */
enum { WATER_BIND_PARTICLES = 2 };

#define WATER_KERNELS 2 /* virga_water_kernel */

struct virga_water {
    virga_effect base; /* first */
    virga_water_def def;
    virga_water_settings settings;
    double origin_m[3];

    particle_grid grid;
    virga_buffer *state, *cell_marks, *picks, *block_insides, *blocks, *block_of, *fields, *block_starts, *densities,
        *shifts, *shapes, *centers, *surfels;
    virga_ring step_ring;
    uint32_t step_particles[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* of the steps in flight, for statistics */
    virga_bindings *kernel_bindings, *bindings;
    virga_pipeline *density[WATER_KERNELS], *kernel[WATER_KERNELS], *field[WATER_KERNELS], *surfel_write[WATER_KERNELS];
    virga_pipeline *block_mark, *block_scan, *block_compact, *surfel_count, *surfel_scan, *edge_write;
    virga_water_stats stats;
};

/* ---- water_surface.c */
void water_read_statistics(void *water, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);

#endif
