// part_behind.frag - adds up the colors of parts of surfels behind the nearest surface of water where that leaves gaps.
// One invocation per pixel of a part. Reads: gaps. Writes: sums of color and weight.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gaps.glsl"
layout(location = 0) in vec2 position;
layout(location = 1) flat in vec4 color_weight;

layout(location = 0) out vec4 sums;

void main()
{
    const float fill = gap_at(ivec2(gl_FragCoord.xy)).fill, inside = max(1.0 - dot(position, position), 0.0);
    if (fill <= 0.0)
        discard;
    sums = vec4(color_weight.rgb, 1.0) * (fill * color_weight.w * inside * inside);
}
