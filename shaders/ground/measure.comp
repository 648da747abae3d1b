// measure.comp - counts the water of all cells, and the cells by state. The measured counts were cleared before.
//
// A workgroup has a tile, and each invocation adds up sixteen cells of it for itself before it adds to what the
// workgroup shares: software Vulkan works those sums off lane by lane.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"

#define CELLS_EACH (VIRGA_GROUND_TILE_CELLS / VIRGA_GROUND_GROUP)
#define STATE_BITS 5 // of a word with counts of up to CELLS_EACH for each state

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(scalar, set = 0, binding = 8) readonly buffer Kept { virga_cell_gpu kept[]; };

// Sums of a tile as 64 bits, in two halves of 16 bits a cell: 4096 x 65535 fits a word.
#define FILM 0
#define PUDDLES 1
#define HELD 2
#define KEPT 3
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

void measure_window(uint first)
{
    Sum film = Sum(0u, 0u), puddles = film, held = film;
    uint of_state = 0u;
    for (uint i = 0u; i < CELLS_EACH; i++) {
        const uint place = first + i * VIRGA_GROUND_GROUP;
        const virga_cell_gpu cell = cells[place];
        const uint material = floors[place].material;
        const uint state = material == NO_GROUND ? VIRGA_GROUND_NONE : cell_state(cell, material);
        const bool deep = state >= VIRGA_GROUND_PUDDLE_3;
        add(film, deep ? 0u : cell.free_nl);
        add(puddles, deep ? cell.free_nl : 0u);
        add(held, cell.held_nl);
        of_state += 1u << (STATE_BITS * state);
    }
    share_sum(FILM, film);
    share_sum(PUDDLES, puddles);
    share_sum(HELD, held);
    for (uint i = 0u; i < VIRGA_GROUND_STATES; i++)
        atomicAdd(states[i], bitfieldExtract(of_state, int(STATE_BITS * i), STATE_BITS));
}

void measure_kept(uint first)
{
    Sum sum = Sum(0u, 0u);
    for (uint i = 0u; i < CELLS_EACH; i++) {
        const virga_cell_gpu cell = kept[first + i * VIRGA_GROUND_GROUP];
        add(sum, cell.free_nl);
        add(sum, cell.held_nl);
    }
    share_sum(KEPT, sum);
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
    const uint tile = gl_WorkGroupID.x, window = tick.tiles * tick.tiles;
    if (tile < window)
        measure_window(tile * VIRGA_GROUND_TILE_CELLS + lane);
    else
        measure_kept((tile - window) * VIRGA_GROUND_TILE_CELLS + lane);
    barrier();
    if (lane < 4u)
        count_sum(VIRGA_GROUND_FIRST_MEASURED + lane, lane);
    if (lane < VIRGA_GROUND_STATES && states[lane] > 0u)
        count_water(VIRGA_GROUND_CELLS + lane, states[lane]);
}
