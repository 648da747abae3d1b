// hit_mark.comp - hits, mark: selects the slots of which a drop may have hit the pane in the newest step.
// One invocation per slot. Reads: slots, drops, the pane. Writes: selection.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_mark.glsl"
#include "hit.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

void main()
{
    begin_list(pane.groups * VIRGA_RAIN_GROUP);
    mark_selected(start_traversal(slot_at(gl_GlobalInvocationID.x)).has_next ? FIRST_KIND : NOT_SELECTED);
}
