// measure.comp - counts the water of all cells, and the cells by state. The measured counts were cleared before.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "groups.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(scalar, set = 0, binding = 8) readonly buffer Kept { virga_cell_gpu kept[]; };

// Sums of a group as 64 bits, in two halves of 16 bits a cell: 256 x 65535 fits a word.
shared uint low_sum[4], high_sum[4], states[VIRGA_GROUND_STATES];

void add(uint which, uint nl)
{
    atomicAdd(low_sum[which], nl & 0xffffu);
    atomicAdd(high_sum[which], nl >> 16);
}

void count_sum(uint index, uint which)
{
    const uint high = high_sum[which];
    count_water(index, low_sum[which]);
    count_water(index, high << 16);
    atomicAdd(counts[index].high, high >> 16);
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
    const uint place = group_index() * VIRGA_GROUND_GROUP + gl_LocalInvocationIndex,
               window = tick.tiles * tick.tiles * VIRGA_GROUND_TILE_CELLS;
    if (place < window) {
        const virga_cell_gpu cell = cells[place];
        const uint material = floors[place].material;
        const uint state = material == NO_GROUND ? VIRGA_GROUND_NONE : cell_state(cell, material);
        add(state >= VIRGA_GROUND_PUDDLE_3 ? 1u : 0u, cell.free_nl);
        add(2u, cell.held_nl);
        atomicAdd(states[state], 1u);
    } else {
        add(3u, kept[place - window].free_nl);
        add(3u, kept[place - window].held_nl);
    }
    barrier();
    if (lane < 4u)
        count_sum(VIRGA_GROUND_FIRST_MEASURED + lane, lane);
    if (lane < VIRGA_GROUND_STATES && states[lane] > 0u)
        count_water(VIRGA_GROUND_CELLS + lane, states[lane]);
}
