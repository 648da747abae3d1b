// map.comp - what the host's materials read: wetness, depth of water, height, and the dark spots of the first drops.
// One invocation per cell of the blocks that have ground. Where blocks have changed or the maps are new, per cell of
// the window: so the others show none. Reads: cells, floors, flow averages, the list of blocks. Writes: the maps,
// spots, slope variance.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "workgroups.glsl"
#include "blocks.glsl"
#include "rings.glsl"
#include "flow_average.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(push_constant) uniform Push { uint listed; }; // 1: only blocks that have ground
layout(scalar, set = 0, binding = 7) buffer Spots { uvec2 spots[]; };
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2DArray wet_map;
layout(set = 0, binding = 14, r32ui) uniform writeonly uimage2DArray spot_map;

// Spots disappear with the water that made them; the next rain makes new ones.
uvec2 spots_left(uint cell_index, float held_share)
{
    const uvec2 bits = spots[cell_index];
    if (held_share <= 0.0 && (bits.x | bits.y) != 0u)
        spots[cell_index] = uvec2(0u);
    return held_share > 0.0 ? bits : uvec2(0u);
}

// Waves calm down in all cells at once: updating some of the cells per step would show their pattern.
uint calm_variance(uint cell_index, float water_m)
{
    const float step_s = tick.tick > 0u ? float(tick.tick_in_step + 1u) * tick.tick_s : 0.0; // 0: there was no tick
    return uint(float(stirs[cell_index]) * exp(-step_s / cell_calm_time(water_m)));
}

// Of the workgroup.
uint first_cell()
{
    if (listed == 0u)
        return group_index() * VIRGA_GROUND_GROUP;
    return floor_words[list_word(gl_WorkGroupID.x)] * VIRGA_GROUND_BLOCK + gl_WorkGroupID.y * VIRGA_GROUND_GROUP;
}

void main()
{
    const uint cell_index = first_cell() + gl_LocalInvocationIndex;
    const uint side = tick.tiles * VIRGA_GROUND_TILE;
    const ivec2 cell = cell_at_index(cell_index);
    const ivec2 texel = cell & int(side - 1u);
    const virga_floor_gpu own = floor_of(cell_index);
    vec4 wet = vec4(0.0, 0.0, 0.0, -60000.0); // far below everything: no water there
    uvec2 bits = uvec2(0u);
    if (own.material != NO_GROUND) {
        const virga_cell_gpu state = cell_of(cell_index);
        const uint capacity = tick.soils[own.material].capacity_nl;
        const float held = float(state.held_nl) / max(float(capacity), 1.0);
        const uint open_nl = state.free_nl - min(hidden_nl(tick.soils[own.material]), state.free_nl);
        const float free_mm = float(open_nl) * tick.m_per_nl * 1e3;
        const float depth_mm = open_nl > 0u ? max(free_mm - float(swing_um(swings[cell_index])) * 1e-3, 0.0) : 0.0;
        const uint stir = calm_variance(cell_index, depth_mm * 1e-3);
        stirs[cell_index] = stir;
        const float film = clamp(depth_mm / 0.05, 0.0, 1.0);
        wet = vec4(max(min(held, 1.0), film), depth_mm, min(float(stir) * 1e-6, 0.1), float(own.height_um) * 1e-6);
        bits = spots_left(cell_index, capacity > 0u ? held : film);
    }
    imageStore(wet_map, ivec3(texel, 0), wet);
    imageStore(spot_map, ivec3(2 * texel.x, texel.y, 0), uvec4(bits.x, 0u, 0u, 0u));
    imageStore(spot_map, ivec3(2 * texel.x + 1, texel.y, 0), uvec4(bits.y, 0u, 0u, 0u));
}
