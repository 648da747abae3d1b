// particle_grid.comp - particles into their grid.
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
    if (i >= state.awake_particles)
        return;
    const uint place = place_of_awake(i);
    const vec2 at = to_vec2(drops[place].position);
    const uint head = grid_head(grid_cell(at));
    moved[moved_at(i, 0u)] = at;
    drops[place].cell = head; // to clear it by
    grid[grid_next(i)] = atomicExchange(grid[head], i + 1u);
}
