// stream.vert - a square between the middles of four cells of running water, in the ripple map.
// One invocation per vertex, six per square, an instance per block. Reads: streams, blocks with waves. Writes: where it
// is, how far the water has come since each layer of waves began, and the waves' heights.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RINGS_ACCESS readonly
#include "tick.glsl"
#include "rings.glsl"
#include "streams.glsl"
#include "gpu/vectors.glsl"

layout(location = 0) noperspective out vec2 at_m; // from the window's low corner
layout(location = 1) noperspective out vec4 moved_m;
layout(location = 2) noperspective out vec3 height_m;
layout(location = 3) noperspective out vec3 turn_rad_s;
layout(location = 4) noperspective out vec3 standing_m;
layout(location = 5) flat out uint octaves; // bits of those that the block has

void main()
{
    const uint entry = streams_head.list[gl_InstanceIndex], number = entry & 0xffffu;
    const uint square = uint(gl_VertexIndex) / 6u;
    const uint corner = uint(gl_VertexIndex) % 6u;
    const uvec2 side = uvec2(corner & 1u, corner == 0u || corner == 1u || corner == 5u ? 0u : 1u);
    const uvec2 block = uvec2(number % tick.stream_blocks, number / tick.stream_blocks);
    const uvec2 inside = uvec2(square % VIRGA_STREAM_BLOCK, square / VIRGA_STREAM_BLOCK) + side;
    const ivec2 cell = ivec2(tick.stream_low[0], tick.stream_low[1]) + ivec2(block * VIRGA_STREAM_BLOCK + inside);
    const virga_stream_gpu stream = streams[stream_index(cell)];
    octaves = entry >> 16;
    at_m = (vec2(cell - ivec2(tick.low_tile[0], tick.low_tile[1]) * VIRGA_GROUND_TILE) + 0.5) * tick.cell_m;
    moved_m = vec4(stream.moved_m[0], stream.moved_m[1], stream.moved_m[2], stream.moved_m[3]);
    standing_m = vec3(stream.standing_m[0], stream.standing_m[1], stream.standing_m[2]);
    height_m = vec3(stream.height_m[0], stream.height_m[1], stream.height_m[2]);
    turn_rad_s = vec3(stream.turn_rad_s[0], stream.turn_rad_s[1], stream.turn_rad_s[2]);
    const vec2 at = (at_m - vec2(tick.ripple_low_m[0], tick.ripple_low_m[1])) / tick.ripple_side_m;
    gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);
}
