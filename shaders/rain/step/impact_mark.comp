// impact_mark.comp - marks which of the listed slots have drops that met a surface in this tick. What is marked from
// here on is the list's entries.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_mark.glsl"
#include "impact.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

void main()
{
    const uint entry = gl_GlobalInvocationID.x;
    const bool met = find_hit(listed[min(entry, list.count - 1u)]).met;
    mark_pick(entry < list.count && met ? FIRST_KIND : NOT_PICKED);
}
