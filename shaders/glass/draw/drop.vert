// drop.vert - vertices of the quads of drops that are drawn as textures.
// One invocation per vertex of a drop's quad. Reads: quads. Writes: position in the drop, which textures it blends.
// Paper: Sato, Dobashi and Yamamoto 2002, section 3.4.
//
// The drop at (u, v) is between four points of the mesh, i to l in the paper's figure 3. With g = (u / width (columns -
// 1), v / height (rows - 1)), they are those around floor(g), and with t = g - floor(g) their weights are (1 - t.x)(1 -
// t.y), t.x (1 - t.y), (1 - t.x) t.y and t.x t.y: bilinear, so a drop that crosses a line of the mesh does not jump.
//
// The paper's quadrilateral around a drop is a triangle here: an equilateral one around a circle has 1.3 times the
// square's area, but no diagonal, along which blocks of pixels are shaded twice.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "drop_quad.glsl"

#define ROOT_3 1.7320508

layout(location = 0) out vec2 local;       // in radii of the base; (point) in pixels
layout(location = 1) flat out vec4 tile;   // xy: corner of the first texture in the image; zw: weights along u and v
layout(location = 2) flat out vec4 amount; // x: alpha, y: level, z: 1 for a point, w: texels of a texture
layout(location = 3) flat out uint quad;

#include "gpu/own_view.glsl"

void main()
{
    quad = uint(gl_VertexIndex) / 3u;
    const uint corner = uint(gl_VertexIndex) % 3u;
    const vec4 sizes = quad_vec4(quad, 12u), rest = quad_vec4(quad, 16u);
    const bool is_point = floatBitsToUint(rest.z) == 1u;
    const vec2 round = corner == 0u ? vec2(-ROOT_3, -1.0) : corner == 1u ? vec2(ROOT_3, -1.0) : vec2(0.0, 2.0);
    const vec2 square = corner == 0u ? vec2(-1.0) : corner == 1u ? vec2(3.0, -1.0) : vec2(-1.0, 3.0);
    local = sizes.w * (is_point ? square : round);
    gl_Position = quad_vec4(quad, 0u) + local.x * quad_vec4(quad, 4u) + local.y * quad_vec4(quad, 8u);
    const vec2 last = vec2(look.texture_columns, look.texture_rows) - 1.0;
    const vec2 at = clamp(sizes.xy / vec2(look.pane.width_m, look.pane.height_m), vec2(0.0), vec2(1.0)) * last;
    const vec2 point = min(floor(at), last - 1.0);
    const float side = float(look.texture_texels);
    tile = vec4(point * vec2(2.0 * side, side), at - point);
    amount = vec4(rest.xy, is_point ? 1.0 : 0.0, side);
}
