// blades.glsl - where a place is relative to a blade. Blades are rectangles (Goto et al. 2009, section 4.2); in a tick
// one moves from a pose to another, and a place counts as swept if the blade passed over it.

// Across the blade (to the left of its direction) and along it, from its middle.
vec2 in_blade(vec2 place, vec2 middle, vec2 along)
{
    const vec2 off = place - middle;
    return vec2(dot(off, vec2(-along.y, along.x)), dot(off, along));
}

vec2 now_in_blade(uint i, vec2 place)
{
    return in_blade(place, to_vec2(tick.blades[i].middle), to_vec2(tick.blades[i].along));
}

vec2 before_in_blade(uint i, vec2 place)
{
    return in_blade(place, to_vec2(tick.blades[i].before_middle), to_vec2(tick.blades[i].before_along));
}

vec2 out_of_blade(uint i, vec2 local)
{
    const vec2 along = to_vec2(tick.blades[i].along);
    return to_vec2(tick.blades[i].middle) + local.x * vec2(-along.y, along.x) + local.y * along;
}

// Whether a circle lies under a blade.
bool lies_under(uint i, vec2 place, float radius)
{
    const vec2 now = now_in_blade(i, place);
    return abs(now.y) <= tick.blades[i].half_length_m + radius && abs(now.x) < tick.blades[i].half_width_m + radius;
}

// Whether a blade passed over a circle in this tick, or lies on it at its end. `was` is where the circle was at its
// start.
bool touched(uint i, vec2 was, vec2 place, float radius)
{
    const vec2 now = now_in_blade(i, place);
    const float reach = tick.blades[i].half_width_m + radius;
    if (abs(now.y) > tick.blades[i].half_length_m + radius)
        return false;
    if (abs(now.x) < reach)
        return true;
    const float side = tick.blades[i].side;
    return side != 0.0 && before_in_blade(i, was).x * side > 0.0 && now.x * side < 0.0;
}

// The bin along a blade that a place belongs to.
uint bin_at(uint i, float along_m)
{
    const float share = along_m / (2.0 * tick.blades[i].half_length_m) + 0.5;
    return i * VIRGA_GLASS_BINS + uint(clamp(share * float(VIRGA_GLASS_BINS), 0.0, float(VIRGA_GLASS_BINS - 1)));
}

// In the band beside a blade that particles live in (section 4.3).
bool in_band(vec2 place)
{
    for (uint i = 0u; i < tick.blade_count; i++) {
        const vec2 now = abs(now_in_blade(i, place));
        if (now.x <= tick.blades[i].half_width_m + tick.band_m &&
            now.y <= tick.blades[i].half_length_m + tick.particle_m)
            return true;
    }
    return false;
}

// Where a blade pushes a particle that it touches: to the side where it was when the tick began, which for what the
// blade caught up with is its front; past its end where it is nearer to that; `flip` takes the other side, and it
// slides along by so much.
vec2 pushed_by(uint i, vec2 at, vec2 was, bool flip, float slide_m, inout bool pushed)
{
    const vec2 now = now_in_blade(i, at);
    const float reach = tick.blades[i].half_width_m + tick.particle_m, start = before_in_blade(i, was).x;
    const float end = abs(now.y) - tick.blades[i].half_length_m;
    if (end > 0.0 && abs(now.x) < tick.blades[i].half_width_m)
        return out_of_blade(i, vec2(now.x, sign(now.y) * (tick.blades[i].half_length_m + tick.particle_m)));
    if (end > 0.0 && abs(now.x) < reach &&
        length(vec2(abs(now.x) - tick.blades[i].half_width_m, end)) >= tick.particle_m)
        return at; // beside its corner
    const float side = abs(start) > 1e-7 ? sign(start) : tick.blades[i].side == 0.0 ? 1.0 : tick.blades[i].side;
    pushed = pushed || tick.blades[i].side != 0.0;
    return out_of_blade(i, vec2((flip ? -side : side) * reach, now.y + slide_m));
}

// Out of all blades. One may push it into another: then it is tried again, on the other sides, and at last along the
// blade, ever farther to one end and the other: where two blades cross there is room beyond the crossing.
vec2 push_by_blades(vec2 at, vec2 was, inout bool pushed)
{
    for (uint attempt = 0u; attempt < 16u; attempt++) {
        bool free = true;
        for (uint i = 0u; i < tick.blade_count; i++) {
            const bool flip = attempt >= 2u;
            const float radius = tick.particle_m * 0.999;
            if (flip ? !lies_under(i, at, radius) : !touched(i, was, at, radius))
                continue;
            const float slide = float(max(attempt, 3u) - 3u) * tick.particle_m * ((attempt & 1u) == 0u ? 1.0 : -1.0);
            at = pushed_by(i, at, was, flip && (attempt & 2u) != 0u, slide, pushed);
            free = false;
        }
        if (free)
            break;
    }
    return at;
}
