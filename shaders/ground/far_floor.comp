// far_floor.comp - the cells of the far map: eight times as wide as the window's, and without state. For each:
// material, unevenness, and whether something above it keeps the rain off.
// One invocation per far cell. Reads: height maps, the material map. Writes: far floors.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "workgroups.glsl"
#include "standing.glsl"
#include "terrain.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(scalar, set = 0, binding = 23) writeonly buffer FarFloors { virga_far_floor_gpu far_floors[]; };
layout(set = 0, binding = 17) uniform usampler2D material_map;
layout(set = 0, binding = 24) uniform sampler2DArray far_depth; // layers: of ground; of all meshes
layout(set = 0, binding = 25) uniform usampler2DArray far_surface;

#define COVER_M 0.5 // what is lower above the ground keeps no rain off it

void main()
{
    const uint index = group_index() * VIRGA_GROUND_GROUP + gl_LocalInvocationIndex;
    const ivec2 texel = ivec2(index % tick.far_cells, index / tick.far_cells);
    const float depth = texelFetch(far_depth, ivec3(texel, 0), 0).r, top = texelFetch(far_depth, ivec3(texel, 1), 0).r;
    const uint surface = texelFetch(far_surface, ivec3(texel, 0), 0).r;
    virga_far_floor_gpu made = virga_far_floor_gpu(0, far_traits(NO_GROUND, 1.0, 0.0, 0.0));
    if (depth < 1.0) {
        const uint material = material_of(material_map, surface, texel, float(VIRGA_GROUND_FAR_CELL),
                                          vec2(tick.far_material_offset[0], tick.far_material_offset[1]));
        const virga_soil_gpu soil = tick.soils[material];
        const ivec2 middle =
            (ivec2(tick.far_low[0], tick.far_low[1]) + texel) * VIRGA_GROUND_FAR_CELL + VIRGA_GROUND_FAR_CELL / 2;
        const float open = (depth - top) * tick.height_map_depth_m > COVER_M ? 0.0 : 1.0;
        const float height_m = tick.height_map_top_m - depth * tick.height_map_depth_m;
        made = virga_far_floor_gpu(int(round(height_m * 1e6)),
                                   far_traits(material, open, level_share(surface, soil), bumps_um(middle, soil)));
    }
    far_floors[index] = made;
}
