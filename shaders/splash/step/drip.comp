// drip.comp - rain water that drains to edges, hangs there and falls as drops: they go into the list of droplets that
// are handed over, behind those that are there. What finds no room stays where it is, and is late. Drops that are late
// at many places must not all fall as soon as there is room: a place that has some lets a quarter more fall than comes
// to it, at random times.
//
// What an index has is the water of one place. If another place has got it, that water is gone, and counted.
//
// All ticks of a step at once. Every site is stepped twice: to count its drops, and to write them behind those of the
// sites before it. Another site is the first in each step, so that it is not always the same that find no room.
// One workgroup, in which each invocation takes a run of sites. Reads: sites. Writes: their water, the list, counts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#include "counters.glsl"
#define HANDED_BINDING 1
#include "handed.glsl"
#include "shared/drip_gpu.h"
#define SOFTWARE_LANES VIRGA_SPLASH_LANES
#include "gpu/long_scan.glsl"

layout(scalar, set = 0, binding = 2) readonly buffer Sites { virga_drip_site_gpu sites[]; };
layout(scalar, set = 0, binding = 3) buffer Drips { virga_drip_gpu drips[]; };

#define MAX_FILM_NL 4000000000u
#define MAX_HANG_NL 1000000000u
#define MAX_DROPS   4u   // of a site in a tick
#define LATE_PACE   1.25 // drops that fall from a place with late ones, over those that come to it
#define LATE_S      1.0  // s, the mean time until a late one falls from a place to which nothing comes
#define SHOWN_S     0.15 // drops are seen as soon as they fall: see CLEAR_S in splash/draw/sprite.glsl

// A whole number whose mean is the value.
uint whole(float value, uint hash) { return uint(min(floor(value + virga_unit(hash)), 4294967040.0)); }

// Sizes are uniform between the two ends.
float diameter_of(uint seed, uint number)
{
    return mix(tick.drip_m[0], tick.drip_m[1], virga_unit(virga_hash3(seed, number, 1u)));
}

// nl of the drops that fall as one: pi / 6 d^3, in mm^3 for d in mm. Below 2^32: 64 drops of 7 mm.
uint water_of(virga_drip_site_gpu site, float diameter_m)
{
    const float mm = 1e3 * diameter_m;
    return uint(523.598776 * mm * mm * mm * site.drops);
}

// Before its first tick: as dry, or with the film that this rain keeps up, and with a part of a drop, so that sites do
// not drip at the same time.
virga_drip_gpu begin_drip(virga_drip_site_gpu site)
{
    const float inflow = site.catch_m2 * tick.drip_nl / tick.tick_s;
    const bool wet = tick.drip_wet != 0u && inflow > 0.0;
    virga_drip_gpu drip = virga_drip_gpu(0u, 0u, 0u, site.owner);
    if (wet) {
        drip.film_nl = uint(min(pow(inflow / site.drain, 1.0 / 3.0), 0.5 * float(MAX_FILM_NL)));
        drip.hang_nl = uint(virga_unit(virga_hash1(site.seed)) * float(water_of(site, diameter_of(site.seed, 0u))));
    }
    return drip;
}

// A drop that fell `age_s` before the end of the step. In this short time the air hardly slows it down. From a place
// that stands it has flown v t ahead of it. One that moves has done so too: the drop left it at x - v t, and both are
// at x now.
void write_drop(uint index, virga_drip_site_gpu site, uint number, float age_s)
{
    const float diameter_m = diameter_of(site.seed, number), late_s = age_s + tick.handed_late_s;
    vec3 position = to_vec(site.position) + to_vec(tick.drip_offset);
    position += to_vec(site.velocity) * (site.jet * late_s);
    position.y -= 0.5 * diameter_m + 0.5 * GRAVITY * late_s * late_s;
    virga_handed_droplet_gpu drop;
    drop.position = float[3](position.x, position.y, position.z);
    drop.age_s = SHOWN_S + late_s;
    drop.velocity = float[3](site.velocity[0], site.velocity[1] - GRAVITY * late_s, site.velocity[2]);
    drop.diameter_m = diameter_m;
    drop.id = virga_hash2(site.seed, number);
    drop.number = 0u;
    drop.water_nl = water_of(site, diameter_m);
    drop.drops = site.drops;
    handed[index] = drop;
}

