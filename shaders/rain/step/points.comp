// points.comp - writes every slot's drop in full, for hosts that read points.
// One invocation per slot. Reads: slots, drops, occlusion maps. Writes: points.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "shared/point.h"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 13) writeonly buffer Points { virga_point_gpu points[]; };

void main()
{
    const uint index = gl_GlobalInvocationID.x, level = slot_level(index);
    const uint class_rank = slot_of(index).class_rank, size_class = class_rank & 0xffffu;
    const vec3 p = to_vec(drop_of(index).position);
    const vec3 velocity = velocity_of(index, size_class);
    float weight = drop_weight(p, level, size_class, class_rank >> 16);
    if (weight > 0.0 && find_cover(p, classes[size_class].slant).height >= p.y)
        weight = 0.0;
    const float top_m = 0.5 * tick.side_m * exp2(float(level + 1u) - float(tick.levels));
    virga_point_gpu point;
    point.position = drop_of(index).position;
    point.diameter_m = classes[size_class].diameter_m;
    point.velocity = float[3](velocity.x, velocity.y, velocity.z);
    point.weight = weight;
    point.id = drop_of(index).id;
    point.age_s = (top_m - p.y) / max(-velocity.y, 0.05);
    point.pad = uint[2](0u, 0u);
    points[index] = point;
}
