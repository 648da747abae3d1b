// share.comp - what fell on a cell in this tick goes into its pores, and what they do not take is shared with the four
// neighbours: Mizukami et al., section 4.6.1 and figure 7, from a line to the plane.
//
// All drops of a tick on one cell count as one. Of W that is left for a saturated cell 0 with n neighbours that are
// ground (a wall takes nothing), heights of water surfaces H before the tick:
//   (1) D is the rise by W / n (half of the drop on a line, a quarter on the plane).
//   (2) H0 > max(Hi + D): each neighbour gets W / n.
//   (3) else: W fills the five from the lowest up until their surfaces are level (where they already are level that is
//       a fifth each, figure 7 (a)).
// The paper's (3) can be met only as far as W goes: who is higher than the level gets nothing.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 6) buffer Arrivals { virga_arrivals_gpu arrivals[]; };

const ivec2 around[5] = ivec2[5](ivec2(0, 0), ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

void give(uint place, int nl)
{
    if (nl > 0)
        atomicAdd(arrivals[place].given_nl, uint(nl));
}

// The level to which `water` fills cells of these heights, from the lowest up (heights of who takes nothing: very
// high).
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
    uint places[5];
    int heights[5];
    int neighbours = 0, highest = -MOST_STEP_NL;
    for (int i = 0; i < 5; i++) {
        places[i] = i == 0 ? own : cell_place(cell + around[i]);
        const bool takes = i == 0 || is_ground(places[i]);
        // Counted from the deepest step, so that no height is below zero.
        heights[i] = takes ? MOST_STEP_NL / 2 + surface_above(places[i], floor_um, -MOST_STEP_NL / 2, MOST_STEP_NL / 2)
                           : 2 * MOST_STEP_NL;
        if (i > 0 && takes) {
            neighbours++;
            highest = max(highest, heights[i]);
        }
    }
    const int part = water / max(neighbours, 1);
    const bool runs_off = neighbours > 0 && heights[0] > highest + part;
    const int level = level_of(heights, water);
    int given = 0;
    for (int i = 1; i < 5; i++) {
        const bool takes = heights[i] < 2 * MOST_STEP_NL;
        const int gift = !takes ? 0 : runs_off ? part : max(level - heights[i], 0);
        give(places[i], gift);
        given += gift;
    }
    give(own, water - given); // with what does not divide
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
        if (piece.place == NO_CELL)
            continue;
        // Of all drops on a cell one invocation gets their sum; which does not matter.
        const uint landed = atomicExchange(arrivals[piece.place].landed_nl, 0u);
        if (landed == 0u)
            continue;
        const uint room = tick.soils[floor_of(piece.place).material].capacity_nl;
        const uint taken = min(landed, room - min(cell_of(piece.place).held_nl, room));
        const uint shared_nl = min(landed - taken, uint(MOST_STEP_NL));
        give(piece.place, int(landed - shared_nl));
        share(piece.cell, piece.place, int(shared_nl));
    }
}
