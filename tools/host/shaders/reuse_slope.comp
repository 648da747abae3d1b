#version 460
// reuse_slope.comp - the slopes of depth of the sub-frame that was shaded everywhere. One invocation for each pixel.
#extension GL_GOOGLE_include_directive : require
#include "reuse.glsl"
#include "reuse_slope.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 5) uniform sampler2D first_depth;
layout(set = 0, binding = 11, std430) writeonly buffer Slopes { vec2 slopes[]; };

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x < int(reuse.width) && pixel.y < int(reuse.height))
        slopes[pixel.y * int(reuse.width) + pixel.x] =
            reuse_slope(first_depth, pixel, texelFetch(first_depth, pixel, 0).r);
}
