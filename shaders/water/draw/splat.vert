// splat.vert - a triangle around the ellipse of a splat, in the plane of its surfel.
// One invocation per corner of a splat. Reads: splats. Writes: the position in the ellipse, in radii.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/texels.glsl"
TEXELS(splat_texel, 7, 6)

layout(constant_id = 0) const bool DEPTH_ONLY = false; // the first of the two passes

layout(location = 0) out vec2 position;
layout(location = 1) flat out vec3 facing_weight;
layout(location = 2) flat out vec2 motion;

// In the depth pass, splats are smaller by a pixel. What lies in front of other water then blends into it over a pixel
// at its border.
float shrink(vec3 center, vec3 first, vec3 second)
{
    const vec2 size = 0.5 * vec2(look.width, look.height) / center.z;
    const vec2 a = (first.xy - center.xy / center.z * first.z) * size;
    const vec2 b = (second.xy - center.xy / center.z * second.z) * size;
    const float narrow = sqrt(min(dot(a, a), dot(b, b)));
    return clamp(1.0 - 1.0 / max(narrow, 1e-3), 0.7, 1.0);
}

void main()
{
    const int splat = gl_VertexIndex / 3, corner = gl_VertexIndex - 3 * splat;
    const uvec4 one = splat_texel(3u * uint(splat)), two = splat_texel(3u * uint(splat) + 1u),
                three = splat_texel(3u * uint(splat) + 2u);
    const vec3 center = uintBitsToFloat(one.xyz), first = uintBitsToFloat(two.xyz), second = uintBitsToFloat(three.xyz);
    const vec2 weight_push = unpackHalf2x16(two.w);
    // The smallest triangle around the unit circle.
    const vec2 at = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
    const float scale = DEPTH_ONLY ? shrink(center, first, second) : 1.0;
    const vec3 clip = center + scale * (at.x * first + at.y * second);
    position = at;
    facing_weight = vec3(unpack_facing(one.w), weight_push.x);
    motion = unpackHalf2x16(three.w);
    // Depth is NEAR_W / w. Moving the splat away from the eye, by a factor, divides its depth by this factor.
    gl_Position = vec4(clip.xy, DEPTH_ONLY ? NEAR_W / (1.0 + weight_push.y) : NEAR_W, clip.z);
}
