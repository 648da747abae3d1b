// fog_take.comp - drops take the fog that they claimed, and free the claims. See fog_drops.glsl.
// One invocation per live slot. Reads: claims. Writes: drops, fog, claims, counters.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "live.glsl"
#include "fog.glsl"
#include "fog_drops.glsl"

void take_claimed(uint slot)
{
    const Sweep sweep = sweep_of(slot);
    uint water = 0u;
    for (int y = sweep.low.y; y <= sweep.high.y; y++)
        for (int x = sweep.low.x; x <= sweep.high.x; x++) {
            const uint cell = cell_number(ivec2(x, y));
            if (claims[cell] != slot)
                continue;
            claims[cell] = NONE;
            water += take_fog(cell);
        }
    drops[slot].water_nl += water;
}

void main()
{
    begin_fog_sums();
    const uint slot = live_slot();
    if (slot != NONE && clears_fog(drops[slot].kind))
        take_claimed(slot);
    end_fog_sums();
}
