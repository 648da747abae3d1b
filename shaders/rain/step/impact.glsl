// impact.glsl - whether a slot's drop hit a surface in this tick, and where.
//
// A drop is under the sky if the first surface on its line of fall is below it. It hit that surface in the tick in
// which it went from above to below. A drop that moves under a cover from the side (lines of fall drift in gusts) does
// not hit the cover far above it: the surface must be within the drop's path in this tick.

#define ROUNDING_M 1e-3 // rounding error of heights

struct Hit {
    bool met;     // decided once, by impact_mark.comp: floats may differ between shaders
    float weight; // of the drop
    float share;  // fraction of the tick at the hit
    vec3 position, velocity;
    Cover surface;
    uint size_class, id;
};

// Whether a drop was so near to a surface in this tick that it may have hit it, by the height of the texel and its
// largest slope. Few are, and only those are tested further: software Vulkan runs every lane through all branches, and
// the map is not in the cache.
bool is_near_surface(uint slot_index)
{
    const uint size_class = slot_of(slot_index).class_rank & 0xffffu;
    const vec3 now = to_vec(drop_of(slot_index).position);
    const float fall_m = -velocity_of(slot_index, size_class).y * tick.tick_s;
    const MapPosition map_pos = map_position(now, classes[size_class].slant);
    const float height = height_at_texel(map_pos);
    const float slope = tick.host_depth != 0u ? 0.0 : MAX_OFFSET / map_pos.map.texels_per_m;
    return height > NOTHING_BELOW && now.y - ROUNDING_M <= height + slope &&
           height - slope <= now.y + 1.5 * fall_m + ROUNDING_M;
}

// Without branches, see above.
Hit test_drop(uint slot_index)
{
    const uint class_rank = slot_of(slot_index).class_rank;
    const uint size_class = class_rank & 0xffffu;
    const virga_drop_gpu drop = drop_of(slot_index);
    const vec3 now = to_vec(drop.position);
    const vec3 velocity = velocity_of(slot_index, size_class);
    const vec3 before = now - velocity * tick.tick_s;
    const float fall_m = before.y - now.y;
    const uint slant = classes[size_class].slant;

    Hit hit;
    hit.surface = find_cover(now, slant);
    const bool crossed = now.y <= hit.surface.height && hit.surface.height <= before.y + 0.5 * fall_m;
    const bool falling = velocity.y <= -0.05;
    const bool sheltered_before = find_cover(before, slant).height >= before.y;
    hit.share = clamp((before.y - hit.surface.height) / fall_m, 0.0, 1.0);
    hit.position = mix(before, now, hit.share);
    hit.velocity = velocity;
    hit.size_class = size_class;
    hit.id = drop.id;
    hit.weight = drop_weight(now, slot_level(slot_index), size_class, class_rank >> 16);
    hit.met = crossed && falling && !sheltered_before && hit.weight > 0.0;
    return hit;
}
