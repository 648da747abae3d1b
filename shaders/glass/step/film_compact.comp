// film_compact.comp - the list of blocks that may have film, and how much there is to measure.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

// Bins of the blades are measured too.
#define LEAST_GROUPS ((VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS + VIRGA_GLASS_GROUP - 1u) / VIRGA_GLASS_GROUP)

void main()
{
    const uvec2 counts = film_block_counts();
    const uint i = gl_GlobalInvocationID.x, all = counts.x * counts.y;
    if (i == 0u) {
        state.measure_groups[1] = state.measure_groups[2] = 1u;
        atomicMax(state.measure_groups[0], max(state.shown_groups[0], LEAST_GROUPS));
    }
    if (i < all && film_blocks[i] != 0u) {
        const uint turn = atomicAdd(state.film_blocks, 1u);
        film_blocks[all + turn] = i;
        atomicMax(state.measure_groups[0], turn / VIRGA_GLASS_MEASURED + 1u);
    }
}
