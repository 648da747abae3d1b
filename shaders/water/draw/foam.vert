// foam.vert - a triangle around the disc of a particle of foam.
// One invocation per corner. Reads: foam_splats. Writes: the position in the disc, in radii.
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

#include "gpu/own_view.glsl"

void main()
{
    const int splat = gl_VertexIndex / 3, corner = gl_VertexIndex - 3 * splat;
    const vec4 center = uintBitsToFloat(foam_texel(FOAM_TEXELS * uint(splat)));
    const uvec4 packed = foam_texel(FOAM_TEXELS * uint(splat) + 1u);
    const float radius = uintBitsToFloat(packed.x);
    // The smallest triangle around the unit circle.
    const vec2 at = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
    position = at;
    color_coverage = vec4(unpackHalf2x16(packed.y), unpackHalf2x16(packed.z));
    motion_distance = vec3(unpackHalf2x16(packed.w), center.w);
    depth_terms = vec4(view.depth_a, view.depth_b, view.far_depth, view.soft_m);
    const vec2 size = 2.0 * radius / vec2(view.viewport[2], view.viewport[3]) * center.w;
    gl_Position = radius > 0.0 ? vec4(center.xy + at * size, center.zw) : DRAWN_NOWHERE;
}
