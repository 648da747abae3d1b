// hit.glsl - drops that hit a pane in the newest step. The pane is a rectangle that moves through the field.
//
// Drops and pane move uniformly in a step, so relative to the pane a drop moves along a straight line. A slot that
// stands for several drops has them around its own position, in a cube divided into cells: at most one per cell, at a
// hashed position. The slots of a class are anywhere in their box, so the drops are too, and only the cells that the
// pane has swept are tested, out of thousands. The first drop is the slot's own, with its id: the one whose streak is
// drawn.
layout(scalar, push_constant) uniform Pane { virga_rain_pane_gpu pane; };

// max cells along a side of a slot's cube; if it stands for more drops, each has the water of several
#define MAX_CELLS 24.0
#define SPREAD 0.25 // side of the cube, of the box's side

struct Hit {
    float share;        // fraction of the step at the hit; negative: no hit
    vec2 pane_position; // on the pane, m along u and v
    vec3 drop_position; // of the drop at the hit
    uint number;        // which of the slot's drops; 0: its own
};

struct Slot {
    vec3 position, velocity; // at the end of the step
    vec3 path;               // in the step, relative to the pane (m)
    float weight;
    float spread; // half the cube's side, m
    float cells;  // cells along a side
    float chance; // probability that a cell has a drop; above 1: the drop has the water of this many
    uint size_class, id, level;
};

// Iterates over the drops of a slot that may have hit the pane: its own, then those of a block of cells.
struct Traversal {
    ivec3 low, high, cell;
    bool own_drop, has_next; // the next is the slot's own drop; there is a next one
};

Slot slot_at(uint slot_index)
{
    Slot slot;
    const uint class_rank = slot_of(slot_index).class_rank, level = slot_level(slot_index);
    slot.size_class = class_rank & 0xffffu;
    slot.position = to_vec(drop_of(slot_index).position);
    slot.id = drop_of(slot_index).id;
    slot.velocity = velocity_of(slot_index, slot.size_class);
    slot.path = (slot.velocity - to_vec(pane.velocity)) * pane.step_s;
    slot.level = level;
    slot.weight = full_weight(level, slot.size_class, class_rank >> 16);
    slot.spread = 0.5 * SPREAD * tick.side_m * exp2(float(level + 1u) - float(tick.levels));
    const float other_drops = max(slot.weight - 1.0, 0.0);
    slot.cells = clamp(ceil(pow(other_drops, 1.0 / 3.0)), 1.0, MAX_CELLS);
    slot.chance = other_drops / (slot.cells * slot.cells * slot.cells);
    return slot;
}

// A drop that hit the pane at a point p, at the fraction s of the step, ends at p + (1 - s) path. All such points are
// in the bounding box of the pane and the pane moved by the path.
Traversal start_traversal(Slot slot)
{
    const vec3 u = to_vec(pane.along_u) * pane.width_m, v = to_vec(pane.along_v) * pane.height_m;
    const vec3 low = min(u, 0.0) + min(v, 0.0) + min(slot.path, 0.0);
    const vec3 high = max(u, 0.0) + max(v, 0.0) + max(slot.path, 0.0);
    const vec3 from = to_vec(pane.corner) - slot.position + slot.spread;
    const float cells_per_m = slot.cells / (2.0 * slot.spread);
    Traversal traversal;
    traversal.low = ivec3(clamp(floor((from + low) * cells_per_m), vec3(0.0), vec3(slot.cells)));
    traversal.high = ivec3(clamp(floor((from + high) * cells_per_m), vec3(-1.0), vec3(slot.cells - 1.0)));
    traversal.cell = traversal.low;
    traversal.own_drop = true;
    traversal.has_next = slot.weight > 0.0 && all(lessThanEqual(traversal.low, traversal.high));
    return traversal;
}

// Advances to the next drop. Without divisions, which software Vulkan does lane by lane.
void advance(inout Traversal traversal)
{
    const bool end_x = traversal.cell.x == traversal.high.x, end_y = end_x && traversal.cell.y == traversal.high.y;
    const bool end_z = end_y && traversal.cell.z == traversal.high.z;
    const ivec3 next = ivec3(end_x ? traversal.low.x : traversal.cell.x + 1,
                             end_y ? traversal.low.y : traversal.cell.y + int(end_x), traversal.cell.z + int(end_y));
    traversal.has_next = traversal.own_drop || !end_z;
    traversal.cell = traversal.own_drop ? traversal.low : next;
    traversal.own_drop = false;
}

// Tests the current drop: whether it exists, and whether it hit the pane if it was under the sky.
Hit test_drop(Slot slot, Traversal traversal)
{
    const uint side = uint(slot.cells);
    const uvec3 cell = uvec3(traversal.cell);
    Hit hit;
    hit.number = traversal.own_drop ? 0u : 1u + cell.x + side * (cell.y + side * cell.z);
    const uint hash = virga_hash2(slot.id, hit.number);
    const vec3 within =
        vec3(virga_unit(hash), virga_unit(virga_hash_absorb(hash, 1u)), virga_unit(virga_hash_absorb(hash, 2u)));
    const vec3 shift = traversal.own_drop ? vec3(0.0) : slot.spread * (2.0 * (vec3(cell) + within) / slot.cells - 1.0);
    // Where two boxes overlap, each has a part of the drops.
    const float chance = (traversal.own_drop ? min(slot.weight, 1.0) : min(slot.chance, 1.0)) *
                         level_share(box_radius(slot.position + shift), slot.level);
    const vec3 u = to_vec(pane.along_u), v = to_vec(pane.along_v), outside = cross(u, v);
    const vec3 now = slot.position + shift - to_vec(pane.corner), before = now - slot.path;
    const float d0 = dot(before, outside), d1 = dot(now, outside), share = d0 / (d0 - d1);
    const vec3 at = mix(before, now, share);
    hit.pane_position = vec2(dot(at, u), dot(at, v));
    hit.drop_position = slot.position + shift - slot.velocity * (pane.step_s * (1.0 - share));
    const bool met = d0 > 0.0 && d1 <= 0.0 && all(greaterThanEqual(hit.pane_position, vec2(0.0))) &&
                     hit.pane_position.x <= pane.width_m && hit.pane_position.y <= pane.height_m;
    hit.share = met && virga_unit(virga_hash_absorb(hash, 3u)) < chance ? min(share, 0.999999) : -1.0;
    return hit;
}

// The next drop that hit the pane if it was under the sky; false: there is none.
bool next_hit(Slot slot, inout Traversal traversal, out Hit hit)
{
    hit.share = -1.0;
    while (traversal.has_next && hit.share < 0.0) {
        hit = test_drop(slot, traversal);
        advance(traversal);
    }
    return hit.share >= 0.0;
}

bool is_under_sky(Slot slot, Hit hit)
{
    return find_cover(hit.drop_position, classes[slot.size_class].slant).height < hit.drop_position.y;
}
