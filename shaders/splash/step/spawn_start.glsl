// spawn_start.glsl - starts a splash and its droplets from a spawn.

#include "shared/crown_sheet.h"

// The first slots of this tick's splashes, droplets and returns.
struct Starts {
    uint splash, droplet, returned;
    uint first_splash; // the oldest splash that is kept
    uint full_from; // rank among this tick's spawns from which on there is no room for droplets
};

// Random streams of a splash, and of each of its droplets.
#define TURN_HASH 1u
#define CONE_HASH 2u
#define BESIDE_HASH 3u
#define DROPLET_HASH 16u // + 4 times its index

#define BESIDE_M 0.3

struct Frame { // axes of the surface
    vec3 normal, side, across;
};

Frame surface_frame(vec3 normal)
{
    Frame frame;
    frame.normal = normal;
    frame.side = normalize(abs(normal.y) > 0.7 ? vec3(normal.y, -normal.x, 0.0) : vec3(normal.z, 0.0, -normal.x));
    frame.across = cross(frame.side, normal);
    return frame;
}

// What the drop's motion along the surface adds to its droplets (section 4.5).
vec3 lean_of(virga_spawn_gpu spawn)
{
    const vec3 velocity = to_vec(spawn.velocity), normal = to_vec(spawn.normal);
    if (is_of_foot(spawn)) // the half axes instead, see droplet.h
        return vec3(velocity.x, 0.0, velocity.z) * (-velocity.y / GRAVITY);
    return tick.bounce * (velocity - dot(velocity, normal) * normal);
}

float splash_life(virga_spawn_gpu spawn)
{
    if (is_of_foot(spawn))
        return 2.0 * drop_speed(spawn) / GRAVITY;
    switch (spawn_model(spawn)) {
    case VIRGA_SPLASH_CROWN_CONE: return crown_time(crown_height(spawn.diameter_m, weber_number(spawn)));
    case VIRGA_SPLASH_DISK: return DISK_S;
    case VIRGA_SPLASH_DOT: return DOT_S;
    }
    return max(SHEET_S, crown_time(MAX_SHEET * crown_height(spawn.diameter_m, weber_number(spawn))));
}

// Slope of the surface along x and z.
vec2 slopes_of(vec3 normal) { return clamp(-normal.xz / max(normal.y, 0.02), vec2(-50.0), vec2(50.0)); }

// Water of its droplets over that of the crown (crown_sheet.h), in units of 1 / 256.
uint flown_share(virga_spawn_gpu spawn, uint droplets)
{
    if (is_of_foot(spawn))
        return uint(256.0 * VIRGA_CROWN_SHED);
    const float drop_nl = 0.5235988e12 * spawn.diameter_m * spawn.diameter_m * spawn.diameter_m;
    const float share = float(spawn.water_nl) / max(VIRGA_CROWN_DROPS * spawn.drops * drop_nl, 1e-6);
    return droplets > 0u ? uint(256.0 * clamp(share, 0.0, 0.9)) : 0u;
}

void write_splash(uint index, uint first, virga_spawn_gpu spawn, vec3 position, uint droplets)
{
    if (index - first >= tick.max_splashes)
        return; // newer splashes of this tick have its slot
    const vec3 lean = lean_of(spawn);
    virga_splash_gpu splash;
    splash.position = float[3](position.x, position.y, position.z);
    splash.share = spawn.share;
    splash.tick = tick.tick;
    splash.diameter_m = spawn.diameter_m;
    splash.speed_m_s = drop_speed(spawn);
    splash.depth_weight = halves(spawn.depth_m * 1e3, spawn.weight);
    splash.normal = spawn.normal;
    splash.random = spawn.random;
    splash.life_s = splash_life(spawn);
    splash.lean = halves(lean.x, lean.z);
    splash.kind = spawn_model(spawn) | ((spawn.kind >> 8) & 31u) << 3 | (spawn.kind & 7u) << 8 | droplets << 16 |
                  flown_share(spawn, droplets) << 24 | (is_of_foot(spawn) ? VIRGA_SPLASH_OF_FOOT : 0u);
    splash.id = spawn.id;
    const uvec4 texels[4] = texels_of(splash);
    const uint texel = 4u * (index & (tick.max_splashes - 1u));
    for (uint i = 0u; i < 4u; i++)
        splashes[texel + i] = texels[i];
}

