// block_mark.comp - which blocks of cells have ground.
// One workgroup per block, an invocation per two cells. Reads: floors. Writes: marks.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "workgroups.glsl"
#include "blocks.glsl"

layout(local_size_x = VIRGA_GROUND_BLOCK / 2) in;

shared uint found;

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u)
        found = 0u;
    barrier();
    const uvec4 two_floors = floor_texel(group_index() * (VIRGA_GROUND_BLOCK / 2) + lane);
    if (two_floors.y != NO_GROUND || two_floors.w != NO_GROUND)
        atomicOr(found, 1u);
    barrier();
    if (lane == 0u)
        floor_words[mark_word(group_index())] = found;
}
