// touch.comp - ground that simulated water touches becomes wet: its pores are full, and a film stays on it. The water
// for that is counted; it comes from the simulation, which does not miss it.
//
// A particle is as wide as the distance of particles: it touches its own cell, and those whose middle is under it.
// One invocation per particle of water. Reads: particles, floors. Writes: cells, counts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "shared/particle.h"

layout(local_size_x = VIRGA_GROUND_GROUP) in;

layout(scalar, set = 0, binding = 27) readonly buffer Water { virga_particle_gpu particles[]; };

#define FILM_UM 50 // what clings to a level surface that water has left
#define MOST_CELLS 16 // under a particle, along each axis
#define BELOW_M 0.5 // water that is farther below a floor is under something else

// Fills up to `full`, and returns what was added. Of all particles over a cell one finds it empty, the others full.
#define FILL(member, full, added) \
    {                             \
        const uint was = atomicMax(member, full); \
        added += full - min(was, full);           \
    }

void wet(uint cell_index)
{
    const virga_soil_gpu soil = tick.soils[floor_of(cell_index).material];
    uint added = 0u;
    FILL(cells[cell_index].held_nl, soil.capacity_nl, added)
    if (soil.drain == 0u)
        FILL(cells[cell_index].free_nl, uint(FILM_UM * tick.nl_per_um), added)
    if (added > 0u)
        count_water(VIRGA_GROUND_TOUCHED, added);
}

void touch(ivec2 cell, float height)
{
    const uint cell_index = index_of_cell(cell + ivec2(tick.low_tile[0], tick.low_tile[1]) * VIRGA_GROUND_TILE);
    if (!is_ground(cell_index))
        return;
    const float above = height - float(floor_of(cell_index).height_um) * 1e-6;
    if (above < tick.water_reach_m && above > -BELOW_M)
        wet(cell_index);
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= tick.water_count || !(particles[index].share > 0.0))
        return;
    const float from[3] = particles[index].position, offset[3] = tick.water_offset;
    const vec3 position = vec3(from[0] + offset[0], from[1] + offset[1], from[2] + offset[2]);
    const vec2 at = position.xz * tick.inv_cell_m;
    if (!all(lessThan(abs(vec3(at, position.y)), vec3(1e6)))) // also for NaN
        return;
    const float half_wide = min(0.5 * tick.water_reach_m * tick.inv_cell_m, 0.5 * float(MOST_CELLS));
    const ivec2 own = ivec2(floor(at));
    const ivec2 first = min(ivec2(ceil(at - half_wide - 0.5)), own);
    const ivec2 last = max(ivec2(ceil(at + half_wide - 0.5)) - 1, own);
    for (int z = first.y; z <= last.y; z++)
        for (int x = first.x; x <= last.x; x++)
            touch(ivec2(x, z), position.y);
}