// Speed of droplets from the energy that is left (Bai, Rusche and Gosman 2002): four fifths are lost, a part goes into
// their surfaces, n pi d^2 sigma, the rest is kinetic. Most droplets are slower than that root mean square, and no
// filmed droplet leaves with more than a third of the drop's speed (2 m/s at 4.4 to 6.5 m/s: table 1 of Mizukami et
// al.).
float physical_speed(virga_spawn_gpu spawn, uint n, uint hash)
{
    const float d3 = spawn.diameter_m * spawn.diameter_m * spawn.diameter_m, speed = drop_speed(spawn);
    const float mass = WATER_DENSITY * 0.5235988 * d3,
                flown = 1e-9 * float(spawn.water_nl) / max(spawn.drops, 1e-3) * 0.9982;
    const float diameter = pow(6.0 / 3.14159265 * flown / (WATER_DENSITY * float(n)), 1.0 / 3.0);
    const float energy = 0.1 * mass * speed * speed - float(n) * 3.14159265 * diameter * diameter * 0.0728;
    const float fastest = sqrt(2.0 * max(energy, 0.0) / max(flown, 1e-12));
    return clamp(fastest * normal_between(0.08, 0.5, hash), 0.1, max(0.35 * speed, 0.1));
}

// A pile on the circle: the bases are evenly spaced, each with a normal deviation of up to six tenths of the spacing.
void start_pile(inout virga_droplet_gpu droplet, virga_spawn_gpu spawn, Frame frame, vec3 center, uint i, uint n)
{
    const virga_splash_rule_gpu rule = rule_of(spawn);
    const uint hash = virga_hash2(spawn.random, DROPLET_HASH + 4u * i);
    const float turn = virga_unit(virga_hash2(spawn.random, TURN_HASH));
    // In [-pi, pi], where sine and cosine have an error below 2^-11 on any device.
    const float turns = (float(i) + turn + 0.3 * normal_cut(virga_unit(hash))) / float(n);
    const float azimuth = 6.2831853 * (turns - floor(turns + 0.5));
    // Droplets of a crown leave in the direction of its flaring rim, independent of its cone.
    const bool crown = spawn_model(spawn) == VIRGA_SPLASH_CROWN_CONE;
    const vec2 angles = crown ? vec2(0.87, 1.4) : vec2(rule.angle[0], rule.angle[1]);
    const float elevation = normal_between(angles.x, angles.y, virga_hash1(hash));
    const uint chance = virga_hash2(hash, 1u);
    float speed =
        is_physical() ? physical_speed(spawn, n, chance) : normal_between(rule.speed[0], rule.speed[1], chance);
    if (crown)
        speed *= 0.4; // deep water absorbs more of it
    const vec3 outward = cos(azimuth) * frame.side + sin(azimuth) * frame.across;
    vec3 base = center + rule.circle_radius * spawn.diameter_m * outward, start = base;
    const vec3 velocity = speed * (cos(elevation) * outward + sin(elevation) * frame.normal) + lean_of(spawn);
    if (crown) {
        // They leave the rim while the crown rises.
        const float weber = weber_number(spawn), t = 0.15 + 0.3 * virga_unit(virga_hash2(hash, 2u));
        const float height = crown_height(spawn.diameter_m, weber);
        base = center + crown_radius(spawn.diameter_m, weber) * crown_spread(t) * outward;
        start = base + height * crown_rise(t) * frame.normal;
        droplet.age_s -= t * crown_time(height);
    }
    droplet.base = float[3](base.x, base.y, base.z);
    droplet.position = float[3](start.x, start.y, start.z);
    droplet.velocity = float[3](velocity.x, velocity.y, velocity.z);
}

// The droplet of the cone moves vertically.
void start_cone(inout virga_droplet_gpu droplet, virga_spawn_gpu spawn, vec3 center)
{
    const virga_splash_rule_gpu rule = rule_of(spawn);
    const uint hash = virga_hash2(spawn.random, CONE_HASH);
    const float weber = weber_number(spawn);
    const float speed = is_physical() ? cone_speed(spawn.diameter_m, weber, virga_unit(hash))
                                      : normal_between(rule.speed[0], rule.speed[1], hash);
    droplet.base = float[3](center.x, center.y, center.z);
    droplet.position = droplet.base;
    droplet.velocity = float[3](0.0, speed, 0.0);
    droplet.age_s -= crown_time(crown_height(spawn.diameter_m, weber)); // it starts when the crown is over
}

