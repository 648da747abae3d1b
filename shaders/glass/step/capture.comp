// capture.comp - drops that were marked merge with their captor. If the captor is captured itself, they wait for the
// next tick.
// One invocation per live slot. Reads: captors. Writes: drops, occupants, passed.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "live.glsl"
#include "rounds.glsl"

void main()
{
    const uint slot = live_slot();
    if (slot == NONE)
        return;
    const uint absorbed_by = drops[slot].absorbed_by;
    if (absorbed_by == NONE)
        return;
    if (drops[absorbed_by].absorbed_by != NONE) {
        drops[slot].kind |= VIRGA_GLASS_CHANGED;
        return;
    }
    const virga_glass_drop_gpu drop = drops[slot];
    if (kind_of(drop) != VIRGA_GLASS_DROP)
        return;
    transfer_water(drop.absorbed_by, drop);
    clear_slot(slot);
    occupants[drop.cell] = 0u;
    passed[drop.cell] = wetted_now();
    count(VIRGA_GLASS_MERGED, 1u);
}
