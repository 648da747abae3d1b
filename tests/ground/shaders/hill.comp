// hill.comp - what a material reads along a surface: the wetness of virga_ground_at or virga_ground_far_at.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/ground_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D wet_map;
layout(set = 0, binding = 1) uniform usampler2D spot_map;
layout(std430, set = 0, binding = 2) writeonly buffer Found { float found[]; };
layout(push_constant) uniform Surface {
    vec2 rise;    // height per cell along x and z: of the surface that is looked at
    float base;   // its height at cell (0, 0)
    float cell_m;
    int cells;
    int far;      // 1: virga_ground_far_at
} surface;

void main()
{
    const uvec2 i = gl_GlobalInvocationID.xy;
    const uint side = gl_NumWorkGroups.x * 8u;
    const vec2 at = 2.0 + (vec2(i) + 0.5) / float(side) * float(surface.cells - 4);
    const float height_m = surface.base + dot(surface.rise, at);
    const virga_ground_wetness dry = virga_ground_wetness(0.0, 0.0, 0.0, 0.0);
    virga_ground_wetness there;
    if (surface.far == 1)
        there = virga_ground_far_at(wet_map, surface.cells, at, height_m, dry, surface.cell_m);
    else
        there = virga_ground_at(wet_map, spot_map, ivec2(0), surface.cells, at, height_m, 1.0, surface.cell_m);
    found[i.y * side + i.x] = there.wet;
}
