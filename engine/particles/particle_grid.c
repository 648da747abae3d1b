/* particles/particle_grid.c - records the passes that sort particles into the neighbour grid. */
#include "particles/particle_grid.h"

#include "gpu/context.h"
#include "gpu/record.h"

/* Clears the counts, and sets the bounds to those of no particles. */
static void reset(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid)
{
    virga_particle_grid_gpu empty = {.low = {VIRGA_GRID_COORDINATE, VIRGA_GRID_COORDINATE, VIRGA_GRID_COORDINATE},
                                     .high = {-VIRGA_GRID_COORDINATE, -VIRGA_GRID_COORDINATE, -VIRGA_GRID_COORDINATE}};
    context->vk.CmdUpdateBuffer(cmd, grid->state->buffer, 0, sizeof empty, &empty);
    context->vk.CmdFillBuffer(cmd, grid->cell_starts->buffer, 0, VK_WHOLE_SIZE, 0);
    context->vk.CmdFillBuffer(cmd, grid->kept->buffer, 0, VK_WHOLE_SIZE, 0);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, READ_WRITE);
}

static uint32_t groups_of(uint32_t items, uint32_t each)
{
    return (items + each - 1) / each;
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
    virga_dispatch_and_barrier(context, cmd, grid->scan, 1);
    over_cells(context, cmd, grid, grid->offsets, offsetof(virga_particle_grid_gpu, scan_groups));
}

static void put_in_order(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid)
{
    over_cells(context, cmd, grid, grid->order, offsetof(virga_particle_grid_gpu, cell_groups));
}

void particle_grid_record(virga_context *context, VkCommandBuffer cmd, const particle_grid *grid, VkDescriptorSet set,
                          uint32_t offset, uint32_t particles)
{
    const uint32_t groups = groups_of(particles, VIRGA_GRID_LANES);
    const VkBuffer state = grid->state->buffer;
    reset(context, cmd, grid);
    context->vk.CmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, grid->bindings->layout, 0, 1, &set, 1,
                                      &offset);
    virga_dispatch_and_barrier(context, cmd, grid->bounds, groups_of(groups, VIRGA_GRID_BOUNDS_EACH));
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
