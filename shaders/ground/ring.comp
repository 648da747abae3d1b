// ring.comp - drops of this tick that fell on water start rings.
// One workgroup, so that ring slots are given in the order of impacts; the newest rings replace the oldest. Reads:
// impacts, landings, cells. Writes: rings.
//
// An impact that stands for many drops starts a ring for each of its pieces. If there are more than ring slots, rings
// are sampled by importance: each with a probability p proportional to the slope variance that it brings, drops
// crater^2, and at most 1. A sampled ring is sqrt(drops / p) times as steep, so that all rings together bring the
// variance of all drops:
//     E = sum p (crater sqrt(drops / p))^2 = sum drops crater^2
// With equal probabilities (one in fifty in heavy rain) nearly all rings would be those of the smallest drops, and
// puddles far too calm.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"
#include "rings.glsl"
#include "flow_average.glsl"
#include "speed.glsl"

// More lanes on a GPU, where the pass takes as long as one of them does; sums of integers do not depend on it.
layout(local_size_x = VIRGA_GROUND_GROUP, local_size_x_id = 5) in; // constant 5: see gpu/pipeline_build.c
#define LANES gl_WorkGroupSize.x
layout(scalar, set = 0, binding = 10) readonly buffer Landings { virga_landing_gpu landings[]; };

#define FIRST_RING_HASH 96u // first hash number for whether a piece starts a ring
#define MAX_NEW_RINGS 2048  // max rings in a tick: ten times the quota of a tick of 1 / 60 s

shared uint sums[LANES];
shared uint parts[3][LANES]; // three arrays: with 512 lanes all is 16 KB, which every device has
shared uint new_rings[MAX_NEW_RINGS]; // impact * VIRGA_GROUND_MAX_PIECES + piece; in order

float drops_of_piece(uint index) { return impacts[index].weight / float(piece_count(impacts[index])); }

Crater crater_at(virga_impact_gpu impact, float water_m)
{
    return crater_of(impact.diameter_m, length(vec3(impact.velocity[0], impact.velocity[1], impact.velocity[2])),
                     water_m);
}

// Weight of a piece: its crater in units of 20 um, squared, times its drops. All craters above that of 2.54 mm count
// the same, so that the sum over four million impacts fits.
uint weight_of(uint index)
{
    const float units = crater_at(impacts[index], landings[index].depth_m).depth_m * 5e4;
    return uint(clamp(units * units * drops_of_piece(index), 1.0, 16129.0));
}

// All that it reads is read at once, as the pass waits for memory each time that it reads. The impacts are drops.
bool on_water(uint index)
{
    if (index >= head_count())
        return false;
    const uint fallen = impacts[index].tick, cell = landings[index].cell;
    const float depth_m = landings[index].depth_m;
    const vec2 at_m =
        cells_in_window_of(impacts[index]) * tick.cell_m - vec2(tick.ripple_low_m[0], tick.ripple_low_m[1]);
    const bool on_map = min(at_m.x, at_m.y) > 0.0 && max(at_m.x, at_m.y) < tick.ripple_side_m;
    return fallen == tick.tick && cell != NO_CELL && depth_m >= MIN_WATER_M && on_map;
}

struct RingCounts {
    float pieces, measure;
};

// Of the pieces on water with a weight below a bar: their number, and the sum of their weights. Integer sums, so that
// the order of drops does not matter.
RingCounts count_below(float bar)
{
    const uint lane = gl_LocalInvocationIndex;
    uvec3 own = uvec3(0u);
    for (uint first = 0u; first < head_count(); first += LANES)
        if (on_water(first + lane)) {
            const uint measure = weight_of(first + lane), pieces = piece_count(impacts[first + lane]);
            if (float(measure) < bar)
                own += uvec3(pieces, (pieces * measure) & 1023u, (pieces * measure) >> 10);
        }
    for (uint i = 0u; i < 3u; i++)
        parts[i][lane] = own[i];
    for (uint reach = LANES / 2u; reach > 0u; reach /= 2u) {
        barrier();
        if (lane < reach)
            for (uint i = 0u; i < 3u; i++)
                parts[i][lane] += parts[i][lane + reach];
    }
    barrier();
    const uvec3 all = uvec3(parts[0][0], parts[1][0], parts[2][0]);
    barrier();
    return RingCounts(float(all.x), float(all.y) + 1024.0 * float(all.z));
}

