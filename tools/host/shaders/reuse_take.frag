#version 460
// reuse_take.frag - a pixel of the sub-frame that was shaded everywhere, in place of one that sees the same surface.
#extension GL_GOOGLE_include_directive : require
#include "attachments.glsl"
#include "reuse.glsl"

layout(set = 0, binding = 4, std430) readonly buffer Choices { uint choices[]; };
layout(set = 0, binding = 6) uniform sampler2D first_color;
layout(set = 0, binding = 7) uniform sampler2D first_normal;
layout(set = 0, binding = 8) uniform sampler2D first_velocity;
layout(set = 0, binding = 9) uniform sampler2D first_water;
layout(set = 0, binding = 10) uniform usampler2D first_id;
void main()
{
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    const uint chosen = choices[uint(pixel.y) * reuse.width + uint(pixel.x)];
    const ivec2 place = ivec2(chosen % 3u, chosen / 3u) - 1, size = ivec2(reuse.width, reuse.height);
    const ivec2 from = chosen == HOST_REUSE_SHADED ? pixel : clamp(pixel + place, ivec2(0), size - 1);
    out_color = texelFetch(first_color, from, 0);
    out_normal = texelFetch(first_normal, from, 0);
    out_velocity = texelFetch(first_velocity, from, 0).xy;
    out_water = texelFetch(first_water, from, 0).xy;
    out_id = texelFetch(first_id, from, 0).r;
}
