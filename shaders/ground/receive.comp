// receive.comp - water that a simulation gives comes to the cells below it. A cell that can not hold more, and a place
// without ground, count it as fallen beside the ground.
// One invocation per entry. Reads: the exchange, floors, cells. Writes: arrivals, counts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "exchange.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 6) buffer Arrivals { virga_arrivals_gpu arrivals[]; };

#define MAX_CELL_NL 0x7fffffffu // flow.comp computes with signed integers

// Adds up to the limit, and returns how much. The sum does not depend on the order.
uint add_limited(uint cell_index, uint nl, uint limit)
{
    uint was = arrivals[cell_index].given_nl;
    for (;;) {
        const uint added = min(nl, limit - min(was, limit));
        const uint found = atomicCompSwap(arrivals[cell_index].given_nl, was, was + added);
        if (found == was)
            return added;
        was = found;
    }
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= given_count())
        return;
    const virga_exchanged_gpu entry = entries[exchange.capacity + index];
    const uint cell_index = cell_below(entry.position);
    uint here = 0u;
    if (cell_index != NO_CELL)
        here = add_limited(cell_index, entry.water_nl, MAX_CELL_NL - min(cell_of(cell_index).free_nl, MAX_CELL_NL));
    if (here > 0u)
        count_water(VIRGA_GROUND_GIVEN, here);
    if (here < entry.water_nl)
        count_water(VIRGA_GROUND_GIVEN_OFF, entry.water_nl - here);
}
