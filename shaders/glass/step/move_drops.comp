// move_drops.comp - all rounds of movement in one workgroup, in place of a call of choose_cell.comp and enter_cell.comp
// for each. A GPU waits several microseconds between calls, and a drop needs less in a round. See rounds.glsl.
// One workgroup. Reads and writes: as choose_cell.comp and enter_cell.comp.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define ONE_WORKGROUP
#include "pane.glsl"
#include "counters.glsl"
#include "live.glsl"
#include "rounds.glsl"
#include "choose_cell.glsl"
#include "enter_cell.glsl"

void wait_for_all()
{
    memoryBarrierBuffer();
    barrier();
}

void main()
{
    const uint count = state.active_count, needed = state.max_rounds, lane = gl_LocalInvocationIndex;
    for (round_index = 0u; round_index <= rounds; round_index++) {
        if (round_index > needed && round_index < rounds)
            continue; // nothing is left to move
        for (uint entry = lane; entry < count; entry += VIRGA_GLASS_GROUP)
            choose_cell(entry);
        wait_for_all();
        if (round_index == rounds)
            break;
        for (uint entry = lane; entry < count; entry += VIRGA_GLASS_GROUP)
            enter_cell(entry);
        wait_for_all();
    }
}
