// tile_discard.comp - discards tiles that there is no room to keep: their water is counted, then cleared.
// One invocation per cell. Reads: the list of tiles. Writes: kept cells, counters.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "workgroups.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(scalar, set = 0, binding = 1) readonly buffer Lists
{
    uint entering[VIRGA_GROUND_MAX_TILES];
    uint discarded[VIRGA_GROUND_MAX_TILES];
};
layout(scalar, set = 0, binding = 8) buffer Cached { virga_cell_gpu cached[]; };

void main()
{
    const uint tile = discarded[group_index() / (VIRGA_GROUND_TILE_CELLS / VIRGA_GROUND_GROUP)];
    const uint part = group_index() % (VIRGA_GROUND_TILE_CELLS / VIRGA_GROUND_GROUP);
    const uint cell_index = (tile << (2 * TILE_SHIFT)) + part * VIRGA_GROUND_GROUP + gl_LocalInvocationIndex;
    const virga_cell_gpu cell = cached[cell_index];
    cached[cell_index] = virga_cell_gpu(0u, 0u);
    if (cell.free_nl > 0u)
        count_water(VIRGA_GROUND_EVICTED, cell.free_nl);
    if (cell.held_nl > 0u)
        count_water(VIRGA_GROUND_EVICTED, cell.held_nl);
}
