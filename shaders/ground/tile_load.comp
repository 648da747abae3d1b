// tile_load.comp - fills the tiles that enter the window: height and material from the height map, and the unevenness
// of the material, which decides where puddles form. Tiles never seen before get the water of ground that was in the
// rain for as long.
// One invocation per cell. Reads: height maps, the material map, kept cells. Writes: floors, cells, spots.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "workgroups.glsl"
#include "flow_average.glsl"
#include "standing.glsl"
#include "shelter.glsl"
#include "terrain.glsl"

#define NEVER_SEEN 0x80000000u // flag of an entry in the list: the tile was never in the window

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(scalar, set = 0, binding = 1) readonly buffer Lists
{
    uint entering[VIRGA_GROUND_MAX_TILES];  // slots of tiles
    uint discarded[VIRGA_GROUND_MAX_TILES]; // slots of kept tiles
};
layout(scalar, set = 0, binding = 7) writeonly buffer Spots { uvec2 spots[]; };
layout(set = 0, binding = 11) uniform sampler2DArray height_map_depth;
layout(set = 0, binding = 12) uniform usampler2DArray height_map_surface;
layout(set = 0, binding = 17) uniform usampler2D material_map;

// The part of the rain that reaches a cell: interpolated between cells of the far map; all of it outside of that.
float rained_share(ivec2 cell)
{
    const vec2 at = (vec2(cell - ivec2(tick.far_low[0], tick.far_low[1]) * VIRGA_GROUND_FAR_CELL) + 0.5) /
                        float(VIRGA_GROUND_FAR_CELL) -
                    0.5;
    const ivec2 low = ivec2(floor(at)), last = ivec2(int(tick.far_cells) - 1);
    if (min(low.x, low.y) < 0 || max(low.x, low.y) >= last.x)
        return 1.0;
    const vec2 t = at - vec2(low);
    return mix(mix(open_at(low), open_at(low + ivec2(1, 0)), t.x),
               mix(open_at(low + ivec2(0, 1)), open_at(low + ivec2(1, 1)), t.x), t.y);
}

void main()
{
    const uint entry = entering[group_index() / (VIRGA_GROUND_TILE_CELLS / VIRGA_GROUND_GROUP)];
    const uint tile = entry & ~NEVER_SEEN;
    const uint part = group_index() % (VIRGA_GROUND_TILE_CELLS / VIRGA_GROUND_GROUP);
    const uint cell_index = (tile << (2 * TILE_SHIFT)) + part * VIRGA_GROUND_GROUP + gl_LocalInvocationIndex;
    const ivec2 cell = cell_at_index(cell_index);
    const ivec3 texel = ivec3(cell - (ivec2(tick.low_tile[0], tick.low_tile[1]) << TILE_SHIFT), 0);
    const float depth = texelFetch(height_map_depth, texel, 0).r;
    const uint surface = texelFetch(height_map_surface, texel, 0).r;
    const uint material =
        material_of(material_map, surface, texel.xy, 1.0, vec2(tick.material_offset[0], tick.material_offset[1]));
    virga_floor_gpu made = virga_floor_gpu(0, NO_GROUND);
    virga_cell_gpu start = virga_cell_gpu(0u, 0u);
    uvec2 bits = uvec2(0u);
    if (depth < 1.0) {
        const float height_m = tick.height_map_top_m - depth * tick.height_map_depth_m; // above the base
        const virga_soil_gpu soil = tick.soils[material];
        const float bump_um = bumps_um(cell, soil);
        made = virga_floor_gpu(int(round(height_m * 1e6 + bump_um)), material);
        const virga_standing_gpu standing = standing_at(material, rained_share(cell), level_share(surface, soil));
        start = water_standing(standing, soil, bump_um);
        bits = spots_standing(standing.spots, virga_hash3(tick.seed, uint(cell.x), uint(cell.y)));
    }
    floors[cell_index] = made;
    swings[cell_index] = 0u;
    if ((entry & NEVER_SEEN) == 0u)
        return;
    cells[cell_index] = start;
    spots[cell_index] = bits;
    if (start.free_nl > 0u)
        count_water(VIRGA_GROUND_STARTED, start.free_nl);
    if (start.held_nl > 0u)
        count_water(VIRGA_GROUND_STARTED, start.held_nl);
}
