// splat_behind.frag - adds up the splats behind the nearest surface of water where that leaves gaps.
// One invocation per pixel of a splat. Reads: gaps. Writes: as splat_sum.frag.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gaps.glsl"
layout(location = 0) in vec2 position;
layout(location = 1) flat in vec4 facing_weight;
layout(location = 2) flat in vec2 motion;

layout(location = 0) out vec4 sums;
layout(location = 1) out vec4 motion_sums;

void main()
{
    const float fill = gap_at(ivec2(gl_FragCoord.xy)).fill, inside = max(1.0 - dot(position, position), 0.0);
    if (fill <= 0.0 || facing_weight.z < 0.0) // specks hide nothing, and what hides them is a droplet
        discard;
    const float weight = fill * facing_weight.w * facing_weight.z * inside * inside;
    sums = vec4(facing_weight.xy, 1.0 / gl_FragCoord.w, 1.0) * weight;
    motion_sums = vec4(motion * weight, 0.0, 0.0);
}
