// take.comp - water that stands in the region becomes particles of a simulation: each cell gives as many times the
// volume of a particle as it has, in the order of cells, as long as the simulation has room. What is less than a
// particle stays, and so does a film. The particles of a cell stand in layers, a spacing apart or a little more, so
// that an even number is in the cell.
// One workgroup, in which each invocation takes a run of cells. Reads: floors. Writes: cells, the exchange, counts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "exchange.glsl"
#define SCAN_LANES uint(VIRGA_GROUND_GROUP)
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;

#define FILM_UM 50 // stays on the ground

// The cell of a number in the region.
uint region_cell(uint number, uint width)
{
    return index_of_cell(ivec2(tick.region_low[0], tick.region_low[1]) + ivec2(number % width, number / width));
}

// Particles along the side of a cell.
uint side() { return max(uint(tick.cell_m / exchange.spacing_m + 0.01), 1u); }

// Height of the floor under the particles of a cell, from the simulation's origin.
float floor_under(uint cell_index)
{
    return max(float(floor_of(cell_index).height_um) * 1e-6 - tick.exchange_offset[1], exchange.floor_m);
}

uint particles_of(uint cell_index)
{
    if (!is_ground(cell_index))
        return 0u;
    const virga_soil_gpu soil = tick.soils[floor_of(cell_index).material];
    const uint free_nl = cells[cell_index].free_nl;
    const uint stays = min(max(uint(FILM_UM * tick.nl_per_um), hidden_nl(soil)), free_nl);
    const float layers = (exchange.ceiling_m - floor_under(cell_index)) / exchange.spacing_m;
    return min((free_nl - stays) / exchange.particle_nl, uint(clamp(layers, 0.0, 65536.0)) * side() * side());
}

void take(uint number, uint width, uint first, uint count)
{
    const uint cell_index = region_cell(number, width), along = side();
    const ivec2 low = ivec2(tick.low_tile[0], tick.low_tile[1]) * VIRGA_GROUND_TILE;
    const vec2 corner = vec2(cell_at_index(cell_index) - low) * tick.cell_m;
    const float bottom = floor_under(cell_index);
    for (uint i = 0u; i < count; i++) {
        const vec2 in_cell = (vec2(i % along, i / along % along) + 0.5) * (tick.cell_m / float(along));
        const vec2 at = corner + in_cell - vec2(tick.exchange_offset[0], tick.exchange_offset[2]);
        const float height = bottom + (float(i / (along * along)) + 0.5) * exchange.spacing_m;
        entries[first + i] = virga_exchanged_gpu(float[3](at.x, height, at.y), exchange.particle_nl);
    }
    cells[cell_index].free_nl -= count * exchange.particle_nl;
}

void count_taken(uint particles)
{
    uint high, low;
    umulExtended(particles, exchange.particle_nl, high, low);
    count_water(VIRGA_GROUND_TAKEN, low);
    atomicAdd(counts[VIRGA_GROUND_TAKEN].high, high);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    const ivec2 low = ivec2(tick.region_low[0], tick.region_low[1]);
    const ivec2 size = max(ivec2(tick.region_high[0], tick.region_high[1]) - low, 0);
    const uint width = uint(size.x), cells_in = exchange.capacity > 0u ? uint(size.x * size.y) : 0u;
    const uint run = (cells_in + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, cells_in), end = min(begin + run, cells_in);
    const uint room = exchange.taken == 0u ? min(exchange.capacity, exchange.free_slots) : 0u;
    uint wanted = 0u;
    for (uint number = begin; number < end; number++)
        wanted += particles_of(region_cell(number, width));
    uvec2 all;
    uint next = scan_group(uvec2(wanted, 0u), all).x;
    for (uint number = begin; number < end && next < room; number++) {
        const uint count = min(particles_of(region_cell(number, width)), room - next);
        if (count > 0u)
            take(number, width, next, count);
        next += count;
    }
    barrier();
    if (lane != 0u)
        return;
    const uint taken = min(all.x, room);
    if (taken > 0u) {
        exchange.taken = taken;
        count_taken(taken);
    }
    exchange.waiting = all.x - taken;
    exchange.given = 0u;
    exchange.given_groups = uint[3](0u, 1u, 1u);
}
