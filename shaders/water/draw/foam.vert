// foam.vert - a triangle around the disc of a particle of foam, or around its streak.
// One invocation per corner. Reads: foam_splats. Writes: the position in the disc, in radii; along the streak from its
// middle.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/texels.glsl"
#include "foam_splats.glsl"
TEXELS(foam_texel, 23, 22)

layout(location = 0) out vec2 position;
layout(location = 1) flat out vec4 color_coverage;
layout(location = 2) flat out vec3 motion_distance;
layout(location = 3) flat out vec4 depth_terms; // see gpu/scene_depth.glsl
layout(location = 4) flat out float half_streak; // radii

#include "gpu/own_view.glsl"

void main()
{
    const int splat = gl_VertexIndex / 3, corner = gl_VertexIndex - 3 * splat;
    const uvec4 first = foam_texel(FOAM_TEXELS * uint(splat));
    const uvec4 packed = foam_texel(FOAM_TEXELS * uint(splat) + 1u);
    const vec3 center = uintBitsToFloat(first.xyz); // x, y, w
    const vec2 streak = unpackHalf2x16(first.w);
    const float radius = uintBitsToFloat(packed.x), length_px = length(streak);
    const bool moves = length_px > ROUND * radius;
    half_streak = moves ? 0.5 * (length_px / radius - ROUND) : 0.0;
    // The smallest triangle around the unit circle, or one around the rectangle of a streak.
    vec2 at = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
    if (moves)
        at = (vec2(corner == 1 ? 4.0 : 0.0, corner == 2 ? 4.0 : 0.0) - 1.0) * vec2(1.0 + half_streak, 1.0);
    position = at;
    color_coverage = vec4(unpackHalf2x16(packed.y), unpackHalf2x16(packed.z));
    motion_distance = vec3(unpackHalf2x16(packed.w), center.z);
    depth_terms = vec4(view.depth_a, view.depth_b, view.far_depth, view.soft_m);
    const vec2 along = moves ? streak / length_px : vec2(1.0, 0.0);
    const vec2 px = radius * (at.x * along + at.y * vec2(-along.y, along.x)) - 0.5 * streak;
    const vec2 xy = center.xy + 2.0 * px / vec2(view.viewport[2], view.viewport[3]) * center.z;
    // As the camera's matrix has it: the depth is b / w - a.
    gl_Position = radius > 0.0 ? vec4(xy, view.depth_b - view.depth_a * center.z, center.z) : DRAWN_NOWHERE;
}
