// place_scan.comp - ranks of those that get a place of their own, in the order of seeds. One workgroup; each lane takes
// a run.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "seeds.glsl"
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

// Places that a seed needs: one for the first on an empty cell, and one for each particle.
uint need(uint i)
{
    if (seeds[i].water_nl == 0u)
        return 0u;
    if (seeds[i].cell == NOWHERE)
        return seeds[i].count;
    return claims[seeds[i].cell] == i && occupants[seeds[i].cell] == 0u ? 1u : 0u;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, all = seed_count();
    const uint run = (all + VIRGA_GLASS_GROUP - 1u) / VIRGA_GLASS_GROUP;
    const uint begin = min(lane * run, all), end = min(begin + run, all);
    uint sum = 0u;
    for (uint i = begin; i < end; i++)
        sum += need(i);
    uvec2 total;
    uint rank = scan_group(uvec2(sum, 0u), total).x;
    for (uint i = begin; i < end; i++) {
        const uint needed = need(i);
        const uint occupant = seeds[i].water_nl == 0u || seeds[i].cell == NOWHERE ? 0u : occupants[seeds[i].cell];
        ranks[i] = occupant != 0u ? JOINS | (occupant - 1u) : needed != 0u ? rank : NO_RANK;
        rank += needed;
    }
    if (lane == 0u) {
        state.placed = min(total.x, state.free);
        state.shown = state.alive + state.placed; // free places are taken from the list's first free one on
        state.shown_groups = uint[3]((state.shown + VIRGA_GLASS_GROUP - 1u) / VIRGA_GLASS_GROUP, 1u, 1u);
    }
}
