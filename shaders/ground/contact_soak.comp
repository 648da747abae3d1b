// contact_soak.comp - the water that contact.comp pushed into cells soaks in, as that of drops does.
// One invocation per cell near a contact. Reads: arrivals, floors. Writes: cells, arrivals (cleared).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "contacts.glsl"
#include "soak.glsl"

layout(local_size_x = 64) in;

void main()
{
    const uint number = gl_GlobalInvocationID.x;
    if (number >= contact_cells())
        return;
    const uint cell_index = near_of(number).cell_index;
    if (cell_index != NO_CELL)
        soak(cell_index);
}
