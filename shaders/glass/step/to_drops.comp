// to_drops.comp - of the particles that claimed a cell, the winner becomes a drop, or merges with the drop that is
// there.
// One invocation per particle. Reads: claims. Writes: drops, occupants.
// Paper: Goto et al. 2009, section 4.5.
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
    const uint slot = slot_of_active(gl_GlobalInvocationID.x);
    const virga_glass_drop_gpu drop = drops[slot];
    if (kind_of(drop) != VIRGA_GLASS_PARTICLE || drop.target == NONE || claims[cell_count() + drop.target] != slot)
        return;
    const uint occupant = occupants[drop.target];
    count(VIRGA_GLASS_TO_DROPS, 1u);
    if (occupant != 0u) {
        transfer_water(occupant - 1u, drop);
        clear_slot(slot);
        count(VIRGA_GLASS_MERGED, 1u);
        return;
    }
    occupants[drop.target] = slot + 1u;
    drops[slot].cell = drops[slot].from_cell = drop.target;
    drops[slot].progress_m = 0.0;
    drops[slot].tail_spacing_m = 0.0;
    drops[slot].strain = drops[slot].tail = drops[slot].outline_tick = 0u;
    drops[slot].kind = VIRGA_GLASS_DROP | VIRGA_GLASS_CHANGED;
}
