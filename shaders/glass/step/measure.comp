// measure.comp - water on the pane, by where it is: a workgroup adds up some blocks of cells that may have film, and as
// many places as it has lanes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "live.glsl"

#define BLOCK VIRGA_GLASS_FILM_BLOCK // as many cells as a workgroup has lanes

shared uint water[3], counts[3], film_there[VIRGA_GLASS_MEASURED]; // 1: some cell of the block has

void add(uint index, uint amount)
{
    const uint old = atomicAdd(state.measured[index].low, amount);
    if (old + amount < old)
        atomicAdd(state.measured[index].high, 1u);
}

// The workgroup's block with this number; NOWHERE: it has not so many. Reads without a branch here and below: in one,
// software Vulkan reads lane by lane.
uint block_of(uint k)
{
    const uvec2 counts = film_block_counts();
    const uint turn = gl_WorkGroupID.x * VIRGA_GLASS_MEASURED + k, all = counts.x * counts.y;
    const uint block = film_blocks[all + min(turn, all - 1u)];
    return turn < state.film_blocks ? block : NOWHERE;
}

// Film of the lane's cell of a block.
uint film_here(uint block)
{
    const uvec2 counts = film_block_counts(), last = uvec2(tick.pane.columns, tick.pane.rows) - 1u;
    const uint there = block != NOWHERE ? block : 0u;
    const uvec2 corner = uvec2(there % counts.x, there / counts.x) * BLOCK;
    const uvec2 cell = corner + uvec2(gl_LocalInvocationIndex % BLOCK, gl_LocalInvocationIndex / BLOCK);
    const uvec2 near = min(cell, last);
    const uint here = film[near.x + near.y * tick.pane.columns];
    return cell == near && block != NOWHERE ? here : 0u;
}

void add_place(uint place)
{
    const uint kind = drops[place].kind;
    if (kind == VIRGA_GLASS_FREE)
        return;
    const uint which = (kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_PARTICLE ? 1u : 0u;
    atomicAdd(water[which], drops[place].water_nl + drops[place].merged_nl);
    atomicAdd(counts[which], 1u);
    if ((kind & VIRGA_GLASS_HELD) != 0u)
        atomicAdd(counts[2], 1u);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, i = gl_GlobalInvocationID.x;
    if (lane < 3u)
        water[lane] = counts[lane] = 0u;
    if (lane < VIRGA_GLASS_MEASURED)
        film_there[lane] = 0u;
    barrier();
    uint sum = 0u;
    for (uint k = 0u; k < VIRGA_GLASS_MEASURED; k++) {
        const uint here = film_here(block_of(k));
        if (here != 0u)
            film_there[k] = 1u;
        sum += here;
    }
    if (sum != 0u)
        atomicAdd(water[2], sum);
    if (i < VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS)
        atomicAdd(water[2], state.bins_nl[i]);
    if (i < state.shown)
        add_place(listed[i]);
    barrier();
    if (lane < VIRGA_GLASS_MEASURED) {
        const uint block = block_of(lane);
        if (film_there[lane] == 0u && block != NOWHERE)
            film_blocks[block] = 0u;
    }
    if (lane < 3u && water[lane] != 0u)
        add(lane, water[lane]);
    if (lane == 0u && counts[0] != 0u)
        atomicAdd(state.drops, counts[0]);
    if (lane == 1u && counts[1] != 0u)
        atomicAdd(state.particles, counts[1]);
    if (lane == 2u && counts[2] != 0u)
        atomicAdd(state.held, counts[2]);
}
