// spawn_scan.comp - prefix sum over the slots that seeds need, in the order of seeds; and the number of slots that the
// next tick has to scan. Clears the sums of the water.
// One workgroup, in which each invocation takes a run of seeds. Reads: seeds, claims, occupants. Writes: ranks, the
// live list (new slots), state.
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

// Slots that a seed needs: one for the winner of an empty cell, and one for each particle.
uint slots_needed(uint i)
{
    if (seeds[i].water_nl == 0u)
        return 0u;
    if (seeds[i].cell == NONE)
        return seeds[i].count;
    return claims[seeds[i].cell] == i && occupants[seeds[i].cell] == 0u ? 1u : 0u;
}

// The number of slots, from the first on, that contain all slots in use at the end of the tick. `spawned`: how many of
// these are new.
uint slots_to_scan(uint spawned)
{
    const uint listed_groups = state.live_list_groups[0] * VIRGA_GLASS_GROUP;
    if (spawned > state.free_listed)
        return listed_groups + spawned - state.free_listed;
    const uint last = state.alive > 0u ? listed[state.alive - 1u] + 1u : 0u;
    return max(last, spawned > 0u ? listed[state.alive + spawned - 1u] + 1u : 0u);
}

uint[3] groups_of(uint invocations)
{
    return uint[3]((invocations + VIRGA_GLASS_GROUP - 1u) / VIRGA_GLASS_GROUP, 1u, 1u);
}

// Clears what film_compact.comp and measure.comp add up at the end of a step.
void begin_measuring()
{
    const virga_glass_count_gpu none = virga_glass_count_gpu(0u, 0u);
    state.drops = state.particles = state.particles_waiting = 0u;
    state.measured = virga_glass_count_gpu[3](none, none, none);
    state.film_blocks = state.measure_groups[0] = 0u;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, all = seed_count();
    const uint run = (all + VIRGA_GLASS_GROUP - 1u) / VIRGA_GLASS_GROUP;
    const uint begin = min(lane * run, all), end = min(begin + run, all);
    uint sum = 0u;
    for (uint i = begin; i < end; i++)
        sum += slots_needed(i);
    uvec2 total;
    uint rank = scan_group(uvec2(sum, 0u), total).x;
    for (uint i = begin; i < end; i++) {
        const uint needed = slots_needed(i);
        const uint occupant = seeds[i].water_nl == 0u || seeds[i].cell == NONE ? 0u : occupants[seeds[i].cell];
        ranks[i] = occupant != 0u ? JOINS | (occupant - 1u) : needed != 0u ? rank : NO_RANK;
        rank += needed;
    }
    const uint spawned = min(total.x, state.free), beyond = state.live_list_groups[0] * VIRGA_GLASS_GROUP;
    for (uint i = state.free_listed + lane; i < spawned; i += VIRGA_GLASS_GROUP)
        listed[state.alive + i] = beyond + i - state.free_listed;
    barrier(); // until all have read how far the list went
    if (lane == 0u) {
        const uint scanned = slots_to_scan(spawned);
        state.spawned = spawned;
        state.shown = state.alive + spawned; // the first free slots of the list are used
        state.shown_groups = groups_of(state.shown);
        state.live_list_groups = groups_of(scanned);
        begin_measuring();
    }
}
