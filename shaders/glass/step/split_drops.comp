// split_drops.comp - drops that a blade meets become particles (Goto et al. 2009, section 4.4): as many as their
// water gives,
// the first in the drop's place, the others beside it by seeds. Those too small for a particle are gathered in the
// blade's bins, and one that the blade pushes over the edge is gone.
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

void split(uint place, uint entry, uint blade, virga_glass_drop_gpu drop)
{
    const uint water = drop.water_nl + drop.merged_nl;
    const uint parts = min((water + tick.particle_nl / 2u) / tick.particle_nl, uint(VIRGA_GLASS_MOST_PARTS));
    occupants[drop.cell] = 0u;
    count(VIRGA_GLASS_TO_PARTS, 1u);
    if (parts == 0u) {
        end_drop(place);
        atomicAdd(state.bins_nl[bin_at(blade, now_in_blade(blade, to_vec2(drop.position)).y)], water);
        return;
    }
    if (!has_glass(to_vec2(drop.position))) {
        end_drop(place);
        count(VIRGA_GLASS_WIPED, water);
        return;
    }
    const uint each = water / parts, extra = water % parts;
    if (parts > 1u) {
        // The seed may hold a tail that this drop left in the same tick: that water goes along.
        const uint tail = seeds[seed_of(entry)].water_nl;
        if (tail != 0u) {
            film[drop.cell] += tail;
            mark_film(drop.cell);
        }
        seeds[seed_of(entry)] =
            virga_glass_seed_gpu(drop.position, float[2](0.0, 0.0), each, parts - 1u, extra > 0u ? extra - 1u : 0u,
                                 NOWHERE, drop.id, VIRGA_GLASS_PARTICLE);
    }
    drop.water_nl = each + (extra > 0u ? 1u : 0u);
    drop.merged_nl = 0u;
    drop.merged_momentum = drop.merged_nl_10um = int[2](0, 0);
    drop.velocity = float[2](0.0, 0.0);
    drop.kind = VIRGA_GLASS_PARTICLE;
    drop.captor = drop.target = NOWHERE;
    drops[place] = drop;
}

void main()
{
    const uint entry = gl_GlobalInvocationID.x;
    const uint place = awake_place();
    if (place == NOWHERE)
        return;
    virga_glass_drop_gpu drop = drops[place];
    if (drop.target < OUTSIDE && kind_of(drop) != VIRGA_GLASS_PARTICLE)
        claims[cell_count() + drop.target] = NOWHERE; // of the last round
    drops[place].target = NOWHERE;
    if (kind_of(drop) != VIRGA_GLASS_DROP)
        return;
    drop.target = NOWHERE;
    const float radius = min(base_radius(drop.water_nl + drop.merged_nl), 0.004);
    for (uint i = 0u; i < tick.blade_count; i++)
        if (touched(i, to_vec2(drop.before), cell_middle(drop.cell), 0.7 * radius)) {
            bool pushed = false;
            drop.position = to_array(push_by_blades(cell_middle(drop.cell), to_vec2(drop.before), pushed));
            split(place, entry, i, drop);
            return;
        }
}
