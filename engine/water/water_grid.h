/* water/water_grid.h - the neighbour grid of particles, which the surface and the solver share. Internal.
 *
 * An effect that uses it has a water_grid in its object, the rows below in its tables, and shaders/water/grid.glsl in
 * its passes. */
#ifndef VIRGA_WATER_WATER_GRID_H
#define VIRGA_WATER_WATER_GRID_H

#include "gpu/effect.h"

#include <virga/shared/water_grid.h>

typedef struct water_grid {
    virga_buffer *state, *cell_starts, *sorted, *sorted_indices, *sorted_velocities, *tickets, *kept, *group_starts,
        *histogram;
    virga_bindings *bindings;
    virga_pipeline *bounds, *fit, *search, *median, *window, *count, *thin, *sums, *scan, *offsets, *fill, *order,
        *copy;
} water_grid;

/* The bindings of the grid's passes. The effect binds the block of the step and the particles. */
enum { WATER_GRID_BIND_STEP, WATER_GRID_BIND_PARTICLES = 2, WATER_GRID_BINDINGS = 11 };

#define WATER_GRID_AT(object, member) offsetof(object, grid.member)

/* Rows of buffers. `cells` and `particles` are indices of counts; `groups` of the count of workgroups of a prefix sum
 * over the cells. */
#define WATER_GRID_BUFFERS(object, name, particles, cells, groups)                                                     \
    {name ".grid",      WATER_GRID_AT(object, state),         VIRGA_USE_INDIRECT,                                      \
     VIRGA_HEAP_DEVICE, .head = sizeof(virga_water_grid_gpu), .first = VIRGA_FIRST_FILL},                              \
        {name ".cell_starts", WATER_GRID_AT(object, cell_starts),                                                      \
         VIRGA_USE_STORAGE,   VIRGA_HEAP_DEVICE,                                                                       \
         .head = 4,           .entry = 4,                                                                              \
         .count = cells},                                                                                              \
        {name ".sorted",    WATER_GRID_AT(object, sorted), VIRGA_USE_TEXELS, VIRGA_HEAP_DEVICE, .entry = 16,           \
         .count = particles},                                                                                          \
        {name ".sorted_indices",                                                                                       \
         WATER_GRID_AT(object, sorted_indices),                                                                        \
         VIRGA_USE_STORAGE,                                                                                            \
         VIRGA_HEAP_DEVICE,                                                                                            \
         .entry = 4,                                                                                                   \
         .count = particles},                                                                                          \
        {name ".sorted_velocities",                                                                                    \
         WATER_GRID_AT(object, sorted_velocities),                                                                     \
         VIRGA_USE_TEXELS,                                                                                             \
         VIRGA_HEAP_DEVICE,                                                                                            \
         .entry = 16,                                                                                                  \
         .count = particles},                                                                                          \
        {name ".tickets",   WATER_GRID_AT(object, tickets), VIRGA_USE_STORAGE, VIRGA_HEAP_DEVICE, .entry = 8,          \
         .count = particles},                                                                                          \
        {name ".histogram", WATER_GRID_AT(object, histogram), VIRGA_USE_STORAGE,                                       \
         VIRGA_HEAP_DEVICE, .head = 12 * VIRGA_WATER_BINS,    .first = VIRGA_FIRST_FILL},                              \
        {name ".kept", WATER_GRID_AT(object, kept), VIRGA_USE_STORAGE, VIRGA_HEAP_DEVICE, .entry = 4, .count = cells}, \
    {                                                                                                                  \
        name ".group_starts", WATER_GRID_AT(object, group_starts), VIRGA_USE_STORAGE, VIRGA_HEAP_DEVICE,               \
            .entry = 4, .count = groups                                                                                \
    }

/* The row of the layout. */
#define WATER_GRID_LAYOUT(object, rows, sets)                               \
    {                                                                       \
        WATER_GRID_AT(object, bindings), rows, WATER_GRID_BINDINGS, sets, 0 \
    }

/* The rows of its bindings. `ring` is the member of the object with the blocks of steps. */
#define WATER_GRID_ROW(object, member)                                                       \
    {                                                                                        \
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT, VIRGA_SOURCE_BUFFER, \
            WATER_GRID_AT(object, member)                                                    \
    }
#define WATER_GRID_BINDING_ROWS(object, ring, block)                                                      \
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VK_SHADER_STAGE_COMPUTE_BIT, VIRGA_SOURCE_RING,           \
     offsetof(object, ring), sizeof(block)},                                            /* 0 */           \
        WATER_GRID_ROW(object, histogram),                                              /* 1 */           \
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},               /* 2 particles */ \
        WATER_GRID_ROW(object, state), WATER_GRID_ROW(object, cell_starts),             /* 3, 4 */        \
        WATER_GRID_ROW(object, sorted), WATER_GRID_ROW(object, sorted_indices),         /* 5, 6 */        \
        WATER_GRID_ROW(object, tickets), WATER_GRID_ROW(object, kept),                  /* 7, 8 */        \
        WATER_GRID_ROW(object, group_starts), WATER_GRID_ROW(object, sorted_velocities) /* 9, 10 */

/* The rows of its passes. The file that uses them includes the headers of the shaders. */
#define WATER_GRID_PASS(object, prefix, pass, layout)                                                               \
    {                                                                                                               \
        prefix ".grid_" #pass, WATER_GRID_AT(object, pass), VIRGA_SPIRV_ROW(water_grid_##pass##_comp), 0, 0, layout \
    }
#define WATER_GRID_PASSES(object, prefix, layout)                                                         \
    WATER_GRID_PASS(object, prefix, bounds, layout), WATER_GRID_PASS(object, prefix, fit, layout),        \
        WATER_GRID_PASS(object, prefix, search, layout), WATER_GRID_PASS(object, prefix, median, layout), \
        WATER_GRID_PASS(object, prefix, window, layout), WATER_GRID_PASS(object, prefix, count, layout),  \
        WATER_GRID_PASS(object, prefix, thin, layout), WATER_GRID_PASS(object, prefix, sums, layout),     \
        WATER_GRID_PASS(object, prefix, scan, layout), WATER_GRID_PASS(object, prefix, offsets, layout),  \
        WATER_GRID_PASS(object, prefix, fill, layout), WATER_GRID_PASS(object, prefix, order, layout),    \
        WATER_GRID_PASS(object, prefix, copy, layout)

/* Sorts `particles` particles into the grid. `set` has the bindings above, with the block of the step at `offset`. Ends
 * with a barrier. */
void water_grid_record(virga_context *context, VkCommandBuffer cmd, const water_grid *grid, VkDescriptorSet set,
                       uint32_t offset, uint32_t particles);

#endif
