// end_tick.comp - ends a tick: merged water and momentum are added to the drops, running drops are moved towards their
// cells, claims are cleared.
// One invocation per live slot or seed. Reads: seeds, ranks. Writes: drops, claims.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "seeds.glsl"
#define FEW
#include "live.glsl"

// The cell from which the merged water came: its rim is held there. The drop's own, if that is not on the pane.
uint cell_of_merged(virga_glass_drop_gpu drop)
{
    const vec2 offset = vec2(drop.merged_nl_10um[0], drop.merged_nl_10um[1]) * (1e-5 / float(drop.merged_nl));
    const ivec2 cell = cell_at(to_vec2(drop.position) + offset);
    return on_pane(cell) ? cell_number(cell) : drop.cell;
}

// Mass and momentum are added (Goto et al. 2009, section 4.1). The drop moves to the center of mass of all the water,
// but keeps its cell, since the cell beside it may be occupied.
void apply_merges(inout virga_glass_drop_gpu drop)
{
    if (drop.merged_nl == 0u)
        return;
    const uint water = drop.water_nl + drop.merged_nl;
    const vec2 momentum = to_vec2(drop.velocity) * float(drop.water_nl) +
                          0.001 * float(VIRGA_GLASS_MOMENTUM) * vec2(drop.merged_momentum[0], drop.merged_momentum[1]);
    drop.velocity = to_array(momentum / float(water));
    if (drop.merged_nl > drop.water_nl / 4u) {
        drop.kind &= ~uint(VIRGA_GLASS_TAIL);
        if (kind_of(drop) == VIRGA_GLASS_DROP && (drop.kind & VIRGA_GLASS_RUNNING) == 0u)
            drop.from_cell = cell_of_merged(drop);
    }
    const vec2 shift = vec2(drop.merged_nl_10um[0], drop.merged_nl_10um[1]) * (1e-5 / float(water));
    drop.position = to_array(to_pane(to_vec2(drop.position) + shift));
    drop.water_nl = water;
    drop.kind |= VIRGA_GLASS_CHANGED;
    drop.merged_nl = 0u;
    drop.merged_momentum = drop.merged_nl_10um = int[2](0, 0);
}

// Cells lie on a grid, but water does not: a running drop approaches the middle of its cell by the distance that it has
// moved.
void approach_cell(inout virga_glass_drop_gpu drop)
{
    const float distance = length(to_vec2(drop.velocity)) * tick.tick_s;
    if ((drop.kind & VIRGA_GLASS_RUNNING) == 0u)
        return;
    const vec2 at = to_vec2(drop.position);
    drop.position = to_array(mix(at, cell_middle(drop.cell), 1.0 - exp(-distance / (1.5 * tick.pane.cell_m))));
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i < seed_count() && seeds[i].cell != NONE && seeds[i].water_nl != 0u) {
        claims[seeds[i].cell] = NONE;
        if (ranks[i] < state.free)
            apply_merges(drops[listed[state.alive + ranks[i]]]);
    }
    const uint slot = live_slot();
    if (slot == NONE)
        return;
    const uint target = drops[slot].target;
    if (target != NONE && target != OUTSIDE)
        claims[cell_count() + target] = NONE; // claims of particles that became drops
    if (target != NONE || drops[slot].absorbed_by != NONE)
        drops[slot].target = drops[slot].absorbed_by = NONE;
    if (drops[slot].merged_nl == 0u && (drops[slot].kind & VIRGA_GLASS_RUNNING) == 0u)
        return;
    virga_glass_drop_gpu drop = drops[slot];
    apply_merges(drop);
    if (kind_of(drop) == VIRGA_GLASS_DROP)
        approach_cell(drop);
    drops[slot] = drop;
}
