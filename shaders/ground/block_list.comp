// block_list.comp - lists the blocks of cells that have ground, in order.
// One workgroup, in which each invocation takes a run of blocks. Reads: marks. Writes: the list and its head.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "blocks.glsl"
#define SCAN_LANES uint(VIRGA_GROUND_GROUP)
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;

void write_groups(uint first, uvec3 groups)
{
    for (uint i = 0u; i < 3u; i++)
        floor_words[block_word(first + i)] = groups[i];
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, count = block_count();
    const uint run = (count + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, count), end = min(begin + run, count);
    uint own = 0u;
    for (uint i = begin; i < end; i++)
        own += floor_words[mark_word(i)];
    uvec2 all;
    uint next = scan_group(uvec2(own, 0u), all).x;
    for (uint i = begin; i < end; i++)
        if (floor_words[mark_word(i)] != 0u)
            floor_words[list_word(next++)] = i;
    if (lane == 0u) {
        const uint flow_groups = (all.x + VIRGA_GROUND_PAIRS_EACH - 1u) / VIRGA_GROUND_PAIRS_EACH;
        write_groups(VIRGA_GROUND_FLOW_GROUPS, uvec3(flow_groups, 1u, 1u));
        write_groups(VIRGA_GROUND_MAP_GROUPS, uvec3(all.x, VIRGA_GROUND_BLOCK / VIRGA_GROUND_GROUP, 1u));
        floor_words[block_word(VIRGA_GROUND_BLOCK_COUNT)] = all.x;
    }
}
