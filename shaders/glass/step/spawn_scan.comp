// spawn_scan.comp - ranks of those that get a place of their own, in the order of seeds, and how far the next tick has
// to look for places in use. One workgroup; each lane takes a run.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "seeds.glsl"
#include "gpu/group_scan.glsl"
#include "shared/compact.h"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 4) buffer List
{
    virga_list_gpu list;
    uint listed[];
};

// Places that a seed needs: one for the first on an empty cell, and one for each particle.
uint need(uint i)
{
    if (seeds[i].water_nl == 0u)
        return 0u;
    if (seeds[i].cell == NOWHERE)
        return seeds[i].count;
    return claims[seeds[i].cell] == i && occupants[seeds[i].cell] == 0u ? 1u : 0u;
}

// Places from the first on among which are all in use at the tick's end, `placed` of them new.
uint reach(uint placed)
{
    const uint listed_groups = state.census_groups[0] * VIRGA_GLASS_GROUP;
    if (placed > state.free_listed)
        return listed_groups + placed - state.free_listed;
    const uint last = state.alive > 0u ? listed[state.alive - 1u] + 1u : 0u;
    return max(last, placed > 0u ? listed[state.alive + placed - 1u] + 1u : 0u);
}

uint[3] groups_of(uint invocations)
{
    return uint[3]((invocations + VIRGA_GLASS_GROUP - 1u) / VIRGA_GLASS_GROUP, 1u, 1u);
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
    const uint placed = min(total.x, state.free), beyond = state.census_groups[0] * VIRGA_GLASS_GROUP;
    for (uint i = state.free_listed + lane; i < placed; i += VIRGA_GLASS_GROUP)
        listed[state.alive + i] = beyond + i - state.free_listed;
    barrier(); // all have read how far the list went
    if (lane == 0u) {
        const uint to = reach(placed);
        state.placed = placed;
        state.shown = state.alive + placed; // free places are taken from the list's first free one on
        state.shown_groups = groups_of(state.shown);
        state.census_groups = groups_of(to);
    }
}
