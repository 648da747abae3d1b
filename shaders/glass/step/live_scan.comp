// live_scan.comp - live list, second pass: prefix sum, and the sizes of the tick's dispatches. For software Vulkan: on
// a GPU live_compact.comp does it.
// One workgroup. Reads: selection. Writes: selection, the list's head, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "live_list.glsl"
#include "gpu/compact_scan.glsl"
#include "live_counts.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

void main()
{
    const uvec2 found = scan_selection(state.live_list_groups[0], tick.pane.max_drops);
    if (gl_LocalInvocationIndex == 0u)
        write_live_counts(found);
}
