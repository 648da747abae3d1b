// merge_particles.comp - particles that found another too close merge with it. If that merges itself, they wait for the
// next tick.
// One invocation per particle. Reads: captors. Writes: drops.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#define FEW
#include "live.glsl"
#include "rounds.glsl"

void main()
{
    if (gl_GlobalInvocationID.x >= state.active_particles)
        return;
    const uint slot = slot_of_active(gl_GlobalInvocationID.x), captor = drops[slot].absorbed_by;
    if (captor == NONE || drops[captor].absorbed_by != NONE)
        return;
    transfer_water(captor, drops[slot]);
    clear_slot(slot);
    count(VIRGA_GLASS_MERGED, 1u);
}
