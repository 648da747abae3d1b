#version 460
// reuse_slope.frag - the slopes of depth of the sub-frame that was shaded everywhere.
#extension GL_GOOGLE_include_directive : require
#include "reuse.glsl"
#include "reuse_slope.glsl"

layout(set = 0, binding = 5) uniform sampler2D first_depth;

layout(location = 0) out vec2 out_slope;

void main()
{
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    out_slope = reuse_slope(first_depth, pixel, texelFetch(first_depth, pixel, 0).r);
}
