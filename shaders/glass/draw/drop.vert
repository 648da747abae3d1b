// drop.vert - vertices of the quads of drops that are drawn as textures.
// One invocation per vertex of a drop's quad. Reads: quads. Writes: position in the drop, which textures it blends.
// Paper: Sato, Dobashi and Yamamoto 2002, section 3.4.
//
// The drop at (u, v) is between four points of the mesh, i to l in the paper's figure 3. With g = (u / width (columns -
// 1), v / height (rows - 1)), they are those around floor(g), and with t = g - floor(g) their weights are (1 - t.x)(1 -
// t.y), t.x (1 - t.y), (1 - t.x) t.y and t.x t.y: bilinear, so a drop that crosses a line of the mesh does not jump.
//
// A flat cap shows what is near the eye's ray only, and the rays to the points of the mesh differ: a lamp is elsewhere
// in each of the four textures, or in none. With h the cap's height in radii of its base, a ray that crosses the base
// at x radii is turned by 2 h (n - 1) x towards the middle. In tangents along the pane, the drop shows at x what is in
// the direction d - 2 h (n - 1) x, d the eye's ray to it; and the texture of a point that the eye sees along d' shows
// that at
//
//     x' = x + (d' - d) / (2 h (n - 1)).
//
// So each texture is looked up there. The hemispheres of the paper show nearly all of the scene, and theirs are looked
// up at x, as the paper has it.
//
// The paper's quadrilateral around a drop is a triangle here: an equilateral one around a circle has 1.3 times the
// square's area, but no diagonal, along which blocks of pixels are shaded twice.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "drop_quad.glsl"
#define NODES_BINDING 5
#include "glass/nodes.glsl"

#define ROOT_3 1.7320508

layout(location = 0) out vec2 local;       // in radii of the base; (point) in pixels
layout(location = 1) flat out vec4 tile;   // xy: corner of the first texture in the image; zw: weights along u and v
layout(location = 2) flat out vec4 amount; // x: alpha, y: level, z: 1 for a point, w: texels of a texture
layout(location = 3) flat out uint quad;
layout(location = 4) flat out vec4 shifts[2]; // x' - x of the four textures: along u in xy and zw, the second row above

#include "gpu/own_view.glsl"

// The eye's ray in tangents along the pane.
vec2 tangents(Frame pane, vec3 eye, vec3 on_pane)
{
    const vec3 ray = on_pane - eye;
    return vec2(dot(ray, pane.along_u), dot(ray, pane.along_v)) / max(abs(dot(ray, pane.normal)), 0.1 * length(ray));
}

// `share` and `first`: the drop and the first of the four, as fractions of the pane; `apart`: from one to the next.
void write_shifts(vec2 share, vec2 first, vec2 apart)
{
    const float m[9] = look.world_from_pane;
    const vec3 eye = -transpose(mat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8])) * to_vec(look.origin);
    const Frame pane = frame_between(share);
    const vec2 here = tangents(pane, eye, pane.position);
    const float turned = 2.0 * look.cap_height * (WATER - 1.0);
    for (uint i = 0u; i < 2u; i++) {
        const vec2 low = first + vec2(0.0, float(i)) * apart, high = low + vec2(apart.x, 0.0);
        shifts[i] = vec4(tangents(pane, eye, frame_between(low).position) - here,
                         tangents(pane, eye, frame_between(high).position) - here) / turned;
    }
}

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
    const vec2 share = clamp(sizes.xy / vec2(look.pane.width_m, look.pane.height_m), vec2(0.0), vec2(1.0));
    const vec2 at = share * last;
    const vec2 point = min(floor(at), last - 1.0);
    const float side = float(look.texture_texels);
    tile = vec4(point * vec2(2.0 * side, side), at - point);
    amount = vec4(rest.xy, is_point ? 1.0 : 0.0, side);
    shifts[0] = shifts[1] = vec4(0.0);
    for (uint i = look.hemispheres; i < 1u; i++) // software Vulkan leaves out a loop that has no turn
        write_shifts(share, point / last, 1.0 / last);
}
