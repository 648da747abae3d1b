// live_compact.comp - live list, third pass: writes the slots. On a GPU the second pass, too.
// One invocation per slot. Reads: selection. Writes: the live list; (GPU) its head, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "live_list.glsl"
#include "gpu/compact_summed.glsl"
#include "live_counts.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

void main()
{
    if (!FOR_GPU) {
        write_slot(gl_GlobalInvocationID.x);
        return;
    }
    const uint groups = state.live_list_groups[0];
    if (gl_WorkGroupID.x >= max(groups, 1u))
        return;
    const uvec2 found = write_summed_slots(groups);
    if (gl_GlobalInvocationID.x == 0u)
        write_live_counts(found);
}
