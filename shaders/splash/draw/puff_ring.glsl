// puff_ring.glsl - a splash that is too small for a sheet, but not for its parts to be seen: the ring of its foot, and
// the droplets that leave it, as streaks of the time for which the shutter is open.
//
// Its total coverage is 1: each part has its share of all by its area, so that it stays as visible as when it was a
// spot.

#define FINGERS   6
#define STAYING   2   // of them are there until the end, as beads
#define RING_PX   0.9 // widths of the lines
#define FINGER_PX 0.75
#define LIFE_S    0.09 // of nearly all splashes, SHEET_S in shape.glsl
#define INSIDE    0.12 // of the ring's coverage: the thin water within it

#define OUT_SHARE 1.15 // farthest that a droplet goes out, of the mean
#define UP_SHARE  1.21 // highest that one is, of the height of all

float hat(float distance_px, float half_px)
{
    return max(1.0 - abs(distance_px) / half_px, 0.0);
}

// x: coverage of a pixel; y: the area (px^2).
vec2 ring_part(vec2 at, vec2 radii)
{
    const vec2 scaled = at / radii;
    const float f = length(scaled), off = (f - 1.0) * f / max(length(scaled / radii), 1e-4);
    const float perimeter = 3.14159265 * (1.5 * (radii.x + radii.y) - sqrt(radii.x * radii.y)); // nearly
    const float inside = INSIDE * clamp(0.5 - off, 0.0, 1.0);
    return vec2(max(hat(off, RING_PX), inside), perimeter * RING_PX + INSIDE * 3.14159265 * radii.x * radii.y);
}

// `at`: from where it begins.
vec2 streak_part(vec2 at, vec2 way)
{
    const float squared = dot(way, way), along = clamp(dot(at, way) / max(squared, 1e-4), 0.0, 1.0);
    return vec2(hat(length(at - way * along), FINGER_PX), (sqrt(squared) + FINGER_PX) * FINGER_PX);
}

// How high a droplet is at a part of the life: it leaves the ring outwards and up, and falls back.
float finger_rise(float life) { return 1.1 * life * (1.0 - life); }

vec2 ring_radii(float half_wide, float sine, float share)
{
    return max(share * half_wide * vec2(1.0, sine), vec2(0.8, 0.4));
}

// Whether a crown may cover `at`, as a spot or by its ring and droplets. Most of the pixels of several crowns are
// between them.
//
// The spot: one_crown_cover is 0 beyond half_wide, and beyond half a pixel below and above its walls. A droplet: the
// largest factors of its way and of its reach. The ring: where ring_part's distance is h, the point is f = 1 + h
// sqrt(c^2 / rx^2 + s^2 / ry^2) times as far out as (c rx, s ry) with c^2 + s^2 = 1. So with rx >= ry its y is at most
// ry + h, and its x at most rx + h sqrt(c^4 + (c s rx / ry)^2), where c s is at most 1/2.
vec3 crown_box(float half_wide, float high, float sine, float share) // half width; how far down, and up
{
    const vec2 radii = ring_radii(half_wide, sine, share);
    const float flatter = radii.x / radii.y, out_px = OUT_SHARE * (1.0 - share) * half_wide + FINGER_PX;
    const float wide = radii.x + max(RING_PX * sqrt(1.0 + 0.25 * flatter * flatter), out_px);
    const float deep = max(sine * half_wide + 0.5, radii.y + max(RING_PX, out_px));
    return vec3(max(wide, half_wide), deep, deep + UP_SHARE * high);
}

bool crown_may_cover(vec2 at, float half_wide, float high, float sine, float share)
{
    const vec3 box = crown_box(half_wide, high, sine, share);
    return abs(at.x) < box.x && at.y > -box.y && at.y < box.z;
}

// `at`: from the middle of the foot, y upwards; `share`: the ring's part of the half width. All in pixels.
float ring_cover(vec2 at, float half_wide, float high, float sine, float share, float life, vec4 chance)
{
    const vec2 radii = ring_radii(half_wide, sine, share);
    vec2 sum = ring_part(at, radii) * (1.0 - 0.7 * life);
    // The half width and the height are those that the droplets have reached by now.
    const float age = max(life, 0.05), before = max(age - (view.time_close_s - view.time_open_s) / LIFE_S, 0.0);
    const vec2 most = vec2((1.0 - share) * half_wide, high) / age;
    // A droplet goes straight outwards on the ground, with the ring's ratio, and up and down over it.
    const vec2 ground = vec2(1.0, radii.y / radii.x), out_before = before * ground, out_since = (age - before) * ground;
    const float up_before = finger_rise(before), up_since = finger_rise(age) - up_before;
    const float leaving = 1.0 - smoothstep(0.45, 0.8, life);
    for (int i = 0; i < FINGERS && share < 0.97; i++) {
        const vec2 other = fract(chance.xy * (3.7 + 2.3 * float(i)) + chance.zw * (1.0 + float(i)));
        const float turn = 6.2831853 * ((float(i) + 0.8 * other.x) / float(FINGERS) + chance.z - 0.5);
        const vec2 outward = vec2(cos(turn), sin(turn)),
                   reach = most * vec2(0.55 + 0.6 * other.y, 0.45 + 0.65 * other.x);
        const vec2 from = outward * (radii + reach.x * out_before) + vec2(0.0, reach.y * up_before);
        const vec2 way = outward * (reach.x * out_since) + vec2(0.0, reach.y * up_since);
        sum += (i < STAYING ? 1.0 : leaving) * streak_part(at - from, way);
    }
    return sum.x / max(sum.y, 1.0);
}
