// edge_write.comp - lists the crossed edges of all blocks: the starts of surfels.
// One invocation per block. Reads: block_insides, block_of, block_starts. Writes: surfels (the edge alone).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#include "water/block_list.glsl"
#include "water/blocks.glsl"
#include "crossings.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(std430, set = 0, binding = 15) writeonly buffer Surfels { uvec4 surfels[]; };

void main()
{
    const uint block = gl_GlobalInvocationID.x;
    if (block >= block_list.count)
        return;
    const Crossings found = crossings_of(blocks[block], block);
    uint surfel = block_starts[block];
    for (uint word = 0u; word < 6u; word++)
        for (uint bits = found.edges[word >> 1][word & 1u]; bits != 0u; bits &= bits - 1u) {
            if (surfel >= frame.max_surfels)
                return;
            const uint point = 32u * (word & 1u) + findLSB(bits);
            surfels[2u * surfel] = uvec4(block, 64u * (word >> 1) + point, 0u, 0u);
            surfel++;
        }
}
