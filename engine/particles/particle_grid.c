/* particles/particle_grid.c - records the passes that sort particles into the neighbour grid. */
#include "particles/particle_grid.h"

#include "gpu/checks.h"
#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/record.h"

#include <virga/shared/particle.h>

virga_result particles_check(const virga_context *context, VkBuffer particles, VkDeviceSize offset, uint32_t count)
{
    const VkDeviceSize alignment = context->properties.limits.minStorageBufferOffsetAlignment;
    if (count && !particles)
        return virga_wrong_argument(&context->log, "step_info.particles: expected a buffer with %u particles, got NULL",
                                    count);
    if (offset % alignment)
        return virga_wrong_argument(&context->log, "step_info.offset: expected a multiple of %u, got %llu",
                                    (uint32_t)alignment, (unsigned long long)offset);
    return virga_host_buffer_check(context, "step_info.particles", particles);
}

virga_bound particles_bound(VkBuffer particles, VkDeviceSize offset, uint32_t count, const virga_buffer *unread)
{
    return count ? (virga_bound){particles, offset, (VkDeviceSize)count * sizeof(virga_particle_gpu)}
                 : (virga_bound){.buffer = unread->buffer};
}

/* Clears the counts, and sets the bounds to those of no particles. */
static void reset(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid)
{
    virga_particle_grid_gpu empty = {.low = {VIRGA_GRID_COORDINATE, VIRGA_GRID_COORDINATE, VIRGA_GRID_COORDINATE},
                                     .high = {-VIRGA_GRID_COORDINATE, -VIRGA_GRID_COORDINATE, -VIRGA_GRID_COORDINATE},
                                     .fading_groups = {0, 1, 1}};
    context->vk.CmdUpdateBuffer(cmd, grid->state->buffer, 0, sizeof empty, &empty);
    context->vk.CmdFillBuffer(cmd, grid->cell_starts->buffer, 0, VK_WHOLE_SIZE, 0);
    context->vk.CmdFillBuffer(cmd, grid->kept->buffer, 0, VK_WHOLE_SIZE, 0);
    virga_wait(context, cmd, VIRGA_COPIES, VIRGA_PASSES);
}

static void over_cells(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid,
                       const virga_pipeline *pass, size_t groups)
{
    virga_dispatch_indirect_and_barrier(context, cmd, pass, grid->state->buffer, groups);
}

/* Counts become indices. */
static void sum_up(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid)
{
    over_cells(context, cmd, grid, grid->sums, offsetof(virga_particle_grid_gpu, scan_groups));
    over_cells(context, cmd, grid, grid->scan, offsetof(virga_particle_grid_gpu, scan_groups));
    over_cells(context, cmd, grid, grid->offsets, offsetof(virga_particle_grid_gpu, scan_groups));
}

static void put_in_order(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid)
{
    over_cells(context, cmd, grid, grid->order, offsetof(virga_particle_grid_gpu, cell_groups));
}

void particle_grid_record(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid, VkDescriptorSet set,
                          uint32_t offset, uint32_t particles)
{
    const uint32_t groups = virga_groups_of(particles, VIRGA_GRID_LANES);
    const VkBuffer state = grid->state->buffer;
    reset(context, cmd, grid);
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, grid->bindings, set, 1, &offset);
    virga_dispatch_and_barrier(context, cmd, grid->bounds, virga_groups_of(groups, VIRGA_GRID_BOUNDS_EACH));
    virga_dispatch_and_barrier(context, cmd, grid->fit, 1);
    for (int round = 0; round < 2; round++) {
        virga_dispatch_indirect_and_barrier(context, cmd, grid->search, state,
                                            offsetof(virga_particle_grid_gpu, search_groups));
        virga_dispatch_and_barrier(context, cmd, grid->median, 1);
    }
    virga_dispatch_and_barrier(context, cmd, grid->window, 1);
    virga_dispatch_and_barrier(context, cmd, grid->count, groups);
    virga_dispatch_and_barrier(context, cmd, grid->thin, groups);
    sum_up(context, cmd, grid);
    virga_dispatch_and_barrier(context, cmd, grid->fill, groups);
    put_in_order(context, cmd, grid);
    virga_dispatch_indirect_and_barrier(context, cmd, grid->copy, state,
                                        offsetof(virga_particle_grid_gpu, sorted_groups));
}

void particle_grid_sort(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid, VkBuffer arguments,
                        VkDeviceSize offset)
{
    virga_dispatch_indirect_and_barrier(context, cmd, grid->thin, arguments, offset);
    sum_up(context, cmd, grid);
    virga_dispatch_indirect_and_barrier(context, cmd, grid->fill, arguments, offset);
    put_in_order(context, cmd, grid);
}
