// hit.glsl - drops that met a pane in the newest step: a rectangle that moves through the field.
//
// Drops and pane move evenly in a step, so seen from the pane a drop comes on a straight line. A slot that stands for
// several drops has them around its own place, each shifted by a hash: the slots of a class lie anywhere in their box,
// so its drops do too. The first is the slot's own, with its id: the one whose streak is drawn.
layout(scalar, set = 0, binding = 3) readonly buffer Drops { virga_drop_gpu drops[]; };
layout(scalar, set = 0, binding = 8) readonly buffer Sways { virga_sway_gpu sways[]; };
layout(scalar, push_constant) uniform Pane { virga_rain_pane_gpu pane; };

#define MOST_DROPS 2048u // of a slot, tested one by one; where it stands for more each has the water of several
#define SPREAD     0.25  // of a box's side that they lie around their slot

struct Hit {
    float share; // of the step that had passed; negative: none
    vec2 place;  // m, along u and v
};

struct Slot {
    vec3 position, velocity; // at the step's end
    float weight;
    float spread; // m, to each side
    uint count, size_class, id, level;
};

Slot slot_at(uint slot_index)
{
    Slot slot;
    const uint class_rank = slots[slot_index].class_rank, level = slot_level(slot_index);
    slot.size_class = class_rank & 0xffffu;
    slot.position = to_vec(drops[slot_index].position);
    slot.id = drops[slot_index].id;
    slot.velocity = to_vec(classes[slot.size_class].velocity);
    if (tick.sway != 0u)
        slot.velocity += to_vec(sways[slot_index].velocity);
    slot.level = level;
    slot.weight = full_weight(level, slot.size_class, class_rank >> 16);
    slot.spread = 0.5 * SPREAD * tick.side_m * exp2(float(level + 1u) - float(tick.levels));
    slot.count = min(uint(slot.weight + virga_unit(virga_hash2(slot.id, tick.seed))), MOST_DROPS);
    return slot;
}

// Nothing of a slot can come near the pane.
bool far_away(Slot slot)
{
    const vec3 middle =
        to_vec(pane.corner) + 0.5 * (to_vec(pane.along_u) * pane.width_m + to_vec(pane.along_v) * pane.height_m);
    const float way = length(slot.velocity - to_vec(pane.velocity)) * pane.step_s;
    return length(slot.position - middle) > 0.5 * (pane.width_m + pane.height_m) + way + 1.75 * slot.spread;
}

vec3 shift_of(Slot slot, uint k)
{
    if (k == 0u)
        return vec3(0.0);
    const uint hash = virga_hash2(slot.id, k);
    return slot.spread * (2.0 * vec3(virga_unit(virga_hash2(hash, 0u)), virga_unit(virga_hash2(hash, 1u)),
                                     virga_unit(virga_hash2(hash, 2u))) - 1.0);
}

Hit find_hit(Slot slot, uint k)
{
    const vec3 u = to_vec(pane.along_u), v = to_vec(pane.along_v), outside = normalize(cross(u, v));
    const vec3 now = slot.position + shift_of(slot, k) - to_vec(pane.corner);
    const vec3 before = now - (slot.velocity - to_vec(pane.velocity)) * pane.step_s;
    const float d0 = dot(before, outside), d1 = dot(now, outside);
    Hit hit = Hit(-1.0, vec2(0.0));
    if (!(d0 > 0.0 && d1 <= 0.0))
        return hit;
    const float share = d0 / (d0 - d1);
    const vec3 at = mix(before, now, share);
    hit.place = vec2(dot(at, u), dot(at, v));
    if (any(lessThan(hit.place, vec2(0.0))) || hit.place.x > pane.width_m || hit.place.y > pane.height_m)
        return hit;
    // Where boxes hand over to each other, each has a part of the drops.
    if (virga_unit(virga_hash3(slot.id, k, 7u)) >=
        level_share(box_radius(slot.position + shift_of(slot, k)), slot.level))
        return hit;
    const vec3 there = slot.position + shift_of(slot, k) - slot.velocity * (pane.step_s * (1.0 - share));
    if (find_shelter(there, classes[slot.size_class].slant).height < there.y)
        hit.share = min(share, 0.999999);
    return hit;
}
