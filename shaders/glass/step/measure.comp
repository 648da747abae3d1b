// measure.comp - sums the water on the pane, by what holds it. A workgroup sums some blocks of cells that may have
// film, and as many slots as it has invocations.
// One invocation per cell of a block, and per live slot. Reads: drops, film, bins. Writes: state, flags of blocks
// without film (cleared).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "live.glsl"
#include "gpu/variants.glsl"

#define BLOCK VIRGA_GLASS_FILM_BLOCK // cells of a block: as many as a workgroup has invocations

shared uint water[3], counts[3], has_film[VIRGA_GLASS_BLOCKS_PER_GROUP]; // 1: a cell of the block has film
shared uint corners[VIRGA_GLASS_BLOCKS_PER_GROUP]; // each block's first cell: column and row, u16 each; NONE: no block

void add(uint index, uint amount)
{
    const uint old = atomicAdd(state.measured[index].low, amount);
    if (old + amount < old)
        atomicAdd(state.measured[index].high, 1u);
}

// The k-th block of this workgroup, or NONE. A GPU goes over all blocks, and has no list of those that may have film.
uint block_of(uint k, uvec2 counts)
{
    const uint index = gl_WorkGroupID.x * VIRGA_GLASS_BLOCKS_PER_GROUP + k;
    if (FOR_GPU)
        return index < counts.x * counts.y && film_blocks[index] != 0u ? index : NONE;
    return index < state.film_blocks ? film_blocks[counts.x * counts.y + index] : NONE;
}

// Film on a cell of the k-th block. It is read without a branch: inside a branch software Vulkan reads lane by lane.
uint film_in_block(uint k, uvec2 in_block)
{
    const uvec2 last = uvec2(tick.pane.columns, tick.pane.rows) - 1u;
    const uvec2 cell = uvec2(corners[k] & 0xffffu, corners[k] >> 16) + in_block, clamped = min(cell, last);
    const uint here = film[clamped.x + clamped.y * tick.pane.columns];
    return cell == clamped ? here : 0u; // NONE lies beyond every pane
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
    const uvec2 blocks = film_block_counts(), in_block = uvec2(lane % BLOCK, lane / BLOCK);
    if (lane < 3u)
        water[lane] = counts[lane] = 0u;
    const uint own_block = lane < VIRGA_GLASS_BLOCKS_PER_GROUP ? block_of(lane, blocks) : NONE;
    if (lane < VIRGA_GLASS_BLOCKS_PER_GROUP) {
        has_film[lane] = 0u;
        corners[lane] = own_block == NONE ? NONE : (own_block % blocks.x | own_block / blocks.x << 16) * BLOCK;
    }
    barrier();
    uint sum = 0u;
    for (uint k = 0u; k < VIRGA_GLASS_BLOCKS_PER_GROUP; k++) {
        if (FOR_GPU && corners[k] == NONE)
            continue;
        const uint here = film_in_block(k, in_block);
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
    if (own_block != NONE && has_film[lane] == 0u)
        film_blocks[own_block] = 0u;
    if (lane < 3u && water[lane] != 0u)
        add(lane, water[lane]);
    if (lane == 0u && counts[0] != 0u)
        atomicAdd(state.drops, counts[0]);
    if (lane == 1u && counts[1] != 0u)
        atomicAdd(state.particles, counts[1]);
    if (lane == 2u && counts[2] != 0u)
        atomicAdd(state.particles_waiting, counts[2]);
}
