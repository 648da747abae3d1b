// fall_scan.comp - gives what fell in this tick its places among the returns, and finds the oldest droplet that is alive.
// One workgroup; each lane takes a run of words.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"
#include "fall_buffers.glsl"
#include "returns.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

shared uint sums[VIRGA_SPLASH_GROUP], oldest;

void main()
{
    const uint lane = gl_LocalInvocationIndex, words = state.droplet_groups[0] * (VIRGA_SPLASH_GROUP / 32);
    const uint run = (words + VIRGA_SPLASH_GROUP - 1u) / VIRGA_SPLASH_GROUP;
    const uint begin = min(lane * run, words), end = min(begin + run, words);
    const uint start = state.first_droplet & ~uint(VIRGA_SPLASH_GROUP - 1), mask = tick.max_droplets / 32u - 1u;
    uint sum = 0u, first = NO_PLACE;
    for (uint i = begin; i < end; i++) {
        const uvec4 word = marks[(start / 32u + i) & mask];
        sum += bitCount(word.x);
        if (first == NO_PLACE && word.y != 0u)
            first = i * 32u + uint(findLSB(word.y));
    }
    sums[lane] = sum;
    if (lane == 0u)
        oldest = NO_PLACE;
    barrier();
    atomicMin(oldest, first);
    for (uint reach = 1u; reach < VIRGA_SPLASH_GROUP; reach *= 2u) { // Hillis and Steele 1986
        barrier();
        const uint lower = lane >= reach ? sums[lane - reach] : 0u;
        barrier();
        sums[lane] += lower;
    }
    barrier();
    uint place = state.returns + sums[lane] - sum;
    for (uint i = begin; i < end; i++) {
        const uint word = (start / 32u + i) & mask;
        marks[word].z = place;
        place += bitCount(marks[word].x);
    }
    barrier();
    if (lane != 0u)
        return;
    const uint total = min(state.returns + sums[VIRGA_SPLASH_GROUP - 1], tick.max_returns);
    count(VIRGA_SPLASH_FALLEN, total - state.returns);
    state.returns = total;
    state.fall_start = start;
    state.first_droplet = oldest == NO_PLACE ? state.end_droplet : start + oldest;
    returns_head.count = total;
    returns_head.dropped = 0u;
    returns_head.group_count = uint[3]((total + 63u) / 64u, 1u, 1u);
    returns_head.capacity = tick.max_returns;
    returns_head.origin = tick.anchor;
    returns_head.tick_s = tick.tick_s;
    returns_head.ticks = tick.tick_in_step + 1u;
    returns_head.is_return = 1u;
}
