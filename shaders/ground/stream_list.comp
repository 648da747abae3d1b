// stream_list.comp - lists the blocks of running water that have waves, in order.
// One workgroup, in which each invocation takes a run of blocks. Reads: the blocks' marks. Writes: the list, and the
// arguments of its draw.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "tick.glsl"
#include "rings.glsl"
#define SCAN_LANES uint(VIRGA_GROUND_GROUP)
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;

// Octaves of a block. It is drawn from the middles of its cells to those of the next ones, also of other blocks.
uint drawn_octaves(uint number)
{
    const uint side = tick.stream_blocks, x = number % side, y = number / side;
    if (x + 1u >= side || y + 1u >= side)
        return 0u;
    return streams_head.shown[number] | streams_head.shown[number + 1u] | streams_head.shown[number + side] |
           streams_head.shown[number + side + 1u];
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, count = tick.stream_blocks * tick.stream_blocks;
    const uint run = (count + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, count), end = min(begin + run, count);
    uint own = 0u;
    for (uint i = begin; i < end; i++)
        own += uint(drawn_octaves(i) != 0u);
    uvec2 all;
    uint next = scan_group(uvec2(own, 0u), all).x;
    for (uint i = begin; i < end; i++) {
        const uint octaves = drawn_octaves(i);
        if (octaves != 0u)
            streams_head.list[next++] = i | octaves << 16;
    }
    if (lane == 0u) {
        streams_head.vertices = 6u * VIRGA_STREAM_BLOCK * VIRGA_STREAM_BLOCK;
        streams_head.blocks = all.x;
        streams_head.first = uint[2](0u, 0u);
    }
}
