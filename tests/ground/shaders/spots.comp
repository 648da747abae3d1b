// spots.comp - the result of virga_ground_spots at the points of a square, or of virga_ground_joint along its lines.
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
    float joint_m;     // > 0: width of a joint; points are m from its edge, and pixel_cells is a pixel in m
    float most_m;
} square;

void main()
{
    const uvec2 i = gl_GlobalInvocationID.xy;
    const vec2 at = square.first + square.apart * vec2(i);
    const uint index = i.y * gl_NumWorkGroups.x * 8u + i.x;
    if (square.joint_m > 0.0)
        found[index] = virga_ground_joint(square.wet, at.x, square.joint_m, square.most_m, square.pixel_cells);
    else
        found[index] = virga_ground_spots(spot_map, square.low_cell, square.cells, at, square.pixel_cells, square.wet);
}
