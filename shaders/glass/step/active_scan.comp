// active_scan.comp - list of active slots, second pass (begin_tick.comp is the first): prefix sum, and the sizes of the
// dispatches that follow. For software Vulkan: on a GPU active_compact.comp does it.
// One workgroup. Reads: selection, the host's impacts. Writes: selection, the list's head, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#define COMPACT_GROUP VIRGA_GLASS_GROUP
#define COMPACT_SELECTION_BINDING 3
#define COMPACT_LIST_BINDING 16
#include "gpu/compact_scan.glsl"
#include "active_counts.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

void main()
{
    const uvec2 found = scan_selection(state.alive_groups[0], tick.pane.max_drops);
    if (gl_LocalInvocationIndex == 0u)
        write_active_counts(found);
}
