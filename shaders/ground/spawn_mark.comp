// spawn_mark.comp - marks which pieces of each impact of this tick splash.
// On a GPU several lanes share the pieces of each impact, see land.comp. Reads: impacts, cells. Writes: landings (a bit
// per piece).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"
#include "spawns.glsl"
#include "gpu/variants.glsl"

layout(local_size_x = VIRGA_GROUND_IMPACTS_EACH, local_size_x_id = 5) in; // constant 5: see gpu/pipeline_build.c
layout(scalar, set = 0, binding = 10) writeonly buffer Landings { virga_landing_gpu landings[]; };

shared uint bits_of_lane[gl_WorkGroupSize.x];

void main()
{
    const uint lanes = FOR_GPU ? gl_WorkGroupSize.x / uint(VIRGA_GROUND_IMPACTS_EACH) : 1u; // of each impact
    const uint lane = gl_LocalInvocationIndex, index = gl_GlobalInvocationID.x / lanes;
    const uint first_piece_of_lane = gl_GlobalInvocationID.x % lanes;
    const bool is_own = is_of_tick(index);
    uint splashing = 0u;
    if (is_own) {
        const virga_impact_gpu impact = impacts[index];
        const uint n = piece_count(impact);
        const Piece first = first_piece(impact);
        for (uint i = first_piece_of_lane; i < n; i += lanes)
            splashing |= is_splash(impact, get_piece(impact, first, i, n), i) ? 1u << i : 0u;
    }
    if (FOR_GPU) {
        bits_of_lane[lane] = splashing;
        barrier();
        splashing = 0u;
        for (uint i = 0u; i < lanes; i++)
            splashing |= bits_of_lane[lane - first_piece_of_lane + i];
    }
    if (is_own && first_piece_of_lane == 0u)
        landings[landing_index(index)].splashing = splashing;
}
