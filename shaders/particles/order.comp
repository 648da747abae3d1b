// order.comp - puts the particles of each cell into the order of their indices, so that the list does not depend on the
// order in which atomics arrived.
// One invocation per cell. Reads: cell_starts. Reads and writes: sorted_indices.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"

layout(local_size_x = VIRGA_GRID_LANES) in;

void main()
{
    const uint cell = gl_GlobalInvocationID.x;
    if (cell >= grid.cells)
        return;
    // Insertion: a cell has about ten particles, and never many more than VIRGA_GRID_CELL_MAX.
    const uint first = cell_starts[cell], end = cell_starts[cell + 1u];
    for (uint i = first + 1u; i < end; i++) {
        const uint own = sorted_indices[i];
        uint at = i;
        while (at > first && sorted_indices[at - 1u] > own) {
            sorted_indices[at] = sorted_indices[at - 1u];
            at--;
        }
        sorted_indices[at] = own;
    }
}
