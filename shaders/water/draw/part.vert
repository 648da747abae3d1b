// part.vert - a triangle around the ellipse of a part of a surfel.
// One invocation per corner. Reads: parts, open blocks. Writes: the position in the ellipse, in radii.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/texels.glsl"
TEXELS(part_texel, 26, 25)
#include "water/packed_share.glsl"
#include "is_open.glsl"

layout(constant_id = 0) const uint PASS = 0u; // as in splat.vert

layout(location = 0) out vec2 position;
layout(location = 1) flat out vec4 color_weight;

void main()
{
    const int part = gl_VertexIndex / 3, corner = gl_VertexIndex - 3 * part;
    const uint texel = uint(VIRGA_WATER_PART_TEXELS * part);
    const uvec4 one = part_texel(texel), two = part_texel(texel + 1u), three = part_texel(texel + 2u);
    // The smallest triangle around the unit circle.
    const vec2 at = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
    const vec3 center = uintBitsToFloat(one.xyz), first = uintBitsToFloat(two.xyz), second = uintBitsToFloat(three.xyz);
    const vec3 clip = center + at.x * first + at.y * second;
    position = at;
    color_weight = vec4(uintBitsToFloat(part_texel(texel + 3u).rgb), share_in(two.x) * unpackHalf2x16(two.w).x);
    // As in splat.vert. Specks have no color of their own.
    const bool is_drawn = color_weight.w >= 0.0 && (PASS != 2u || is_over_open(center, first, second));
    gl_Position = is_drawn ? vec4(clip.xy, NEAR_W, clip.z) : DRAWN_NOWHERE;
}
