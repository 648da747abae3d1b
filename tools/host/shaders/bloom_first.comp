#version 460
// bloom_first.comp - the diffracted light of a picture at half its size, and what of it was diffracted again.
// One invocation per texel of the first level. Reads: color, depth. Writes: both pictures of the first level.
#extension GL_GOOGLE_include_directive : require
#include "bloom.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D color;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D to_all;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D to_more;

// A pixel without a color would take away that of all pixels around it.
vec3 finite(vec3 light)
{
    const bvec3 is = equal(floatBitsToUint(light) & 0x7f800000u, uvec3(0x7f800000u));
    return mix(light, vec3(0.0), is);
}

void main()
{
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = ivec2(bloom.columns, bloom.rows);
    if (texel.x >= int(bloom.width) || texel.y >= int(bloom.height))
        return;
    vec3 all = vec3(0.0), more = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        const ivec2 pixel = min(2 * texel + ivec2(i & 1, i >> 1), size - 1);
        const vec2 share = diffracted(texelFetch(depth, pixel, 0).r, pixel, size);
        const vec3 light = 0.25 * share.x * finite(texelFetch(color, pixel, 0).rgb);
        all += light;
        more += share.y * light;
    }
    imageStore(to_all, texel, vec4(all, 0.0));
    imageStore(to_more, texel, vec4(more, 0.0));
}
