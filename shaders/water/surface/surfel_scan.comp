// surfel_scan.comp - prefix sum over the blocks: counts become the index of a block's first surfel.
// One workgroup, in which each invocation takes a run of blocks. Reads and writes: block_starts, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#include "water/block_list.glsl"
#include "water/state.glsl"
#define BLOCKS_ACCESS
#include "water/blocks.glsl"
#define SCAN_LANES 256u
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint count = block_list.count, each = (count + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES;
    const uint first = min(gl_LocalInvocationIndex * each, count), end = min(first + each, count);
    uint sum = 0u;
    for (uint i = first; i < end; i++)
        sum += block_starts[i];
    uvec2 all;
    uint before = scan_group(uvec2(sum, 0u), all).x;
    for (uint i = first; i < end; i++) {
        const uint own = block_starts[i];
        block_starts[i] = before;
        before += own;
    }
    if (gl_LocalInvocationIndex != 0u)
        return;
    state.surfels_wanted = all.x;
    state.surfels = min(all.x, frame.max_surfels);
    state.first_spray_surfel = state.surfels; // without spray there are none
    state.spray_surfels = 0u;
    state.surfel_groups = uint[3]((state.surfels + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES, 1u, 1u);
}
