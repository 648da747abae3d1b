// streak_write.comp - writes a streak for each selected slot: the drop's path while the shutter is open, cut where it
// hits a surface, and its light.
// One invocation per selected slot. Reads: slots, drops, occlusion maps, the view. Writes: streaks, motions.
//
// A drop of length D, whose middle moves by l while the shutter is open, covers a point between its ends for the
// fraction D / l of the time (all of it if l < D). Towards the ends this falls off, over a ramp as long as the shorter
// of the two. Its total is D x l / l, so what the drop covers does not depend on its speed (after Garg and Nayar 2007,
// who have l >> D). A streak that is narrower than the sampling is drawn wider, with less coverage.
//
// When a picture is averaged from several views, each view shows its part of the path, with more coverage accordingly.
// A streak that would need more than full coverage (its slot stands for many drops, or streak_gain makes it brighter)
// gets full coverage and is longer, so that the mean of the views is as bright as a single view of the whole path.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "view.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_buffers.glsl"
#include "order.glsl"
#include "gpu/line.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 7) writeonly buffer Streaks { virga_streak_gpu streaks[]; };
// The same buffer: the motions follow behind `max_streaks` streaks of four texels each, a texel per motion.
layout(scalar, set = 0, binding = 7) writeonly buffer Motions { vec4 motions[]; };

// Cuts the path from `tail` to `head` where it hits a surface. False: no part of it is under the sky.
bool cut_at_surface(vec3 tail, inout vec3 head, uint slant)
{
    if (tick.maps == 0u)
        return true;
    const float path = tail.y - head.y;
    if (find_cover(tail, slant).height >= tail.y)
        return false;
    const Cover below = find_cover(head, slant);
    if (head.y > below.height)
        return true;
    if (path <= 1e-6 || below.height > tail.y + 0.5 * path)
        return false;
    head = mix(tail, head, clamp((tail.y - below.height) / path, 0.0, 1.0));
    return true;
}

// Height over width: the polynomial of virga_drop_axis_ratio.
float axis_ratio(float mm)
{
    return clamp(0.9951 + mm * (0.0251 + mm * (-0.03644 + mm * (0.005303 - 0.0002492 * mm))), 0.5, 1.0);
}

virga_streak_gpu empty_streak()
{
    virga_streak_gpu streak;
    streak.head = float[2](2.0, 2.0);
    streak.tail = streak.head;
    streak.depth = float[2](0.0, 0.0);
    streak.distance = float[2](1.0, 1.0);
    streak.width_alpha = 0u;
    streak.body_wave = 0u;
    streak.oscillations = 0u;
    streak.order = 0u;
    streak.light = uint[3](0u, 0u, 0u);
    streak.id = 0u;
    return streak;
}

// x: coverage in this view alone, from that over all views. y: by which factor the streak is longer than the drop's
// path in this view.
vec2 view_coverage(float whole, float body_px, float path_px, float blur)
{
    const float min_px = max(body_px, blur), drawn = max(path_px, min_px);
    const float alpha = whole * max(look.parts * path_px, min_px) / drawn;
    const float longer = alpha > 1.0 ? alpha * drawn / max(path_px, 1e-3) : 1.0;
    return vec2(min(alpha, 1.0), clamp(longer, 1.0, look.parts));
}

// The path of a drop while the shutter is open: relative to the tick's origin, and in clip coordinates, where it is a
// straight line too.
struct Path {
    vec3 head, tail;
    vec4 clip_head, clip_tail;
};

Path path_of(vec3 at_tick, vec3 velocity)
{
    Path path;
    path.head = at_tick + velocity * view.time_close_s;
    path.tail = at_tick + velocity * view.time_open_s;
    path.clip_head = project(to_mat(view.clip_from_rel), path.head + to_vec(view.origin_offset));
    path.clip_tail = project(to_mat(view.open_clip_from_rel), path.tail + to_vec(view.origin_offset));
    return path;
}

// Clips the path at the near plane.
void cut_at_near(inout Path path)
{
    cut_at_near_plane(path.clip_head, path.clip_tail);
    cut_at_near_plane(path.clip_tail, path.clip_head);
}

float path_in_px(Path path)
{
    cut_at_near(path);
    const vec2 moved = path.clip_head.xy / path.clip_head.w - path.clip_tail.xy / path.clip_tail.w;
    return length(moved * 0.5 * vec2(view.viewport[2], view.viewport[3]));
}

// Lengthens the path by a factor, around its middle.
void lengthen_path(inout Path path, float times)
{
    const vec3 further = (0.5 * times - 0.5) * (path.head - path.tail);
    const vec4 clip_further = (0.5 * times - 0.5) * (path.clip_head - path.clip_tail);
    path.head += further;
    path.tail -= further;
    path.clip_head += clip_further;
    path.clip_tail -= clip_further;
}

