// fall_scan.comp - compaction of droplets: prefix sum of the marks. Where droplets are few it also moves them through
// the tick and compacts them, which saves two dispatches.
// One workgroup, in which each invocation takes a run of words. Reads: marks, droplets. Writes: marks, state, droplets.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#include "counters.glsl"
#include "flight.glsl"
#include "spawn.glsl"
#define MARKS_ACCESS coherent
#include "fall_buffers.glsl"
#include "returns.glsl"
#include "fall_compact.glsl"
#define STEP_WORDS (VIRGA_SPLASH_SINGLE_GROUP_DROPLETS / 32)
#include "fly.glsl"
#include "view_groups.glsl"
#define SOFTWARE_LANES VIRGA_SPLASH_LANES
#include "gpu/long_scan.glsl"

// The spawns of the step's later ticks, which are at the end. Each may find no room in the air and return its water at
// once.
uint spawns_to_come()
{
    uint low = 0u, high = spawn_count();
    while (low < high) {
        const uint middle = (low + high) / 2u;
        if (int(spawns[middle].tick - tick.tick) > 0)
            high = middle;
        else
            low = middle + 1u;
    }
    return spawn_count() - low;
}

// Steps all `end` droplets, which are few.
void step_few(uint lane, uint end)
{
    clear_bits(lane);
    barrier();
    for (uint slot = lane; slot < end; slot += SCAN_LANES) {
        const virga_droplet_gpu droplet = droplet_of(slot);
        if ((droplet.kind & VIRGA_DROPLET_ALIVE) != 0u)
            step_droplet(slot, droplet, slot);
    }
    barrier();
    if (32u * lane < end)
        marks[lane] = uvec4(fallen_bits[lane], alive_bits[lane], 0u, 0u);
    memoryBarrierBuffer();
    barrier();
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, end_droplet = state.end_droplet, returned = state.returns;
    const uint words = (end_droplet + 31u) / 32u,
               few = end_droplet <= VIRGA_SPLASH_SINGLE_GROUP_DROPLETS ? end_droplet : 0u;
    step_few(lane, few);
    const uint run = (words + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, words), end = min(begin + run, words);
    uvec2 sum = uvec2(0u);
    for (uint i = begin; i < end; i++)
        sum += uvec2(bitCount(marks[i].xy));
    uvec2 all;
    uvec2 before = scan_group(sum, all);
    for (uint i = begin; i < end; i++) {
        const uvec4 word = marks[i];
        marks[i].zw = before;
        before += uvec2(bitCount(word.xy));
    }
    const uint reserved_returns = min(returned + spawns_to_come(), tick.max_returned_droplets);
    // if there are more, they wait in the air
    const uint fallen = min(all.x, tick.max_returned_droplets - reserved_returns);
    memoryBarrierBuffer();
    barrier();
    for (uint slot = lane; slot < few; slot += SCAN_LANES) // not read as texels, because they were written here
        compact_droplet(slot, stored_droplet(slot), returned, fallen);
    if (lane != 0u)
        return;
    state.returns_before = returned;
    state.returns = returned + fallen;
    state.staying = all.y - fallen;
    state.fall_groups = state.droplet_groups;
    set_view_groups(all.y - fallen);
    count(VIRGA_SPLASH_FALLEN, fallen);
    count(VIRGA_SPLASH_DROPLETS_HELD, all.x - fallen);
    returns_head.count = returned + fallen;
    returns_head.dropped = 0u;
    returns_head.group_count = uint[3]((returned + fallen + 63u) / 64u, 1u, 1u);
    returns_head.capacity = tick.max_returned_droplets;
    returns_head.origin = tick.anchor;
    returns_head.tick_s = tick.tick_s;
    returns_head.ticks = tick.tick_in_step + 1u;
    returns_head.first_tick = tick.tick - tick.tick_in_step;
    returns_head.is_return = 1u;
}
