// streak_profile.glsl - coverage of a small round body that moves while the shutter is open: across its path, and along
// it.

// Across: a box filter of one pixel at the edge, and the chord lengths of a disc where the streak is wide enough to
// show them. Narrow streaks get the mean of the chords, pi / 4, so that coverage does not depend on the resolution.
float streak_profile(float from_middle, float half_width)
{
    const float u = min(from_middle / half_width, 1.0);
    const float edge = clamp(half_width + 0.5 - from_middle, 0.0, 1.0);
    return edge * mix(0.785398, sqrt(1.0 - u * u), clamp(half_width - 0.75, 0.0, 1.0));
}

// Along: the part of the full coverage between both ends.
float streak_length(float begun, float ends) { return clamp(begun, 0.0, 1.0) * clamp(ends - begun, 0.0, 1.0); }

// Length of the ramp at each end: coverage rises over the shorter of body and path (at least a pixel). The ramp is
// centred where the box of the longer one begins.
float streak_ramp_px(float way, float body) { return max(min(way, body), 1.0); }

// Position along the path, in ramps from the begin; the distance from the other end is streak_ends() minus this.
float streak_begun(float along, float way, float body)
{
    const float ramp = streak_ramp_px(way, body);
    return (along - 0.5 * way + 0.5 * (max(way, body) + ramp)) / ramp;
}

float streak_ends(float way, float body)
{
    const float ramp = streak_ramp_px(way, body);
    return (max(way, body) + ramp) / ramp;
}

// All of a wide streak. At `u` from its middle the body is a chord, shorter by sqrt(1 - u^2), so both ends are round: a
// body that hardly moves, or is out of focus, is a disc. Where the chord is shorter than the path, it covers a pixel
// for a shorter part of the time. `full` is that part in the middle, which the streak's coverage already has.
//
// Narrow streaks are too thin to show it and get the mean over all chords, as in streak_profile. In between, chords are
// mixed, and `mean` keeps the integral over the streak: pi / 4 of body and width.
float streak_capsule(float from_middle, float half_width, float along, float way, float body)
{
    const float u = min(from_middle / half_width, 1.0);
    const float edge = clamp(half_width + 0.5 - from_middle, 0.0, 1.0);
    const float wide = clamp(half_width - 0.75, 0.0, 1.0);
    const float chord = body * mix(1.0, sqrt(1.0 - u * u), wide), mean = 0.785398 / (1.0 - 0.214602 * wide);
    const float time = min(chord / max(way, 1.0), 1.0), full = clamp(body / max(way, 1.0), 1e-6, 1.0);
    return edge * mean * time / full * streak_length(streak_begun(along, way, chord), streak_ends(way, chord));
}
