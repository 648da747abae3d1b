// blades.glsl - points relative to a wiper blade. Blades are rectangles (Goto et al. 2009, section 4.2). In a tick a
// blade moves from one pose to another; a point is swept if the blade passed over it.

// Blade coordinates, from the blade's middle: x across (positive to the left of its direction), y along.
vec2 to_blade(vec2 point, vec2 middle, vec2 along)
{
    const vec2 offset = point - middle;
    return vec2(dot(offset, vec2(-along.y, along.x)), dot(offset, along));
}

vec2 to_blade_now(uint i, vec2 point)
{
    return to_blade(point, to_vec2(tick.blades[i].middle), to_vec2(tick.blades[i].along));
}

vec2 to_blade_before(uint i, vec2 point)
{
    return to_blade(point, to_vec2(tick.blades[i].before_middle), to_vec2(tick.blades[i].before_along));
}

vec2 from_blade(uint i, vec2 local)
{
    const vec2 along = to_vec2(tick.blades[i].along);
    return to_vec2(tick.blades[i].middle) + local.x * vec2(-along.y, along.x) + local.y * along;
}

// Whether a circle lies under a blade at the end of the tick.
bool is_under_blade(uint i, vec2 point, float radius)
{
    const vec2 now = to_blade_now(i, point);
    return abs(now.y) <= tick.blades[i].half_length_m + radius && abs(now.x) < tick.blades[i].half_width_m + radius;
}

// Whether a blade passed over a circle in this tick, or lies on it at the end. `start` is where the circle was at the
// start of the tick.
bool is_swept(uint i, vec2 start, vec2 point, float radius)
{
    const vec2 now = to_blade_now(i, point);
    const float reach = tick.blades[i].half_width_m + radius;
    if (abs(now.y) > tick.blades[i].half_length_m + radius)
        return false;
    if (abs(now.x) < reach)
        return true;
    const float side = tick.blades[i].side;
    return side != 0.0 && to_blade_before(i, start).x * side > 0.0 && now.x * side < 0.0;
}

// The bin of the blade that a distance along it belongs to.
uint bin_at(uint i, float along_m)
{
    const float share = along_m / (2.0 * tick.blades[i].half_length_m) + 0.5;
    return i * VIRGA_GLASS_BINS + uint(clamp(share * float(VIRGA_GLASS_BINS), 0.0, float(VIRGA_GLASS_BINS - 1)));
}

// Whether a point is in a band beside a blade, where particles live (section 4.3).
bool is_in_band(vec2 point)
{
    for (uint i = 0u; i < tick.blade_count; i++) {
        const vec2 now = abs(to_blade_now(i, point));
        if (now.x <= tick.blades[i].half_width_m + tick.band_m &&
            now.y <= tick.blades[i].half_length_m + tick.particle_m)
            return true;
    }
    return false;
}

// Where a blade pushes a particle that it touches: to the side on which the particle was at the start of the tick, so a
// particle that the blade caught up with comes to its front. A particle past the blade's end is pushed beyond that end.
// `flip` takes the other side; `slide_m` moves the particle along the blade.
vec2 pushed_by(uint i, vec2 at, vec2 start, bool flip, float slide_m, inout bool pushed)
{
    const vec2 now = to_blade_now(i, at);
    const float reach = tick.blades[i].half_width_m + tick.particle_m, start_x = to_blade_before(i, start).x;
    const float end = abs(now.y) - tick.blades[i].half_length_m;
    if (end > 0.0 && abs(now.x) < tick.blades[i].half_width_m)
        return from_blade(i, vec2(now.x, sign(now.y) * (tick.blades[i].half_length_m + tick.particle_m)));
    if (end > 0.0 && abs(now.x) < reach &&
        length(vec2(abs(now.x) - tick.blades[i].half_width_m, end)) >= tick.particle_m)
        return at; // beside a corner of the blade
    const float side = abs(start_x) > 1e-7 ? sign(start_x) : tick.blades[i].side == 0.0 ? 1.0 : tick.blades[i].side;
    pushed = pushed || tick.blades[i].side != 0.0;
    return from_blade(i, vec2((flip ? -side : side) * reach, now.y + slide_m));
}

// Pushes a particle out of all blades. One blade may push it into another; then the other sides are tried, and at last
// ever longer distances along the blade, to both ends: where two blades cross, there is room beyond the crossing.
vec2 push_by_blades(vec2 at, vec2 start, inout bool pushed)
{
    for (uint attempt = 0u; attempt < 16u; attempt++) {
        bool clear = true;
        for (uint i = 0u; i < tick.blade_count; i++) {
            const bool flip = attempt >= 2u;
            const float radius = tick.particle_m * 0.999;
            if (flip ? !is_under_blade(i, at, radius) : !is_swept(i, start, at, radius))
                continue;
            const float slide = float(max(attempt, 3u) - 3u) * tick.particle_m * ((attempt & 1u) == 0u ? 1.0 : -1.0);
            at = pushed_by(i, at, start, flip && (attempt & 2u) != 0u, slide, pushed);
            clear = false;
        }
        if (clear)
            break;
    }
    return at;
}
