// hit.glsl - drops that met a pane in the newest step: a rectangle that moves through the field.
//
// Drops and pane move evenly in a step, so seen from the pane a drop comes on a straight line. A slot that stands for
// several drops has them around its own place, in a cube that is cut into cells: at most one to a cell, anywhere in it,
// by a hash. The slots of a class lie anywhere in their box, so its drops do too; and only the cells that the pane has
// swept need to be looked at, of thousands. The first drop is the slot's own, with its id: the one whose streak is
// drawn.
layout(scalar, push_constant) uniform Pane { virga_rain_pane_gpu pane; };

#define MOST_CELLS 24.0 // along a side of a slot's cube; where it stands for more drops each has the water of several
#define SPREAD     0.25 // of a box's side: that of the cube

struct Hit {
    float share;     // of the step that had passed; negative: none
    vec2 place;      // m, along u and v
    vec3 there;      // where the drop was then
    uint number;     // of the slot's drops; 0: its own
};

struct Slot {
    vec3 position, velocity; // at the step's end
    vec3 way;                // in the step, seen from the pane (m)
    float weight;
    float spread;    // m, to each side
    float cells;     // along a side
    float chance;    // of a cell to have a drop; above 1: that one has the water of so many
    uint size_class, id, level;
};

// The drops of a slot that may have met the pane: its own, then those of a block of cells.
struct Walk {
    ivec3 low, high, cell;
    bool own, left; // the next is its own; there is a next
};

Slot slot_at(uint slot_index)
{
    Slot slot;
    const uint class_rank = slot_of(slot_index).class_rank, level = slot_level(slot_index);
    slot.size_class = class_rank & 0xffffu;
    slot.position = to_vec(drop_of(slot_index).position);
    slot.id = drop_of(slot_index).id;
    slot.velocity = velocity_of(slot_index, slot.size_class);
    slot.way = (slot.velocity - to_vec(pane.velocity)) * pane.step_s;
    slot.level = level;
    slot.weight = full_weight(level, slot.size_class, class_rank >> 16);
    slot.spread = 0.5 * SPREAD * tick.side_m * exp2(float(level + 1u) - float(tick.levels));
    const float others = max(slot.weight - 1.0, 0.0);
    slot.cells = clamp(ceil(pow(others, 1.0 / 3.0)), 1.0, MOST_CELLS);
    slot.chance = others / (slot.cells * slot.cells * slot.cells);
    return slot;
}

// A drop that met the pane at a point p with the share s of the step passed is at p + (1 - s) way at its end: all such
// places lie in the box around the pane and the pane moved by the way.
Walk walk_of(Slot slot)
{
    const vec3 u = to_vec(pane.along_u) * pane.width_m, v = to_vec(pane.along_v) * pane.height_m;
    const vec3 low = min(u, 0.0) + min(v, 0.0) + min(slot.way, 0.0);
    const vec3 high = max(u, 0.0) + max(v, 0.0) + max(slot.way, 0.0);
    const vec3 from = to_vec(pane.corner) - slot.position + slot.spread;
    const float cells_per_m = slot.cells / (2.0 * slot.spread);
    Walk walk;
    walk.low = ivec3(clamp(floor((from + low) * cells_per_m), vec3(0.0), vec3(slot.cells)));
    walk.high = ivec3(clamp(floor((from + high) * cells_per_m), vec3(-1.0), vec3(slot.cells - 1.0)));
    walk.cell = walk.low;
    walk.own = true;
    walk.left = slot.weight > 0.0 && all(lessThanEqual(walk.low, walk.high));
    return walk;
}

// To the next drop: no divisions, which software Vulkan does lane by lane.
void advance(inout Walk walk)
{
    const bool end_x = walk.cell.x == walk.high.x, end_y = end_x && walk.cell.y == walk.high.y;
    const bool end_z = end_y && walk.cell.z == walk.high.z;
    const ivec3 next = ivec3(end_x ? walk.low.x : walk.cell.x + 1,
                             end_y ? walk.low.y : walk.cell.y + int(end_x), walk.cell.z + int(end_y));
    walk.left = walk.own || !end_z;
    walk.cell = walk.own ? walk.low : next;
    walk.own = false;
}

// Whether there is a drop at the walk's place, and whether it met the pane, were it under the sky.
Hit meet(Slot slot, Walk walk)
{
    const uint side = uint(slot.cells);
    const uvec3 cell = uvec3(walk.cell);
    Hit hit;
    hit.number = walk.own ? 0u : 1u + cell.x + side * (cell.y + side * cell.z);
    const uint hash = virga_hash2(slot.id, hit.number);
    const vec3 within = vec3(virga_unit(hash), virga_unit(virga_hash_absorb(hash, 1u)),
                             virga_unit(virga_hash_absorb(hash, 2u)));
    const vec3 shift = walk.own ? vec3(0.0) : slot.spread * (2.0 * (vec3(cell) + within) / slot.cells - 1.0);
    // Where boxes hand over to each other, each has a part of the drops.
    const float chance = (walk.own ? min(slot.weight, 1.0) : min(slot.chance, 1.0)) *
                         level_share(box_radius(slot.position + shift), slot.level);
    const vec3 u = to_vec(pane.along_u), v = to_vec(pane.along_v), outside = cross(u, v);
    const vec3 now = slot.position + shift - to_vec(pane.corner), before = now - slot.way;
    const float d0 = dot(before, outside), d1 = dot(now, outside), share = d0 / (d0 - d1);
    const vec3 at = mix(before, now, share);
    hit.place = vec2(dot(at, u), dot(at, v));
    hit.there = slot.position + shift - slot.velocity * (pane.step_s * (1.0 - share));
    const bool met = d0 > 0.0 && d1 <= 0.0 && all(greaterThanEqual(hit.place, vec2(0.0))) &&
                     hit.place.x <= pane.width_m && hit.place.y <= pane.height_m;
    hit.share = met && virga_unit(virga_hash_absorb(hash, 3u)) < chance ? min(share, 0.999999) : -1.0;
    return hit;
}

// The next drop of the walk that met the pane, were it under the sky; false: none.
bool next_hit(Slot slot, inout Walk walk, out Hit hit)
{
    hit.share = -1.0;
    while (walk.left && hit.share < 0.0) {
        hit = meet(slot, walk);
        advance(walk);
    }
    return hit.share >= 0.0;
}

bool under_sky(Slot slot, Hit hit)
{
    return find_shelter(hit.there, classes[slot.size_class].slant).height < hit.there.y;
}
