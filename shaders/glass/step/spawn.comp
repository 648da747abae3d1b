// spawn.comp - seeds come to their places: a free one, or the drop that is in their cell. Without a free place water
// joins the film.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "seeds.glsl"
#include "shared/compact.h"

layout(local_size_x = VIRGA_GLASS_FEW_GROUP) in;
layout(scalar, set = 0, binding = 4) readonly buffer List
{
    virga_list_gpu list;
    uint listed[];
};

// Everything but what others may add at the same time.
void start(uint place, virga_glass_seed_gpu seed, vec2 at, uint water, uint id)
{
    drops[place].position = drops[place].before = to_array(at);
    drops[place].velocity = seed.velocity;
    drops[place].water_nl = water;
    drops[place].kind = seed.kind | (seed.kind == VIRGA_GLASS_DROP ? VIRGA_GLASS_CHANGED : 0u);
    drops[place].cell = drops[place].from_cell = seed.cell;
    drops[place].ahead_m = 0.0;
    drops[place].tail_m = 0.0;
    drops[place].age_s = 0.0;
    drops[place].id = id;
    drops[place].random = virga_hash2(id, tick.pane.seed);
    drops[place].target = drops[place].captor = NOWHERE;
    if (seed.cell != NOWHERE)
        occupants[seed.cell] = place + 1u;
}

void to_film(vec2 at, uint water)
{
    const ivec2 cell = clamp(cell_at(at), ivec2(0), ivec2(tick.pane.columns, tick.pane.rows) - 1);
    atomicAdd(film[cell_number(cell)], water);
    mark_film(cell_number(cell));
    passed[cell_number(cell)] = tick.tick;
    count(VIRGA_GLASS_CROWDED, 1u);
}

// Particles of one seed, each shifted a little by chance (section 4.4).
void start_particles(uint i, virga_glass_seed_gpu seed)
{
    for (uint k = 0u; k < seed.count; k++) {
        const uint hash = virga_hash4(seed.id, tick.tick, i, k), rank = ranks[i] + k;
        const float turn = 6.2831853 * virga_unit(hash),
                    far = tick.particle_m * (0.2 + 0.8 * virga_unit(virga_hash1(hash)));
        const vec2 at = to_vec2(seed.position) + far * vec2(cos(turn), sin(turn));
        const uint water = seed.water_nl + (k < seed.extra_nl ? 1u : 0u);
        if (!has_glass(at))
            count(VIRGA_GLASS_WIPED, water); // pushed over the edge at once; its place stays free
        else if (rank < state.free)
            start(listed[state.alive + rank], seed, at, water, hash);
        else
            to_film(at, water);
    }
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= seed_count() || seeds[i].water_nl == 0u)
        return;
    const virga_glass_seed_gpu seed = seeds[i];
    if (seed.cell == NOWHERE) {
        start_particles(i, seed);
        return;
    }
    const uint first = claims[seed.cell], rank = ranks[first];
    const bool joins = (rank & JOINS) != 0u;
    if (!joins && rank >= state.free) {
        to_film(to_vec2(seed.position), seed.water_nl);
        return;
    }
    const uint place = joins ? rank & ~JOINS : listed[state.alive + rank];
    if (!joins && first == i)
        start(place, seed, to_vec2(seed.position), seed.water_nl, seed.id);
    else {
        // The first of several is not there to read: its place is its seed's.
        const vec2 there = joins ? to_vec2(drops[place].position) : to_vec2(seeds[first].position);
        const vec2 off = to_vec2(seed.position) - there;
        const ivec2 away = ivec2(round(clamp(off * (float(seed.water_nl) * 1e5), -2e8, 2e8)));
        atomicAdd(drops[place].merged_nl, seed.water_nl);
        atomicAdd(drops[place].merged_nl_10um[0], away.x);
        atomicAdd(drops[place].merged_nl_10um[1], away.y);
        count(VIRGA_GLASS_MERGED, 1u);
    }
}
