// soak.comp - the water that came to a cell fills its pores first; the rest stays on it.
// One invocation per impact, for the cells that it reached. Reads: arrivals, floors. Writes: cells, arrivals (cleared).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"
#include "soak.glsl"

layout(local_size_x = 64) in;

const ivec2 around[5] = ivec2[5](ivec2(0, 0), ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

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
