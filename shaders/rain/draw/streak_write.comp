// streak_write.comp - a streak for each marked slot: where the drop goes while the shutter is open, cut where it meets
// something, and the light in it.
//
// A drop of length D whose middle moves by l while the shutter is open covers a point between its ends for the share
// D / l of the time (all of it where l < D); towards the ends less, over a ramp of the shorter of the two. In all that
// is D x l / l: what the drop covers does not depend on its speed (after Garg and Nayar 2007, who have l >> D). What is
// narrower than the sampling is drawn as wide as that and covers less.
//
// Of a picture that is averaged from several views each shows its part of that way, with as much more coverage. Where a
// streak of a slot that stands for many drops, or one made brighter by streak_gain, would have to cover more than all,
// it covers all and is longer, so that the views' mean is as bright as one view of all of the way.
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
// The same buffer: behind `max_streaks` streaks of four texels each lies a texel for each one's motion.
layout(scalar, set = 0, binding = 7) writeonly buffer Motions { vec4 motions[]; };

#define MOST_COVERAGE 0.25 // of a streak that stands for many: what it would cover beyond is haze, see rain_draw.c

// Cuts the way from `tail` to `head` where it meets a surface. False: nothing of it is under the sky.
bool cut_at_surface(vec3 tail, inout vec3 head, uint slant)
{
    if (tick.maps == 0u)
        return true;
    const float way = tail.y - head.y;
    if (find_shelter(tail, slant).height >= tail.y)
        return false;
    const Shelter below = find_shelter(head, slant);
    if (head.y > below.height)
        return true;
    if (way <= 1e-6 || below.height > tail.y + 0.5 * way)
        return false;
    head = mix(tail, head, clamp((tail.y - below.height) / way, 0.0, 1.0));
    return true;
}

// Height over width; the polynomial of virga_drop_axis_ratio.
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
    streak.turns = 0u;
    streak.order = 0u;
    streak.light = uint[3](0u, 0u, 0u);
    streak.id = 0u;
    return streak;
}

// Coverage from the drop's width, length of its way and weight.
float coverage(float width_px, float body_px, float way_px, float blur, float weight)
{
    const float one = streak_coverage(width_px, body_px, way_px, blur), all = one * weight;
    return min(all, max(one, MOST_COVERAGE)) * clamp(all / LEAST_COVERAGE - 1.0, 0.0, 1.0);
}

// Of this view alone, from that over the whole way of all views' shutters, and how much longer than the drop's way in
// it the streak is.
vec2 part_of_coverage(float whole, float body_px, float way_px, float blur)
{
    const float least = max(body_px, blur), drawn = max(way_px, least);
    const float alpha = whole * max(look.parts * way_px, least) / drawn;
    const float longer = alpha > 1.0 ? alpha * drawn / max(way_px, 1e-3) : 1.0;
    return vec2(min(alpha, 1.0), clamp(longer, 1.0, look.parts));
}

// Where a drop goes while the shutter is open: relative to the tick's origin, and in the camera's clip coordinates, in
// which it is as straight.
struct Way {
    vec3 head, tail;
    vec4 clip_head, clip_tail;
};

Way way_of(vec3 at_tick, vec3 velocity)
{
    Way way;
    way.head = at_tick + velocity * view.time_close_s;
    way.tail = at_tick + velocity * view.time_open_s;
    way.clip_head = project(to_mat(view.clip_from_rel), way.head + to_vec(view.origin_offset));
    way.clip_tail = project(to_mat(view.open_clip_from_rel), way.tail + to_vec(view.origin_offset));
    return way;
}

// The part of it before the near plane.
void cut_at_near(inout Way way)
{
    cut_at_near_plane(way.clip_head, way.clip_tail);
    cut_at_near_plane(way.clip_tail, way.clip_head);
}

float way_in_px(Way way)
{
    cut_at_near(way);
    const vec2 moved = way.clip_head.xy / way.clip_head.w - way.clip_tail.xy / way.clip_tail.w;
    return length(moved * 0.5 * vec2(view.viewport[2], view.viewport[3]));
}

// Around its middle.
void lengthen(inout Way way, float times)
{
    const vec3 further = (0.5 * times - 0.5) * (way.head - way.tail);
    const vec4 clip_further = (0.5 * times - 0.5) * (way.clip_head - way.clip_tail);
    way.head += further;
    way.tail -= further;
    way.clip_head += clip_further;
    way.clip_tail -= clip_further;
}

