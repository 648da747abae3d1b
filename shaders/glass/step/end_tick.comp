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
#include "glass/outline.glsl"

#define TAIL_SPEED 0.03  // m/s at which the tail of a running drop is half drawn out
#define RUN_STRAIN 0.3   // of a fast drop's head, along its way; an estimate

// The outline of a drop as it is now.
void relax_outline(inout virga_glass_drop_gpu drop)
{
    const float age_s = float(tick.tick - drop.outline_tick) * tick.tick_s;
    const float left = outline_left(age_s, base_radius(drop.water_nl));
    drop.strain = pack_strain(strain_left(unpack_strain(drop.strain), left));
    drop.tail = pack_tail(unpack_tail(drop.tail) * left);
    drop.outline_tick = tick.tick;
}

// The strain of the drop that two become at once: that of the ellipse with the second moments of their water. Those of
// a paraboloid on an ellipse with the half axes a and b are a^2 / 6 and b^2 / 6, and with an offset d between them two
// drops m and n have m n / (m + n) d d^T more, about the middle of both. A symmetric matrix with the trace T and, as a
// vector of twice the angle, the rest D has an ellipse with the strain atanh(|D| / T) along D. What merged is taken as
// one round drop.
vec2 merged_strain(virga_glass_drop_gpu drop, vec2 offset)
{
    const float m = float(drop.water_nl), n = float(drop.merged_nl);
    const float a = base_radius(drop.water_nl), b = base_radius(drop.merged_nl);
    const vec2 strain = unpack_strain(drop.strain);
    const float size = length(strain), apart2 = m * n / (m + n) * dot(offset, offset);
    const float trace = (m * a * a * cosh(size) + n * b * b) / 3.0 + apart2;
    const vec2 rest = strain_along(offset, apart2) + strain * (m * a * a * sinh(size) / (3.0 * max(size, 1e-6)));
    const float x = min(length(rest) / trace, 0.99);
    return rest * (0.5 * log((1.0 + x) / (1.0 - x)) / max(length(rest), 1e-20));
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
    if (drop.merged_nl > drop.water_nl / 4u)
        drop.kind &= ~uint(VIRGA_GLASS_TAIL);
    const vec2 moment = vec2(drop.merged_nl_10um[0], drop.merged_nl_10um[1]) * 1e-5;
    const vec2 shift = moment / float(water);
    if (kind_of(drop) == VIRGA_GLASS_DROP) {
        relax_outline(drop);
        drop.strain = pack_strain(merged_strain(drop, moment / float(drop.merged_nl)));
    }
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

// A running drop draws out a tail behind it, and its head gets longer along its way. Its rear is where it was, so both
// follow a new direction after one length of the drop, and the tail of one that turns is bent.
void draw_out(inout virga_glass_drop_gpu drop)
{
    const vec2 velocity = to_vec2(drop.velocity);
    const float speed = length(velocity), share = speed / (speed + TAIL_SPEED);
    if ((drop.kind & VIRGA_GLASS_RUNNING) == 0u || speed == 0.0)
        return;
    relax_outline(drop);
    const float new = 1.0 - exp(-speed * tick.tick_s / (2.0 * base_radius(drop.water_nl)));
    drop.tail = pack_tail(mix(unpack_tail(drop.tail), velocity * (-share / speed), new));
    drop.strain = pack_strain(mix(unpack_strain(drop.strain), strain_along(velocity, RUN_STRAIN * share), new));
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
    if (kind_of(drop) == VIRGA_GLASS_DROP) {
        approach_cell(drop);
        draw_out(drop);
    }
    drops[slot] = drop;
}
