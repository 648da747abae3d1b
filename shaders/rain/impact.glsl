// impact.glsl - whether a slot's drop met a surface in this tick, and where.
//
// A drop is under the sky where the first thing on its line of fall is below it. It met that thing in the tick in which
// it went from above to below. A drop that comes under cover from the side (lines of fall drift a little in gusts) does
// not hit the cover far above it: the surface must lie on the way of this tick.
layout(scalar, set = 0, binding = 3) readonly buffer Drops { virga_drop_gpu drops[]; };
layout(scalar, set = 0, binding = 8) readonly buffer Sways { virga_sway_gpu sways[]; };

struct Hit {
    float weight; // 0: none
    float share;  // of the tick that had passed
    vec3 position, velocity;
    Shelter surface;
    uint size_class, id;
};

Hit find_hit(uint slot_index, uint level)
{
    Hit hit;
    hit.weight = 0.0;
    const uint class_rank = slots[slot_index].class_rank;
    hit.size_class = class_rank & 0xffffu;
    const virga_drop_gpu drop = drops[slot_index];
    const vec3 now = to_vec(drop.position);
    const float weight = drop_weight(now, level, hit.size_class, class_rank >> 16);
    hit.velocity = to_vec(classes[hit.size_class].velocity);
    if (tick.sway != 0u)
        hit.velocity += to_vec(sways[slot_index].velocity);
    if (weight <= 0.0 || hit.velocity.y > -0.05)
        return hit;

    const uint slant = classes[hit.size_class].slant;
    hit.surface = find_shelter(now, slant);
    if (now.y > hit.surface.height)
        return hit;
    const vec3 before = now - hit.velocity * tick.tick_s;
    const float fallen = before.y - now.y;
    if (hit.surface.height > before.y + 0.5 * fallen || find_shelter(before, slant).height >= before.y)
        return hit;
    hit.share = clamp((before.y - hit.surface.height) / fallen, 0.0, 1.0);
    hit.position = mix(before, now, hit.share);
    hit.weight = weight;
    hit.id = drop.id;
    return hit;
}
