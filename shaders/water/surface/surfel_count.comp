// surfel_count.comp - counts the surfels of each block: one for each edge of the grid that the surface crosses.
// One invocation per block. Reads: block_insides, block_of. Writes: block_starts (counts).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#include "water/block_list.glsl"
#define BLOCKS_ACCESS
#include "water/blocks.glsl"
#include "crossings.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint block = gl_GlobalInvocationID.x;
    if (block >= block_list.count)
        return;
    const Crossings found = crossings_of(blocks[block], block);
    uint count = 0u;
    for (uint axis = 0u; axis < 3u; axis++)
        count += bitCount(found.edges[axis].x) + bitCount(found.edges[axis].y);
    block_starts[block] = count;
}
