// choose_cell.comp - the next cell of each drop that has way left: the one ahead or one of its two neighbours, by
// affinity
// (Goto et al. 2009, section 4.1 and figure 1, after Kaneda et al. 1993).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#define FEW
#include "live.glsl"
#include "rounds.glsl"

// What a cell's drop leaves there: a film, and where it is due a small drop (by a seed, placed at the tick's end).
void leave_trail(uint place, uint entry, uint cell, inout virga_glass_drop_gpu drop)
{
    const float square_m2 = tick.pane.cell_m * tick.pane.cell_m, a = base_radius(drop.water_nl);
    const float width = min(2.0 * a / tick.pane.cell_m, 1.0);
    const uint left =
        min(round_by_chance(tick.film_m * square_m2 * width * 1e12, virga_hash3(drop.random, tick.tick, cell)),
            drop.water_nl / 8u);
    if (left != 0u) {
        film[cell] += left;
        mark_film(cell);
    }
    drop.water_nl -= left;
    drop.tail_m += tick.pane.cell_m;
    const uint seed = landing_count() + entry;
    const uint hash = virga_hash3(drop.random, tick.tick, 2u);
    if (tick.tail_radius_m <= 0.0 || drop.tail_m < tick.tail_m * (0.4 + 1.2 * virga_unit(hash)) ||
        seeds[seed].water_nl != 0u)
        return;
    const float radius = tick.tail_radius_m * (0.35 + 0.65 * virga_unit(virga_hash1(hash)));
    const uint water =
        min(uint(tick.drop_nl_of_m3 * radius * radius * radius), uint(tick.tail_share * float(drop.water_nl)));
    if (water == 0u)
        return;
    drop.tail_m = 0.0;
    drop.water_nl -= water;
    const vec2 shift = vec2(virga_unit(virga_hash2(hash, 1u)), virga_unit(virga_hash2(hash, 2u))) - 0.5;
    seeds[seed] =
        virga_glass_seed_gpu(to_array(to_pane(cell_middle(cell) + 0.6 * shift * tick.pane.cell_m)), float[2](0.0, 0.0),
                             water, 0u, 0u, cell, virga_hash2(drop.id, tick.tick), VIRGA_GLASS_DROP | VIRGA_GLASS_TAIL);
}

// Who came to which cell in the round before. Each cell has one writer: the one that entered, else the one that left.
void write_down(uint place, uint entry, inout virga_glass_drop_gpu drop)
{
    if (drop.target == NOWHERE)
        return;
    const bool entered = kind_of(drop) == VIRGA_GLASS_DROP;
    const uint left = entered ? drop.from_cell : drop.cell;
    const bool taken = claims[claim_of(left, round_index - 1u)] != NOWHERE;
    if (!taken) {
        occupants[left] = 0u;
        if (entered)
            leave_trail(place, entry, left, drop);
    }
    if (entered) {
        occupants[drop.cell] = place + 1u;
        drop.water_nl += film[drop.cell]; // a drop takes the film on its way along
        film[drop.cell] = 0u;
    }
}

const ivec2 ways[8] = ivec2[8](ivec2(1, 0), ivec2(1, 1), ivec2(0, 1), ivec2(-1, 1), ivec2(-1, 0), ivec2(-1, -1),
                               ivec2(0, -1), ivec2(1, -1));

// How likely the way ahead and those to its right and left are before the glass has its say, so that the mean step lies
// in the direction of motion, which is by `off` (its tangent) to the left of the middle way. With shares s + t to the
// left and s - t to the right, the mean of three steps of a square grid is off by 2 t where the middle way lies along
// an axis, and by t / (1 - s) where it is a diagonal. No share is negative if s is at least |t|: what s is above that
// is meander.
vec3 even_shares(float off, bool diagonal)
{
    const float least = diagonal ? abs(off) / (1.0 + abs(off)) : 0.5 * abs(off);
    const float s = mix(least, max(least, 0.35), tick.meander);
    const float t = diagonal ? (1.0 - s) * off : 0.5 * off;
    return vec3(1.0 - 2.0 * s, s - t, s + t);
}

// Shares times affinity: uneven glass, low places of a bump map (both in the cell's word), and wet paths draw drops on.
float cell_draw(ivec2 cell)
{
    if (!on_pane(cell))
        return 1.0;
    const uint number = cell_number(cell);
    return exp(tick.affinity_sigma * cell_affinity(surface[number])) * (1.0 + 4.0 * tick.path_ease * cell_wet(number));
}

ivec2 choose_way(virga_glass_drop_gpu drop, ivec2 cell)
{
    const vec2 v = to_vec2(drop.velocity);
    const float turn = atan(v.y, v.x) * (4.0 / 3.14159265);
    const float nearest = floor(turn + 0.5);
    const uint ahead = uint(int(nearest) + 8) & 7u, right = (ahead + 7u) & 7u, left = (ahead + 1u) & 7u;
    const vec3 shares =
        even_shares(tan((turn - nearest) * (3.14159265 / 4.0)), (ahead & 1u) != 0u) *
        vec3(cell_draw(cell + ways[ahead]), cell_draw(cell + ways[right]), cell_draw(cell + ways[left]));
    const float lot =
        virga_unit(virga_hash3(drop.random, tick.tick, 16u + round_index)) * (shares.x + shares.y + shares.z);
    return ways[lot < shares.x ? ahead : lot < shares.x + shares.y ? right : left];
}

// Who goes over the edge takes its water along.
void run_off(inout virga_glass_drop_gpu drop)
{
    count(VIRGA_GLASS_RUN_OFF, drop.water_nl + drop.merged_nl);
    drop.kind = VIRGA_GLASS_FREE;
    drop.water_nl = drop.merged_nl = 0u;
    drop.merged_momentum = drop.merged_nl_10um = int[2](0, 0);
    drop.target = OUTSIDE;
}

// The cell that it goes to, or over the edge.
void go_on(uint place, inout virga_glass_drop_gpu drop)
{
    const ivec2 cell = cell_place(drop.cell), way = choose_way(drop, cell);
    drop.ahead_m -= tick.pane.cell_m * length(vec2(way));
    drop.kind |= VIRGA_GLASS_RUNNING;
    if (on_pane(cell + way)) {
        drop.target = cell_number(cell + way);
        atomicMin(claims[claim_of(drop.target, round_index)], place);
    } else
        run_off(drop);
}

void main()
{
    const uint place = awake_place();
    if (place == NOWHERE)
        return;
    if (round_index == 0u)
        seeds[landing_count() + gl_GlobalInvocationID.x].water_nl = 0u;
    const uint kind = drops[place].kind & VIRGA_GLASS_KIND;
    const bool goes = round_index < rounds && kind == VIRGA_GLASS_DROP && drops[place].ahead_m >= tick.pane.cell_m;
    if (kind == VIRGA_GLASS_PARTICLE)
        return;
    if (!goes && drops[place].target == NOWHERE) {
        if (drops[place].captor != NOWHERE)
            drops[place].captor = NOWHERE;
        return;
    }
    virga_glass_drop_gpu drop = drops[place];
    write_down(place, gl_GlobalInvocationID.x, drop);
    if (round_index < rounds) {
        drop.captor = drop.target; // whose claim the next pass clears
        drop.target = NOWHERE;
    } else
        drop.captor = NOWHERE; // the last claims are cleared in split_drops.comp
    if (goes && to_vec2(drop.velocity) == vec2(0.0))
        drop.ahead_m = 0.0; // at rest it has no direction to go in
    else if (goes)
        go_on(place, drop);
    drops[place] = drop;
}
