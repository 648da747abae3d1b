// spawn_scan.comp - prefix sum over the tick's spawns: the index of each splash, and of its droplets, in the order of
// spawns. One workgroup, in which each invocation takes a run of spawns. If that is one spawn, it also starts its
// splash, which saves a dispatch.
// One invocation per run of spawns. Reads: spawns. Writes: ranks, state, splashes, droplets.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#include "counters.glsl"
#include "flight.glsl"
#include "spawn.glsl"
#include "splash/shape.glsl"
#include "returns.glsl"
#include "spawn_start.glsl"
#include "handed.glsl"
#define SOFTWARE_LANES VIRGA_SPLASH_LANES
#include "gpu/long_scan.glsl"

shared uint full_rank, droplets_at_full, expired, cut_short;

bool is_over(virga_splash_gpu splash)
{
    return (float(tick.tick - splash.tick) - splash.share) * tick.tick_s > splash.life_s;
}

// Releases the oldest splashes that are over. Returns the first that is not.
uint forget_splashes(uint lane)
{
    uint first = state.first_splash;
    for (;;) {
        if (lane == 0u)
            expired = SCAN_LANES;
        barrier();
        const uint index = first + lane;
        bool live = index - first >= state.end_splash - first;
        if (!live)
            live = !is_over(splash_of(index & (tick.max_splashes - 1u)));
        if (live)
            atomicMin(expired, lane);
        barrier();
        const uint passed = expired;
        first += passed;
        barrier();
        if (passed < SCAN_LANES)
            break;
    }
    return first;
}

// Of the splashes from `first` to `end`, which newer ones replace: how many were not over.
void count_cut_short(uint lane, uint first, uint end)
{
    if (lane == 0u)
        cut_short = 0u;
    barrier();
    for (uint i = lane; i < min(end - first, tick.max_splashes); i += SCAN_LANES)
        if (!is_over(splash_of((first + i) & (tick.max_splashes - 1u))))
            atomicAdd(cut_short, 1u);
    barrier();
    if (lane == 0u)
        count(VIRGA_SPLASH_CUT_SHORT, cut_short);
}

// The first splash that is kept when there are splashes up to `end_after`.
uint make_room(uint lane, uint first, uint end, uint end_after)
{
    const uint block = uint(VIRGA_SPLASH_BLOCK - 1);
    if (end_after - (first & ~block) <= tick.max_splashes)
        return first;
    const uint kept = (end_after - tick.max_splashes + block) & ~block;
    count_cut_short(lane, first, first + min(kept - first, end - first));
    return kept;
}

// Droplets that are handed over come at the end of the step, and so do drops from edges. These are few and large. Had
// splashes of heavy rain all slots, nothing would drip for seconds, and what waited would then fall as a curtain.
uint room_beside_handed(uint room)
{
    if (tick.max_handed == 0u)
        return room;
    const uint kept = min(handed_head.count, tick.max_handed) + kept_for_drips();
    return room - min(min(kept, tick.max_handed), room);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, all = spawn_count();
    const uint run = (all + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, all), end = min(begin + run, all);
    const uint staying = state.staying, end_splash = state.end_splash;
    const uint returned = tick.tick_in_step == 0u ? 0u : state.returns;
    uint first_splash = forget_splashes(lane);
    uvec2 sum = uvec2(0u);
    for (uint i = begin; i < end; i++)
        if (spawns[i].tick == tick.tick) {
            spawn_ranks[i].y = droplet_count(spawns[i]);
            sum += uvec2(1u, spawn_ranks[i].y);
        }
    if (lane == 0u)
        full_rank = NO_SLOT;
    uvec2 found;
    uvec2 index = scan_group(sum, found);
    const uint room = room_beside_handed(tick.max_droplets - staying);
    for (uint i = begin; i < end; i++) {
        if (spawns[i].tick != tick.tick)
            continue;
        const uint droplets = spawn_ranks[i].y;
        if (index.y + droplets > room)
            atomicMin(full_rank, index.x);
        spawn_ranks[i] = uvec2(index.x, min(index.y, 0xffffffu) | droplets << 24);
        index += uvec2(1u, droplets);
    }
    barrier();
    if (lane == 0u)
        droplets_at_full = found.y;
    barrier();
    for (uint i = begin; i < end; i++)
        if (spawns[i].tick == tick.tick && spawn_ranks[i].x == full_rank)
            droplets_at_full = first_droplet(spawn_ranks[i].y); // at most one invocation
    barrier();
    const uint end_after = end_splash + found.x;
    first_splash = make_room(lane, first_splash, end_splash, end_after);
    const bool few = all <= SCAN_LANES;
    if (few && lane < all && spawns[lane].tick == tick.tick)
        start_splash(spawns[lane], spawn_ranks[lane],
                     Starts(end_splash, staying, returned, first_splash, full_rank));
    if (lane != 0u)
        return;
    const uint crowded = full_rank == NO_SLOT ? 0u : found.x - full_rank, droplets = staying + droplets_at_full;
    state.first_splash = first_splash;
    state.end_splash = end_after;
    state.tick_splash = end_splash;
    state.tick_droplet = staying;
    state.end_droplet = droplets;
    state.full_from = full_rank;
    state.returns_before = returned;
    state.returns = min(returned + crowded, tick.max_returned_droplets);
    state.spawn_groups = uint[3](few ? 0u : (all + VIRGA_SPLASH_GROUP - 1u) / VIRGA_SPLASH_GROUP, 1u, 1u);
    state.droplet_groups = ring_groups(0u, droplets <= VIRGA_SPLASH_SINGLE_GROUP_DROPLETS ? 0u : droplets);
    state.splash_groups = ring_groups(first_splash, end_after);
    state.alive = 0u;
    count(VIRGA_SPLASH_WITHOUT_DROPLETS, crowded);
    count(VIRGA_SPLASH_DROPLETS, droplets_at_full);
}
