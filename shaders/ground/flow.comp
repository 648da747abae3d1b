// flow.comp - water flows downhill, seeps away and evaporates, over all blocks of the window that have ground.
// One invocation per pair of cells. Reads: floors, the list of blocks. Writes: cells, flow averages, counters.
//
// A thin sheet without inertia (diffusive wave). Through the side shared by two cells flows q = h^(5/3) sqrt(S) / n
// per metre of width (Manning), with h the water above what the roughness of the upper cell holds back, and S the slope
// of the surface. A pass handles one side of each cell: pairs of cells along x or z, first pairs whose lower cell is
// even, then odd ones (PAIRS, in the push constants). So an invocation owns its pair and changes both cells in place,
// no water is made or lost, and each pass does a quarter of the work. Four passes are a round; each lets water flow for
// the time of the round.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "flow_average.glsl"
#include "blocks.glsl"

layout(local_size_x = VIRGA_GROUND_GROUP) in;
layout(push_constant) uniform Push { uint pairs; }; // bit 0: along z instead of x; bit 1: the lower cell is odd

shared uint group_sunk, group_dried; // at most a few thousand nl per cell

// Sums of the invocation's own pairs: software Vulkan handles shared variables lane by lane.
struct Lost {
    uint sunk, dried;
    virga_ground_count_gpu drained;
};

struct Surface {
    int height_um;
    uint material, free_nl;
};

// The flow from the higher of two surfaces to the lower one, which is `difference` (nl) below it.
//
// m0 is the height that Manning's flow at the start of the pass moves. A flow m lowers the upper cell and raises the
// lower one. The flow in the middle of the pass, at h - m / 2 and D - m (D: the difference), linear in m, is m = m0 (1
// - m (5 / (6 h) + 1 / (2 D)))   so   m = m0 / (1 + m0 (5 / (6 h) + 1 / (2 D))). With m0 alone a sheet would be too
// fast by 13 % (2 mm on 1 % slope, rounds of 1/60 s) to 54 % (rounds of 4/60 s), because pairs oscillate; this is right
// within 2 %. The flow is at most what levels the two, and half of the mobile water.
int flow_down(Surface upper, int difference)
{
    const uint material = min(upper.material, uint(VIRGA_GROUND_MATERIALS - 1));
    const uint retained = min(upper.free_nl, tick.soils[material].retention_nl);
    const int mobile = int(min(upper.free_nl - retained, 0x7fffffffu));
    precise const float h = float(mobile) * tick.m_per_nl, d = float(difference) * tick.m_per_nl;
    precise const float q = tick.soils[material].inv_manning * h * pow(h, 2.0 / 3.0) * sqrt(d * tick.inv_cell_m);
    precise const float m0 = q * tick.flow_s * tick.inv_cell_m;
    precise const float m = m0 / (1.0 + m0 * (5.0 / (6.0 * max(h, 1e-9)) + 1.0 / (2.0 * max(d, 1e-9))));
    return min(int(min(m / tick.m_per_nl, 1e9)), min(mobile, difference) / 2);
}

// Flow from the cell `high` into the cell `low`; negative: the other way.
int flow_between(Surface low, Surface high)
{
    const int max_um = MAX_STEP_NL / tick.nl_per_um;
    const int rise_um = clamp(high.height_um - low.height_um, -max_um, max_um);
    const int difference =
        rise_um * tick.nl_per_um + int(min(high.free_nl, uint(MAX_STEP_NL))) - int(min(low.free_nl, uint(MAX_STEP_NL)));
    const bool comes = difference > 0;
    Surface upper = low;
    upper.material = comes ? high.material : low.material;
    upper.free_nl = comes ? high.free_nl : low.free_nl;
    const int flow = flow_down(upper, abs(difference));
    return comes ? flow : -flow;
}

// Each cell is the lower one of two pairs in a round. Only then it loses water, each time for half of the round.
float loss_s() { return 0.5 * tick.flow_s; }

// Evaporation first removes water on the cell, then, more and more slowly, water in its pores.
uint dry(inout virga_cell_gpu cell, virga_soil_gpu soil, uint hash)
{
    const float share = cell.free_nl > 0u ? 1.0 : float(cell.held_nl) / max(float(soil.capacity_nl), 1.0);
    const uint wanted = round_randomly(tick.evaporation_nl_s * soil.drying * share * loss_s(), hash);
    const uint from_free = min(wanted, cell.free_nl), from_pores = min(wanted - from_free, cell.held_nl);
    cell.free_nl -= from_free;
    cell.held_nl -= from_pores;
    return from_free + from_pores;
}

// Water that leaves a cell of ground, except to its neighbours.
void drain_cell(inout virga_cell_gpu cell, uint material, uint hash, inout Lost lost)
{
    const virga_soil_gpu soil = tick.soils[material];
    const uint sunk = min(round_randomly(soil.sink_nl_s * loss_s(), hash), cell.free_nl);
    cell.free_nl -= sunk;
    const uint drained = soil.drain != 0u ? cell.free_nl : 0u;
    cell.free_nl -= drained;
    const uint dried = dry(cell, soil, virga_hash1(hash));
    lost.sunk += sunk;
    lost.dried += dried;
    lost.drained.low += drained;
    lost.drained.high += lost.drained.low < drained ? 1u : 0u;
}

