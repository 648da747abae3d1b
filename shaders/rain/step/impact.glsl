// impact.glsl - whether a slot's drop met a surface in this tick, and where.
//
// A drop is under the sky where the first thing on its line of fall is below it. It met that thing in the tick in which
// it went from above to below. A drop that comes under cover from the side (lines of fall drift a little in gusts) does
// not hit the cover far above it: the surface must lie on the way of this tick.

#define ROUNDING_M 1e-3 // of heights

struct Hit {
    bool met;     // decided once, by impact_mark.comp: floats may come out otherwise in another shader
    float weight; // of the drop, were it to meet something
    float share;  // of the tick that had passed
    vec3 position, velocity;
    Shelter surface;
    uint size_class, id;
};

// Whether a slot's drop was so near to a surface in this tick that it may have met it: by the middle of a texel, give
// or take its slope. Few are, and all else is looked at for those alone: software Vulkan runs every lane through what a
// branch would skip, and the map is far away in memory.
bool near_surface(uint slot_index)
{
    const uint size_class = slot_of(slot_index).class_rank & 0xffffu;
    const vec3 now = to_vec(drop_of(slot_index).position);
    const float fallen = -velocity_of(slot_index, size_class).y * tick.tick_s;
    const MapPlace place = map_place(now, classes[size_class].slant);
    const float height = middle_height(place);
    const float slope = tick.host_depth != 0u ? 0.0 : MOST_OFFSET / place.map.texels_per_m;
    return height > NOTHING_BELOW && now.y - ROUNDING_M <= height + slope &&
           height - slope <= now.y + 1.5 * fallen + ROUNDING_M;
}

// Without branches, see above.
Hit find_hit(uint slot_index)
{
    const uint class_rank = slot_of(slot_index).class_rank;
    const uint size_class = class_rank & 0xffffu;
    const virga_drop_gpu drop = drop_of(slot_index);
    const vec3 now = to_vec(drop.position);
    const vec3 velocity = velocity_of(slot_index, size_class);
    const vec3 before = now - velocity * tick.tick_s;
    const float fallen = before.y - now.y;
    const uint slant = classes[size_class].slant;

    Hit hit;
    hit.surface = find_shelter(now, slant);
    const bool crossed = now.y <= hit.surface.height && hit.surface.height <= before.y + 0.5 * fallen;
    const bool falling = velocity.y <= -0.05;
    const bool sheltered_before = find_shelter(before, slant).height >= before.y;
    hit.share = clamp((before.y - hit.surface.height) / fallen, 0.0, 1.0);
    hit.position = mix(before, now, hit.share);
    hit.velocity = velocity;
    hit.size_class = size_class;
    hit.id = drop.id;
    hit.weight = drop_weight(now, slot_level(slot_index), size_class, class_rank >> 16);
    hit.met = crossed && falling && !sheltered_before && hit.weight > 0.0;
    return hit;
}
