// measure.comp - sums the water of all cells, and counts cells by state. The sums were cleared before.
// One workgroup per tile. Reads: cells, floors. Writes: counters.
//
// Each invocation sums sixteen cells by itself before it adds to shared variables, which software Vulkan handles lane
// by lane.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"

#define CELLS_EACH (VIRGA_GROUND_TILE_CELLS / VIRGA_GROUND_GROUP)
#define STATE_BITS 5 // bits per state in a word that counts up to CELLS_EACH cells of each state

layout(constant_id = 0) const bool CACHED_TILES = false; // measures kept tiles instead of the window
layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(scalar, set = 0, binding = 8) readonly buffer Cached { virga_cell_gpu cached[]; };

// The sums of a tile in 64 bits, as two words of 16-bit halves: 4096 x 65535 fits into a word.
#define FILM 0
#define PUDDLES 1
#define HELD 2
#define CACHED 3
shared uint low_sum[4], high_sum[4], states[VIRGA_GROUND_STATES];

struct Sum {
    uint low, high;
};

void add(inout Sum sum, uint nl)
{
    sum.low += nl & 0xffffu;
    sum.high += nl >> 16;
}

void share_sum(uint which, Sum sum)
{
    atomicAdd(low_sum[which], sum.low);
    atomicAdd(high_sum[which], sum.high);
}

void count_sum(uint index, uint which)
{
    const uint high = high_sum[which];
    count_water(index, low_sum[which]);
    count_water(index, high << 16);
    atomicAdd(counts[index].high, high >> 16);
}

struct Sums {
    Sum film, puddles, held;
    uint of_state;
};

void measure_cell(virga_cell_gpu cell, uint material, inout Sums sums)
{
    const uint state = material == NO_GROUND ? VIRGA_GROUND_NONE : cell_state(cell, material);
    const bool deep = state >= VIRGA_GROUND_PUDDLE_3;
    add(sums.film, deep ? 0u : cell.free_nl);
    add(sums.puddles, deep ? cell.free_nl : 0u);
    add(sums.held, cell.held_nl);
    sums.of_state += 1u << (STATE_BITS * state);
}

// `first`: a texel, which is two cells.
void measure_window(uint first)
{
    const Sum none = Sum(0u, 0u);
    Sums sums = Sums(none, none, none, 0u);
    for (uint i = 0u; i < CELLS_EACH; i += 2u) {
        const uint texel = first + i / 2u * VIRGA_GROUND_GROUP;
        const uvec4 two_cells = cell_texel(texel), two_floors = floor_texel(texel);
        measure_cell(virga_cell_gpu(two_cells.x, two_cells.y), two_floors.y, sums);
        measure_cell(virga_cell_gpu(two_cells.z, two_cells.w), two_floors.w, sums);
    }
    share_sum(FILM, sums.film);
    share_sum(PUDDLES, sums.puddles);
    share_sum(HELD, sums.held);
    for (uint i = 0u; i < VIRGA_GROUND_STATES; i++)
        atomicAdd(states[i], bitfieldExtract(sums.of_state, int(STATE_BITS * i), STATE_BITS));
}

void measure_cached(uint first)
{
    Sum sum = Sum(0u, 0u);
    for (uint i = 0u; i < CELLS_EACH; i++) {
        const virga_cell_gpu cell = cached[first + i * VIRGA_GROUND_GROUP];
        add(sum, cell.free_nl);
        add(sum, cell.held_nl);
    }
    share_sum(CACHED, sum);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane < 4u) {
        low_sum[lane] = 0u;
        high_sum[lane] = 0u;
    }
    if (lane < VIRGA_GROUND_STATES)
        states[lane] = 0u;
    barrier();
    if (CACHED_TILES)
        measure_cached(gl_WorkGroupID.x * VIRGA_GROUND_TILE_CELLS + lane);
    else
        measure_window(gl_WorkGroupID.x * (VIRGA_GROUND_TILE_CELLS / 2) + lane);
    barrier();
    if (CACHED_TILES ? lane == CACHED : lane < CACHED)
        count_sum(VIRGA_GROUND_FIRST_MEASURED + lane, lane);
    if (lane < VIRGA_GROUND_STATES && states[lane] > 0u)
        count_water(VIRGA_GROUND_CELLS + lane, states[lane]);
}
