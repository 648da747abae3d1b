// measure.comp - water on the pane, by where it is: a workgroup adds up a block of cells that may have film, and as many
// places as it has lanes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "alive.glsl"

#define BLOCK VIRGA_GLASS_FILM_BLOCK // as many cells as a workgroup has lanes

shared uint water[3], counts[3], film_there;

void add(uint index, uint amount)
{
    const uint old = atomicAdd(state.measured[index].low, amount);
    if (old + amount < old)
        atomicAdd(state.measured[index].high, 1u);
}

// Film of the lane's cell of the workgroup's block.
uint film_here(uint block)
{
    const uvec2 counts = film_block_counts();
    const uvec2 corner = uvec2(block % counts.x, block / counts.x) * BLOCK;
    const uvec2 cell = corner + uvec2(gl_LocalInvocationIndex % BLOCK, gl_LocalInvocationIndex / BLOCK);
    return cell.x < tick.pane.columns && cell.y < tick.pane.rows ? film[cell.x + cell.y * tick.pane.columns] : 0u;
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
    if (lane == 0u)
        film_there = 0u;
    barrier();
    const uvec2 blocks = film_block_counts();
    const bool has_block = gl_WorkGroupID.x < state.film_blocks;
    const uint block = has_block ? film_blocks[blocks.x * blocks.y + gl_WorkGroupID.x] : 0u;
    const uint here = has_block ? film_here(block) : 0u;
    if (here != 0u)
        atomicAdd(film_there, here);
    if (i < VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS)
        atomicAdd(water[2], state.bins_nl[i]);
    if (i < state.shown)
        add_place(listed[i]);
    barrier();
    if (lane == 0u && has_block && film_there == 0u)
        film_blocks[block] = 0u;
    if (lane < 3u) {
        const uint sum = water[lane] + (lane == 2u ? film_there : 0u);
        if (sum != 0u)
            add(lane, sum);
    }
    if (lane == 0u && counts[0] != 0u)
        atomicAdd(state.drops, counts[0]);
    if (lane == 1u && counts[1] != 0u)
        atomicAdd(state.particles, counts[1]);
    if (lane == 2u && counts[2] != 0u)
        atomicAdd(state.held, counts[2]);
}
