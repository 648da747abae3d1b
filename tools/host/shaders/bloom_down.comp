#version 460
// bloom_down.comp - the next level: half as many texels on a side, filtered by (1, 3, 3, 1) / 8 along each.
// One invocation per texel. Reads: both pictures of a level. Writes: those of the next one.
#extension GL_GOOGLE_include_directive : require
#include "bloom.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 2) uniform sampler2D from_all;
layout(set = 0, binding = 3) uniform sampler2D from_more;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D to_all;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D to_more;

void main()
{
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy), last = ivec2(bloom.columns, bloom.rows) - 1;
    if (texel.x >= int(bloom.width) || texel.y >= int(bloom.height))
        return;
    vec4 all = vec4(0.0), more = vec4(0.0);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 4; x++) {
            const ivec2 at = clamp(2 * texel + ivec2(x, y) - 1, ivec2(0), last);
            const float weight = (x == 1 || x == 2 ? 0.375 : 0.125) * (y == 1 || y == 2 ? 0.375 : 0.125);
            all += weight * texelFetch(from_all, at, 0);
            more += weight * texelFetch(from_more, at, 0);
        }
    imageStore(to_all, texel, all);
    imageStore(to_more, texel, more);
}
