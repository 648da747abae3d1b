// share.comp - what fell on a cell in this tick fills its pores, and the rest is shared with the four neighbours.
// On software Vulkan one invocation per impact, on a GPU one per some cells of the blocks that have ground: see
// cell_pairs.glsl. Reads: floors, cells as before this tick. Writes: arrivals.
// Paper: Mizukami et al., section 4.6.1 and figure 7, extended from a line to the plane.
//
// All drops of a tick on a cell count as one. W is left for a saturated cell 0 with n neighbours that are ground (a
// wall accepts nothing), H are the heights of the water surfaces before the tick: (1) D is the rise by W / n (half of
// the drop on a line, a quarter on the plane). (2) H0 > max(Hi + D): each neighbour gets W / n. (3) else: W fills the
// five cells from the lowest up until their surfaces are level (if they already are, each gets a
//       fifth, figure 7 (a)).
// The paper's (3) holds only as far as W is enough: a cell that is higher than the level gets nothing.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"
layout(scalar, set = 0, binding = 6) buffer Arrivals { virga_arrivals_gpu arrivals[]; };
#include "cell_pairs.glsl"

const ivec2 around[5] = ivec2[5](ivec2(0, 0), ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

void give(uint cell_index, int nl)
{
    if (nl > 0)
        atomicAdd(arrivals[cell_index].given_nl, uint(nl));
}

// The level to which `water` fills cells of these heights, from the lowest up. A cell that accepts nothing has a very
// large height.
int level_of(int heights[5], int water)
{
    for (int i = 0; i < 4; i++) // insertion sort
        for (int j = i + 1; j > 0; j--) {
            const int low = min(heights[j - 1], heights[j]), high = max(heights[j - 1], heights[j]);
            heights[j - 1] = low;
            heights[j] = high;
        }
    int sum = water, level = 0;
    for (int k = 0; k < 5; k++) {
        if (k > 0 && level <= heights[k])
            break;
        sum += heights[k];
        level = sum / (k + 1);
    }
    return level;
}

void share(ivec2 cell, uint own, int water)
{
    const int floor_um = floor_of(own).height_um;
    uint cell_indices[5];
    int heights[5];
    int neighbours = 0, highest = -MAX_STEP_NL;
    for (int i = 0; i < 5; i++) {
        cell_indices[i] = i == 0 ? own : index_of_cell(cell + around[i]);
        const bool accepts = i == 0 || is_ground(cell_indices[i]);
        // Relative to the lowest possible step, so that no height is negative.
        heights[i] = accepts
                         ? MAX_STEP_NL / 2 + surface_above(cell_indices[i], floor_um, -MAX_STEP_NL / 2, MAX_STEP_NL / 2)
                         : 2 * MAX_STEP_NL;
        if (i > 0 && accepts) {
            neighbours++;
            highest = max(highest, heights[i]);
        }
    }
    const int part = water / max(neighbours, 1);
    const bool runs_off = neighbours > 0 && heights[0] > highest + part;
    const int level = level_of(heights, water);
    int given = 0;
    for (int i = 1; i < 5; i++) {
        const bool accepts = heights[i] < 2 * MAX_STEP_NL;
        const int part = !accepts ? 0 : runs_off ? part : max(level - heights[i], 0);
        give(cell_indices[i], part);
        given += part;
    }
    give(own, water - given); // and the remainder of the division
}

// `landed`: what fell on the cell.
void share_landed(ivec2 cell, uint cell_index, uint landed)
{
    const uint room = tick.soils[floor_of(cell_index).material].capacity_nl;
    const uint absorbed = min(landed, room - min(cell_of(cell_index).held_nl, room));
    const uint shared_nl = min(landed - absorbed, uint(MAX_STEP_NL));
    give(cell_index, int(landed - shared_nl));
    share(cell, cell_index, int(shared_nl));
}

void share_cell(uint cell_index, uint landed)
{
    if (landed == 0u)
        return;
    arrivals[cell_index].landed_nl = 0u;
    share_landed(cell_at_index(cell_index), cell_index, landed);
}

void share_pairs()
{
    const uint count = listed_blocks();
    for (uint pair = gl_LocalInvocationIndex; pair < PAIRS_OF_GROUP; pair += gl_WorkGroupSize.x) {
        const uint first = first_of_pair(pair, count);
        if (first == NO_CELL)
            return;
        const virga_arrivals_gpu low = arrivals[first], high = arrivals[first + 1u];
        share_cell(first, low.landed_nl);
        share_cell(first + 1u, high.landed_nl);
    }
}

void share_impact(uint index)
{
    const virga_impact_gpu impact = impacts[index];
    const uint n = piece_count(impact);
    const Piece first = first_piece(impact);
    for (uint i = 0u; i < n; i++) {
        const Piece piece = get_piece(impact, first, i, n);
        if (piece.cell_index == NO_CELL)
            continue;
        // One invocation of all drops on a cell gets their sum; it does not matter which.
        const uint landed = atomicExchange(arrivals[piece.cell_index].landed_nl, 0u);
        if (landed != 0u)
            share_landed(piece.cell, piece.cell_index, landed);
    }
}

void main()
{
    if (FOR_GPU)
        share_pairs();
    else if (is_of_tick(gl_GlobalInvocationID.x))
        share_impact(gl_GlobalInvocationID.x);
}
