// begin_tick.comp - a tick begins: drops dry, forces act on those that they may move, and each of these gets the way
// that it
// may go.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "live.glsl"
#include "forces.glsl"
#include "blades.glsl"
#define COMPACT_GROUP VIRGA_GLASS_GROUP
#define COMPACT_PICKS_BINDING 3
#define COMPACT_LIST_BINDING 16
#define list picked_list
#define listed picked_entries
#define List Picked
#include "gpu/compact_mark.glsl"
#undef list
#undef listed
#undef List

shared uint evaporated, most_nl;

// Water that a drop loses: tails shrink (Goto et al., 4.1), all dry.
uint loss(uint water, uint kind, uint random, float a)
{
    const float rate_nl_s =
        3.14159265 * a * a * ((kind & VIRGA_GLASS_TAIL) != 0u ? tick.shrink_nl_s : tick.evaporation_m_s * 1e12);
    return min(round_by_chance(rate_nl_s * tick.tick_s, virga_hash3(random, tick.tick, 1u)), water);
}

// No force on the pane can set a drop in motion that is so small: most are, and need not look at their place.
bool is_stuck(float mass, float a)
{
    const float pulled = mass * tick.most_pull + tick.air_drag * a * a * tick.most_air * tick.most_air;
    return pulled < tick.hold * a * LEAST_HOLD * (1.0 - tick.path_ease);
}

void let_move(uint place, uint kind, uint water, float mass, float a)
{
    const vec2 at = to_vec2(drops[place].position), before = to_vec2(drops[place].velocity);
    const bool on_mesh = (kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_DROP;
    const uint cell = on_mesh ? drops[place].cell
                              : cell_number(clamp(cell_at(at), ivec2(0), ivec2(tick.pane.columns, tick.pane.rows) - 1));
    const uint word = surface[cell];
    vec2 velocity = next_velocity(before, pull(at, mass, a, word), holding(a, cell, word), mass, a);
    const float most = 0.9 * float(tick.cells_per_tick) * tick.pane.cell_m / tick.tick_s;
    velocity *= min(1.0, most / max(length(velocity), 1e-12));
    drops[place].velocity = to_array(velocity);
    if (on_mesh) {
        const float ahead_m = drops[place].ahead_m + length(velocity) * tick.tick_s;
        drops[place].ahead_m = ahead_m;
        if (ahead_m >= tick.pane.cell_m)
            atomicMax(state.most_rounds, uint(ahead_m / tick.pane.cell_m + 0.01));
    } else
        drops[place].position = to_array(at + velocity * tick.tick_s);
}

// A blade comes within reach of it in this tick, even if it runs as far as it can.
bool near_blade(uint place)
{
    const float reach = float(tick.cells_per_tick) * tick.pane.cell_m + 0.004;
    const vec2 at = to_vec2(drops[place].position);
    for (uint i = 0u; i < tick.blade_count; i++)
        if (touched(i, at, at, reach))
            return true;
    return false;
}

// Whether something happens to it in this tick.
uint begin_tick(uint place, inout uint water, inout uint lost)
{
    uint kind = drops[place].kind;
    water = drops[place].water_nl;
    const bool on_mesh = (kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_DROP, ran = (kind & VIRGA_GLASS_RUNNING) != 0u;
    const float a = base_radius(water), mass = float(water) * KG_OF_NL;
    drops[place].age_s += tick.tick_s;
    const bool changed = (kind & VIRGA_GLASS_CHANGED) != 0u;
    if (ran || !on_mesh || changed) // a merger may have shifted it
        drops[place].before = drops[place].position;
    if (ran || !on_mesh || (kind & (VIRGA_GLASS_CHANGED | VIRGA_GLASS_LOOKS)) != 0u) {
        kind = (kind & (VIRGA_GLASS_KIND | VIRGA_GLASS_TAIL)) | (changed ? VIRGA_GLASS_LOOKS : 0u);
        drops[place].kind = kind;
    }
    lost = loss(water, kind, drops[place].random, a);
    if (lost != 0u)
        drops[place].water_nl = water - lost;
    if (lost == water) {
        drops[place].kind = VIRGA_GLASS_FREE;
        if (on_mesh)
            occupants[drops[place].cell] = 0u;
        return NOT_PICKED;
    }
    const bool moves =
        !on_mesh || ran || any(notEqual(to_vec2(drops[place].velocity), vec2(0.0))) || !is_stuck(mass, a);
    if (moves)
        let_move(place, kind, water, mass, a);
    if (ran && to_vec2(drops[place].velocity) == vec2(0.0))
        drops[place].kind = kind | VIRGA_GLASS_CHANGED; // stopped
    const bool wakes = changed || (moves && drops[place].ahead_m >= tick.pane.cell_m) || near_blade(place);
    return !on_mesh ? SECOND_KIND : wakes ? FIRST_KIND : NOT_PICKED;
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        evaporated = most_nl = 0u;
    const uint place = alive_place();
    uint water = 0u, lost = 0u, pick = NOT_PICKED;
    if (place != NOWHERE)
        pick = begin_tick(place, water, lost);
    mark_pick(pick); // with barriers
    if (lost != 0u)
        atomicAdd(evaporated, lost);
    atomicMax(most_nl, water);
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        count(VIRGA_GLASS_EVAPORATED, evaporated);
        atomicMax(state.most_nl, most_nl);
    }
}
