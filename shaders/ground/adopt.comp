// adopt.comp - tiles that come into the window get their floors: height and material of what lies there, and the
// unevenness of that material, which decides where puddles gather.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "groups.glsl"
#include "swing.glsl"
#include "shared/surface.glsl"

#define NEVER_SEEN 0x80000000u // of an entry in the list: the tile comes without water

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(scalar, set = 0, binding = 1) readonly buffer Lists
{
    uint entering[VIRGA_GROUND_MAX_TILES];  // slots of tiles
    uint forgotten[VIRGA_GROUND_MAX_TILES]; // slots of kept tiles
};
layout(set = 0, binding = 11) uniform sampler2DArray survey_depth;
layout(set = 0, binding = 12) uniform usampler2DArray survey_surface;
layout(set = 0, binding = 17) uniform usampler2D material_map;

float knot(ivec2 at) { return virga_unit(virga_hash3(0x6b756d70u, uint(at.x), uint(at.y))) * 2.0 - 1.0; }

// Smooth noise between knots; its standard deviation is about 0.33.
float noise(vec2 at)
{
    const ivec2 low = ivec2(floor(at));
    vec2 t = at - vec2(low);
    t = t * t * (3.0 - 2.0 * t);
    return mix(mix(knot(low), knot(low + ivec2(1, 0)), t.x), mix(knot(low + ivec2(0, 1)), knot(low + ivec2(1, 1)), t.x),
               t.y);
}

float bumps_um(ivec2 cell, virga_soil_gpu soil)
{
    if (soil.bumps_um <= 0.0)
        return 0.0;
    // Three octaves; cells are taken modulo a large period, with its seam 26 km out, so that floats stay fine far from
    // the origin.
    const vec2 at = vec2((cell + 0x80000) & 0xfffff) / soil.bump_cells;
    return soil.bumps_um * (2.4 * noise(at) + 1.2 * noise(2.0 * at + 17.3) + 0.6 * noise(4.0 * at + 5.1));
}

// The mesh's, or what the host's map says there.
uint material_of(ivec3 texel)
{
    const uint mesh = min(surface_material(texelFetch(survey_surface, texel, 0).r), VIRGA_GROUND_MATERIALS - 1u);
    const vec2 at = (vec2(texel.xy) + 0.5) * vec2(tick.material_scale[0], tick.material_scale[1]) +
                    vec2(tick.material_offset[0], tick.material_offset[1]);
    // Asked so that it is false of what is not a number, as the place in a map without extent is.
    if (!(all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)))))
        return mesh;
    const uint mapped = texelFetch(material_map, ivec2(at * vec2(textureSize(material_map, 0))), 0).r;
    return mapped < VIRGA_GROUND_MATERIALS ? mapped : mesh;
}

void main()
{
    const uint entry = entering[group_index() / (VIRGA_GROUND_TILE_CELLS / VIRGA_GROUND_GROUP)];
    const uint tile = entry & ~NEVER_SEEN;
    const uint part = group_index() % (VIRGA_GROUND_TILE_CELLS / VIRGA_GROUND_GROUP);
    const uint place = (tile << (2 * TILE_SHIFT)) + part * VIRGA_GROUND_GROUP + gl_LocalInvocationIndex;
    const ivec2 cell = cell_at_place(place);
    const ivec3 texel = ivec3(cell - (ivec2(tick.low_tile[0], tick.low_tile[1]) << TILE_SHIFT), 0);
    const float depth = texelFetch(survey_depth, texel, 0).r;
    const uint material = material_of(texel);
    virga_floor_gpu made = virga_floor_gpu(0, NO_GROUND);
    virga_cell_gpu start = virga_cell_gpu(0u, 0u);
    if (depth < 1.0) {
        const float height_m = tick.survey_top_m - depth * tick.survey_height_m; // above the base
        const virga_soil_gpu soil = tick.soils[material];
        const float bump_um = bumps_um(cell, soil);
        made = virga_floor_gpu(int(round(height_m * 1e6 + bump_um)), material);
        // Rain that fell before stands in the hollows; on the humps is only what their roughness holds.
        const float hump_um = max(bump_um + 0.5 * soil.bumps_um, 0.0);
        const float depth_um = soil.drain != 0u ? 0.0 : max(tick.start_water_um - hump_um, 0.0);
        const bool wet = tick.start_water_um > 0.0 && soil.drain == 0u;
        start.free_nl = wet ? max(uint(depth_um * float(tick.nl_per_um)), soil.retention_nl / 2u) : 0u;
        start.held_nl = wet ? soil.capacity_nl : uint(float(soil.capacity_nl) * tick.start_wetness);
    }
    floors[place] = made;
    swings[place] = 0u;
    if ((entry & NEVER_SEEN) == 0u)
        return;
    cells[place] = start;
    if (start.free_nl > 0u)
        count_water(VIRGA_GROUND_STARTED, start.free_nl);
    if (start.held_nl > 0u)
        count_water(VIRGA_GROUND_STARTED, start.held_nl);
}
