// split_drops.comp - drops that a blade meets become particles: as many as their water is enough for. The first takes
// the drop's slot, the others become seeds. Water that is too little for a particle goes into the blade's bins; drops
// that the blade pushes over the edge are removed.
// One invocation per active slot. Reads: drops, blades. Writes: drops, claims (cleared), occupants, film, seeds, bins.
// Paper: Goto et al. 2009, section 4.4.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#define FEW
#include "live.glsl"
#include "blades.glsl"
#include "rounds.glsl"

uint seed_of(uint entry) { return landing_count() + entry; }

void split_drop(uint slot, uint entry, uint blade, virga_glass_drop_gpu drop)
{
    const uint water = drop.water_nl + drop.merged_nl;
    const uint particles = min((water + tick.particle_nl / 2u) / tick.particle_nl, uint(VIRGA_GLASS_MAX_PARTS));
    occupants[drop.cell] = 0u;
    count(VIRGA_GLASS_TO_PARTS, 1u);
    if (particles == 0u) {
        clear_slot(slot);
        atomicAdd(state.bins_nl[bin_at(blade, to_blade_now(blade, to_vec2(drop.position)).y)], water);
        return;
    }
    if (!has_glass(to_vec2(drop.position))) {
        clear_slot(slot);
        count(VIRGA_GLASS_WIPED, water);
        return;
    }
    const uint each = water / particles, extra = water % particles;
    if (particles > 1u) {
        // The seed may already hold a tail that this drop left in the same tick. Its water becomes film.
        const uint tail = seeds[seed_of(entry)].water_nl;
        if (tail != 0u) {
            film[drop.cell] += tail;
            mark_film(drop.cell);
        }
        seeds[seed_of(entry)] = virga_glass_seed_gpu(drop.position, float[2](0.0, 0.0), each, particles - 1u,
                                                     extra > 0u ? extra - 1u : 0u, NONE, drop.id, VIRGA_GLASS_PARTICLE);
    }
    drop.water_nl = each + (extra > 0u ? 1u : 0u);
    drop.merged_nl = 0u;
    drop.merged_momentum = drop.merged_nl_10um = int[2](0, 0);
    drop.velocity = float[2](0.0, 0.0);
    drop.kind = VIRGA_GLASS_PARTICLE;
    drop.absorbed_by = drop.target = NONE;
    drops[slot] = drop;
}

void main()
{
    const uint entry = gl_GlobalInvocationID.x;
    const uint slot = active_slot();
    if (slot == NONE)
        return;
    virga_glass_drop_gpu drop = drops[slot];
    if (drop.target < OUTSIDE && kind_of(drop) != VIRGA_GLASS_PARTICLE)
        claims[cell_count() + drop.target] = NONE; // its claim of the last round
    drops[slot].target = NONE;
    if (kind_of(drop) != VIRGA_GLASS_DROP)
        return;
    drop.target = NONE;
    const float radius = min(base_radius(drop.water_nl + drop.merged_nl), 0.004);
    for (uint i = 0u; i < tick.blade_count; i++)
        if (is_swept(i, to_vec2(drop.previous_position), cell_middle(drop.cell), 0.7 * radius)) {
            bool pushed = false;
            drop.position = to_array(push_by_blades(cell_middle(drop.cell), to_vec2(drop.previous_position), pushed));
            split_drop(slot, entry, i, drop);
            return;
        }
}
