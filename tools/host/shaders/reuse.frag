#version 460
// reuse.frag - the depth that a sub-frame is shaded against: its own where it is shaded, and the nearest of all, which
// nothing is equal to, where it keeps what is there.
#extension GL_GOOGLE_include_directive : require
#include "reuse.glsl"

layout(set = 0, binding = 0) uniform sampler2D depth_picture;
layout(set = 0, binding = 1, std430) readonly buffer Planes { vec4 planes[]; };

void main()
{
    const uvec2 pixel = uvec2(gl_FragCoord.xy);
    const bool shaded = planes[reuse_block(pixel)].w < 0.0;
    gl_FragDepth = shaded ? texelFetch(depth_picture, ivec2(pixel), 0).r : 0.0;
}
