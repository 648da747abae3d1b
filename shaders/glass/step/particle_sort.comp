// particle_sort.comp - writes the particles, sorted by cell, for the first round. See particles.glsl.
// One invocation per particle. Reads: drops, the grid, places of cells. Writes: sorted particles.
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
    const uint slot = slot_of_active(i), place = places[place_of_cell(drops[slot].cell)] + grid[grid_rank(i)];
    moved[moved_at(place, 0u)] = uvec3(floatBitsToUint(to_vec2(drops[slot].position)), i);
}
