// rounds.glsl - drops go from cell to cell in rounds: in each, every drop with way left claims the next cell, then all
// claims are settled at once, so that no order of drops matters.
//
// choose: writes down who came to which cell in the round before, then claims: the lowest place wins a cell enter:  the
// winner enters; who lost, and who came to a drop that stays, merges with it: water and momentum are added as
//         integers, in whatever order
//
// A cell that its drop leaves in this round is free for those who come: two drops that follow each other do not merge.
layout(push_constant) uniform Round
{
    uint round_index;  // claims alternate between two arrays: one is cleared while the other is in use
    uint rounds; // the last call of choose has round == rounds: it only writes down
};

uint claim_of(uint cell, uint of_round) { return cell + (of_round & 1u) * cell_count(); }

// What a drop gives of momentum (VIRGA_GLASS_MOMENTUM nl mm/s) and of moment (nl 10 um), at most: beyond the range of
// whole numbers a conversion is undefined. The first is 2.3 ml at the most that a drop may run in a tick, 7.2 cells or
// 864 mm/s by default. What a wiper gathers comes near it (more than 1e9 nl mm/s in windshield.yaml). Eight such drops
// may end in one place in a tick, and ten with all their moment: as many as there is room for around it.
#define MOST_MOMENTUM 2.5e8
#define MOST_MOMENT 2e8

// Water and momentum of a drop that ends, given to another place, and how far from it that water was.
void give_to(uint other, virga_glass_drop_gpu drop)
{
    const uint water = drop.water_nl + drop.merged_nl;
    const vec2 off = to_vec2(drop.position) - to_vec2(drops[other].position);
    const ivec2 away = ivec2(round(clamp(off * (float(water) * 1e5), -MOST_MOMENT, MOST_MOMENT)));
    const vec2 momentum = to_vec2(drop.velocity) * (1000.0 / float(VIRGA_GLASS_MOMENTUM)) * float(drop.water_nl);
    const ivec2 own = ivec2(round(clamp(momentum, -MOST_MOMENTUM, MOST_MOMENTUM)));
    atomicAdd(drops[other].merged_nl, water);
    atomicAdd(drops[other].merged_momentum[0], own.x + drop.merged_momentum[0]);
    atomicAdd(drops[other].merged_momentum[1], own.y + drop.merged_momentum[1]);
    atomicAdd(drops[other].merged_nl_10um[0], away.x + drop.merged_nl_10um[0]);
    atomicAdd(drops[other].merged_nl_10um[1], away.y + drop.merged_nl_10um[1]);
}

// What is left of its place.
void end_drop(uint place)
{
    drops[place].kind = VIRGA_GLASS_FREE;
    drops[place].water_nl = 0u;
    drops[place].merged_nl = 0u;
    drops[place].merged_momentum = drops[place].merged_nl_10um = int[2](0, 0);
}
