// splat.vert - a triangle around the ellipse of a splat, in the plane of its surfel.
// One invocation per corner of a splat. Reads: splats, open blocks. Writes: the position in the ellipse, in radii.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/texels.glsl"
TEXELS(splat_texel, 7, 6)
#include "water/packed_share.glsl"
#include "is_open.glsl"

layout(constant_id = 0) const uint PASS = 0u; // 0: sums, 1: the depth before them, 2: what is behind
#define DEPTH_ONLY (PASS == 1u)

layout(location = 0) out vec2 position;
layout(location = 1) flat out vec4 facing_weight; // w: the share that is there
layout(location = 2) flat out vec2 motion;

void main()
{
    const int splat = gl_VertexIndex / 3, corner = gl_VertexIndex - 3 * splat;
    const uvec4 one = splat_texel(3u * uint(splat)), two = splat_texel(3u * uint(splat) + 1u),
                three = splat_texel(3u * uint(splat) + 2u);
    const vec3 center = uintBitsToFloat(one.xyz), first = uintBitsToFloat(two.xyz), second = uintBitsToFloat(three.xyz);
    const float weight = unpackHalf2x16(two.w).x;
    const vec2 push_scale = unpack_push_scale(two.w);
    // The smallest triangle around the unit circle.
    const vec2 at = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
    const float scale = DEPTH_ONLY ? push_scale.y : 1.0;
    const vec3 clip = center + scale * (at.x * first + at.y * second);
    position = at;
    facing_weight = vec4(unpack_facing(one.w), weight, share_in(two.x));
    motion = unpackHalf2x16(three.w);
    // Depth is NEAR_W / w. Moving the splat away from the eye, by a factor, divides its depth by this factor.
    // Hides nothing, or fills nothing.
    if ((DEPTH_ONLY && scale == 0.0) || (PASS == 2u && (weight < 0.0 || !is_over_open(center, first, second)))) {
        gl_Position = DRAWN_NOWHERE;
        return;
    }
    gl_Position = vec4(clip.xy, DEPTH_ONLY ? NEAR_W / (1.0 + push_scale.x) : NEAR_W, clip.z);
}
