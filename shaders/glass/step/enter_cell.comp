// enter_cell.comp - claims of a round are settled: one drop to a cell.
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
    const uint place = awake_place();
    if (place == NOWHERE)
        return;
    const uint before = drops[place].captor;
    if (before < OUTSIDE && (drops[place].kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_PARTICLE)
        claims[claim_of(before, round_index + 1u)] = NOWHERE;
    const uint target = drops[place].target;
    if (target >= OUTSIDE || (drops[place].kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_DROP)
        return;
    passed[drops[place].cell] = tick.tick; // several may write the same into a cell
    passed[target] = tick.tick;
    const uint occupant = occupants[target];
    const bool stays = occupant != 0u && drops[occupant - 1u].target == NOWHERE;
    const uint first = claims[claim_of(target, round_index)];
    if (!stays && first == place) {
        drops[place].from_cell = drops[place].cell;
        drops[place].cell = target;
        return;
    }
    give_to(stays ? occupant - 1u : first, drops[place]);
    end_drop(place);
    count(VIRGA_GLASS_MERGED, 1u);
}
