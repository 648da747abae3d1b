// median.comp - ends a round of the search for the median: finds the bin that it is in, for the next round, and clears
// the histogram.
// One invocation per axis. Reads and writes: histogram, the grid's state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"
#include "particles/histogram.glsl"

layout(local_size_x = 3) in;

void main()
{
    const uint axis = gl_LocalInvocationIndex;
    if (grid.search_groups[0] == 0u)
        return;
    uint below = grid.below[axis], bin = 0u, found = VIRGA_GRID_BINS;
    for (; bin < VIRGA_GRID_BINS; bin++) {
        const uint here = histogram[axis * VIRGA_GRID_BINS + bin];
        histogram[axis * VIRGA_GRID_BINS + bin] = 0u;
        if (found == VIRGA_GRID_BINS && below + here > grid.valid / 2u)
            found = bin;
        if (found == VIRGA_GRID_BINS)
            below += here;
    }
    grid.below[axis] = below;
    grid.from[axis] += int(found * grid.width[axis]);
    grid.width[axis] = (grid.width[axis] + VIRGA_GRID_BINS - 1u) / VIRGA_GRID_BINS;
}
