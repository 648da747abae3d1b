// impact_find.comp - marks the slots whose drops met a surface in this tick.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "field.glsl"
#include "scan_buffers.glsl"
#include "impact.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

void main()
{
    const Hit hit = find_hit(gl_GlobalInvocationID.x, gl_WorkGroupID.x / tick.groups_per_level);
    mark_pick(hit.weight > 0.0);
}