// Cuts the path where it hits a surface; returns the part that is left, or -1 for none. A cut streak is as bright per
// length as the whole one, because the drop passed it at the same speed.
float cut_path_at_surface(inout Path path, uint slant)
{
    const vec3 whole = path.head;
    if (!cut_at_surface(path.tail, path.head, slant))
        return -1.0;
    const float kept_share = clamp(distance(path.head, path.tail) / max(distance(whole, path.tail), 1e-6), 0.0, 1.0);
    path.clip_head = mix(path.clip_tail, path.clip_head, kept_share);
    return kept_share;
}

void set_light(inout virga_streak_gpu streak, vec3 middle)
{
    const vec3 d = normalize(middle);
    const vec3 glitter = lamps(middle, d);
    // The light at a part r of the drop's radius goes from `center` to `rim` with r^2. Near the middle rays are
    // deflected by up to 16 degrees, at the rim by 50 and more (Legendre moments: their cosines). The mean over the
    // disc is half of each, with the moments 0.77 and 0.54. Those of the phase function are 0.77 and 0.62, but
    // harmonics of degree 2 undershoot before dark walls. Of 60 streets at random, with sky above and houses beside,
    // the light of drops before houses is then wrong by 30 % (root mean square) against the integral over the phase
    // function, and with 0.54 by 22 % (tests/core/test_drop_light.c).
    const vec3 center = environment(d, vec2(0.97, 0.90)) + glitter;
    const vec3 rim = environment(d, vec2(view.phase_moment[1], view.phase_moment[2]) * vec2(0.75, 0.3)) + 0.6 * glitter;
    streak.light = uint[3](halves(center.r, center.g), halves(center.b, rim.r), halves(rim.g, rim.b));
}

// The phase of an oscillation at a time after the tick, in turns. A tick is counted in 2^-32 turns, and these integers
// wrap around correctly; seconds since the start of the rain would lose their fraction in a float.
float oscillation_phase(float hz, float time_s)
{
    const uint in_a_tick = uint(fract(hz * tick.tick_s) * 4294967296.0);
    return fract(virga_unit(in_a_tick * tick.tick) + hz * time_s);
}

// The drop's oscillation: second mode, Rayleigh 1879. Drops below about 1 mm are too stiff to show it (Tokay and Beard
// 1996), and where the lens blurs the waves there is none. Drops of the same size oscillate by different amounts
// (Kubesh and Beard 1993): from none to twice the mean here. `times`: from when to when the streak shows it.
void set_wave(inout virga_streak_gpu streak, float diameter_mm, float body_px, float path_px, float blur, vec2 times)
{
    const float radius = 0.5e-3 * diameter_mm;
    const float hz = sqrt(8.0 * 0.0728 / (998.2 * radius * radius * radius)) / 6.2831853;
    const float oscillations = hz * (times.y - times.x);
    streak.oscillations =
        halves(oscillations, fract(virga_unit(virga_hash2(tick.seed, streak.id)) + oscillation_phase(hz, times.x)));
    const float waves_blurred = blur * oscillations / max(path_px, 1.0);
    const float own = 2.0 * virga_unit(virga_hash3(tick.seed, streak.id, 1u));
    const float size = own * clamp(0.16 * (diameter_mm - 0.8), 0.0, 0.45) / (1.0 + 4.0 * waves_blurred * waves_blurred);
    streak.body_wave = halves(max(body_px, blur), size * look.oscillation);
}

// Motion of the whole streak since the previous frame, by what the drop has moved in between.
void write_motion(uint index, vec3 head, vec3 tail, vec3 velocity)
{
    if (look.motion == 0u)
        return;
    const mat4 now = to_mat(view.clip_from_rel), before = to_mat(view.previous_clip_from_rel);
    const vec3 path = velocity * view.frame_interval_s;
    const vec4 clip_head = project(now, head), clip_tail = project(now, tail);
    const vec2 at_head = motion_px(clip_head, project(before, head - path));
    const vec2 at_tail = clip_tail.w < NEAR_W ? at_head : motion_px(clip_tail, project(before, tail - path));
    motions[4u * look.max_streaks + index] = vec4(at_head, at_tail);
}

// A path much shorter than the lens's blur is drawn with 0.7 of the blur's length, so that both ends rise softly: a
// round spot, where it would be a square.
void lengthen_blurred(inout vec2 head, inout vec2 tail, vec2 path_px, float blur)
{
    const float path = length(path_px), wanted = 0.7 * blur;
    if (path >= wanted)
        return;
    const vec2 along = path > 1e-3 ? path_px / path : vec2(0.0, 1.0);
    const vec2 middle = 0.5 * (head + tail), half_way = along * wanted / vec2(view.viewport[2], view.viewport[3]);
    head = middle + half_way;
    tail = middle - half_way;
}

