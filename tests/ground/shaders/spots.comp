// spots.comp - the result of virga_ground_spots at the points of a square.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/ground_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform usampler2D spot_map;
layout(std430, set = 0, binding = 1) writeonly buffer Found { float found[]; };
layout(push_constant) uniform Square {
    ivec2 low_cell;
    vec2 first;        // cells, the first point
    float apart;       // cells, from one to the next
    float pixel_cells;
    int cells;
    float wet;
} square;

void main()
{
    const uvec2 i = gl_GlobalInvocationID.xy;
    found[i.y * gl_NumWorkGroups.x * 8u + i.x] =
        virga_ground_spots(spot_map, square.low_cell, square.cells, square.first + square.apart * vec2(i),
                           square.pixel_cells, square.wet);
}