// The index of the lower cell of a pair. Tiles have an even number of cells per side, so an even cell of a tile is even
// in the world.
uint low_index(uint pair, bool along_z, uint odd)
{
    const uint tile = pair / (VIRGA_GROUND_TILE_CELLS / 2), inside = pair % (VIRGA_GROUND_TILE_CELLS / 2);
    const uint row_bits = along_z ? TILE_SHIFT : TILE_SHIFT - 1;
    const uvec2 half_local = uvec2(inside & ((1u << row_bits) - 1u), inside >> row_bits);
    const uvec2 local = half_local * (along_z ? uvec2(1, 2) : uvec2(2, 1)) + (along_z ? uvec2(0, odd) : uvec2(odd, 0));
    return (tile << (2 * TILE_SHIFT)) | (local.y << TILE_SHIFT) | local.x;
}

// Whether only one of two cells is in the region whose water is simulated. No water flows over its border in cells: the
// particles are there, which the cells outside do not see.
bool is_border(ivec2 low_cell, ivec2 high_cell)
{
    const ivec2 low = ivec2(tick.region_low[0], tick.region_low[1]);
    const ivec2 high = ivec2(tick.region_high[0], tick.region_high[1]);
    const bool first = all(greaterThanEqual(low_cell, low)) && all(lessThan(low_cell, high));
    const bool second = all(greaterThanEqual(high_cell, low)) && all(lessThan(high_cell, high));
    return first != second;
}

void run_pair(uint pair, bool along_z, inout Lost lost)
{
    const uint cell_index = low_index(pair, along_z, pairs >> 1);
    const ivec2 low_cell = cell_at_index(cell_index);
    const ivec2 high_cell = low_cell + (along_z ? ivec2(0, 1) : ivec2(1, 0));
    const uint found = index_of_cell(high_cell);
    const uint other = found == NO_CELL ? cell_index : found;
    const uvec2 own_words = cell_words[cell_index], other_words = cell_words[other];
    virga_cell_gpu cell = virga_cell_gpu(own_words.x, own_words.y);
    const virga_floor_gpu low_floor = floor_of(cell_index), high_floor = floor_of(other);
    const Surface low = Surface(low_floor.height_um, low_floor.material, cell.free_nl);
    const Surface high = Surface(high_floor.height_um, high_floor.material, other_words.x);
    const bool both = found != NO_CELL && low.material != NO_GROUND && high.material != NO_GROUND &&
        !is_border(low_cell, high_cell);
    const int inflow = both ? flow_between(low, high) : 0;
    const int half_um = inflow / (2 * tick.nl_per_um);
    swings[cell_index] = with_swing(swings[cell_index], along_z, half_um);
    if (both) {
        cell_words[other].x = uint(int(high.free_nl) - inflow);
        swings[other] = with_swing(swings[other], along_z, -half_um);
    }
    if (low.material != NO_GROUND) {
        cell.free_nl = uint(int(cell.free_nl) + inflow);
        const uint hash = virga_hash2(tick.seed + 0x9e3779b9u * (4u * tick.tick + pairs),
                                      uint(low_cell.x) * 0x85ebca6bu ^ uint(low_cell.y) * 0xc2b2ae35u);
        drain_cell(cell, low.material, hash, lost);
        cell_words[cell_index] = uvec2(cell.free_nl, cell.held_nl);
    }
}

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) {
        group_sunk = 0u;
        group_dried = 0u;
    }
    barrier();
    Lost lost = Lost(0u, 0u, virga_ground_count_gpu(0u, 0u));
    // The lower cells of a block's pairs are its own. A pair without ground below has nothing to do.
    const uint first = gl_WorkGroupID.x * VIRGA_GROUND_PAIRS_EACH;
    const uint end = min(first + VIRGA_GROUND_PAIRS_EACH, floor_words[block_word(VIRGA_GROUND_BLOCK_COUNT)]);
    for (uint entry = first; entry < end; entry++)
        run_pair(floor_words[list_word(entry)] * VIRGA_GROUND_GROUP + lane, (pairs & 1u) != 0u, lost);
    if (lost.sunk > 0u)
        atomicAdd(group_sunk, lost.sunk);
    if (lost.dried > 0u)
        atomicAdd(group_dried, lost.dried);
    if ((lost.drained.low | lost.drained.high) != 0u) {
        count_water(VIRGA_GROUND_RUN_OFF, lost.drained.low);
        atomicAdd(counts[VIRGA_GROUND_RUN_OFF].high, lost.drained.high);
    }
    barrier();
    if (lane == 0u) {
        if (group_sunk > 0u)
            count_water(VIRGA_GROUND_INFILTRATED, group_sunk);
        if (group_dried > 0u)
            count_water(VIRGA_GROUND_EVAPORATED, group_dried);
    }
}
