// temporal.glsl - the motion of what drops show, for the forms with motion vectors or a reactive mask. After
// plate.glsl and, but for the paper's style, path.glsl.
//
// A drop shows the place q of the picture at the pixel p. Between p and its neighbours q changes by J, some tens of
// pixels a pixel in a drop that shows all of the street. What is at q now was at q' in the previous frame's picture,
// where the water that is at p now was at p0, and showed q0. There what is at q now was not at p0, but at
// p0 + J^-1 (q' - q0). So a picture in a drop moves with the pane, and against it only by a small part of what the
// scene does.
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

// Where what is at a place of the picture was in the previous frame's: as the host says, or as what stands still does.
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
    const vec4 place_at = stored == view.far_depth ? vec4(ray, 0.0) : vec4(ray * view_depth(stored), 1.0);
    return pixel_of(to_mat(view.previous_clip_from_rel) * place_at);
}

// Where the water of this pixel was.
vec2 water_before() { return pixel_of(to_mat(look.previous_from_here) * vec4(position, 1.0)); }

// How far the picture in the water moves against the water, looking back a frame: J^-1 (q' - q0). Where J is singular
// the drop focuses, and shows of one place a patch: that stays. Next to it a vector is at most four times the scene's.
vec2 motion_in_water(mat2 change, vec2 scene_was, vec2 shown_was)
{
    const vec2 flow = scene_was - shown_was;
    const float turn = determinant(change), most = 4.0 * length(flow);
    if (abs(turn) < 0.05)
        return vec2(0.0);
    const vec2 moved = inverse(change) * flow;
    const float far = length(moved);
    return far > most ? moved * (most / max(far, 1e-6)) : moved;
}

#ifndef PAPER
// What the pane's water showed at this place of it in the previous frame, by Snell: with the eye where it was. The
// scene is taken to be as far away as now.
vec2 shown_before(Path path, vec3 d)
{
    const vec3 flat_normal = cross(along_u, along_v), d_before = normalize(position - to_vec(look.eye_before));
    Path before = path;
    pass_through(before, d_before, flat_normal);
    const float distance = HAS_DEPTH ? scene_distance(d) : 0.0;
    const vec3 met = before.from + before.out_of * max(distance - length(before.from), 0.0);
    return pixel_of(to_mat(look.previous_from_here) * (distance > 0.0 ? vec4(met, 1.0) : vec4(before.out_of, 0.0)));
}

// Whether what shows at a pixel is what is seen through the water, and that is not fixed to the pane itself.
bool moves_inside(Path path, Water water)
{
    const bool opaque = SIDE == VIRGA_GLASS_DRAW_OPAQUE;
    return !opaque && path.ahead && !path.hidden && !path.total && path.reflects < 0.5 && water.cover >= water.mist;
}
#endif

// `inside` from motion_in_water. The mask: water that moves against what is behind it leaves pixels, or comes into
// them, whose history is of the other; and what moves in drops is known only about as well as they are. Where all keeps
// still its history is as good as any.
void write_temporal(vec2 inside, float cover)
{
    const vec2 own = water_before() + inside - gl_FragCoord.xy;
    WRITE_MOTION(clamp(own, vec2(-16384.0), vec2(16384.0)), cover);
    const vec2 behind = scene_before(gl_FragCoord.xy) - gl_FragCoord.xy;
    WRITE_REACTIVE(cover * clamp(2.0 * max(length(inside), length(own - behind)), 0.0, 1.0), 1.0);
}
#endif
