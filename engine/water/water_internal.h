/* water/water_internal.h - defines the struct of virga_water and the functions its files share. Internal.
 *
 *   water.c          create, destroy, settings, queries
 *   water_surface.c  a step: particles become surfels
 *   water_spray.c    the spray of a step
 *   spray_kernel.c   the kernel of its droplets
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

enum { WATER_LAYOUT_GRID, WATER_LAYOUT_KERNELS, WATER_LAYOUT_SURFACE, WATER_LAYOUT_SPRAY };

/* Bindings of the kernels' and the surface's passes that the effect binds itself. */
enum { WATER_BIND_PARTICLES = 2 };

#define WATER_KERNELS 2 /* virga_water_kernel */

/* The spray. */
typedef struct water_spray {
    virga_buffer *picks, *list, *splashes, *table, *starts, *droplets;
    virga_bindings *bindings;
    virga_pipeline *mark, *scan, *compact, *break_up, *starts_scan, *write, *place, *surfel;
} water_spray;

struct virga_water {
    virga_effect base; /* first */
    virga_water_def def;
    virga_water_settings settings;
    double origin_m[3];

    particle_grid grid;
    virga_buffer *state, *cell_marks, *picks, *block_insides, *blocks, *block_of, *fields, *block_starts, *densities,
        *shifts, *shapes, *centers, *surfels;
    water_spray spray;
    uint32_t splash_half; /* of the newest step */
    bool spray_goes_on;   /* the newest step had spray */
    double spray_time_s;  /* of that step */
    virga_ring step_ring;
    uint32_t step_particles[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* of the steps in flight, for statistics */
    virga_bindings *kernel_bindings, *bindings;
    virga_pipeline *density[WATER_KERNELS], *kernel[WATER_KERNELS], *field[WATER_KERNELS], *surfel_write[WATER_KERNELS];
    virga_pipeline *block_mark, *block_scan, *block_compact, *surfel_count, *surfel_scan, *edge_write;
    virga_water_stats stats;
};

/* ---- water_surface.c */
void water_read_statistics(void *water, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);

/* ---- water_spray.c */

uint32_t water_table_entries(const virga_water_def *def); /* of one half */
bool water_has_spray(const virga_water *water);
void water_spray_fill(virga_water *water, double time_s, virga_water_step_gpu *out);
void water_spray_clear(const virga_water *water, VkCommandBuffer cmd);
void water_spray_record(virga_water *water, VkCommandBuffer cmd);
void water_spray_record_surfels(virga_water *water, VkCommandBuffer cmd);

#endif
