// measure.comp - sums the water on the pane, by what holds it. A workgroup sums some blocks of cells that may have
// film, and as many slots as it has invocations.
// One invocation per cell of a block, and per live slot. Reads: drops, film, bins. Writes: state, flags of blocks
// without film (cleared).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "live.glsl"

#define BLOCK VIRGA_GLASS_FILM_BLOCK // cells of a block: as many as a workgroup has invocations

shared uint water[3], counts[3], has_film[VIRGA_GLASS_BLOCKS_PER_GROUP]; // 1: a cell of the block has film

void add(uint index, uint amount)
{
    const uint old = atomicAdd(state.measured[index].low, amount);
    if (old + amount < old)
        atomicAdd(state.measured[index].high, 1u);
}

// The k-th block of this workgroup, or NONE. It is read without a branch, here and below: inside a branch software
// Vulkan reads lane by lane.
uint block_of(uint k)
{
    const uvec2 counts = film_block_counts();
    const uint index = gl_WorkGroupID.x * VIRGA_GLASS_BLOCKS_PER_GROUP + k, all = counts.x * counts.y;
    const uint block = film_blocks[all + min(index, all - 1u)];
    return index < state.film_blocks ? block : NONE;
}

// Film on this invocation's cell of a block.
uint film_of_lane(uint block)
{
    const uvec2 counts = film_block_counts(), last = uvec2(tick.pane.columns, tick.pane.rows) - 1u;
    const uint valid_block = block != NONE ? block : 0u;
    const uvec2 corner = uvec2(valid_block % counts.x, valid_block / counts.x) * BLOCK;
    const uvec2 cell = corner + uvec2(gl_LocalInvocationIndex % BLOCK, gl_LocalInvocationIndex / BLOCK);
    const uvec2 clamped = min(cell, last);
    const uint here = film[clamped.x + clamped.y * tick.pane.columns];
    return cell == clamped && block != NONE ? here : 0u;
}

void add_drop(uint slot)
{
    const uint kind = drops[slot].kind;
    if (kind == VIRGA_GLASS_FREE)
        return;
    const uint type = (kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_PARTICLE ? 1u : 0u;
    atomicAdd(water[type], drops[slot].water_nl + drops[slot].merged_nl);
    atomicAdd(counts[type], 1u);
    if ((kind & VIRGA_GLASS_WAITING) != 0u)
        atomicAdd(counts[2], 1u);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, i = gl_GlobalInvocationID.x;
    if (lane < 3u)
        water[lane] = counts[lane] = 0u;
    if (lane < VIRGA_GLASS_BLOCKS_PER_GROUP)
        has_film[lane] = 0u;
    barrier();
    uint sum = 0u;
    for (uint k = 0u; k < VIRGA_GLASS_BLOCKS_PER_GROUP; k++) {
        const uint here = film_of_lane(block_of(k));
        if (here != 0u)
            has_film[k] = 1u;
        sum += here;
    }
    if (sum != 0u)
        atomicAdd(water[2], sum);
    if (i < VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS)
        atomicAdd(water[2], state.bins_nl[i]);
    if (i < state.shown)
        add_drop(listed[i]);
    barrier();
    if (lane < VIRGA_GLASS_BLOCKS_PER_GROUP) {
        const uint block = block_of(lane);
        if (has_film[lane] == 0u && block != NONE)
            film_blocks[block] = 0u;
    }
    if (lane < 3u && water[lane] != 0u)
        add(lane, water[lane]);
    if (lane == 0u && counts[0] != 0u)
        atomicAdd(state.drops, counts[0]);
    if (lane == 1u && counts[1] != 0u)
        atomicAdd(state.particles, counts[1]);
    if (lane == 2u && counts[2] != 0u)
        atomicAdd(state.particles_waiting, counts[2]);
}
