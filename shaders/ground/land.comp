// land.comp - the drops of a tick land: water by cell, what each drop met there, and the dark spots that they leave.
// A workgroup per VIRGA_GROUND_IMPACTS_EACH impacts. Reads: impacts, cells as before this tick. Writes: arrivals,
// landings, spots, slope variance, spawns.
//
// Few impacts have many pieces. On software Vulkan an invocation does all pieces of its impact, one after another. On a
// GPU that would take as long as the impact with the most; so there several lanes share the pieces of each impact.
//
// Everything is read as before this tick, and sums are integers, so the order of drops does not matter.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "pieces.glsl"
#include "rings.glsl"
#include "spawns.glsl"
#include "shared/ground_map.glsl"
#include "gpu/variants.glsl"

layout(local_size_x = VIRGA_GROUND_IMPACTS_EACH, local_size_x_id = 5) in; // constant 5: see gpu/pipeline_build.c
#define LANES_EACH 4u // of an impact, on a GPU. Most impacts have fewer pieces, and each lane reads the impact.
layout(scalar, set = 0, binding = 6) buffer Arrivals { virga_arrivals_gpu arrivals[]; };
layout(scalar, set = 0, binding = 7) buffer Spots { uvec2 spots[]; };
layout(scalar, set = 0, binding = 10) buffer Landings { virga_landing_gpu landings[]; };

// Takes the place that fits the drop's spot best, by where it is and by its size, and for a large spot others within
// it: together as many as it has area, in bits. A spot smaller than a bit is seen by that chance.
void leave_spot(Piece piece, float diameter_m, uint hash)
{
    const float bit_m = tick.cell_m / float(VIRGA_GROUND_SPOTS);
    const float radius = 0.5 * VIRGA_GROUND_SPREAD * diameter_m / bit_m;
    const float within = clamp(2.0 * radius - 1.0, 0.0, radius);
    const vec2 at = piece.in_cell * float(VIRGA_GROUND_SPOTS);
    const ivec2 own = clamp(ivec2(at), ivec2(0), ivec2(VIRGA_GROUND_SPOTS - 1));
    const ivec2 low = (piece.cell & int(tick.tiles * VIRGA_GROUND_TILE - 1u)) * VIRGA_GROUND_SPOTS;
    float least = 1e9;
    uvec2 best = uvec2(0u), bits = uvec2(0u);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            const ivec2 bit = own + ivec2(x, y);
            const uint index = uint(bit.y * VIRGA_GROUND_SPOTS + bit.x), mask = 1u << (index & 31u);
            const uvec2 one = index < 32u ? uvec2(mask, 0u) : uvec2(0u, mask);
            const vec4 chance = virga_ground_spot_chance(low + bit);
            const vec2 apart = vec2(bit) + virga_ground_spot_middle(chance) - at;
            const float larger = virga_ground_spot_radius(chance) - radius;
            const float misfit = dot(apart, apart) + larger * larger;
            const bool inside = min(bit.x, bit.y) >= 0 && max(bit.x, bit.y) < VIRGA_GROUND_SPOTS;
            const bool better = inside && misfit < least;
            least = better ? misfit : least;
            best = better ? one : best;
            bits |= inside && dot(apart, apart) < within * within ? one : uvec2(0u);
        }
    if (virga_unit(hash) < 3.14159265 * radius * radius)
        bits |= best;
    if (bits.x != 0u)
        atomicOr(spots[piece.cell_index].x, bits.x);
    if (bits.y != 0u)
        atomicOr(spots[piece.cell_index].y, bits.y);
}

void record_landing(uint index, Piece piece, virga_impact_gpu impact)
{
    landings[index].cell = piece.cell_index;
    landings[index].state = state_at(piece.cell_index);
    landings[index].depth_m = depth_at(piece.cell_index);
    landings[index].material = material_at(piece.cell_index, impact);
    if (tick.max_spawns == 0u)
        landings[index].first_spawn = NO_SPAWN;
}

void write_spawn(uint index, virga_impact_gpu impact, Piece piece, uint i, Spawning plan, float drops)
{
    const uint state = state_at(piece.cell_index);
    virga_spawn_gpu spawn;
    const vec3 moved = vec3(head.origin[0], head.origin[1], head.origin[2]) -
                       vec3(spawns_head.origin[0], spawns_head.origin[1], spawns_head.origin[2]);
    const vec3 position = plan.position + moved;
    spawn.position = float[3](position.x, position.y, position.z);
    spawn.share = fract(impact.time_s / tick.tick_s) + delay_ticks(impact, i, plan.hash);
    spawn.velocity = impact.velocity;
    spawn.diameter_m = impact.diameter_m;
    spawn.normal = impact.normal;
    spawn.depth_m = depth_at(piece.cell_index);
    spawn.weight = drops / plan.keep;
    spawn.drops = drops;
    spawn.id = impact.id;
    spawn.tick = tick.tick;
    spawn.water_nl = plan.water_nl;
    spawn.random = virga_hash2(plan.hash, 1u);
    spawn.kind = state | material_at(piece.cell_index, impact) << 8 | plan.model << 16 | i << 24;
    spawns[index] = spawn;
}

