#version 460
// bloom_up.comp - the light of a level by its weights, and that of all coarser levels.
// One invocation per texel. Reads: both pictures of the level, the coarser sum. Writes: the sum, over the first one.
#extension GL_GOOGLE_include_directive : require
#include "bloom.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 2) uniform sampler2D coarse;
layout(set = 0, binding = 4, rgba32f) uniform image2D all;
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D more;

void main()
{
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(bloom.width) || texel.y >= int(bloom.height))
        return;
    vec4 sum = vec4(bloom.single.rgb, 0.0) * imageLoad(all, texel) + vec4(bloom.more.rgb, 0.0) * imageLoad(more, texel);
    if (bloom.columns > 0u)
        sum += from_coarse(coarse, texel);
    imageStore(all, texel, sum);
}
