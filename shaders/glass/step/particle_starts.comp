// particle_starts.comp - the place of each cell's particles among the sorted ones. The first of a cell takes it for
// all. See particles.glsl.
// One invocation per particle. Reads: the grid, drops. Writes: places of cells.
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
    if (i >= state.active_particles || grid[grid_rank(i)] != 0u)
        return;
    const uint head = drops[slot_of_active(i)].cell;
    places[place_of_cell(head)] = atomicAdd(places[places_taken()], grid[head]);
}
