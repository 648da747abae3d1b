#version 460
// reuse.frag - the depth that a sub-frame is shaded against: its own where it is shaded. Elsewhere one that nothing is
// equal to: the nearest of all where it keeps what is there, and HOST_REUSE_TAKEN where it takes another
// pixel.
#extension GL_GOOGLE_include_directive : require
#include "reuse.glsl"

layout(set = 0, binding = 0) uniform sampler2D depth_picture;
layout(set = 0, binding = 1, std430) readonly buffer Planes { vec4 planes[]; };
layout(set = 0, binding = 4, std430) readonly buffer Choices { uint choices[]; };

void main()
{
    const uvec2 pixel = uvec2(gl_FragCoord.xy);
    const bool keeps = reuse_keeps(planes[reuse_block(pixel)]);
    const bool shaded = choices[pixel.y * reuse.width + pixel.x] == HOST_REUSE_SHADED;
    const float depth = texelFetch(depth_picture, ivec2(pixel), 0).r;
    gl_FragDepth = keeps ? 0.0 : shaded ? depth : HOST_REUSE_TAKEN;
}
