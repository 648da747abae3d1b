// front_overlap.glsl - how much of a lens's opening a drop on its front element covers.
//
// A lens with an opening of radius R, focused at the distance s, has drops on a pane at the distance d before the
// opening. The light of a pixel whose ray through the opening's middle is w (view depth 1) comes from the point s w,
// through every point a of the opening. It crosses the pane at
//
//     x = d w + (1 - d / s) a,
//
// so a drop with its middle at c and a base of radius r is before those a for which |d w + k a - c| < r, k = 1 - d / s.
// With e = d w - c, how far the pixel's ray passes the drop's middle, that is the part that two discs have in common,
// one of radius r around the drop's middle and one of radius k R that is e from it, as a share of the second:
//
//     share(e) = area(disc(0, r), disc(e, k R)) / (pi k^2 R^2).
//
// It is min(1, r^2 / (k R)^2) for |e| < |k R - r|, and ends at |e| = k R + r: a disc with a soft rim, of the size of
// the opening's shadow and not of the drop. Its sum over the picture is that of the drop in sharp focus, pi r^2 / d^2,
// as the mean over all discs of one size is their area. Here all is in radii of the drop: t = |e| / r, and the
// opening is k R / r.

// The part of a disc of a radius that a chord cuts off: it has half the length `half_chord` and is `away` from the
// middle. The series keeps its digits where the angle is small.
float segment_area(float radius, float half_chord, float away)
{
    const float angle = 2.0 * atan(half_chord, away), square = angle * angle;
    const float series = angle * square * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))) / 6.0;
    return 0.5 * radius * radius * (angle < 0.5 ? series : angle - sin(angle));
}

// The area that a disc of radius 1 and one of radius `opening` have in common, t from each other.
float common_area(float t, float opening)
{
    const float larger = max(opening, 1.0), smaller = min(opening, 1.0);
    if (t >= larger + smaller)
        return 0.0;
    if (t <= larger - smaller)
        return 3.14159265 * smaller * smaller;
    const float from_smaller = ((t - larger) * (t + larger) + smaller * smaller) / (2.0 * t);
    const float half_chord = sqrt(max((smaller - from_smaller) * (smaller + from_smaller), 0.0));
    return segment_area(smaller, half_chord, from_smaller) + segment_area(larger, half_chord, t - from_smaller);
}

// An opening with blades is no disc. Its shape is A, with corners 1 from its middle, where the row of pixels runs down:
// as in shaders/lens/aperture.glsl, so a drop's disc looks as any disc in front of the focus. Rays through it cross the
// pane in `local` + opening A.

// How far A reaches at an angle.
float blade_reach(float angle)
{
    const float blade = 6.2831853 / float(look.opening_blades), from_first = angle - look.opening_turn;
    const float beside = from_first - blade * floor(from_first / blade + 0.5);
    return mix(cos(0.5 * blade) / cos(beside), 1.0, look.opening_round);
}

// The radius of the opening whose edge goes through a point, in radii of the opening.
float opening_reach(vec2 at)
{
    const float away = length(at);
    return look.opening_blades == 0u || away < 1e-6 ? away : away / blade_reach(atan(at.y, at.x));
}

float sector(vec2 a, vec2 b) { return 0.5 * atan(a.x * b.y - a.y * b.x, dot(a, b)); }

// The area that a disc of radius 1 around the origin and the triangle of the origin, a and b have in common; less than
// 0 if b is to the right of a.
float common_triangle(vec2 a, vec2 b)
{
    const vec2 along = b - a;
    const float square = max(dot(along, along), 1e-20), middle = -dot(a, along) / square;
    const float apart = a.x * along.y - a.y * along.x, reach2 = square - apart * apart;
    if (reach2 <= 0.0)
        return sector(a, b);
    const float reach = sqrt(reach2) / square;
    const float enters = clamp(middle - reach, 0.0, 1.0), leaves = clamp(middle + reach, 0.0, 1.0);
    const vec2 from = a + enters * along, to = a + leaves * along;
    return (enters > 0.0 ? sector(a, from) : 0.0) + 0.5 * (from.x * to.y - from.y * to.x) +
           (leaves < 1.0 ? sector(to, b) : 0.0);
}

// The same as common_area for an opening with blades whose middle is at `from`.
float common_with_blades(vec2 from, float opening)
{
    if (length(from) >= 1.0 + opening)
        return 0.0;
    const uint corners = look.opening_blades * (look.opening_round > 0.0 ? VIRGA_GLASS_BLADE_PARTS : 1u);
    const float part = 6.2831853 / float(corners), first = look.opening_turn - 3.14159265 / float(look.opening_blades);
    vec2 corner = from + opening * vec2(cos(first), sin(first)); // between two blades, 1 from the middle
    float sum = 0.0;
    for (uint i = 1u; i <= corners; i++) {
        const float angle = first + part * float(i);
        const vec2 next = from + opening * blade_reach(angle) * vec2(cos(angle), sin(angle));
        sum += common_triangle(corner, next);
        corner = next;
    }
    return max(sum, 0.0);
}

// The share of the opening that a drop covers, for a pixel whose ray passes the drop's middle at `local`.
float opening_share(vec2 local, float opening)
{
    const float covered =
        look.opening_blades == 0u ? common_area(length(local), opening) : common_with_blades(local, opening);
    return min(covered / (look.opening_area * opening * opening), 1.0);
}
