// streak_mark.comp - streaks, mark: selects the slots whose drops a view may see. Second kind: wide streaks.
// One invocation per slot. Reads: slots, drops. Writes: selection; on GPUs the counts of order_count.comp (cleared).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "view.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_mark.glsl"
#include "order.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

// Whether both ends are beyond the same side of the picture, by more than `m`. In clip coordinates, where the sides are
// planes.
bool is_outside(vec4 head, vec4 tail, vec2 m)
{
    const vec2 high = min(head.xy - head.w, tail.xy - tail.w), low = min(-head.xy - head.w, -tail.xy - tail.w);
    return max(head.w, tail.w) < NEAR_W || any(greaterThan(high, m)) || any(greaterThan(low, m));
}

// Without branches: software Vulkan runs every lane through all of them, and reads buffers faster outside.
uint kind_of_streak(uint slot_index)
{
    const uint class_rank = slot_of(slot_index).class_rank;
    const uint size_class = class_rank & 0xffffu;
    const float diameter = classes[size_class].diameter_m;
    const vec3 velocity = velocity_of(slot_index, size_class);
    const vec3 at_tick = to_vec(drop_of(slot_index).position);
    const float weight = drop_weight(at_tick, slot_level(slot_index), size_class, class_rank >> 16);
    const vec3 p = at_tick + to_vec(view.origin_offset);
    const vec4 head = to_mat(view.clip_from_rel) * vec4(p + velocity * view.time_close_s, 1.0);
    const vec4 tail = to_mat(view.open_clip_from_rel) * vec4(p + velocity * view.time_open_s, 1.0);
    const float nearest = max(min(head.w, tail.w), 0.1);
    const float width_px = diameter / (nearest * view.pixel_angle);
    const float depth = 0.5 * (max(head.w, NEAR_W) + max(tail.w, NEAR_W)), blur = blur_px(depth);
    // As far as streak_write.comp may lengthen it.
    const vec4 beyond = (0.5 * look.parts - 0.5) * (head - tail);
    // Half of the drop and a pixel, seen at the end that is farther away.
    const vec2 margin = (width_px + blur + 2.0) * max(head.w, tail.w) / vec2(view.viewport[2], view.viewport[3]);
    // As in streak_write.comp, by the visible length of the path: seen along its fall, a drop hardly moves and covers
    // more.
    const float head_w = max(head.w, NEAR_W), tail_w = max(tail.w, NEAR_W);
    const vec2 moved = (head.xy / head_w - tail.xy / tail_w) * 0.5 * vec2(view.viewport[2], view.viewport[3]);
    const float path_px = min(head.w, tail.w) < NEAR_W ? 0.0 : length(moved);
    const float body_px = diameter / (depth * view.pixel_angle);
    const bool visible = !is_outside(head + beyond, tail - beyond, margin) && diameter >= look.streak_min_m &&
                         limited_coverage(vec2(body_px), look.parts * path_px, blur, diameter, velocity, weight) > 0.0;
    return !visible ? NOT_SELECTED : max(width_px, blur) > WIDE_PX ? SECOND_KIND : FIRST_KIND;
}

void main()
{
    const uint slot_index = gl_GlobalInvocationID.x;
    begin_list(look.max_streaks);
    if (FOR_GPU && gl_WorkGroupID.x == 0u)
        order[total_index(gl_LocalInvocationIndex)] = 0u; // for order_count.comp
    mark_selected(kind_of_streak(slot_index));
}