// Parts of the water, in tenths: a droplet has between 1 and 4 times the smallest part.
uint part_of(virga_spawn_gpu spawn, uint i, uint n)
{
    const uint u = virga_hash2(spawn.random, DROPLET_HASH + 4u * i + 1u) >> 16;
    const bool cone = spawn_model(spawn) == VIRGA_SPLASH_CROWN_CONE && i == 0u;
    return cone ? 8u * n : 10u + (30u * ((u * u) >> 16) >> 16);
}

void start_droplets(virga_spawn_gpu spawn, vec3 center, uint first, uint n)
{
    const Frame frame = surface_frame(to_vec(spawn.normal));
    const vec2 slopes = slopes_of(frame.normal);
    const bool cone = spawn_model(spawn) == VIRGA_SPLASH_CROWN_CONE;
    uint parts = 0u, left = spawn.water_nl;
    for (uint i = 0u; i < n; i++)
        parts += part_of(spawn, i, n);
    // Each droplet has at least one nanolitre, or it would have no size; the parts divide the rest.
    const uint unit = (spawn.water_nl - n) / parts, rest = spawn.water_nl - n - unit * parts;
    for (uint i = 0u; i < n; i++) {
        virga_droplet_gpu droplet;
        const uint part = part_of(spawn, i, n);
        // Below 2^32: parts are at most 64 x 40, and the remainder is less than the parts.
        const uint water = i + 1u == n ? left : 1u + unit * part + rest * part / parts;
        left -= water;
        droplet.water_nl = water;
        droplet.age_s = -spawn.share * tick.tick_s;
        droplet.diameter_m = pow(6e-12 / 3.14159265 * float(water) / max(spawn.drops, 1e-3), 1.0 / 3.0);
        droplet.slopes = halves(slopes.x, slopes.y);
        droplet.kind = spawn_model(spawn) | ((spawn.kind >> 8) & 31u) << 3 | (spawn.kind & 7u) << 8 | i << 16 |
                       ((spawn.kind >> 24) & 31u) << 24 | VIRGA_DROPLET_ALIVE;
        droplet.id = spawn.id;
        droplet.weight_free = halves(spawn.weight, 0.0);
        if (cone && i == 0u)
            start_cone(droplet, spawn, center);
        else
            start_pile(droplet, spawn, frame, center, i, n);
        const uvec4 texels[4] = texels_of(droplet);
        for (uint j = 0u; j < 4u; j++)
            droplets[4u * (first + i) + j] = texels[j];
    }
}

// Pieces of an impact whose own positions are not on ground are at the impact's position, where their splashes would
// overlap. Splashes with droplets stay where their droplets start.
vec3 shown_beside(virga_spawn_gpu spawn, uint droplets)
{
    if ((spawn.kind >> 24 & 31u) == 0u || droplets > 0u)
        return vec3(0.0);
    const Frame frame = surface_frame(to_vec(spawn.normal));
    const uint hash = virga_hash2(spawn.random, BESIDE_HASH);
    const float turns = virga_unit(hash), away = BESIDE_M * sqrt(virga_unit(virga_hash1(hash)));
    const float angle = 6.2831853 * (turns - floor(turns + 0.5)); // in [-pi, pi] as in start_pile
    return away * (cos(angle) * frame.side + sin(angle) * frame.across);
}

void start_splash(virga_spawn_gpu spawn, uvec2 rank, Starts starts)
{
    const vec3 center = to_vec(spawn.position) + (to_vec(spawns_head.origin) - to_vec(tick.anchor));
    const bool crowded = rank.x >= starts.full_from;
    const uint n = crowded ? 0u : droplet_count_of(rank.y);
    write_splash(starts.splash + rank.x, starts.first_splash, spawn, center + shown_beside(spawn, n), n);
    count(VIRGA_SPLASH_BY_MODEL + spawn_model(spawn) * VIRGA_SPLASH_MATERIALS + ((spawn.kind >> 8) & 31u), 1u);
    count(VIRGA_SPLASH_FLOWN, spawn.water_nl);
    if (n > 0u)
        start_droplets(spawn, center, starts.droplet + first_droplet(rank.y), n);
    const uint at = starts.returned + (rank.x - starts.full_from);
    if (crowded && at < tick.max_returned_droplets) {
        write_return(at, center, to_vec(spawn.velocity), 0.0, spawn.id, (spawn.kind >> 8) & 31u, spawn.water_nl);
        count(VIRGA_SPLASH_RETURNED, spawn.water_nl);
    }
}
