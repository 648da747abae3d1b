// rounds.glsl - drops move from cell to cell in rounds. In each round every drop that still has to move claims its next
// cell, then all claims are resolved at once, so the order of drops does not matter.
//
//     choose_cell  records the moves of the round before, then claims a cell; the drop with the lowest slot wins it
//     enter_cell   the winner enters the cell. A drop that lost the claim merges with the winner, and one that came to
//                  a drop at rest merges with that: water and momentum are added as integers, in any order
//
// A cell whose drop leaves in this round is free for others: two drops that follow each other do not merge.
// Claims alternate between two arrays: one is cleared while the other is used. In the last call of choose_cell
// round_index == rounds: it only records moves.
#ifdef ONE_WORKGROUP
uint round_index;
const uint rounds = VIRGA_GLASS_ROUNDS;
#else
layout(push_constant) uniform Round
{
    uint round_index;
    uint rounds;
};
#endif

uint claim_of(uint cell, uint of_round) { return cell + (of_round & 1u) * cell_count(); }

// Limits of what a drop can transfer: momentum in units of VIRGA_GLASS_MOMENTUM nl mm/s, and moment in nl 10 um. A
// conversion beyond the range of int is undefined. The first limit is 2.3 ml at the largest speed, 7.2 cells in a tick
// or 864 mm/s by default; water gathered by a wiper comes near it (more than 1e9 nl mm/s in windshield.yaml). Eight
// such drops may merge in one slot in a tick, and ten with the largest moment, which is as many as there is room for
// around it.
#define MAX_MOMENTUM 2.5e8
#define MAX_MOMENT 2e8

// Transfers the water and the momentum of a drop to another slot, and the moment of that water about the other drop.
void transfer_water(uint other, virga_glass_drop_gpu drop)
{
    const uint water = drop.water_nl + drop.merged_nl;
    const vec2 offset = to_vec2(drop.position) - to_vec2(drops[other].position);
    const ivec2 moment = ivec2(round(clamp(offset * (float(water) * 1e5), -MAX_MOMENT, MAX_MOMENT)));
    const vec2 momentum = to_vec2(drop.velocity) * (1000.0 / float(VIRGA_GLASS_MOMENTUM)) * float(drop.water_nl);
    const ivec2 momentum_units = ivec2(round(clamp(momentum, -MAX_MOMENTUM, MAX_MOMENTUM)));
    atomicAdd(drops[other].merged_nl, water);
    atomicAdd(drops[other].merged_momentum[0], momentum_units.x + drop.merged_momentum[0]);
    atomicAdd(drops[other].merged_momentum[1], momentum_units.y + drop.merged_momentum[1]);
    atomicAdd(drops[other].merged_nl_10um[0], moment.x + drop.merged_nl_10um[0]);
    atomicAdd(drops[other].merged_nl_10um[1], moment.y + drop.merged_nl_10um[1]);
}

// Frees a slot.
void clear_slot(uint slot)
{
    drops[slot].kind = VIRGA_GLASS_FREE;
    drops[slot].water_nl = 0u;
    drops[slot].merged_nl = 0u;
    drops[slot].merged_momentum = drops[slot].merged_nl_10um = int[2](0, 0);
}
