// contact_sheet.glsl - the sheet that a foot throws up, as a spawn: an oval crown around the foot, which splash draws.
// Its water stays in the cells, as that of crowns of drops does. Include wakes.glsl and contact_plan.glsl before.
#include "shared/spawn.h"
#include "shared/splash_rule.h"

layout(scalar, set = 0, binding = 19) buffer Spawns
{
    virga_spawns_gpu spawns_head;
    virga_spawn_gpu spawns[];
};

#define LEAST_SHEET_NL 3e6 // less than 3 ml is only drops

// What a foot has moved in a tick: the sums of its places.
struct Trod {
    vec2 at;
    float moved_nl, deep_m;
};

Trod trod_by(uint contact)
{
    ivec2 at = ivec2(0);
    uint water = 0u, number = 0u;
    for (uint bin = contact * WAKE_BINS; bin < (contact + 1u) * WAKE_BINS; bin++) {
        at += ivec2(wake_along[bin], wake_across[bin]);
        water += wake_water[bin];
        number += wake_cells[bin];
    }
    const float inv = 1.0 / float(max(number, 1u));
    const float moved_nl = float(water) * float(PER_NL);
    return Trod(vec2(at) * (inv / PER_M), moved_nl, moved_nl * inv * tick.m_per_nl);
}

float sheet_nl_of(uint contact, Trod trod)
{
    const bool foot = contact < min(tick.contact_count, uint(VIRGA_GROUND_CONTACTS)) &&
                      tick.contacts[contact].radius_m <= 0.0;
    const float nl = trod.moved_nl * rising_share(contact, trod.deep_m, foot_speed(contact, trod.deep_m));
    return foot && nl >= LEAST_SHEET_NL ? nl : 0.0;
}

virga_floor_gpu floor_under(uint contact, Trod trod)
{
    const vec2 at = out_of_contact(contact, trod.at);
    const ivec2 low = ivec2(tick.low_tile[0], tick.low_tile[1]) * VIRGA_GROUND_TILE;
    const uint cell_index = index_of_cell(ivec2(floor(at * tick.inv_cell_m)) + low);
    if (is_ground(cell_index))
        return floor_of(cell_index);
    return virga_floor_gpu(int(tick.contacts[contact].height_m * 1e6), 0u);
}

vec3 above_origin(uint contact, Trod trod)
{
    const vec2 at = out_of_contact(contact, trod.at);
    const float floor_m = float(floor_under(contact, trod).height_um) * 1e-6;
    precise vec3 window = vec3(tick.window_high[0], tick.base_m, tick.window_high[2]) -
                          vec3(spawns_head.origin[0], spawns_head.origin[1], spawns_head.origin[2]);
    precise vec3 result = window + vec3(tick.window_low[0], 0.0, tick.window_low[2]) + vec3(at.x, floor_m, at.y);
    return result;
}

void write_sheet(uint contact, Trod trod, float sheet_nl, uint index)
{
    const vec2 half_m = vec2(tick.contacts[contact].half_m[0], tick.contacts[contact].half_m[1]);
    const vec2 ahead = ahead_of(contact), heading = half_m.x >= half_m.y ? ahead : vec2(-ahead.y, ahead.x);
    const vec3 position = above_origin(contact, trod);
    // It rises and goes out at half the water's speed, and is highest when gravity has stopped it.
    const float speed = 0.5 * foot_speed(contact, trod.deep_m), up_s = speed / 9.81;
    const float longer = max(half_m.x, half_m.y), shorter = min(half_m.x, half_m.y);
    virga_spawn_gpu spawn;
    spawn.position = float[3](position.x, position.y, position.z);
    spawn.share = 0.5; // what treads down moves little: in the middle of the tick
    spawn.velocity = float[3](longer / up_s + speed, -speed, shorter / up_s + speed);
    spawn.diameter_m = pow(1.909859317e-12 * sheet_nl / VIRGA_CROWN_DROPS, 1.0 / 3.0);
    spawn.normal = float[3](heading.x, 0.0, heading.y);
    spawn.depth_m = trod.deep_m;
    spawn.weight = 1.0;
    spawn.drops = 1.0;
    spawn.id = tick.contacts[contact].id;
    spawn.tick = tick.tick;
    spawn.water_nl = 0u;
    spawn.random = virga_hash4(tick.seed, tick.contacts[contact].id, tick.tick, 0x5ee7u);
    spawn.kind = VIRGA_GROUND_PUDDLE_5 | floor_under(contact, trod).material << 8 | VIRGA_SPLASH_CROWN_CONE << 16 |
                 VIRGA_SPAWN_SHEET;
    spawns[index] = spawn;
}

// An invocation for each contact, in the order of contacts, after start_wakes. Has a barrier.
void start_sheets()
{
    const uint contact = gl_LocalInvocationIndex;
    Trod trod = Trod(vec2(0.0), 0.0, 0.0);
    float sheet_nl = 0.0;
    if (contact < uint(VIRGA_GROUND_CONTACTS)) {
        trod = trod_by(contact);
        sheet_nl = sheet_nl_of(contact, trod);
        wake_count[contact] = sheet_nl > 0.0 && tick.contact_droplets > 0u ? 1u : 0u;
    }
    const uint before = min(spawns_head.count, tick.max_spawns);
    barrier();
    uint index = before, all = 0u;
    for (uint i = 0u; i < uint(VIRGA_GROUND_CONTACTS); i++) {
        index += i < contact ? wake_count[i] : 0u;
        all += wake_count[i];
    }
    const bool mine = sheet_nl > 0.0 && tick.contact_droplets > 0u;
    if (mine && index < tick.max_spawns)
        write_sheet(contact, trod, sheet_nl, index);
    if (contact == 0u && all > 0u && tick.max_spawns > 0u) {
        const uint count = min(before + all, tick.max_spawns);
        spawns_head.count = count;
        spawns_head.group_count = uint[3]((count + 63u) / 64u, 1u, 1u);
    }
}
