// particle_grid.comp - inserts the particles into the grid of linked lists. See particles.glsl.
// One invocation per particle. Reads: drops. Writes: the grid, positions for the first round.
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
    const uint slot = slot_of_active(i);
    const vec2 at = to_vec2(drops[slot].position);
    const uint head = grid_head(grid_cell(at));
    moved[moved_at(i, 0u)] = at;
    drops[slot].cell = head; // the grid is cleared by it
    grid[grid_next(i)] = atomicExchange(grid[head], i + 1u);
}