// The bar: a piece with at least this weight always gets a ring, one below with the probability weight / bar. The
// probabilities add up to the quota at most.
float find_bar()
{
    // So that living rings and those still to fall never exceed the ring slots.
    const float longest_s = VIRGA_RING_MAX_LIFE_S + VIRGA_GROUND_PIECE_S * float(VIRGA_GROUND_MAX_PIECES);
    const float quota = 0.95 * float(VIRGA_MAX_RINGS) * tick.tick_s / longest_s;
    const RingCounts all = count_below(1e30);
    if (all.pieces <= quota)
        return 0.0;
    // Pieces above the first bar leave a part of the quota to the others.
    const RingCounts low = count_below(all.measure / quota);
    return low.measure / max(quota - (all.pieces - low.pieces), 1.0);
}

float chance_of(uint index, float bar) { return min(float(weight_of(index)) / max(bar, 1e-6), 1.0); }

// A bit for each piece of an impact that starts a ring.
uint choose_pieces(uint index, float bar)
{
    const float chance = chance_of(index, bar);
    const uint pieces = piece_count(impacts[index]);
    uint chosen = 0u;
    for (uint i = 0u; i < pieces; i++)
        if (virga_unit(virga_hash4(tick.seed, impacts[index].id, tick.tick, FIRST_RING_HASH + i)) < chance)
            chosen |= 1u << i;
    return chosen;
}

// Lists the pieces that start a ring, in order; returns their number.
uint list_new_rings(float bar)
{
    const uint lane = gl_LocalInvocationIndex;
    uint total = 0u;
    for (uint first = 0u; first < head_count(); first += LANES) {
        const uint index = first + lane;
        uint chosen = on_water(index) ? choose_pieces(index, bar) : 0u;
        sums[lane] = bitCount(chosen);
        for (uint reach = 1u; reach < LANES; reach *= 2u) {
            barrier();
            const uint lower = lane >= reach ? sums[lane - reach] : 0u;
            barrier();
            sums[lane] += lower;
        }
        barrier();
        for (uint at = total + sums[lane] - bitCount(chosen); chosen != 0u; chosen &= chosen - 1u, at++)
            if (at < MAX_NEW_RINGS)
                new_rings[at] = index * VIRGA_GROUND_MAX_PIECES + uint(findLSB(chosen));
        total += sums[LANES - 1];
        barrier();
    }
    return min(total, MAX_NEW_RINGS);
}

void start_ring(uint ring_index, uint index, uint i, float chance)
{
    const virga_impact_gpu impact = impacts[index];
    const Piece piece = get_piece(impact, first_piece(impact), i, piece_count(impact));
    const float water_m = i == 0u ? landings[index].depth_m : depth_at(piece.cell_index);
    virga_ring_gpu ring;
    ring.cell = int[2](piece.cell.x, piece.cell.y);
    ring.in_cell = float[2](piece.in_cell.x, piece.in_cell.y);
    ring.tick = impact.tick;
    ring.share = fract(impact.time_s / tick.tick_s) + delay_ticks(impact, i, piece_hash(impact, i));
    const Crater crater = crater_at(impact, water_m);
    ring.crater_m = water_m < MIN_WATER_M ? 0.0 : crater.depth_m * sqrt(drops_of_piece(index) / chance);
    ring.width = crater.width;
    ring.depth_m = water_m;
    ring.id = impact.id;
    float running;
    uint material;
    const vec2 drift = speed_at(piece.cell, running, material) / MEAN_SHARE;
    ring.drift = float[2](drift.x, drift.y);
    rings[ring_index % VIRGA_MAX_RINGS] = ring;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    const float bar = find_bar();
    const uint count = list_new_rings(bar), total = rings_head.total;
    for (uint i = lane; i < count; i += LANES) {
        const uint index = new_rings[i] / VIRGA_GROUND_MAX_PIECES;
        start_ring(total + i, index, new_rings[i] % VIRGA_GROUND_MAX_PIECES, chance_of(index, bar));
    }
    barrier();
    if (lane == 0u)
        rings_head.total = total + count;
}
