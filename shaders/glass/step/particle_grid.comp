// particle_grid.comp - counts the particles of each cell of their grid. See particles.glsl.
// One invocation per particle. Reads: drops. Writes: the grid, the particles' cells.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#define FEW
#include "live.glsl"
#include "particles.glsl"

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= state.active_particles)
        return;
    const uint slot = slot_of_active(i), head = grid_head(grid_cell(to_vec2(drops[slot].position)));
    drops[slot].cell = head; // the grid is cleared by it
    grid[grid_rank(i)] = atomicAdd(grid[head], 1u);
}
