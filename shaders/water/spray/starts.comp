// starts.comp - two prefix sums over the splash particles: where the droplets of those that leave are in the list that
// is handed over, and where the others' are among the droplets that are drawn here. The first particle whose droplets
// find no room in that list stays, and so do all after it.
// One workgroup, in which each invocation takes a run of particles. Writes: droplet_starts, splashes, state, the head
// of the list.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#include "handed.glsl"
#define SCAN_LANES 256u
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

shared uint full_from; // droplets that leave, before the first that finds no room

bool leaves(uint splash) { return (splashes[splash_now(splash)].flags & VIRGA_LEAVER_LEAVING) != 0u; }

// Gives the particles of a run that leave their ranges in the list. `before`: droplets of those before the run.
void find_room(uvec2 run, uint before)
{
    const uint listed = handed_head.count, room = handed_head.capacity - min(listed, handed_head.capacity);
    for (uint i = run.x; i < run.y; i++) {
        if (!leaves(i))
            continue;
        const uint end = before + splashes[splash_now(i)].pieces;
        splashes[splash_now(i)].first = listed + before;
        if (end > room) {
            splashes[splash_now(i)].flags &= ~VIRGA_LEAVER_LEAVING;
            atomicMin(full_from, before);
        }
        before = end;
    }
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, count = state.splashes;
    const uint each = (count + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES;
    const uvec2 run = uvec2(min(lane * each, count), min(lane * each + each, count));
    uint leaving = 0u;
    for (uint i = run.x; i < run.y; i++)
        leaving += leaves(i) ? splashes[splash_now(i)].pieces : 0u;
    if (lane == 0u)
        full_from = 0xffffffffu;
    uvec2 all;
    const uint leaving_before = scan_group(uvec2(leaving, 0u), all).x;
    const uint all_leaving = all.x;
    if (frame.hands_over != 0u)
        find_room(run, leaving_before);
    barrier(); // also between the two prefix sums
    uint drawn = 0u;
    for (uint i = run.x; i < run.y; i++)
        drawn += leaves(i) ? 0u : splashes[splash_now(i)].pieces;
    uint before = scan_group(uvec2(drawn, 0u), all).x;
    for (uint i = run.x; i < run.y; i++) {
        droplet_starts[i] = before;
        before += leaves(i) ? 0u : splashes[splash_now(i)].pieces;
    }
    if (lane != 0u)
        return;
    state.droplets_wanted = all.x;
    state.droplets = min(all.x, frame.max_droplets);
    if (frame.hands_over == 0u)
        return;
    const uint listed = handed_head.count + min(all_leaving, full_from);
    handed_head.count = listed;
    handed_head.group_count = uint[3]((listed + 63u) / 64u, 1u, 1u);
}
