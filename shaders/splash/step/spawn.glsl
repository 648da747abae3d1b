// spawn.glsl - the spawns, and how many droplets each makes.
#include "shared/spawn.h"
#include "shared/splash_share.glsl"
#include "chance.glsl"

layout(scalar, set = 0, binding = 3) readonly buffer Spawns
{
    virga_spawns_gpu spawns_head;
    virga_spawn_gpu spawns[];
};
layout(scalar, set = 0, binding = 8) buffer SpawnRanks
{
    uvec2
        // per spawn: x: its rank in its tick; y: its first droplet from the tick's first, and from bit 24 on its
        // droplets' number
        spawn_ranks[];
};

// Both are decided once, by spawn_scan.comp: floats may differ between shaders.
uint first_droplet(uint packed_rank) { return packed_rank & 0xffffffu; }
uint droplet_count_of(uint packed_rank) { return packed_rank >> 24; }

// A host's own list is not trusted: indices are clamped.
uint spawn_model(virga_spawn_gpu spawn) { return min((spawn.kind >> 16) & 255u, VIRGA_SPLASH_MODELS - 1u); }

uint spawn_count() { return min(spawns_head.count, tick.max_spawns); }

virga_splash_rule_gpu rule_of(virga_spawn_gpu spawn)
{
    return rules
        .rules[((spawn.kind >> 8) & 31u) * VIRGA_GROUND_STATES + min(spawn.kind & 255u, VIRGA_GROUND_STATES - 1u)];
}

bool is_of_foot(virga_spawn_gpu spawn) { return (spawn.kind & VIRGA_SPAWN_SHEET) != 0u; }

float drop_speed(virga_spawn_gpu spawn)
{
    return is_of_foot(spawn) ? max(-spawn.velocity[1], 0.0) : length(to_vec(spawn.velocity));
}

float weber_number(virga_spawn_gpu spawn)
{
    const float speed = drop_speed(spawn);
    return WATER_DENSITY * speed * speed * spawn.diameter_m / 0.0728;
}

bool is_wet(virga_spawn_gpu spawn) { return (spawn.kind & 255u) != VIRGA_GROUND_DRY; }

uint droplet_count(virga_spawn_gpu spawn)
{
    const virga_splash_rule_gpu rule = rule_of(spawn);
    const uint hash = virga_hash2(spawn.random, 0u);
    if (spawn.water_nl == 0u)
        return 0u;
    if (!is_physical())
        return clamp(whole_between(rule.count[0], rule.count[1], hash), 1u,
                     min(spawn.water_nl, uint(VIRGA_SPLASH_MAX_COUNT)));
    // A crown on deep water sheds few droplets from its rim, and its cone one more.
    const bool cone = spawn_model(spawn) == VIRGA_SPLASH_CROWN_CONE;
    const float mean = 5.0 * splash_excess(spawn.diameter_m, drop_speed(spawn), is_wet(spawn)) * rule.strength;
    const float share = 0.5 + virga_unit(hash); // varies from drop to drop
    const uint rim = uint(floor(mean * share * (cone ? 0.25 : 1.0) + virga_unit(virga_hash1(hash))));
    return clamp(rim + (cone ? 1u : 0u), 1u, min(spawn.water_nl, uint(VIRGA_SPLASH_MAX_COUNT)));
}
