// spawn_scan.comp - gives this tick's splashes and droplets their places, in the order of spawns. One
// workgroup; each lane takes a run of spawns.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "count.glsl"
#include "orbit.glsl"
#include "spawn.glsl"
#define SCAN_LANES VIRGA_SPLASH_LANES
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_SPLASH_LANES) in;

shared uint crowded_rank, crowded_droplets, expired;

// The oldest splashes that are over make room.
void forget_splashes(uint lane)
{
    uint first = state.first_splash;
    for (;;) {
        if (lane == 0u)
            expired = VIRGA_SPLASH_LANES;
        barrier();
        const uint place = first + lane;
        bool live = place - first >= state.end_splash - first;
        if (!live) {
            const virga_splash_gpu splash = splashes[place & (tick.max_splashes - 1u)];
            live = (float(tick.tick - splash.tick) - splash.share) * tick.tick_s <= splash.life_s;
        }
        if (live)
            atomicMin(expired, lane);
        barrier();
        const uint passed = expired;
        first += passed;
        barrier();
        if (passed < VIRGA_SPLASH_LANES)
            break;
    }
    if (lane == 0u)
        state.first_splash = first;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, all = spawn_count();
    const uint run = (all + VIRGA_SPLASH_LANES - 1u) / VIRGA_SPLASH_LANES;
    const uint begin = min(lane * run, all), end = min(begin + run, all);
    forget_splashes(lane);
    uvec2 sum = uvec2(0u);
    for (uint i = begin; i < end; i++)
        if (spawns[i].tick == tick.tick) {
            places[i].y = droplet_count(spawns[i]);
            sum += uvec2(1u, places[i].y);
        }
    if (lane == 0u)
        crowded_rank = NO_PLACE;
    uvec2 found;
    uvec2 place = scan_group(sum, found);
    const uint room = tick.max_droplets - state.staying;
    for (uint i = begin; i < end; i++) {
        if (spawns[i].tick != tick.tick)
            continue;
        const uint droplets = places[i].y;
        if (place.y + droplets > room)
            atomicMin(crowded_rank, place.x);
        places[i] = uvec2(place.x, min(place.y, 0xffffffu) | droplets << 24);
        place += uvec2(1u, droplets);
    }
    barrier();
    if (lane == 0u)
        crowded_droplets = found.y;
    barrier();
    for (uint i = begin; i < end; i++)
        if (spawns[i].tick == tick.tick && places[i].x == crowded_rank)
            crowded_droplets = first_droplet(places[i].y); // one invocation at most
    barrier();
    if (lane != 0u)
        return;
    state.tick_droplet = state.staying;
    state.tick_splash = state.end_splash;
    state.end_droplet = state.staying + crowded_droplets;
    state.end_splash += found.x;
    if (state.end_splash - (state.first_splash & ~uint(VIRGA_SPLASH_BLOCK - 1)) > tick.max_splashes)
        state.first_splash = (state.end_splash - tick.max_splashes + VIRGA_SPLASH_BLOCK - 1u) & ~uint(VIRGA_SPLASH_BLOCK - 1);
    const uint crowded = crowded_rank == NO_PLACE ? 0u : found.x - crowded_rank;
    state.crowded_from = crowded_rank;
    state.returns_before = tick.tick_in_step == 0u ? 0u : state.returns;
    state.returns = min(state.returns_before + crowded, tick.max_returns);
    state.droplet_groups = ring_groups(0u, state.end_droplet);
    state.splash_groups = ring_groups(state.first_splash, state.end_splash);
    count(VIRGA_SPLASH_CROWDED, crowded);
    count(VIRGA_SPLASH_DROPLETS, crowded_droplets);
}
