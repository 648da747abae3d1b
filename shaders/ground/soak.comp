// soak.comp - the water that came to a cell fills its pores first; the rest stays on it.
// One invocation per impact, for the cells that it reached. Reads: arrivals, floors. Writes: cells, arrivals (cleared).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 6) buffer Arrivals { virga_arrivals_gpu arrivals[]; };

const ivec2 around[5] = ivec2[5](ivec2(0, 0), ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

void soak(uint cell_index)
{
    // Nothing is added in this pass: of all invocations that look at this cell, one finds the sum and the others 0.
    const uint given = atomicExchange(arrivals[cell_index].given_nl, 0u);
    if (given == 0u)
        return;
    const uvec2 words = cell_words[cell_index];
    const virga_cell_gpu cell = virga_cell_gpu(words.x, words.y);
    const uint capacity = tick.soils[floor_of(cell_index).material].capacity_nl;
    const uint absorbed = min(given, capacity - min(cell.held_nl, capacity));
    cell_words[cell_index] = uvec2(cell.free_nl + (given - absorbed), cell.held_nl + absorbed);
}

// The cells over which land.comp spread a piece that stands for several drops.
void soak_around(Piece piece, int spread)
{
    for (int z = -spread; z <= spread && spread > 0; z++)
        for (int x = -spread; x <= spread; x++) {
            const uint cell_index = index_of_cell(piece.cell + ivec2(x, z));
            if (is_ground(cell_index))
                soak(cell_index);
        }
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (!is_of_tick(index))
        return;
    const virga_impact_gpu impact = impacts[index];
    const uint n = piece_count(impact);
    const Piece first = first_piece(impact);
    for (uint i = 0u; i < n; i++) {
        const Piece piece = get_piece(impact, first, i, n);
        if (piece.cell_index == NO_CELL)
            continue;
        for (int k = 0; k < 5; k++) {
            const uint cell_index = index_of_cell(piece.cell + around[k]);
            if (is_ground(cell_index))
                soak(cell_index);
        }
        soak_around(piece, spread_of(impact.weight / float(n)));
    }
}
