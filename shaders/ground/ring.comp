// ring.comp - drops of this tick that fell on water start rings. One workgroup, so that places are handed out in the
// order of impacts: the newest rings take the places of the oldest.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"
#include "rings.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(scalar, set = 0, binding = 10) readonly buffer Landings { virga_landing_gpu landings[]; };

shared uint eligible, sums[VIRGA_GROUND_GROUP];

bool on_water(uint index)
{
    if (!is_of_tick(index))
        return false;
    const vec2 at_m = in_window(impacts[index]) * tick.cell_m - vec2(tick.ripple_low_m[0], tick.ripple_low_m[1]);
    return landings[index].cell != NO_CELL && landings[index].depth_m >= LEAST_WATER_M && min(at_m.x, at_m.y) > 0.0 &&
           max(at_m.x, at_m.y) < tick.ripple_side_m;
}

void start_ring(uint place, uint index)
{
    const virga_impact_gpu impact = impacts[index];
    const Piece piece = first_piece(impact);
    virga_ring_gpu ring;
    ring.cell = int[2](piece.cell.x, piece.cell.y);
    ring.in_cell = float[2](piece.in_cell.x, piece.in_cell.y);
    ring.tick = impact.tick;
    ring.share = fract(impact.time_s / tick.tick_s);
    ring.crater_m = crater_depth(impact.diameter_m, landings[index].depth_m);
    ring.depth_m = landings[index].depth_m;
    ring.id = impact.id;
    rings[place % VIRGA_RINGS] = ring;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u)
        eligible = 0u;
    barrier();
    for (uint first = 0u; first < head_count(); first += VIRGA_GROUND_GROUP)
        if (on_water(first + lane))
            atomicAdd(eligible, 1u);
    barrier();
    // By lot, so that those which live are never more than there are places for.
    const float quota = 0.95 * float(VIRGA_RINGS) * tick.tick_s / VIRGA_RING_TIME_S;
    const float share = quota / max(float(eligible), 1.0);
    uint total = rings_head.total;
    for (uint first = 0u; first < head_count(); first += VIRGA_GROUND_GROUP) {
        const uint index = first + lane;
        bool taken = on_water(index);
        if (taken)
            taken = virga_unit(virga_hash4(tick.seed, impacts[index].id, tick.tick, 9u)) < share;
        sums[lane] = taken ? 1u : 0u;
        for (uint reach = 1u; reach < VIRGA_GROUND_GROUP; reach *= 2u) {
            barrier();
            const uint lower = lane >= reach ? sums[lane - reach] : 0u;
            barrier();
            sums[lane] += lower;
        }
        barrier();
        if (taken)
            start_ring(total + sums[lane] - 1u, index);
        total += sums[VIRGA_GROUND_GROUP - 1];
        barrier();
    }
    if (lane == 0u)
        rings_head.total = total;
}
