// adopt_end.comp - ends a step: droplets that were taken are in the air, and the list of the next step has room for as
// many as there are free slots, without those that are kept for drops from edges.
// One invocation. Reads and writes: state, the list's head.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#include "counters.glsl"
#include "handed.glsl"
#include "view_groups.glsl"

layout(local_size_x = 1) in;

void main()
{
    const uint taken = handed_count();
    state.staying += taken;
    count(VIRGA_SPLASH_DROPLETS, taken);
    set_view_groups(state.staying);
    handed_head.count = 0u;
    if (tick.drip_sites == 0u)
        handed_head.drips = 0u;
    const uint room = min(tick.max_handed, tick.max_droplets - state.staying);
    handed_head.capacity = room - min(kept_for_drips(), room);
    handed_head.group_count = uint[3](0u, 1u, 1u);
}
