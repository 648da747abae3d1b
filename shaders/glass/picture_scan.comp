// picture_scan.comp - which tiles there is anything to do in, and where each one's list begins: sums of the counts
// before it. A list that does not fit is left
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
layout(scalar, set = 0, binding = 17) readonly buffer Written { uint written[]; };
layout(scalar, set = 0, binding = 18) buffer Work { virga_glass_work_gpu work; uint wet[]; };

// A tile without water that had none before is as it was.
bool is_wet(uint i)
{
    const uint at = i % look.tile_columns + i / look.tile_columns * look.written_columns;
    return tiles[i].count != 0u || tiles[i].film != 0u || written[at] != 0u;
}

void main()
{
    const uint count = look.tile_columns * look.tile_rows, run = (count + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(gl_LocalInvocationIndex * run, count), end = min(begin + run, count);
    // Two numbers in one: there are never 65,536 tiles.
    uvec2 sum = uvec2(0u);
    for (uint i = begin; i < end; i++)
        sum += uvec2(tiles[i].count, is_wet(i) ? (tiles[i].film & VIRGA_GLASS_HAS_FILM) != 0u ? 0x10000u : 1u : 0u);
    uvec2 all;
    const uvec2 before = scan_group(sum, all);
    uint first = before.x, number = before.y & 0xffffu, film_number = look.max_tiles + (before.y >> 16u);
    for (uint i = begin; i < end; i++) {
        const uint own = tiles[i].count;
        if (is_wet(i)) {
            if ((tiles[i].film & VIRGA_GLASS_HAS_FILM) != 0u)
                wet[film_number++] = i;
            else
                wet[number++] = i;
        }
        tiles[i].first = first;
        if (first + own > look.max_entries) {
            atomicAdd(cut_count, own);
            tiles[i].count = 0u;
        }
        first += own;
    }
    if (gl_LocalInvocationIndex == 0u) {
        work.tile_groups = uint[3](all.y & 0xffffu, 1u, 1u);
        work.film_groups = uint[3](all.y >> 16u, 1u, 1u);
        work.ball_groups = uint[3]((ball_count + VIRGA_GLASS_FILL_GROUP - 1u) / VIRGA_GLASS_FILL_GROUP, 1u, 1u);
    }
}
