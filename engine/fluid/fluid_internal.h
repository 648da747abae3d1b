/* fluid/fluid_internal.h - defines the struct of virga_fluid and the functions its files share. Internal.
 *
 *   fluid.c       create, destroy, settings, blocks of water, queries
 *   fluid_step.c  a step
 */
#ifndef VIRGA_FLUID_FLUID_INTERNAL_H
#define VIRGA_FLUID_FLUID_INTERNAL_H

#include "fluid/fluid.h"
#include "gpu/context.h"
#include "gpu/effect.h"
#include "particles/particle_grid.h"

#include <virga/shared/fluid_gpu.h>

#define FLUID_MAX_BLOCKS 16 /* between two steps */

/* The data that is read back for one frame. */
typedef struct fluid_readback {
    virga_fluid_state_gpu state;
} fluid_readback;

enum { FLUID_LAYOUT_GRID, FLUID_LAYOUT_ADD, FLUID_LAYOUT_STEP };

/* Bindings that the step binds itself. */
enum { FLUID_BIND_ADDED = 3 };

struct virga_fluid {
    virga_effect base; /* first */
    virga_fluid_def def;
    virga_fluid_settings settings;

    uint32_t particles; /* slots in use */
    virga_fluid_add_gpu blocks[FLUID_MAX_BLOCKS];
    uint32_t block_count; /* to be added in the next step */
    /* The blocks that steps in flight have added, for lost frames. */
    struct {
        uint64_t frame;
        uint32_t count;
        virga_fluid_add_gpu blocks[FLUID_MAX_BLOCKS];
    } sent[VIRGA_MAX_FRAMES_IN_FLIGHT];
    uint32_t step_particles[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* of the steps in flight, for statistics */

    particle_grid grid;
    virga_buffer *state, *slots, *slot_pressures, *positions, *moved, *walls, *solved, *lists;
    virga_ring step_ring, add_ring;
    virga_bindings *add_bindings, *bindings;
    virga_pipeline *add, *begin, *count, *copy, *neighbours, *push, *correct, *check, *forces, *advance;
    virga_fluid_stats stats;
};

/* First cell and number of cells of the grid on each axis. */
void fluid_grid_box(const virga_fluid_settings *settings, int32_t first[3], uint32_t dims[3]);

/* ---- fluid_step.c */
void fluid_lost(void *fluid, uint64_t frame, uint32_t did);
void fluid_read_statistics(void *fluid, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);

#endif
