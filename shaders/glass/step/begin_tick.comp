// begin_tick.comp - begins a tick: drops under simulated water join it, others evaporate, forces accelerate those that
// can move, and each of them gets the distance that it may move in this tick.
// One invocation per live slot. Reads: the live list, cells, blades. Writes: drops, selection (active slots; second
// kind: particles), state. Paper: Goto et al. 2009, section 4.1.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "live.glsl"
#include "forces.glsl"
#include "blades.glsl"
#include "flood.glsl"
#define COMPACT_GROUP VIRGA_GLASS_GROUP
#define COMPACT_SELECTION_BINDING 3
#define COMPACT_LIST_BINDING 16
#define list selected_list
#define listed selected_entries
#define List Selected
#include "gpu/compact_mark.glsl"
#undef list
#undef listed
#undef List

shared uint evaporated, joined, max_nl;

// Water that a drop loses: tails shrink (section 4.1), all drops evaporate.
uint loss(uint water, uint kind, uint random, float a)
{
    const float rate_nl_s =
        3.14159265 * a * a * ((kind & VIRGA_GLASS_TAIL) != 0u ? tick.shrink_nl_s : tick.evaporation_m_s * 1e12);
    return min(round_randomly(rate_nl_s * tick.tick_s, virga_hash3(random, tick.tick, 1u)), water);
}

// Whether a drop is so small that no force on this pane can move it. Most are; they need not read their cell.
bool is_stuck(float mass, float a)
{
    const float strongest = mass * tick.max_acceleration + tick.air_drag * a * a * tick.max_air_m_s * tick.max_air_m_s;
    return strongest < tick.hold * a * MIN_HOLD * (1.0 - tick.path_ease);
}

void integrate_motion(uint slot, uint kind, uint water, float mass, float a)
{
    const vec2 at = to_vec2(drops[slot].position), before = to_vec2(drops[slot].velocity);
    const bool on_mesh = (kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_DROP;
    const uint cell = on_mesh ? drops[slot].cell
                              : cell_number(clamp(cell_at(at), ivec2(0), ivec2(tick.pane.columns, tick.pane.rows) - 1));
    const uint packed_cell = surface[cell];
    vec2 force = force_on_drop(at, mass, a, packed_cell);
    float hold = retention_force(a, packed_cell);
    follow_path(before, cell, a, force, hold);
    vec2 velocity = next_velocity(before, force, hold, mass, a);
    const float max_speed = 0.9 * float(tick.cells_per_tick) * tick.pane.cell_m / tick.tick_s;
    velocity *= min(1.0, max_speed / max(length(velocity), 1e-12));
    drops[slot].velocity = to_array(velocity);
    if (on_mesh) {
        const float progress_m = drops[slot].progress_m + length(velocity) * tick.tick_s;
        drops[slot].progress_m = progress_m;
        if (progress_m >= tick.pane.cell_m)
            atomicMax(state.max_rounds, uint(progress_m / tick.pane.cell_m + 0.01));
    } else
        drops[slot].position = to_array(at + velocity * tick.tick_s);
}

// Whether a blade comes near the drop in this tick, even if the drop moves as far as it can.
bool near_blade(uint slot)
{
    const float reach = float(tick.cells_per_tick) * tick.pane.cell_m + 0.004;
    const vec2 at = to_vec2(drops[slot].position);
    for (uint i = 0u; i < tick.blade_count; i++)
        if (is_swept(i, at, at, reach))
            return true;
    return false;
}

// Whether simulated water has come to a drop. It frees the slot: the drop is a part of that water.
bool join_water(uint slot, bool on_mesh)
{
    const ivec2 last = ivec2(tick.pane.columns, tick.pane.rows) - 1;
    const uint cell = on_mesh ? drops[slot].cell
                              : cell_number(clamp(cell_at(to_vec2(drops[slot].position)), ivec2(0), last));
    if (!is_under_water(cell))
        return false;
    atomicAdd(joined, drops[slot].water_nl);
    drops[slot].kind = VIRGA_GLASS_FREE;
    drops[slot].water_nl = 0u;
    if (on_mesh)
        occupants[cell] = 0u;
    return true;
}

// Returns the selection of the slot: whether the drop is active in this tick.
uint update_drop(uint slot, inout uint water, inout uint lost)
{
    uint kind = drops[slot].kind;
    const bool on_mesh = (kind & VIRGA_GLASS_KIND) == VIRGA_GLASS_DROP, ran = (kind & VIRGA_GLASS_RUNNING) != 0u;
    if (tick.flooded != 0u && join_water(slot, on_mesh))
        return NOT_SELECTED;
    water = drops[slot].water_nl;
    const float a = base_radius(water), mass = float(water) * KG_OF_NL;
    drops[slot].age_s += tick.tick_s;
    const bool changed = (kind & VIRGA_GLASS_CHANGED) != 0u;
    if (ran || !on_mesh || changed) // a merge may have shifted it
        drops[slot].previous_position = drops[slot].position;
    if (ran || !on_mesh || (kind & (VIRGA_GLASS_CHANGED | VIRGA_GLASS_MERGE_CHECK)) != 0u) {
        kind = (kind & (VIRGA_GLASS_KIND | VIRGA_GLASS_TAIL)) | (changed ? VIRGA_GLASS_MERGE_CHECK : 0u);
        drops[slot].kind = kind;
    }
    lost = loss(water, kind, drops[slot].random, a);
    if (lost != 0u)
        drops[slot].water_nl = water - lost;
    if (lost == water) {
        drops[slot].kind = VIRGA_GLASS_FREE;
        if (on_mesh)
            occupants[drops[slot].cell] = 0u;
        return NOT_SELECTED;
    }
    const bool moves = !on_mesh || ran || any(notEqual(to_vec2(drops[slot].velocity), vec2(0.0))) || !is_stuck(mass, a);
    if (moves)
        integrate_motion(slot, kind, water, mass, a);
    if (ran && to_vec2(drops[slot].velocity) == vec2(0.0))
        drops[slot].kind = kind | VIRGA_GLASS_CHANGED; // stopped
    const bool is_active = changed || (moves && drops[slot].progress_m >= tick.pane.cell_m) || near_blade(slot);
    return !on_mesh ? SECOND_KIND : is_active ? FIRST_KIND : NOT_SELECTED;
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        evaporated = joined = max_nl = 0u;
    const uint slot = live_slot();
    uint water = 0u, lost = 0u, selected = NOT_SELECTED;
    if (slot != NONE)
        selected = update_drop(slot, water, lost);
    mark_selected(selected); // has barriers
    if (lost != 0u)
        atomicAdd(evaporated, lost);
    atomicMax(max_nl, water);
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        count(VIRGA_GLASS_EVAPORATED, evaporated);
        count(VIRGA_GLASS_JOINED, joined);
        atomicMax(state.max_nl, max_nl);
    }
}