// Up to where it meets something; returns the share that is left, and -1 where nothing is. A cut streak is as bright
// along its length as the whole one: the drop passed it at the same speed.
float cut_at_what_it_meets(inout Way way, uint slant)
{
    const vec3 whole = way.head;
    if (!cut_at_surface(way.tail, way.head, slant))
        return -1.0;
    const float kept = clamp(distance(way.head, way.tail) / max(distance(whole, way.tail), 1e-6), 0.0, 1.0);
    way.clip_head = mix(way.clip_tail, way.clip_head, kept);
    return kept;
}

void set_light(inout virga_streak_gpu streak, vec3 middle)
{
    const vec3 d = normalize(middle);
    const vec3 glitter = lamps(middle, d);
    // Near the middle rays are bent by up to 16 degrees, at the rim by 50 and more (Legendre: cosines of those).
    const vec3 centre = environment(d, vec2(0.97, 0.90)) + glitter;
    const vec3 rim = environment(d, vec2(view.phase_moment[1], view.phase_moment[2]) * vec2(0.75, 0.3)) + 0.6 * glitter;
    streak.light = uint[3](halves(centre.r, centre.g), halves(centre.b, rim.r), halves(rim.g, rim.b));
}

// Oscillations up to a time after the tick's, less whole ones. A tick has so many 2^32ths of one, and whole numbers of
// these wrap around where they should: seconds since it began to rain would soon have no room for a part of one.
float turn_at(float hz, float time_s)
{
    const uint in_a_tick = uint(fract(hz * tick.tick_s) * 4294967296.0);
    return fract(virga_unit(in_a_tick * tick.tick) + hz * time_s);
}

// Second mode, Rayleigh 1879; drops below about 1 mm are too stiff to show it (Tokay and Beard 1996). Where the lens
// blurs one wave into the next there is none.
// `times`: from when to when the streak shows it.
void set_wave(inout virga_streak_gpu streak, float diameter_mm, float body_px, float way_px, float blur, vec2 times)
{
    const float radius = 0.5e-3 * diameter_mm;
    const float hz = sqrt(8.0 * 0.0728 / (998.2 * radius * radius * radius)) / 6.2831853;
    const float turns = hz * (times.y - times.x);
    streak.turns = halves(turns, fract(virga_unit(virga_hash2(tick.seed, streak.id)) + turn_at(hz, times.x)));
    const float waves_blurred = blur * turns / max(way_px, 1.0);
    const float size = clamp(0.16 * (diameter_mm - 0.8), 0.0, 0.45) / (1.0 + 4.0 * waves_blurred * waves_blurred);
    streak.body_wave = halves(max(body_px, blur), size * look.oscillation);
}

// From where the drop's way is on the picture to where it was when the previous frame was drawn: the whole streak,
// which has gone on by what the drop has in between.
void write_motion(uint index, vec3 head, vec3 tail, vec3 velocity)
{
    if (look.motion == 0u)
        return;
    const mat4 now = to_mat(view.clip_from_rel), before = to_mat(view.previous_clip_from_rel);
    const vec3 way = velocity * view.ago_s;
    const vec4 clip_head = project(now, head), clip_tail = project(now, tail);
    const vec2 at_head = motion_px(clip_head, project(before, head - way));
    const vec2 at_tail = clip_tail.w < NEAR_W ? at_head : motion_px(clip_tail, project(before, tail - way));
    motions[4u * look.max_streaks + index] = vec4(at_head, at_tail);
}

// A way much shorter than what the lens blurs a point to is drawn as long as 0.7 of that, so that both ends rise
// slowly: a soft spot, where it would be a square.
void round_off(inout vec2 head, inout vec2 tail, vec2 way_px, float blur)
{
    const float way = length(way_px), wanted = 0.7 * blur;
    if (way >= wanted)
        return;
    const vec2 along = way > 1e-3 ? way_px / way : vec2(0.0, 1.0);
    const vec2 middle = 0.5 * (head + tail), half_way = along * wanted / vec2(view.viewport[2], view.viewport[3]);
    head = middle + half_way;
    tail = middle - half_way;
}

