// prepare_find.comp - marks the slots whose drops a view may see.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "field.glsl"
#include "view.glsl"
#include "find.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 3) readonly buffer Drops { virga_drop_gpu drops[]; };

// Without branches: software Vulkan runs every lane through all of them, and reads buffers faster outside.
uint kind_of_streak(uint slot_index)
{
    const uint class_rank = slots[slot_index].class_rank;
    const uint size_class = class_rank & 0xffffu;
    const float diameter = classes[size_class].diameter_m;
    const vec3 velocity = to_vec(classes[size_class].velocity);
    const vec3 at_tick = to_vec(drops[slot_index].position);
    const float weight = drop_weight(at_tick, slot_level(slot_index), size_class, class_rank >> 16);
    const vec3 p = at_tick + velocity * view.time_close_s + to_vec(view.origin_offset);
    // A cone around the view, widened by the way that the drop moves while the shutter is open.
    const float depth = dot(p, to_vec(view.ahead));
    const float slack = 0.5 + 10.0 * (view.time_close_s - view.time_open_s);
    const float off_axis = length(p - depth * to_vec(view.ahead));
    const float width_px = diameter / (max(depth, 0.1) * view.pixel_angle);
    const float way = length(velocity) * (view.time_close_s - view.time_open_s);
    const bool seen = depth >= -slack && off_axis <= depth * view.tangent + slack && diameter >= view.bodies_min_m &&
                      weight * streak_coverage(width_px, diameter, way) > LEAST_COVERAGE;
    return !seen ? NOT_PICKED : width_px > WIDE_PX ? SECOND_KIND : FIRST_KIND;
}

void main()
{
    const uint slot_index = gl_GlobalInvocationID.x;
    mark_pick(kind_of_streak(slot_index));
}
