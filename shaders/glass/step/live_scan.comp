// live_scan.comp - live list, second pass: prefix sum, and the sizes of the tick's dispatches.
// One workgroup. Reads: selection. Writes: selection, the list's head, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "live_list.glsl"
#include "gpu/compact_scan.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

uint[3] groups_of(uint invocations)
{
    return uint[3]((invocations + VIRGA_GLASS_GROUP - 1u) / VIRGA_GLASS_GROUP, 1u, 1u);
}

void main()
{
    const uvec2 found = scan_selection(state.live_list_groups[0], tick.pane.max_drops);
    if (gl_LocalInvocationIndex != 0u)
        return;
    state.alive = found.y;
    state.free = tick.pane.max_drops - found.y;
    state.free_listed = found.x;
    state.max_rounds = 0u;
    state.max_nl = 0u;
    state.alive_groups = groups_of(found.y);
}
