// corner.glsl - a vertex of the pane: its position, and the pane's directions there.
#define NODES_BINDING 5
#include "glass/nodes.glsl"

layout(location = 0) out vec2 pane_position; // (u, v) on the pane, m
layout(location = 1) out vec3 position;      // relative to the camera

// Constants of the view as flat outputs: in a fragment shader software Vulkan reads each word of a uniform buffer lane
// by lane, but a flat input once per triangle.
layout(location = 5) flat out vec4 map_grid;        // xy: size of a texel (m); zw: the last texel
layout(location = 6) flat out vec4 view_box;        // the viewport
layout(location = 7) flat out vec2 threshold_shift; // x: threshold, y: paper_shift

struct Corner {
    vec3 position, along_u, along_v;
};

// Writes the vertex's outputs. `share` is its position as fractions of the pane's width and height. Returns the pane's
// directions there, in the world.
Corner emit_corner(vec2 share)
{
    const float m[9] = look.world_from_pane;
    const mat3 world_from_pane = mat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]);
    const Frame pane = frame_between(share);
    map_grid = vec4(texel_m(), vec2(look.map_columns, look.map_rows) - 1.0);
    view_box = vec4(view.viewport[0], view.viewport[1], view.viewport[2], view.viewport[3]);
    threshold_shift = vec2(look.threshold, look.paper_shift);
    pane_position = share * vec2(look.pane.width_m, look.pane.height_m);
    position = world_from_pane * pane.position + to_vec(look.origin);
    gl_Position = to_mat(view.clip_from_rel) * vec4(position, 1.0);
    return Corner(position, world_from_pane * pane.along_u, world_from_pane * pane.along_v);
}
