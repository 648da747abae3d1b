// far_map.comp - what the host's materials read outside the window: ground that has been in the rain for as long as the
// rest.
// One invocation per far cell. Reads: far floors, standing water. Writes: the far map.
//
// Puddles are in the same hollows as in the window. In the distance, where pixels are wider than puddles, there is
// their mean. A row below the map has level open ground of each material.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "workgroups.glsl"
#include "rings.glsl"
#include "standing.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(scalar, set = 0, binding = 23) readonly buffer FarFloors { virga_far_floor_gpu far_floors[]; };
layout(set = 0, binding = 26, rgba16f) uniform writeonly image2DArray far_map;

// Variance of slope in steady rain. Waves come from the energy of drops: their mean diameter by volume times the square
// of their speed is 1.7 times that by surface where diameters are distributed exponentially. Fewer of them are as much
// water.
float stirred(float water_m, float open_share)
{
    const float wider = 1.7, diameter_m = wider * tick.rain_drop_m;
    const float drops = tick.rain_per_m2_s / (wider * wider * wider) * tick.cell_m * tick.cell_m * open_share;
    const float speed = max(9.65 - 10.3 * exp(-600.0 * diameter_m), 0.0); // Atlas et al. 1973
    return min(drops * crater_kept_s(crater_of(diameter_m, speed, water_m), water_m), 0.1);
}

// What ground of one material has that is in the same rain, whatever its bumps.
struct Alike {
    virga_standing_gpu standing;
    virga_soil_gpu soil;
    uint hidden_nl;
    float full, held; // wetness of pores under free water, and where there is none
};

Alike alike(uint material, float open_share, float level_share)
{
    const virga_soil_gpu soil = tick.soils[material];
    const virga_standing_gpu standing = standing_at(material, open_share, level_share);
    const float room = max(float(soil.capacity_nl), 1.0);
    return Alike(standing, soil, hidden_nl(soil), min(float(soil.capacity_nl) / room, 1.0),
                 min(float(held_standing_nl(standing, soil)) / room, 1.0));
}

// Wetness, depth (m), and 1 where the water is deep enough for waves.
vec3 look_of(Alike own, float bump_um)
{
    const uint free_nl = free_standing_nl(own.standing, own.soil, bump_um);
    const float depth_m = float(free_nl - min(own.hidden_nl, free_nl)) * tick.m_per_nl;
    return vec3(max(free_nl == 0u ? own.held : own.full, clamp(depth_m / 0.00005, 0.0, 1.0)), depth_m,
                float(depth_m >= MIN_WATER_M));
}

void main()
{
    const uint index = group_index() * VIRGA_GROUND_GROUP + gl_LocalInvocationIndex;
    const uint side = max(tick.far_cells, 1u), count = tick.far_cells * tick.far_cells;
    if (index >= count + VIRGA_GROUND_MATERIALS)
        return;
    const bool in_map = index < count;
    const uint row = index / side; // one division for both
    const ivec2 texel = in_map ? ivec2(index - row * side, row) : ivec2(index - count, tick.far_cells);
    virga_far_floor_gpu own = far_floors[in_map ? index : 0u];
    own.traits = in_map ? own.traits : far_traits(index - count, 1.0, 1.0, 0.0);
    const uint material = own.traits & 255u;
    vec4 wet = vec4(0.0, 0.0, 0.0, -60000.0); // as in map.comp
    if (material != NO_GROUND) {
        const float open = far_open(own.traits);
        const Alike ground = alike(material, open, far_level(own.traits));
        const float quarters[4] = float[4](VIRGA_GROUND_QUARTERS);
        vec3 mean = vec3(0.0);
        for (int i = 0; i < 4; i++)
            mean += 0.25 * look_of(ground, quarters[i] * ground.soil.bumps_um);
        const vec2 away = vec2(texel) + 0.5 - vec2(tick.far_camera[0], tick.far_camera[1]);
        const float even = in_map ? smoothstep(tick.far_even[0], tick.far_even[1], length(away)) : 1.0;
        const vec3 look = mix(look_of(ground, far_bump_um(own.traits)), mean, even);
        const float spots = 1.0 - exp(-ground.standing.spots);
        wet = vec4(look.x, look.y * 1e3, look.y > 0.0 ? look.z * stirred(look.y, open) : -spots,
                   float(own.height_um) * 1e-6);
    }
    imageStore(far_map, ivec3(texel, 0), wet);
}