// Where it is drawn; returns its length on the picture, in pixels.
float place_streak(inout virga_streak_gpu streak, Way way, float blur)
{
    const vec3 head = way.clip_head.xyz / way.clip_head.w, tail = way.clip_tail.xyz / way.clip_tail.w;
    const vec2 shown = (head.xy - tail.xy) * 0.5 * vec2(view.viewport[2], view.viewport[3]);
    vec2 from = tail.xy, to = head.xy;
    round_off(to, from, shown, blur);
    streak.head = float[2](to.x, to.y);
    streak.tail = float[2](from.x, from.y);
    streak.depth = float[2](head.z, tail.z);
    streak.distance = float[2](way.clip_head.w, way.clip_tail.w);
    return length(shown);
}

virga_streak_gpu make_streak(uint slot_index, uint index)
{
    virga_streak_gpu streak = empty_streak();
    const uint class_rank = slot_of(slot_index).class_rank;
    const uint size_class = class_rank & 0xffffu;
    const virga_drop_gpu drop = drop_of(slot_index);
    const vec3 at_tick = to_vec(drop.position), velocity = velocity_of(slot_index, size_class);
    Way way = way_of(at_tick, velocity);
    if (max(way.clip_head.w, way.clip_tail.w) < NEAR_W)
        return streak;

    const float depth = 0.5 * (max(way.clip_head.w, NEAR_W) + max(way.clip_tail.w, NEAR_W)), blur = blur_px(depth);
    const float diameter = classes[size_class].diameter_m, mm = diameter * 1e3;
    const float width_px = diameter / (depth * view.pixel_angle), body_px = width_px * axis_ratio(mm);
    const float distance_m = length(0.5 * (way.head + way.tail) + to_vec(view.origin_offset));
    const float near = view.near_m > 0.0 ? clamp(distance_m / view.near_m - 1.0, 0.0, 1.0) : 1.0;
    const float weight = near * drop_weight(at_tick, slot_level(slot_index), size_class, class_rank >> 16);
    const float way_px = way_in_px(way);
    const float whole = coverage(width_px, body_px, look.parts * way_px, blur, weight);
    const vec2 alpha_longer = part_of_coverage(whole, body_px, way_px, blur);

    lengthen(way, alpha_longer.y);
    const float kept = cut_at_what_it_meets(way, classes[size_class].slant);
    cut_at_near(way);
    if (kept < 0.0 || way.clip_head.w < NEAR_W || way.clip_tail.w < NEAR_W)
        return streak;
    const float shown_px = place_streak(streak, way, blur);
    streak.width_alpha = halves(drawn_width(width_px, blur), alpha_longer.x);
    streak.id = drop.id;
    const vec3 head = way.head + to_vec(view.origin_offset), tail = way.tail + to_vec(view.origin_offset);
    write_motion(index, head, tail, velocity);
    set_light(streak, 0.5 * (head + tail));
    const float open_s = view.time_close_s - view.time_open_s, longer_s = open_s * alpha_longer.y;
    const float begin_s = view.time_open_s - 0.5 * (longer_s - open_s);
    set_wave(streak, mm, body_px, shown_px, blur, vec2(begin_s, begin_s + longer_s * kept));
    return streak;
}

// As thin as streaks are drawn (but for how its half float is rounded), so that all lines have one width.
bool is_line(virga_streak_gpu streak)
{
    const float width = unpackHalf2x16(streak.width_alpha).x, body = unpackHalf2x16(streak.body_wave).x;
    const vec2 head = vec2(streak.head[0], streak.head[1]), tail = vec2(streak.tail[0], streak.tail[1]);
    return width <= 1.001 * view.min_width_px && is_whole(head, tail, 0.5 * body + 0.5);
}

// By its middle; what is beyond the picture counts as at its border.
uint bucket_of(virga_streak_gpu streak)
{
    if (streak.width_alpha >> 16 == 0u)
        return NOT_DRAWN;
    const vec2 middle = 0.5 * vec2(streak.head[0] + streak.tail[0], streak.head[1] + streak.tail[1]);
    const vec2 areas = vec2(float(AREAS_ACROSS), float(areas_down()));
    const uvec2 area = uvec2(clamp((0.5 * middle + 0.5) * areas, vec2(0.0), areas - 0.5));
    const uint bucket = area.y * AREAS_ACROSS + area.x;
    return look.lines == 0u || is_line(streak) ? bucket : first_bucket_of_quads() + bucket;
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= list.count)
        return;
    virga_streak_gpu streak = make_streak(listed[index], index);
    streak.order = bucket_of(streak);
    streaks[index] = streak;
}
