// land.comp - the drops of a tick arrive: water by cell, what each met there, and the dark spots that they leave.
//
// Everything is read as it was before this tick, and sums are of integers, so the order of drops does not matter.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"
#include "rings.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 6) buffer Arrivals { virga_arrivals_gpu arrivals[]; };
layout(scalar, set = 0, binding = 7) buffer Spots { uvec2 spots[]; };
layout(scalar, set = 0, binding = 10) writeonly buffer Landings { virga_landing_gpu landings[]; };

#define SPREAD 2.0 // diameter of the spot over that of the drop, on what is porous

// Bits that a spot covers: all within its radius; one that it covers in part, as often as its share.
void leave_spot(Piece piece, float diameter_m, uint hash)
{
    const float bit_m = tick.cell_m / float(VIRGA_GROUND_SPOTS), radius = 0.5 * SPREAD * diameter_m / bit_m;
    const vec2 at = piece.in_cell * float(VIRGA_GROUND_SPOTS);
    const ivec2 own = clamp(ivec2(at), ivec2(0), ivec2(VIRGA_GROUND_SPOTS - 1));
    const bool shows = virga_unit(hash) < 3.14159265 * radius * radius;
    uvec2 bits = uvec2(0u);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            const ivec2 bit = own + ivec2(x, y);
            const bool covered = (x == 0 && y == 0) ? shows : distance(vec2(bit) + 0.5, at) < radius;
            if (covered && min(bit.x, bit.y) >= 0 && max(bit.x, bit.y) < VIRGA_GROUND_SPOTS) {
                const uint index = uint(bit.y * VIRGA_GROUND_SPOTS + bit.x);
                bits[index >> 5] |= 1u << (index & 31u);
            }
        }
    if (bits.x != 0u)
        atomicOr(spots[piece.place].x, bits.x);
    if (bits.y != 0u)
        atomicOr(spots[piece.place].y, bits.y);
}

void record_landing(uint index, Piece piece, uint material)
{
    virga_landing_gpu landing = virga_landing_gpu(piece.place, VIRGA_GROUND_NONE, 0.0, material);
    if (piece.place != NO_CELL) {
        landing.material = floors[piece.place].material;
        landing.state = cell_state(cells[piece.place], landing.material);
        landing.depth_m = float(cells[piece.place].free_nl) * tick.m_per_nl;
    }
    landings[index] = landing;
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= head.count || impacts[index].tick != tick.tick)
        return;
    const virga_impact_gpu impact = impacts[index];
    const uint n = piece_count(impact);
    uint here = 0u, elsewhere = 0u;
    for (uint i = 0u; i < n; i++) {
        const Piece piece = get_piece(impact, i, n);
        if (i == 0u)
            record_landing(index, piece, impact.material);
        if (piece.place == NO_CELL) {
            elsewhere += piece.water_nl;
            continue;
        }
        here += piece.water_nl;
        atomicAdd(arrivals[piece.place].landed_nl, piece.water_nl);
        const float water_m = float(cells[piece.place].free_nl) * tick.m_per_nl;
        if (water_m >= LEAST_WATER_M) {
            const float drops = impact.weight / float(n);
            atomicAdd(stirs[piece.place], uint(drops * crater_variance(crater_depth(impact.diameter_m, water_m)) * 1e6));
        }
        leave_spot(piece, impact.diameter_m, virga_hash4(tick.seed, impact.id, impact.tick, 64u + i));
    }
    if (here > 0u)
        count_water(VIRGA_GROUND_LANDED, here);
    if (elsewhere > 0u)
        count_water(VIRGA_GROUND_ELSEWHERE, elsewhere);
}
