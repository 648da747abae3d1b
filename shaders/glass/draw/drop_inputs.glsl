// drop_inputs.glsl - what path.glsl, plate.glsl and temporal.glsl read, for one point of the pane. Where a tile is
// drawn the same comes from its vertices (surface.glsl).
#define NODES_BINDING 5
#include "glass/nodes.glsl"
#include "water.glsl"

vec3 position, along_u, along_v; // of the point: relative to the camera, and the pane's directions
vec4 view_box, tint_given, clip_xy[2], clip_w;
vec2 gain_angle;

// `share`: the point, as fractions of the pane's width and height.
void stand_at(vec2 share)
{
    const float m[9] = look.world_from_pane;
    const mat3 world_from_pane = mat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]);
    const Frame pane = frame_between(share);
    const mat4 clip = to_mat(view.clip_from_rel);
    position = world_from_pane * pane.position + to_vec(look.origin);
    along_u = world_from_pane * pane.along_u;
    along_v = world_from_pane * pane.along_v;
    view_box = vec4(view.viewport[0], view.viewport[1], view.viewport[2], view.viewport[3]);
    tint_given = vec4(to_vec(look.tint), view.color_given);
    clip_xy = vec4[2](vec4(clip[0].xy, clip[1].xy), vec4(clip[2].xy, clip[3].xy));
    clip_w = vec4(clip[0].w, clip[1].w, clip[2].w, clip[3].w);
    gain_angle = vec2(look.gain, view.pixel_angle);
}

void stand_on(vec2 pane_position) { stand_at(pane_position / vec2(look.pane.width_m, look.pane.height_m)); }
