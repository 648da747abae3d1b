/* particles/particle_grid.h - the neighbour grid of particles, which the surface and the solver share. Internal.
 *
 * An effect that uses it has a particle_grid in its object, the rows below in its tables, and
 * shaders/particles/grid.glsl in its passes. Its uniform block begins as virga_particle_step_gpu. */
#ifndef VIRGA_PARTICLES_PARTICLE_GRID_H
#define VIRGA_PARTICLES_PARTICLE_GRID_H

#include "gpu/effect.h"

#include <virga/shared/particle_grid.h>

typedef struct particle_grid {
    virga_buffer *state, *cell_starts, *sorted, *sorted_indices, *sorted_velocities, *tickets, *kept, *group_starts,
        *histogram;
    virga_bindings *bindings;
    virga_pipeline *bounds, *fit, *search, *median, *window, *count, *thin, *sums, *scan, *offsets, *fill, *order,
        *copy;
} particle_grid;

/* The bindings of the grid's passes. The effect binds the block of the step and the particles. */
enum { PARTICLE_GRID_BIND_STEP, PARTICLE_GRID_BIND_PARTICLES = 2, PARTICLE_GRID_BINDINGS = 11 };

#define PARTICLE_GRID_AT(object, member) offsetof(object, grid.member)

/* Rows of buffers. `cells` and `particles` are indices of counts; `groups` of the count of workgroups of a prefix sum
 * over the cells. */
#define PARTICLE_GRID_BUFFERS(object, name, particles, cells, groups)                                            \
    {name ".grid",      PARTICLE_GRID_AT(object, state),         VIRGA_USE_INDIRECT,                             \
     VIRGA_HEAP_DEVICE, .head = sizeof(virga_particle_grid_gpu), .first = VIRGA_FIRST_FILL},                     \
        {name ".cell_starts", PARTICLE_GRID_AT(object, cell_starts),                                             \
         VIRGA_USE_STORAGE,   VIRGA_HEAP_DEVICE,                                                                 \
         .head = 4,           .entry = 4,                                                                        \
         .count = cells},                                                                                        \
        {name ".sorted",    PARTICLE_GRID_AT(object, sorted), VIRGA_USE_TEXELS, VIRGA_HEAP_DEVICE, .entry = 16,  \
         .count = particles},                                                                                    \
        {name ".sorted_indices",                                                                                 \
         PARTICLE_GRID_AT(object, sorted_indices),                                                               \
         VIRGA_USE_STORAGE,                                                                                      \
         VIRGA_HEAP_DEVICE,                                                                                      \
         .entry = 4,                                                                                             \
         .count = particles},                                                                                    \
        {name ".sorted_velocities",                                                                              \
         PARTICLE_GRID_AT(object, sorted_velocities),                                                            \
         VIRGA_USE_TEXELS,                                                                                       \
         VIRGA_HEAP_DEVICE,                                                                                      \
         .entry = 16,                                                                                            \
         .count = particles},                                                                                    \
        {name ".tickets",   PARTICLE_GRID_AT(object, tickets), VIRGA_USE_STORAGE, VIRGA_HEAP_DEVICE, .entry = 8, \
         .count = particles},                                                                                    \
        {name ".histogram", PARTICLE_GRID_AT(object, histogram), VIRGA_USE_STORAGE,                              \
         VIRGA_HEAP_DEVICE, .head = 12 * VIRGA_GRID_BINS,        .first = VIRGA_FIRST_FILL},                     \
        {name ".kept",  PARTICLE_GRID_AT(object, kept), VIRGA_USE_STORAGE, VIRGA_HEAP_DEVICE, .entry = 4,        \
         .count = cells},                                                                                        \
    {                                                                                                            \
        name ".group_starts", PARTICLE_GRID_AT(object, group_starts), VIRGA_USE_STORAGE, VIRGA_HEAP_DEVICE,      \
            .entry = 4, .count = groups                                                                          \
    }

/* The row of the layout. */
#define PARTICLE_GRID_LAYOUT(object, rows, sets)                                  \
    {                                                                             \
        PARTICLE_GRID_AT(object, bindings), rows, PARTICLE_GRID_BINDINGS, sets, 0 \
    }

