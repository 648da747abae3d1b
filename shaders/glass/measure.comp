// measure.comp - water on the pane, by where it is; each lane adds up several cells, each workgroup its lanes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

shared uint water[3], counts[3];

void add(uint index, uint amount)
{
    const uint old = atomicAdd(state.measured[index].low, amount);
    if (old + amount < old)
        atomicAdd(state.measured[index].high, 1u);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, i = gl_GlobalInvocationID.x;
    if (lane < 3u)
        water[lane] = counts[lane] = 0u;
    barrier();
    uint sum = 0u;
    for (uint cell = i; cell < cell_count(); cell += gl_NumWorkGroups.x * VIRGA_GLASS_GROUP)
        sum += film[cell];
    if (sum != 0u)
        atomicAdd(water[2], sum);
    if (i < VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS)
        atomicAdd(water[2], state.bins_nl[i]);
    if (i < tick.pane.max_drops && drops[i].kind != VIRGA_GLASS_FREE) {
        const bool particle = kind_of(drops[i]) == VIRGA_GLASS_PARTICLE;
        atomicAdd(water[particle ? 1 : 0], drops[i].water_nl + drops[i].merged_nl);
        atomicAdd(counts[particle ? 1 : 0], 1u);
        if ((drops[i].kind & VIRGA_GLASS_HELD) != 0u)
            atomicAdd(counts[2], 1u);
    }
    barrier();
    if (lane < 3u && water[lane] != 0u)
        add(lane, water[lane]);
    if (lane == 0u && counts[0] != 0u)
        atomicAdd(state.drops, counts[0]);
    if (lane == 1u && counts[1] != 0u)
        atomicAdd(state.particles, counts[1]);
    if (lane == 2u && counts[2] != 0u)
        atomicAdd(state.held, counts[2]);
}
