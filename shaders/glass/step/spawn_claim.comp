// spawn_claim.comp - creates the seeds of drops that land, then all seeds claim their cells; the seed with the lowest
// number wins.
// One invocation per seed. Reads: the host's impacts, occupants, blades. Writes: seeds, claims, film.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "seeds.glsl"
#include "blades.glsl"
#include "flood.glsl"
#include "shared/impact.h"

layout(local_size_x = VIRGA_GLASS_SMALL_GROUP) in;
layout(scalar, set = 0, binding = 14) readonly buffer Impacts
{
    virga_impacts_gpu head;
    virga_impact_gpu impacts[];
};

virga_glass_seed_gpu no_seed()
{
    return virga_glass_seed_gpu(float[2](0.0, 0.0), float[2](0.0, 0.0), 0u, 0u, 0u, NONE, 0u, VIRGA_GLASS_DROP);
}

// A drop of the rain rate: anywhere on the pane, with less probability where the pane turns away from the rain.
virga_glass_seed_gpu rain_drop(uint i)
{
    const uint hash = virga_hash3(tick.pane.seed, tick.tick, i);
    virga_glass_seed_gpu seed = no_seed();
    const vec2 at = vec2(virga_unit(virga_hash2(hash, 1u)) * tick.pane.width_m,
                         virga_unit(virga_hash2(hash, 2u)) * tick.pane.height_m);
    const float cosine = -dot(to_vec(tick.fall), normalize(frame_at(at).normal));
    if (cosine <= virga_unit(virga_hash2(hash, 3u)) * tick.fall_cosine)
        return seed;
    // A random size class, and within it some more or less water, with the mean of the class.
    const float d = tick.sizes_m[uint(virga_unit(virga_hash2(hash, 4u)) * float(VIRGA_GLASS_SIZES))];
    const float water = 0.5235988e12 * d * d * d * (0.8 + 0.4 * virga_unit(virga_hash2(hash, 5u)));
    seed.position = to_array(at);
    seed.water_nl = round_randomly(water, virga_hash2(hash, 6u));
    seed.id = hash;
    return seed;
}

// A drop of the host's list, if it lands in this tick.
virga_glass_seed_gpu host_drop(uint i)
{
    virga_glass_seed_gpu seed = no_seed();
    if (i >= state.impacts || impacts[i].tick != tick.tick)
        return seed;
    seed.position = float[2](impacts[i].position[0], impacts[i].position[1]);
    seed.water_nl = impacts[i].water_nl;
    seed.id = impacts[i].id;
    return seed;
}

bool is_on_blade(vec2 at)
{
    for (uint i = 0u; i < tick.blade_count; i++)
        if (is_swept(i, at, at, 0.0))
            return true;
    return false;
}

// Decides what becomes of it: a drop that misses the pane is ignored, one that lands on a blade is wiped off, one that
// lands on simulated water joins it, a fine one becomes film.
void land_drop(inout virga_glass_seed_gpu seed)
{
    const ivec2 cell = cell_at(to_vec2(seed.position));
    if (seed.water_nl == 0u || !has_glass(to_vec2(seed.position))) {
        seed.water_nl = 0u;
        return;
    }
    count(VIRGA_GLASS_LANDED, seed.water_nl);
    count(VIRGA_GLASS_ARRIVED, 1u);
    seed.cell = cell_number(cell);
    if (is_on_blade(to_vec2(seed.position)) || is_on_blade(cell_middle(seed.cell))) {
        count(VIRGA_GLASS_WIPED, seed.water_nl);
        seed.water_nl = 0u;
    } else if (is_under_water(seed.cell)) {
        count(VIRGA_GLASS_JOINED, seed.water_nl);
        seed.water_nl = 0u;
    } else if (float(seed.water_nl) < tick.mist_nl) { // no fresh film: these are fine drops from the start
        atomicAdd(film[seed.cell], seed.water_nl);
        mark_film(seed.cell);
        seed.water_nl = 0u;
    }
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= seed_count())
        return;
    if (i < landing_count()) {
        virga_glass_seed_gpu seed = i < tick.arrivals ? rain_drop(i) : host_drop(i - tick.arrivals);
        land_drop(seed);
        seeds[i] = seed;
    } else if (seeds[i].water_nl != 0u && seeds[i].cell != NONE && is_on_blade(cell_middle(seeds[i].cell))) {
        atomicAdd(film[seeds[i].cell], seeds[i].water_nl); // it was left behind where a blade has come to since
        mark_film(seeds[i].cell);
        seeds[i].water_nl = 0u;
    }
    if (seeds[i].water_nl != 0u && seeds[i].cell != NONE)
        atomicMin(claims[seeds[i].cell], i);
}
