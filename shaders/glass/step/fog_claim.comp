// fog_claim.comp - drops claim the cells whose fog they take. See fog_drops.glsl.
// One invocation per live slot. Reads: drops, fog. Writes: claims.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "live.glsl"
#include "fog.glsl"
#include "fog_drops.glsl"

void main()
{
    const uint slot = live_slot();
    if (slot == NONE || !clears_fog(drops[slot].kind))
        return;
    const Sweep sweep = sweep_of(slot);
    for (int y = sweep.low.y; y <= sweep.high.y; y++)
        for (int x = sweep.low.x; x <= sweep.high.x; x++) {
            const uint cell = cell_number(ivec2(x, y));
            if (film[fog_word(cell)] != 0u && is_cleared(sweep, slot, cell))
                atomicMin(claims[cell], slot);
        }
}