// Projects the path; returns its length on the picture, in pixels.
float project_streak(inout virga_streak_gpu streak, Path path, float blur)
{
    const vec3 head = path.clip_head.xyz / path.clip_head.w, tail = path.clip_tail.xyz / path.clip_tail.w;
    const vec2 shown = (head.xy - tail.xy) * 0.5 * vec2(view.viewport[2], view.viewport[3]);
    vec2 from = tail.xy, to = head.xy;
    lengthen_blurred(to, from, shown, blur);
    streak.head = float[2](to.x, to.y);
    streak.tail = float[2](from.x, from.y);
    streak.depth = float[2](head.z, tail.z);
    streak.distance = float[2](path.clip_head.w, path.clip_tail.w);
    return length(shown);
}

virga_streak_gpu make_streak(uint slot_index, uint index)
{
    virga_streak_gpu streak = empty_streak();
    const uint class_rank = slot_of(slot_index).class_rank;
    const uint size_class = class_rank & 0xffffu;
    const virga_drop_gpu drop = drop_of(slot_index);
    const vec3 at_tick = to_vec(drop.position), velocity = velocity_of(slot_index, size_class);
    Path path = path_of(at_tick, velocity);
    if (max(path.clip_head.w, path.clip_tail.w) < NEAR_W)
        return streak;

    const float depth = 0.5 * (max(path.clip_head.w, NEAR_W) + max(path.clip_tail.w, NEAR_W)), blur = blur_px(depth);
    const float diameter = classes[size_class].diameter_m, mm = diameter * 1e3;
    const float width_px = diameter / (depth * view.pixel_angle), body_px = width_px * axis_ratio(mm);
    const float distance_m = length(0.5 * (path.head + path.tail) + to_vec(view.origin_offset));
    const float near = view.near_fade_m > 0.0 ? clamp(distance_m / view.near_fade_m - 1.0, 0.0, 1.0) : 1.0;
    const float drops = drop_weight(at_tick, slot_level(slot_index), size_class, class_rank >> 16);
    const float path_px = path_in_px(path);
    const float whole = near * limited_coverage(vec2(width_px, body_px), look.parts * path_px, blur, diameter, velocity,
                                                drops);
    const vec2 alpha_longer = view_coverage(whole, body_px, path_px, blur);

    lengthen_path(path, alpha_longer.y);
    const float kept_share = cut_path_at_surface(path, classes[size_class].slant);
    cut_at_near(path);
    if (kept_share < 0.0 || path.clip_head.w < NEAR_W || path.clip_tail.w < NEAR_W)
        return streak;
    const float shown_px = project_streak(streak, path, blur);
    streak.width_alpha = halves(drawn_width(width_px, blur), alpha_longer.x);
    streak.id = drop.id;
    const vec3 head = path.head + to_vec(view.origin_offset), tail = path.tail + to_vec(view.origin_offset);
    write_motion(index, head, tail, velocity);
    set_light(streak, 0.5 * (head + tail));
    const float open_s = view.time_close_s - view.time_open_s, longer_s = open_s * alpha_longer.y;
    const float begin_s = view.time_open_s - 0.5 * (longer_s - open_s);
    set_wave(streak, mm, body_px, shown_px, blur, vec2(begin_s, begin_s + longer_s * kept_share));
    return streak;
}

// Whether a streak is as thin as streaks can be (up to rounding of its half float), so that all lines have the same
// width.
bool is_line(virga_streak_gpu streak)
{
    const float width = unpackHalf2x16(streak.width_alpha).x, body = unpackHalf2x16(streak.body_wave).x;
    const vec2 head = vec2(streak.head[0], streak.head[1]), tail = vec2(streak.tail[0], streak.tail[1]);
    return width <= 1.001 * view.min_width_px && is_whole(head, tail, 0.5 * body + 0.5);
}

// By the streak's middle, clamped to the picture.
uint bucket_of_streak(virga_streak_gpu streak)
{
    if (streak.width_alpha >> 16 == 0u)
        return NOT_DRAWN;
    const vec2 middle = 0.5 * vec2(streak.head[0] + streak.tail[0], streak.head[1] + streak.tail[1]);
    const vec2 areas = vec2(float(AREA_COLUMNS), float(area_rows()));
    const uvec2 area = uvec2(clamp((0.5 * middle + 0.5) * areas, vec2(0.0), areas - 0.5));
    const uint bucket = area.y * AREA_COLUMNS + area.x;
    return look.lines == 0u || is_line(streak) ? bucket : first_bucket_of_quads() + bucket;
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= list.count)
        return;
    virga_streak_gpu streak = make_streak(listed[index], index);
    streak.order = bucket_of_streak(streak);
    streaks[index] = streak;
}
