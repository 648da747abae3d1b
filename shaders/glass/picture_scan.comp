// picture_scan.comp - where each tile's list begins: sums of the counts before it. A list that does not fit is left
// out whole, so
// that what is seen does not depend on who came first.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "picture_tiles.glsl"
#include "gpu/group_scan.glsl"

layout(local_size_x = SCAN_LANES) in;
layout(scalar, set = 0, binding = 10) buffer Counts { uint ball_count, cut_count; };

void main()
{
    const uint count = look.tile_columns * look.tile_rows, run = (count + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(gl_LocalInvocationIndex * run, count), end = min(begin + run, count);
    uint sum = 0u;
    for (uint i = begin; i < end; i++)
        sum += tiles[i].count;
    uvec2 all;
    uint first = scan_group(uvec2(sum, 0u), all).x;
    for (uint i = begin; i < end; i++) {
        const uint own = tiles[i].count;
        tiles[i].first = first;
        if (first + own > look.max_entries) {
            atomicAdd(cut_count, own);
            tiles[i].count = 0u;
        }
        first += own;
    }
}
