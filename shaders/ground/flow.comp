// flow.comp - between rains: water runs downhill, sinks and dries, over all of the window.
//
// A thin sheet whose inertia does not matter (the diffusive wave): through the side that two cells share flows
//   q = h^(5/3) sqrt(S) / n   per metre of width (Manning), h the water above what the roughness of the upper cell
//   holds back, S the slope of the surface.
// It never takes more than a quarter of that water nor a fifth of the difference in height, so five cells can not
// swing, nor a cell run below empty. Both cells of a pair work out the same integer, so nothing is made or lost.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "groups.glsl"
#include "rings.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(scalar, set = 0, binding = 5) writeonly buffer Next { virga_cell_gpu next_cells[]; };

shared uint group_sunk, group_dried; // a few thousand nl a cell at most

const ivec2 sides[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

struct Surface {
    int height_um;
    uint material, free_nl;
};

// Without branches: software Vulkan reads buffers faster outside of them. What is no cell reads as the cell itself.
Surface surface_at(uint place)
{
    return Surface(floors[place].height_um, floors[place].material, cells[place].free_nl);
}

// What flows through the side from the higher of two surfaces to the lower one.
int flow_down(Surface upper, int difference)
{
    const uint material = min(upper.material, uint(VIRGA_GROUND_MATERIALS - 1));
    const uint retained = min(upper.free_nl, tick.soils[material].retention_nl);
    const int mobile = int(min(upper.free_nl - retained, 0x7fffffffu));
    precise const float h = float(mobile) * tick.m_per_nl;
    precise const float slope = float(difference) * tick.m_per_nl * tick.inv_cell_m;
    precise const float q = tick.soils[material].inv_manning * h * pow(h, 2.0 / 3.0) * sqrt(slope);
    precise const float moved = min(q * tick.flow_s * tick.inv_cell_m / tick.m_per_nl, 1e9);
    return min(int(moved), min(mobile / 4, difference / 5));
}

int net_inflow(uint place, Surface own, ivec2 cell)
{
    int sum = 0;
    const int most_um = MOST_STEP_NL / tick.nl_per_um;
    const int own_nl = int(min(own.free_nl, uint(MOST_STEP_NL)));
    for (int i = 0; i < 4; i++) {
        const uint found = cell_place(cell + sides[i]);
        const Surface other = surface_at(found == NO_CELL ? place : found);
        const int rise_um = clamp(other.height_um - own.height_um, -most_um, most_um);
        const int difference = rise_um * tick.nl_per_um + int(min(other.free_nl, uint(MOST_STEP_NL))) - own_nl;
        const bool comes = difference > 0;
        Surface upper = own;
        upper.material = comes ? other.material : own.material;
        upper.free_nl = comes ? other.free_nl : own.free_nl;
        const int flow = flow_down(upper, abs(difference));
        sum += found == NO_CELL || other.material == NO_GROUND ? 0 : comes ? flow : -flow;
    }
    return sum;
}

// Evaporation takes what lies on the cell, then, ever slower, what is in its pores.
uint dry(inout virga_cell_gpu cell, virga_soil_gpu soil, uint hash)
{
    const float share = cell.free_nl > 0u ? 1.0 : float(cell.held_nl) / max(float(soil.capacity_nl), 1.0);
    const uint wanted = round_fairly(tick.evaporation_nl_s * soil.drying * share * tick.flow_s, hash);
    const uint from_free = min(wanted, cell.free_nl), from_pores = min(wanted - from_free, cell.held_nl);
    cell.free_nl -= from_free;
    cell.held_nl -= from_pores;
    return from_free + from_pores;
}

void main()
{
    if (gl_LocalInvocationIndex == 0u) {
        group_sunk = 0u;
        group_dried = 0u;
    }
    barrier();
    const uint place = group_index() * VIRGA_GROUND_GROUP + gl_LocalInvocationIndex;
    virga_cell_gpu cell = cells[place];
    const ivec2 where = cell_at_place(place);
    const Surface own = surface_at(place);
    const int inflow = net_inflow(place, own, where);
    if (own.material != NO_GROUND) {
        const virga_soil_gpu soil = tick.soils[own.material];
        cell.free_nl = uint(int(cell.free_nl) + inflow);
        const uint hash =
            virga_hash2(tick.seed + 0x9e3779b9u * tick.tick, uint(where.x) * 0x85ebca6bu ^ uint(where.y) * 0xc2b2ae35u);
        const uint sunk = min(round_fairly(soil.sink_nl_s * tick.flow_s, hash), cell.free_nl);
        cell.free_nl -= sunk;
        const uint drained = soil.drain != 0u ? cell.free_nl : 0u;
        cell.free_nl -= drained;
        const uint dried = dry(cell, soil, virga_hash1(hash));
        if (sunk > 0u)
            atomicAdd(group_sunk, sunk);
        if (dried > 0u)
            atomicAdd(group_dried, dried);
        if (drained > 0u)
            count_water(VIRGA_GROUND_RUN_OFF, drained);
    }
    next_cells[place] = cell;
    stirs[place] = uint(float(stirs[place]) * exp(-tick.flow_s / calm_time(float(cell.free_nl) * tick.m_per_nl)));
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        if (group_sunk > 0u)
            count_water(VIRGA_GROUND_INFILTRATED, group_sunk);
        if (group_dried > 0u)
            count_water(VIRGA_GROUND_EVAPORATED, group_dried);
    }
}
