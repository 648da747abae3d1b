// scan.comp - the list of splash particles, second pass.
// One workgroup, in which each invocation takes a run of words. Reads and writes: selection, the list's head, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 7
#define COMPACT_LIST_BINDING 9
#include "gpu/compact_scan.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uvec2 kinds = scan_selection(grid.sorted_groups[0], frame.max_splashes);
    const uint found = kinds.x + kinds.y;
    if (gl_LocalInvocationIndex != 0u)
        return;
    state.splash_serials[state.splash_half] = frame.serial;
    state.splash_times[state.splash_half] = frame.time_s;
    leavers.half_now = state.splash_half;
    leavers.max = frame.max_splashes;
    leavers.mask = frame.splash_mask;
    leavers.count = min(found, frame.max_splashes);
    state.splashes_wanted = found;
    state.splashes = min(found, frame.max_splashes);
    const uint words = grid.sorted_groups[0] * (VIRGA_WATER_LANES / 32u);
    state.spray_word_groups = uint[3]((words + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES, 1u, 1u);
}
