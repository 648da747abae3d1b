// picture_corner.glsl - a corner of what is drawn of the pane: where it is, and what mist shows there.
layout(scalar, set = 0, binding = 5) readonly buffer Nodes { virga_glass_node_gpu nodes[]; };

layout(location = 0) out vec2 place;    // (u, v) on the pane (m)
layout(location = 1) out vec3 position; // relative to the camera
layout(location = 2) out vec3 along_u;
layout(location = 3) out vec3 along_v;

layout(location = 4) out vec3 mist_light;

#include "picture_copies.glsl"
#include "picture_mode.glsl"

struct Corner {
    vec3 position, along_u, along_v;
};

Corner node_at(uvec2 node)
{
    const virga_glass_node_gpu at = nodes[node.x + node.y * VIRGA_GLASS_NODES];
    return Corner(to_vec(at.position), to_vec(at.along_u), to_vec(at.along_v));
}

Corner mix_corners(Corner a, Corner b, float t)
{
    return Corner(mix(a.position, b.position, t), mix(a.along_u, b.along_u, t), mix(a.along_v, b.along_v, t));
}

// Between the four nodes around a place.
Corner corner_at(vec2 share)
{
    const vec2 grid = share * float(VIRGA_GLASS_NODES - 1);
    const uvec2 low = min(uvec2(grid), uvec2(VIRGA_GLASS_NODES - 2));
    const vec2 t = grid - vec2(low);
    return mix_corners(mix_corners(node_at(low), node_at(low + uvec2(1, 0)), t.x),
                       mix_corners(node_at(low + uvec2(0, 1)), node_at(low + uvec2(1, 1)), t.x), t.y);
}

// Water too small to show a shape: each drop is a lens that shows all of the world before the pane.
vec3 shown_by_mist()
{
    if (!HAS_PLATE)
        return 0.85 * to_vec(look.tint) * environment(normalize(position), vec2(1.0));
    const vec2 uv = clamp(0.5 * gl_Position.xy / max(gl_Position.w, 1e-5) + 0.5, vec2(0.0), vec2(1.0));
    return 0.85 * to_vec(look.tint) * copy_at(uv, VIRGA_GLASS_COPY_LEVELS - 2);
}

// `share`: of the pane's width and height.
void place_corner(vec2 share)
{
    const float m[9] = look.world_from_pane;
    const mat3 world_from_pane = mat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]);
    const Corner pane = corner_at(share);
    place = share * vec2(look.pane.width_m, look.pane.height_m);
    position = world_from_pane * pane.position + to_vec(look.origin);
    along_u = world_from_pane * pane.along_u;
    along_v = world_from_pane * pane.along_v;
    gl_Position = to_mat(view.clip_from_rel) * vec4(position, 1.0);
    mist_light = shown_by_mist();
}