// Gives an equal share of a piece's water, and of its slope variance, to each cell around, which keeps it; its own cell
// gets the rest.
void spread_water(Piece piece, int spread, uint water_nl, uint stir)
{
    const uint side = uint(2 * spread + 1), share = water_nl / (side * side), stir_share = stir / (side * side);
    const int floor_um = floor_of(piece.cell_index).height_um;
    uint rest = water_nl, rest_stir = stir;
    for (int z = -spread; z <= spread; z++)
        for (int x = -spread; x <= spread; x++) {
            const uint cell_index = x == 0 && z == 0 ? NO_CELL : index_beside(piece, ivec2(x, z), floor_um);
            if (cell_index == NO_CELL)
                continue;
            atomicAdd(arrivals[cell_index].given_nl, share);
            if (stir_share > 0u)
                atomicAdd(stirs[cell_index], stir_share);
            rest -= share;
            rest_stir -= stir_share;
        }
    atomicAdd(arrivals[piece.cell_index].landed_nl, rest);
    if (rest_stir > 0u)
        atomicAdd(stirs[piece.cell_index], rest_stir);
}

// Water that stays on the ground, and its traces. Returns what came to cells.
uint arrive(virga_impact_gpu impact, Piece piece, uint water_nl, float drops, uint i)
{
    if (piece.cell_index == NO_CELL)
        return 0u;
    const float water_m = float(cell_of(piece.cell_index).free_nl) * tick.m_per_nl;
    const float speed = length(vec3(impact.velocity[0], impact.velocity[1], impact.velocity[2]));
    const float stir = drops * crater_variance(crater_of(impact.diameter_m, speed, water_m), water_m) * 1e6;
    spread_water(piece, spread_of(drops), water_nl, water_m >= MIN_WATER_M ? uint(stir) : 0u);
    leave_spot(piece, impact.diameter_m, virga_hash4(tick.seed, impact.id, impact.tick, 64u + i));
    return water_nl;
}

// Water of an invocation's pieces, in 64 bits.
struct Water {
    virga_ground_count_gpu here, flown, elsewhere;
    virga_ground_count_gpu returned, spray, spray_off; // of returns
};

void add(inout virga_ground_count_gpu sum, uint nl)
{
    sum.low += nl;
    sum.high += sum.low < nl ? 1u : 0u;
}

void count_sum(uint index, virga_ground_count_gpu sum)
{
    if (sum.low > 0u)
        count_water(index, sum.low);
    if (sum.high > 0u)
        atomicAdd(counts[index].high, sum.high);
}

// Piece i of n. `spawn_index`: of the impact's first spawn. `splashing`: a bit for each of its pieces.
void land_piece(uint index, virga_impact_gpu impact, Piece first, uint i, uint n, uint spawn_index, uint splashing,
                inout Water sums)
{
    const Piece piece = get_piece(impact, first, i, n);
    const float drops = impact.weight / float(n);
    if (i == 0u)
        record_landing(landing_index(index), piece, impact);
    uint water = piece.water_nl;
    if (spawn_index != NO_SPAWN && (splashing >> i & 1u) != 0u) {
        const Spawning plan = plan_spawn(impact, piece, i);
        write_spawn(spawn_index + bitCount(bitfieldExtract(splashing, 0, int(i))), impact, piece, i, plan, drops);
        water -= plan.water_nl;
        add(sums.flown, plan.water_nl);
    }
    const uint here = arrive(impact, piece, water, drops, i);
    add(sums.here, here);
    add(sums.elsewhere, water - here);
    const bool spray = (impact.material & VIRGA_IMPACT_SPRAY) != 0u;
    add(sums.returned, spray ? 0u : piece.water_nl);
    add(sums.spray, spray ? piece.water_nl - (water - here) : 0u);
    add(sums.spray_off, spray ? water - here : 0u);
}

void count_water_of(Water sums)
{
    count_sum(VIRGA_GROUND_LANDED, sums.here);
    count_sum(VIRGA_GROUND_OFF_GROUND, sums.elsewhere);
    count_sum(VIRGA_GROUND_FLOWN, sums.flown);
    if (head.is_return == 0u)
        return;
    count_sum(VIRGA_GROUND_RETURNED, sums.returned);
    count_sum(VIRGA_GROUND_SPRAY, sums.spray);
    count_sum(VIRGA_GROUND_SPRAY_OFF, sums.spray_off);
}

void main()
{
    const uint lanes = FOR_GPU ? LANES_EACH : 1u, local = gl_LocalInvocationIndex / lanes;
    const uint index = gl_WorkGroupID.x * uint(VIRGA_GROUND_IMPACTS_EACH) + local;
    if (local >= uint(VIRGA_GROUND_IMPACTS_EACH) || !is_of_tick(index))
        return;
    const virga_impact_gpu impact = impacts[index];
    const uint n = piece_count(impact), landing = landing_index(index);
    const uint spawn_index = tick.max_spawns == 0u ? NO_SPAWN : landings[landing].first_spawn;
    const uint splashing = landings[landing].splashing;
    const Piece first = first_piece(impact);
    const virga_ground_count_gpu none = virga_ground_count_gpu(0u, 0u);
    Water sums = Water(none, none, none, none, none, none);
    for (uint i = gl_LocalInvocationIndex % lanes; i < n; i += lanes)
        land_piece(index, impact, first, i, n, spawn_index, splashing, sums);
    count_water_of(sums);
}
