// block_scan.comp - the list of blocks, second pass.
// One workgroup, in which each invocation takes a run of words. Reads and writes: selection, the list's head, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#include "water/state.glsl"
#include "water/list_groups.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 8
#define COMPACT_LIST_BINDING 10
#include "gpu/compact_scan.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint found = scan_selection(grid.cell_groups[0], frame.max_blocks).x;
    if (gl_LocalInvocationIndex != 0u)
        return;
    state.blocks_wanted = found;
    state.blocks = min(found, frame.max_blocks);
    state.block_lane_groups = uint[3]((state.blocks + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES, 1u, 1u);
    state.block_groups = list_groups(state.blocks);
}