/* The rows of its bindings. `ring` is the member of the object with the blocks of steps. */
#define PARTICLE_GRID_ROW(object, member)                                                    \
    {                                                                                        \
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT, VIRGA_SOURCE_BUFFER, \
            PARTICLE_GRID_AT(object, member)                                                 \
    }
#define PARTICLE_GRID_BINDING_ROWS(object, ring, block)                                                         \
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VK_SHADER_STAGE_COMPUTE_BIT, VIRGA_SOURCE_RING,                 \
     offsetof(object, ring), sizeof(block)},                                                  /* 0 */           \
        PARTICLE_GRID_ROW(object, histogram),                                                 /* 1 */           \
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},                     /* 2 particles */ \
        PARTICLE_GRID_ROW(object, state), PARTICLE_GRID_ROW(object, cell_starts),             /* 3, 4 */        \
        PARTICLE_GRID_ROW(object, sorted), PARTICLE_GRID_ROW(object, sorted_indices),         /* 5, 6 */        \
        PARTICLE_GRID_ROW(object, tickets), PARTICLE_GRID_ROW(object, kept),                  /* 7, 8 */        \
        PARTICLE_GRID_ROW(object, group_starts), PARTICLE_GRID_ROW(object, sorted_velocities) /* 9, 10 */

/* The rows of its passes. The file that uses them includes shaders/particles_shaders.h. */
#define PARTICLE_GRID_PASS(object, prefix, pass, layout)                                                          \
    {                                                                                                             \
        prefix ".grid_" #pass, PARTICLE_GRID_AT(object, pass), VIRGA_SPIRV(particles_##pass##_comp), 0, 0, layout \
    }
#define PARTICLE_GRID_PASSES(object, prefix, layout)                                                            \
    PARTICLE_GRID_PASS(object, prefix, bounds, layout), PARTICLE_GRID_PASS(object, prefix, fit, layout),        \
        PARTICLE_GRID_PASS(object, prefix, search, layout), PARTICLE_GRID_PASS(object, prefix, median, layout), \
        PARTICLE_GRID_PASS(object, prefix, window, layout), PARTICLE_GRID_PASS(object, prefix, count, layout),  \
        PARTICLE_GRID_PASS(object, prefix, thin, layout), PARTICLE_GRID_PASS(object, prefix, sums, layout),     \
        PARTICLE_GRID_PASS(object, prefix, scan, layout), PARTICLE_GRID_PASS(object, prefix, offsets, layout),  \
        PARTICLE_GRID_PASS(object, prefix, fill, layout), PARTICLE_GRID_PASS(object, prefix, order, layout),    \
        PARTICLE_GRID_PASS(object, prefix, copy, layout)

/* A number of cells, rounded up to whole workgroups of the passes over cells. */
static inline uint32_t particle_grid_cells(uint32_t cells)
{
    return (cells + VIRGA_GRID_SCAN_CELLS - 1) / VIRGA_GRID_SCAN_CELLS * VIRGA_GRID_SCAN_CELLS;
}

/* Checks a buffer of particles that a host gives in its step_info. */
virga_result particles_check(const virga_context *context, VkBuffer particles, VkDeviceSize offset, uint32_t count);

/* The same buffer for a binding; without particles another one, which is not read. */
virga_bound particles_bound(VkBuffer particles, VkDeviceSize offset, uint32_t count, const virga_buffer *unread);

/* Sorts `particles` particles into the grid. `set` has the bindings above, with the block of the step at `offset`. Ends
 * with a barrier. */
void particle_grid_record(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid, VkDescriptorSet set,
                          uint32_t offset, uint32_t particles);

/* The sort alone, for an effect that places the grid and counts the particles of its cells itself: from their counts
 * and tickets to the list of sorted indices. The set is bound, and `arguments` has workgroups for an invocation per
 * particle. Ends with a barrier. */
void particle_grid_sort(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid, VkBuffer arguments,
                        VkDeviceSize offset);

#endif
