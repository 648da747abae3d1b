// receive_soak.comp - the water that receive.comp brought to cells soaks in, as that of drops does.
// One invocation per entry. Reads: the exchange, arrivals, floors. Writes: cells, arrivals (cleared).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "exchange.glsl"
#include "soak.glsl"

layout(local_size_x = 64) in;

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= given_count())
        return;
    const uint cell_index = cell_below(entries[exchange.capacity + index].position);
    if (cell_index != NO_CELL)
        soak(cell_index);
}
