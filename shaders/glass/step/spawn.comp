// spawn.comp - seeds become drops and particles: in a free slot, or in the drop that occupies their cell. Without a
// free slot their water becomes film.
// One invocation per seed. Reads: seeds, claims, ranks, the live list. Writes: drops, occupants, film.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "seeds.glsl"
#include "shared/compact.h"

layout(local_size_x = VIRGA_GLASS_SMALL_GROUP) in;
layout(scalar, set = 0, binding = 4) readonly buffer List
{
    virga_list_gpu list;
    uint listed[];
};

// Sets everything but the sums that other invocations may add to at the same time.
void init_drop(uint slot, virga_glass_seed_gpu seed, vec2 at, uint water, uint id)
{
    drops[slot].position = drops[slot].previous_position = to_array(at);
    drops[slot].velocity = seed.velocity;
    drops[slot].water_nl = water;
    drops[slot].kind = seed.kind | (seed.kind == VIRGA_GLASS_DROP ? VIRGA_GLASS_CHANGED : 0u);
    drops[slot].cell = drops[slot].from_cell = seed.cell;
    drops[slot].progress_m = 0.0;
    drops[slot].tail_spacing_m = 0.0;
    drops[slot].age_s = 0.0;
    drops[slot].id = id;
    drops[slot].random = virga_hash2(id, tick.pane.seed);
    drops[slot].target = drops[slot].absorbed_by = NONE;
    drops[slot].strain = drops[slot].tail = drops[slot].outline_tick = 0u;
    if (seed.cell != NONE)
        occupants[seed.cell] = slot + 1u;
}

void add_to_film(vec2 at, uint water)
{
    const ivec2 cell = clamp(cell_at(at), ivec2(0), ivec2(tick.pane.columns, tick.pane.rows) - 1);
    atomicAdd(film[cell_number(cell)], water);
    mark_film(cell_number(cell));
    passed[cell_number(cell)] = wetted_now();
    count(VIRGA_GLASS_WITHOUT_SLOT, 1u);
}

// Spawns the particles of one seed, each shifted a little at random (Goto et al. 2009, section 4.4). How many seeds are
// before this one depends on the number of ticks in a step, so its number among all is no part of the random number.
void spawn_particles(uint i, virga_glass_seed_gpu seed)
{
    for (uint k = 0u; k < seed.count; k++) {
        const uint hash = virga_hash4(seed.id, tick.tick, i - landing_count(), k), rank = ranks[i] + k;
        const float angle = 6.2831853 * virga_unit(hash),
                    distance = tick.particle_m * (0.2 + 0.8 * virga_unit(virga_hash1(hash)));
        const vec2 at = to_vec2(seed.position) + distance * vec2(cos(angle), sin(angle));
        const uint water = seed.water_nl + (k < seed.extra_nl ? 1u : 0u);
        if (!has_glass(at))
            count(VIRGA_GLASS_WIPED, water); // it starts over the edge; its slot stays free
        else if (rank < state.free)
            init_drop(listed[state.alive + rank], seed, at, water, hash);
        else
            add_to_film(at, water);
    }
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= seed_count() || seeds[i].water_nl == 0u)
        return;
    const virga_glass_seed_gpu seed = seeds[i];
    if (seed.cell == NONE) {
        spawn_particles(i, seed);
        return;
    }
    const uint first = claims[seed.cell], rank = ranks[first];
    const bool joins = (rank & JOINS) != 0u;
    if (!joins && rank >= state.free) {
        add_to_film(to_vec2(seed.position), seed.water_nl);
        return;
    }
    const uint slot = joins ? rank & ~JOINS : listed[state.alive + rank];
    if (!joins && first == i)
        init_drop(slot, seed, to_vec2(seed.position), seed.water_nl, seed.id);
    else {
        // The drop of the first seed may not be written yet; its position is that of its seed.
        const vec2 there = joins ? to_vec2(drops[slot].position) : to_vec2(seeds[first].position);
        const vec2 offset = to_vec2(seed.position) - there;
        const ivec2 moment = ivec2(round(clamp(offset * (float(seed.water_nl) * 1e5), -2e8, 2e8)));
        atomicAdd(drops[slot].merged_nl, seed.water_nl);
        atomicAdd(drops[slot].merged_nl_10um[0], moment.x);
        atomicAdd(drops[slot].merged_nl_10um[1], moment.y);
        count(VIRGA_GLASS_MERGED, 1u);
    }
}
