#version 460
// reuse_take.frag - a pixel is the one that reuse_choose.frag found for it in the sub-frame that was shaded
// everywhere. The depth test leaves out all others.
#extension GL_GOOGLE_include_directive : require
#include "attachments.glsl"
#include "reuse.glsl"

layout(set = 0, binding = 6) uniform sampler2D first_color;
layout(set = 0, binding = 7) uniform sampler2D first_normal;
layout(set = 0, binding = 8) uniform sampler2D first_velocity;
layout(set = 0, binding = 9) uniform sampler2D first_water;
layout(set = 0, binding = 14) uniform usampler2D places;

void main()
{
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    const ivec2 from = reuse_inside(pixel + reuse_place(texelFetch(places, pixel, 0).r));
    out_color = texelFetch(first_color, from, 0);
    out_normal = texelFetch(first_normal, from, 0);
    out_velocity = texelFetch(first_velocity, from, 0).xy;
    out_water = texelFetch(first_water, from, 0).xy;
}
