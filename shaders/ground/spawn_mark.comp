// spawn_mark.comp - marks which pieces of each impact of this tick splash.
// One invocation per impact. Reads: impacts, cells. Writes: landings (a bit per piece).
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
    uint splashing = 0u;
    const Piece first = first_piece(impact);
    for (uint i = 0u; i < n; i++)
        splashing |= is_splash(impact, get_piece(impact, first, i, n), i) ? 1u << i : 0u;
    landings[landing_index(index)].splashing = splashing;
}
