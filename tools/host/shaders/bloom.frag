#version 460
// bloom.frag - diffracted light over the picture that it was taken from.
// One invocation per pixel. Reads: the sum of the levels, depth. Writes: premultiplied light, and the share taken.
#extension GL_GOOGLE_include_directive : require
#include "bloom.glsl"

layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D sum;
layout(location = 0) out vec4 radiance;

void main()
{
    const ivec2 pixel = ivec2(gl_FragCoord.xy), size = ivec2(bloom.width, bloom.height);
    const vec2 share = diffracted(texelFetch(depth, pixel, 0).r, pixel, size);
    const float kept = bloom.single.r + share.y * bloom.more.r;
    radiance = vec4(from_coarse(sum, pixel).rgb, share.x * (1.0 - kept));
}
