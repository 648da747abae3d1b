// film_compact.comp - list of the blocks of cells that may have film, in any order; and the size of the dispatch that
// measures. For software Vulkan.
// One invocation per block. Reads: block flags. Writes: the list of blocks, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

// The bins of the blades are measured too.
#define MIN_GROUPS ((VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS + VIRGA_GLASS_GROUP - 1u) / VIRGA_GLASS_GROUP)

void main()
{
    const uvec2 counts = film_block_counts();
    const uint i = gl_GlobalInvocationID.x, all = counts.x * counts.y;
    if (i == 0u) {
        state.measure_groups[1] = state.measure_groups[2] = 1u;
        atomicMax(state.measure_groups[0], max(state.shown_groups[0], MIN_GROUPS));
    }
    if (i < all && film_blocks[i] != 0u) {
        const uint index = atomicAdd(state.film_blocks, 1u);
        film_blocks[all + index] = i;
        atomicMax(state.measure_groups[0], index / VIRGA_GLASS_BLOCKS_PER_GROUP + 1u);
    }
}