// Water of a tick: rain to the film, film to the edge. Returns what reached the edge.
uint drain(virga_drip_site_gpu site, uint number, inout virga_drip_gpu drip, inout uint caught)
{
    const uint hash = virga_hash3(site.seed, number, 0u);
    const uint rain = whole(site.catch_m2 * tick.drip_nl, hash);
    const uint kept = min(rain, MAX_FILM_NL - drip.film_nl);
    const float film = float(drip.film_nl + kept);
    const float rate = site.drain * film * film * film;
    const uint out_nl = drip.hang_nl < MAX_HANG_NL ? min(whole(rate * tick.tick_s, virga_hash1(hash)), uint(film)) : 0u;
    const uint left = min(out_nl, drip.film_nl + kept);
    caught += kept; // beyond a film of litres nothing stays
    drip.film_nl += kept - left;
    drip.hang_nl += left;
    return left;
}

// Whether the late drop k of a tick falls in it, by chance: what falls is `quota_nl` in the mean, or more, so that the
// last ones fall too. Takes from the quota what falls. The tick has one random number for all its drops: only the last
// of them does not fall for certain.
bool late_falls(float random, uint k, uint size_nl, inout float quota_nl)
{
    const float size = float(size_nl), least = k == 0u ? size * (tick.tick_s / LATE_S) : 0.0;
    const bool falls = random * size < max(quota_nl, least);
    quota_nl -= size;
    return falls;
}

// All ticks of a step. `last`: drops are written from `index` on, as far as there is room. Returns their number.
uint step_site(uint i, bool last, uint room, inout uint index, inout uvec3 water)
{
    const virga_drip_site_gpu site = sites[i];
    virga_drip_gpu drip = drips[i];
    uint fell = 0u, caught = 0u;
    if (drip.owner != site.owner) {
        if (last) {
            count(VIRGA_SPLASH_DRIP_LEFT, drip.film_nl);
            count(VIRGA_SPLASH_DRIP_LEFT, drip.hang_nl);
        }
        drip = begin_drip(site);
        caught = drip.film_nl + drip.hang_nl;
    }
    for (uint t = 0u; t < tick.tick_in_step; t++) {
        const uint number = tick.tick - tick.tick_in_step + t, came = drain(site, number, drip, caught);
        uint size = water_of(site, diameter_of(site.seed, drip.drops));
        const bool late = drip.hang_nl - came >= size;
        const uint hash = late ? virga_hash3(site.seed, number, 2u) : 0u;
        const float random = virga_unit(hash), late_rest = float(hash & 255u) / 256.0;
        float quota = LATE_PACE * float(came);
        for (uint k = 0u; k < MAX_DROPS && drip.hang_nl >= size && !(last && index >= room); k++) {
            if (late && !late_falls(random, k, size, quota))
                break;
            drip.hang_nl -= size;
            // It falls when there is enough water for it: what hangs then came later in the tick. A late one falls at
            // any time, four of them at different ones (golden section).
            const float rest = late ? fract(late_rest + 0.618034 * float(k))
                                    : clamp(float(drip.hang_nl) / float(max(came, 1u)), 0.0, 1.0);
            if (last) {
                write_drop(index++, site, drip.drops, (float(tick.tick_in_step - 1u - t) + rest) * tick.tick_s);
                water += uvec3(0u, size, uint(site.drops));
            }
            drip.drops++;
            size = water_of(site, diameter_of(site.seed, drip.drops));
            fell++;
        }
    }
    if (last) {
        drips[i] = drip;
        water.x += caught;
    }
    return fell;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, run = (tick.drip_sites + SCAN_LANES - 1u) / SCAN_LANES;
    const uint begin = min(lane * run, tick.drip_sites), end = min(begin + run, tick.drip_sites);
    // Not the list's capacity, which is for others that write to it and leaves these slots.
    const uint before = handed_count(), room = min(tick.max_handed, tick.max_droplets - state.staying);
    const uint first = virga_hash1(tick.tick) % max(tick.drip_sites, 1u);
    uint fell = 0u, index = 0u;
    uvec2 all = uvec2(0u);
    for (uint pass = 0u; pass < 2u; pass++) {
        if (pass == 1u)
            index = before + scan_group(uvec2(fell, 0u), all).x;
        for (uint i = begin; i < end; i++) {
            uvec3 water = uvec3(0u);
            fell += step_site((first + i) % tick.drip_sites, pass == 1u, room, index, water);
            count(VIRGA_SPLASH_DRIP_IN, water.x);
            count(VIRGA_SPLASH_DRIP_OUT, water.y);
            count(VIRGA_SPLASH_DRIPS, water.z);
        }
    }
    if (lane != 0u)
        return;
    const uint total = min(before + all.x, max(room, before));
    count(VIRGA_SPLASH_DRIPS_HELD, before + all.x - total);
    const uint ticks = max(tick.tick_in_step, 1u);
    handed_head.drips = (all.x + ticks - 1u) / ticks;
    handed_head.count = total;
    handed_head.group_count = uint[3]((total + 63u) / 64u, 1u, 1u);
}
