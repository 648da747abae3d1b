// temporal.glsl - motion of what drops show, for variants with motion vectors or a reactive mask. Include it after
// plate.glsl and, except in the paper's style, path.glsl.
//
// At the pixel p a drop shows the pixel q of the picture. Between p and its neighbours q changes by J, some tens of
// pixels per pixel in a drop that shows a whole street. What is at q now was at q' in the previous frame's picture; the
// water that is at p now was at p0 there, and showed q0. So what is at q now was not at p0 there, but at p0 + J^-1 (q'
// - q0). The picture in a drop moves with the pane, and relative to it only by a small part of the scene's motion.
#include "gpu/temporal.glsl"

#if defined(MOTION) || defined(REACTIVE)
#define TEMPORAL

layout(set = 0, binding = 24) uniform sampler2D scene_motion;

vec2 pixel_of(vec4 clip)
{
    const vec2 ndc = clip.xy / max(clip.w, 1e-5);
    return vec2(view.viewport[0], view.viewport[1]) + (0.5 * ndc + 0.5) * vec2(view.viewport[2], view.viewport[3]);
}

bool in_viewport(vec2 pixel)
{
    const vec2 at = pixel - vec2(view.viewport[0], view.viewport[1]);
    return all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(view.viewport[2], view.viewport[3])));
}

// Where what a pixel shows was in the previous frame's picture: by the host's motion vectors, or as a still scene.
vec2 scene_before(vec2 pixel)
{
    const bool inside = in_viewport(pixel);
    if (inside && view.motion_given != 0u) {
        const vec2 size = vec2(textureSize(scene_motion, 0));
        const vec2 scale = vec2(view.motion_scale[0], view.motion_scale[1]);
        return pixel + textureLod(scene_motion, pixel / size, 0.0).xy / scale;
    }
    const float stored = HAS_DEPTH && inside ? buffer_depth(pixel) : view.far_depth;
    const vec3 ray = pixel_ray(pixel);
    const vec4 met_at = stored == view.far_depth ? vec4(ray, 0.0) : vec4(ray * view_depth(stored), 1.0);
    return pixel_of(to_mat(view.previous_clip_from_rel) * met_at);
}

// Where the water of this pixel was.
vec2 water_before() { return pixel_of(to_mat(look.previous_from_here) * vec4(position, 1.0)); }

// Motion of the picture in the water relative to the water, one frame back: J^-1 (q' - q0). Where J is singular the
// drop focuses, and shows one point as a patch, which stays. Near that, the vector is limited to four times the
// scene's.
vec2 motion_in_water(mat2 change, vec2 scene_was, vec2 shown_was)
{
    const vec2 flow = scene_was - shown_was;
    const float det = determinant(change), max_px = 4.0 * length(flow);
    if (abs(det) < 0.05)
        return vec2(0.0);
    const vec2 moved = inverse(change) * flow;
    const float length_px = length(moved);
    return length_px > max_px ? moved * (max_px / max(length_px, 1e-6)) : moved;
}

#ifndef PAPER
// What this water showed in the previous frame, by Snell, with the eye where it was. The scene's distance is taken as
// now.
vec2 shown_before(Path path, vec3 d)
{
    const vec3 flat_normal = cross(along_u, along_v), d_before = normalize(position - to_vec(look.previous_eye));
    Path before = path;
    pass_through(before, d_before, flat_normal);
    const float distance = HAS_DEPTH ? scene_distance(d) : 0.0;
    const vec3 met = before.from + before.out_of * max(distance - length(before.from), 0.0);
    return pixel_of(to_mat(look.previous_from_here) * (distance > 0.0 ? vec4(met, 1.0) : vec4(before.out_of, 0.0)));
}

// Whether a pixel shows the scene through the water, and not something fixed to the pane.
bool shows_scene(Path path, Water water)
{
    const bool opaque = SIDE == VIRGA_GLASS_DRAW_OPAQUE;
    return !opaque && path.ahead && !path.hidden && !path.total && path.reflects < 0.5 && water.cover >= water.mist;
}
#endif

// `inside`: from motion_in_water. The reactive mask: water that moves relative to the background uncovers and covers
// pixels whose history belongs to the other, and the motion inside drops is only approximate. Where nothing moves,
// history is valid.
void write_temporal(vec2 inside, float cover)
{
    const vec2 own_motion = water_before() + inside - gl_FragCoord.xy;
    WRITE_MOTION(clamp(own_motion, vec2(-16384.0), vec2(16384.0)), cover);
    const vec2 behind = scene_before(gl_FragCoord.xy) - gl_FragCoord.xy;
    WRITE_REACTIVE(cover * clamp(2.0 * max(length(inside), length(own_motion - behind)), 0.0, 1.0), 1.0);
}
#endif
