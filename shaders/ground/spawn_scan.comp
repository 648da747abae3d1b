// spawn_scan.comp - prefix sum over the pieces that splash: the index of each impact's first spawn, in the order of
// impacts.
// One workgroup, in which each invocation takes a run of impacts. Reads: landings. Writes: landings, the spawns' head.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"
#include "spawns.glsl"
#define SOFTWARE_LANES VIRGA_GROUND_GROUP
#include "gpu/long_scan.glsl"

layout(scalar, set = 0, binding = 10) buffer Landings { virga_landing_gpu landings[]; };

#define MIN_NEAR_M 0.25
#define MAX_NEAR_M 1000.0

shared uint filled;

// The radius within which all drops splash follows the quota; the number of splashes beyond it grows with its square
// too. Near the quota it follows slowly: one that answers to the chance of each tick would double its variance.
float next_near(float near_m, float found)
{
    const float ratio = rules.quota / max(found, 1.0);
    const float gain = mix(0.1, 1.0, smoothstep(0.2, 0.7, abs(log(ratio))));
    const float wanted = near_m * sqrt(clamp(pow(ratio, gain), 0.8, 1.1));
    return clamp(wanted, MIN_NEAR_M, MAX_NEAR_M);
}

// Pieces of an impact that splash; NO_SPAWN if it is not of this tick. All is read at once, as the pass takes as long
// as the reads of an invocation that wait for each other.
uint splashes_of(uint index)
{
    const uint fallen = impacts[index].tick, material = impacts[index].material;
    const uint splashing = landings[landing_index(index)].splashing;
    const bool is_return = head.is_return != 0u, of_tick = fallen == tick.tick;
    const bool no_pane = VIRGA_IMPACT_PANE(material) == 0u;
    return (is_return && no_pane) || (!is_return && of_tick) ? uint(bitCount(splashing)) : NO_SPAWN;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, run = (head_count() + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, head_count()), end = min(begin + run, head_count());
    uint sum = 0u;
    for (uint i = begin; i < end; i++) {
        const uint count = splashes_of(i);
        sum += count != NO_SPAWN ? count : 0u;
    }
    if (lane == 0u)
        filled = tick.max_spawns;
    uvec2 all;
    const uint before_lane = scan_group(uvec2(sum, 0u), all).x, found = all.x;
    const bool first = tick.tick_in_step == 0u && head.is_return == 0u;
    const uint before = first ? 0u : spawns_head.count;
    uint spawn_index = before + before_lane;
    for (uint i = begin; i < end; i++) {
        const uint count = splashes_of(i);
        if (count == NO_SPAWN)
            continue;
        const bool fits = spawn_index + count <= tick.max_spawns;
        if (!fits)
            atomicMin(filled, spawn_index); // impacts from the first that does not fit on get none
        landings[landing_index(i)].first_spawn = count > 0u && fits ? spawn_index : NO_SPAWN;
        spawn_index += count;
    }
    barrier();
    if (lane != 0u)
        return;
    const uint count = min(before + found, filled);
    spawns_head.count = count;
    spawns_head.dropped = (first ? 0u : spawns_head.dropped) + (before + found - count);
    spawns_head.capacity = tick.max_spawns;
    spawns_head.tick_s = tick.tick_s;
    spawns_head.group_count = uint[3]((count + 63u) / 64u, 1u, 1u);
    spawns_head.ticks = tick.tick_in_step + 1u;
    if (first)
        spawns_head.first_tick = tick.tick;
    if (head.is_return == 0u) {
        spawns_head.origin = head.origin;
        // land.comp uses the radius that spawn_mark.comp decided with.
        spawns_head.near_of_tick_m = spawns_head.near_m;
        spawns_head.drops_of_tick = found;
    }
    // Those of droplets that fall back count too.
    const float spawned = float(found) + (head.is_return == 0u ? 0.0 : float(spawns_head.drops_of_tick));
    spawns_head.near_m = next_near(spawns_head.near_of_tick_m, spawned);
}
