// end_tick.comp - a tick ends: what merged is counted in, drops are drawn where they are now, claims are cleared.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "seeds.glsl"
#define FEW
#include "live.glsl"

// Mass and momentum add up (section 4.1), and the middle is that of all the water. Only the place that is drawn: the
// cell stays, as its neighbour may be taken.
void take_in(inout virga_glass_drop_gpu drop)
{
    if (drop.merged_nl == 0u)
        return;
    const uint water = drop.water_nl + drop.merged_nl;
    const vec2 momentum = to_vec2(drop.velocity) * float(drop.water_nl) +
                          0.001 * float(VIRGA_GLASS_MOMENTUM) * vec2(drop.merged_momentum[0], drop.merged_momentum[1]);
    drop.velocity = to_array(momentum / float(water));
    if (drop.merged_nl > drop.water_nl / 4u)
        drop.kind &= ~uint(VIRGA_GLASS_TAIL);
    const vec2 shift = vec2(drop.merged_nl_10um[0], drop.merged_nl_10um[1]) * (1e-5 / float(water));
    drop.position = to_array(to_pane(to_vec2(drop.position) + shift));
    drop.water_nl = water;
    drop.kind |= VIRGA_GLASS_CHANGED;
    drop.merged_nl = 0u;
    drop.merged_momentum = drop.merged_nl_10um = int[2](0, 0);
}

// Cells lie on a grid, but water does not: a drop is drawn on its way to the middle of its cell, as far as it has
// moved.
void draw_nearer(inout virga_glass_drop_gpu drop)
{
    const float way = length(to_vec2(drop.velocity)) * tick.tick_s;
    if ((drop.kind & VIRGA_GLASS_RUNNING) == 0u)
        return;
    const vec2 at = to_vec2(drop.position);
    drop.position = to_array(mix(at, cell_middle(drop.cell), 1.0 - exp(-way / (1.5 * tick.pane.cell_m))));
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i < seed_count() && seeds[i].cell != NOWHERE && seeds[i].water_nl != 0u) {
        claims[seeds[i].cell] = NOWHERE;
        if (ranks[i] < state.free)
            take_in(drops[listed[state.alive + ranks[i]]]);
    }
    const uint place = alive_place();
    if (place == NOWHERE)
        return;
    const uint target = drops[place].target;
    if (target != NOWHERE && target != OUTSIDE)
        claims[cell_count() + target] = NOWHERE; // of leaving particles
    if (target != NOWHERE || drops[place].captor != NOWHERE)
        drops[place].target = drops[place].captor = NOWHERE;
    if (drops[place].merged_nl == 0u && (drops[place].kind & VIRGA_GLASS_RUNNING) == 0u)
        return;
    virga_glass_drop_gpu drop = drops[place];
    take_in(drop);
    if (kind_of(drop) == VIRGA_GLASS_DROP)
        draw_nearer(drop);
    drops[place] = drop;
}
