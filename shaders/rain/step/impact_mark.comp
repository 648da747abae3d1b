// impact_mark.comp - impacts, second list, mark: selects the entries of the first list whose drop did hit a surface.
// One invocation per entry. Reads: the list, drops, occlusion maps. Writes: selection.
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
    const bool met = test_drop(listed[min(entry, list.count - 1u)]).met;
    mark_selected(entry < list.count && met ? FIRST_KIND : NOT_SELECTED);
}
