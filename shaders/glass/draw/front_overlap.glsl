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

float opening_share(float t, float opening)
{
    return min(common_area(t, opening) / (3.14159265 * opening * opening), 1.0);
}
