// impact_near_mark.comp - impacts, first list, mark: selects the slots whose drops may have hit a surface in this tick.
// One invocation per slot. Reads: slots, drops, occlusion maps. Writes: selection.
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
    begin_list(tick.groups * VIRGA_RAIN_GROUP);
    mark_selected(is_near_surface(gl_GlobalInvocationID.x) ? FIRST_KIND : NOT_SELECTED);
}
