// order.comp - puts the particles of each cell into the order of their ids, so that the list depends neither on the
// order in which atomics arrived nor on that of the particles. Particles with the same id are in the order of their
// indices.
// One invocation per cell. Reads: cell_starts, particles. Reads and writes: sorted_indices.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"

layout(local_size_x = VIRGA_GRID_LANES) in;

bool is_before(uint index, uint id, uint other)
{
    const uint other_id = particles[other].id;
    return id < other_id || (id == other_id && index < other);
}

void main()
{
    const uint cell = gl_GlobalInvocationID.x;
    if (cell >= grid.cells)
        return;
    // Insertion: a cell has about ten particles, and never many more than VIRGA_GRID_CELL_MAX.
    const uint first = cell_starts[cell], end = cell_starts[cell + 1u];
    for (uint i = first + 1u; i < end; i++) {
        const uint own = sorted_indices[i], id = particles[own].id;
        uint at = i;
        while (at > first && is_before(own, id, sorted_indices[at - 1u])) {
            sorted_indices[at] = sorted_indices[at - 1u];
            at--;
        }
        sorted_indices[at] = own;
    }
}
