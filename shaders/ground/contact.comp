// contact.comp - wheels and feet move the water under them: some flies, some is pushed into the cells around.
// One workgroup, in which each invocation takes a run of the cells near contacts, so that droplets are listed in the
// order of cells. Reads: floors. Writes: cells, arrivals, the list of droplets, counts, wakes, spawns.
//
// A cell belongs to the first contact that covers it, and nothing that is written here is read here but by the
// invocation that writes it. So the result does not depend on the order of invocations.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "contacts.glsl"
#include "contact_plan.glsl"
#include "contact_throw.glsl"
#include "rings.glsl"
#include "wakes.glsl"
#include "contact_sheet.glsl"
#define SCAN_LANES uint(VIRGA_GROUND_LANES)
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_GROUND_LANES) in;
layout(scalar, set = 0, binding = 6) buffer Arrivals { virga_arrivals_gpu arrivals[]; };

shared uint listed; // droplets at the end

// The cell that a plan's pushed water goes to; NO_CELL: it stays.
uint target_of(Near near, Plan plan)
{
    const vec2 to = out_of_contact(near.contact, plan.at + plan.outward * plan.push_m) * tick.inv_cell_m;
    const ivec2 low = ivec2(tick.low_tile[0], tick.low_tile[1]) * VIRGA_GROUND_TILE;
    const uint target = index_of_cell(ivec2(floor(to)) + low);
    if (!is_ground(target) || target == near.cell_index)
        return NO_CELL;
    const int rise_um = floor_of(target).height_um - floor_of(near.cell_index).height_um;
    const int max_um = int(1e6 * REACH_M);
    return abs(rise_um) <= max_um ? target : NO_CELL;
}

void carry_out(Near near, Plan plan, uint first, bool has_room)
{
    uint gone = 0u;
    if (has_room && plan.droplets > 0u) {
        throw_droplets(near, plan, first);
        gone = plan.tread_nl + plan.sheet_nl;
        count_water(VIRGA_GROUND_THROWN, gone);
    }
    const uint target = plan.pushed_nl > 0u ? target_of(near, plan) : NO_CELL;
    if (target != NO_CELL) {
        atomicAdd(arrivals[target].given_nl, plan.pushed_nl);
        gone += plan.pushed_nl;
    }
    if (gone == 0u)
        return;
    const uint before_nl = cells[near.cell_index].free_nl;
    cells[near.cell_index].free_nl = before_nl - gone;
    stir(near.contact, plan.at, gone, before_nl);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, all_cells = contact_cells();
    const uint run = (all_cells + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, all_cells), end = min(begin + run, all_cells);
    const bool throws = tick.contact_droplets > 0u;
    const uint held = throws ? handed_head.count : 0u, capacity = throws ? handed_head.capacity : 0u;
    if (lane == 0u)
        listed = held;
    clear_wakes();
    uint wanted = 0u;
    for (uint number = begin; number < end; number++)
        wanted += plan_of(near_of(number)).droplets;
    uvec2 all;
    uint next = held + scan_group(uvec2(wanted, 0u), all).x;
    for (uint number = begin; number < end; number++) {
        const Near near = near_of(number);
        const Plan plan = plan_of(near);
        const bool has_room = next + plan.droplets <= capacity;
        if (plan.moves)
            carry_out(near, plan, next, has_room);
        next += plan.droplets;
        if (has_room)
            atomicMax(listed, next);
    }
    barrier();
    if (lane == 0u && throws && listed > held) {
        handed_head.count = listed;
        handed_head.group_count = uint[3]((listed + 63u) / 64u, 1u, 1u);
    }
    start_wakes();
    barrier();
    start_sheets();
}
