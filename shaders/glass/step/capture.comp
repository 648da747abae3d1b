// capture.comp - drops that were found merge with their captor, unless that is taken in itself: then they wait a tick,
// and look again.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "live.glsl"
#include "rounds.glsl"

void main()
{
    const uint place = alive_place();
    if (place == NOWHERE)
        return;
    const uint captor = drops[place].captor;
    if (captor == NOWHERE)
        return;
    if (drops[captor].captor != NOWHERE) {
        drops[place].kind |= VIRGA_GLASS_CHANGED;
        return;
    }
    const virga_glass_drop_gpu drop = drops[place];
    if (kind_of(drop) != VIRGA_GLASS_DROP)
        return;
    give_to(drop.captor, drop);
    end_drop(place);
    occupants[drop.cell] = 0u;
    passed[drop.cell] = tick.tick;
    count(VIRGA_GLASS_MERGED, 1u);
}
