// active_compact.comp - list of active slots, third pass: writes their indices in the live list, particles first. On a
// GPU the second pass, too.
// One invocation per live slot. Reads: selection; (GPU) the host's impacts. Writes: the active list; (GPU) its head,
// state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#define COMPACT_GROUP VIRGA_GLASS_GROUP
#define COMPACT_SELECTION_BINDING 3
#define COMPACT_LIST_BINDING 16
#include "gpu/compact_summed.glsl"
#include "active_counts.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

void main()
{
    if (!FOR_GPU) {
        write_slot(gl_GlobalInvocationID.x);
        return;
    }
    const uint groups = state.alive_groups[0];
    if (gl_WorkGroupID.x >= max(groups, 1u))
        return;
    const uvec2 found = write_summed_slots(groups);
    if (gl_GlobalInvocationID.x == 0u)
        write_active_counts(found);
}
