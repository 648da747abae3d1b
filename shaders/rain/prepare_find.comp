// prepare_find.comp - marks the slots whose drops a view may see.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "field.glsl"
#include "view.glsl"
#include "scan_buffers.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 3) readonly buffer Drops { virga_drop_gpu drops[]; };

bool may_be_seen(uint slot_index, uint level)
{
    const uint class_rank = slots[slot_index].class_rank;
    const uint size_class = class_rank & 0xffffu;
    const float diameter = classes[size_class].diameter_m;
    const vec3 at_tick = to_vec(drops[slot_index].position);
    const float weight = drop_weight(at_tick, level, size_class, class_rank >> 16);
    if (weight <= 0.0 || diameter < view.bodies_min_m)
        return false;
    const vec3 velocity = to_vec(classes[size_class].velocity);
    const vec3 p = at_tick + velocity * view.time_close_s + to_vec(view.origin_offset);
    // A cone around the view, widened by the way that the drop moves while the shutter is open.
    const float depth = dot(p, to_vec(view.ahead));
    const float slack = 0.5 + 10.0 * (view.time_close_s - view.time_open_s);
    const float off_axis = length(p - depth * to_vec(view.ahead));
    if (depth < -slack || off_axis > depth * view.tangent + slack)
        return false;
    const float width_px = diameter / (max(depth, 0.1) * view.pixel_angle);
    const float way = length(velocity) * (view.time_close_s - view.time_open_s);
    return weight * streak_coverage(width_px, diameter, way) > LEAST_COVERAGE;
}

void main()
{
    mark_pick(may_be_seen(gl_GlobalInvocationID.x, gl_WorkGroupID.x / tick.groups_per_level));
}
