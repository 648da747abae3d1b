// soak.comp - the water that came to a cell fills its pores first; the rest stays on it.
// On software Vulkan one invocation per impact, for the cells that it reached; on a GPU one per some cells of the
// blocks that have ground: see cell_pairs.glsl. Reads: arrivals, floors. Writes: cells, arrivals (cleared).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"
#include "soak.glsl"
#include "cell_pairs.glsl"

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

void soak_impact(uint index)
{
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

void soak_pairs()
{
    const uint count = listed_blocks();
    for (uint pair = gl_LocalInvocationIndex; pair < PAIRS_OF_GROUP; pair += gl_WorkGroupSize.x) {
        const uint first = first_of_pair(pair, count);
        if (first == NO_CELL)
            return;
        const virga_arrivals_gpu low = arrivals[first], high = arrivals[first + 1u];
        if (low.given_nl != 0u)
            soak(first);
        if (high.given_nl != 0u)
            soak(first + 1u);
    }
}

void main()
{
    if (FOR_GPU)
        soak_pairs();
    else if (is_of_tick(gl_GlobalInvocationID.x))
        soak_impact(gl_GlobalInvocationID.x);
}
