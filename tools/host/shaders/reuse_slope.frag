#version 460
// reuse_slope.frag - what is asked of each pixel of the sub-frame that was shaded everywhere, in one texel: the slopes
// of its depth, its depth, and its id, which is at most HOST_REUSE_MOVES and so a whole number in a float.
#extension GL_GOOGLE_include_directive : require
#include "reuse.glsl"
#include "reuse_slope.glsl"

layout(set = 0, binding = 5) uniform sampler2D first_depth;
layout(set = 0, binding = 10) uniform usampler2D first_id;

layout(location = 0) out vec4 out_seen;

void main()
{
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    const float depth = texelFetch(first_depth, pixel, 0).r;
    out_seen = vec4(reuse_slope(first_depth, pixel, depth), depth, float(texelFetch(first_id, pixel, 0).r));
}
