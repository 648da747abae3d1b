// drop_size.glsl - which drops are drawn as textures, and which as shapes of the height map, by their size on the
// picture. As a drop gets smaller, its texture first fades in over its shape, from FADES_IN times look.textured_px
// down. When the texture covers it, the shape shrinks under it. So nothing appears or disappears at once.
#define NODES_BINDING 5
#include "glass/nodes.glsl"

#define FADES_IN vec2(0.85, 1.0)
#define FADES_OUT vec2(0.7, 0.85)

// Clip coordinates of a point of the pane's frame, or (w = 0) of a direction.
vec4 clip_of_pane(vec3 point, float w)
{
    const float m[9] = look.world_from_pane;
    const mat3 world_from_pane = mat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]);
    return to_mat(view.clip_from_rel) * vec4(world_from_pane * point + w * to_vec(look.origin), w);
}

Frame frame_on(vec2 middle) { return frame_between(middle / vec2(look.pane.width_m, look.pane.height_m)); }

// Diameter in pixels, across the line of sight, in units of look.textured_px. Very large for what is at the eye or
// behind it.
float relative_size(float radius_m, float clip_w)
{
    return 2.0 * radius_m / max(clip_w * view.pixel_angle * look.textured_px, 1e-9);
}

// What is left of the shape.
float shape_left(float size) { return smoothstep(FADES_OUT.x, FADES_OUT.y, size); }

float texture_alpha(float size) { return 1.0 - smoothstep(FADES_IN.x, FADES_IN.y, size); }
