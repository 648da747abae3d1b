// spawn_find.comp - how many splashes each impact of this tick makes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"
#include "spawns.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 10) writeonly buffer Landings { virga_landing_gpu landings[]; };

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (!is_of_tick(index))
        return;
    const virga_impact_gpu impact = impacts[index];
    const uint n = piece_count(impact);
    uint count = 0u;
    for (uint i = 0u; i < n; i++)
        count += plan_spawn(impact, get_piece(impact, i, n), i, spawns_head.near_m).model != VIRGA_SPLASH_NONE ? 1u : 0u;
    landings[landing_index(index)].first_spawn = count;
}
