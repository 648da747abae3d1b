// streak_profile.glsl - coverage of a small round thing that moves while the shutter is open, across its way and along
// it.

// A box filter of a pixel on the edge; the profile of a disc's chords where it is wide enough to show. Narrow streaks
// get its mean, pi / 4, so coverage does not depend on the resolution.
float streak_profile(float from_middle, float half_width)
{
    const float u = min(from_middle / half_width, 1.0);
    const float edge = clamp(half_width + 0.5 - from_middle, 0.0, 1.0);
    return edge * mix(0.785398, sqrt(1.0 - u * u), clamp(half_width - 0.75, 0.0, 1.0));
}

// Share of the full coverage at a place between the ends.
float streak_length(float begun, float ends) { return clamp(begun, 0.0, 1.0) * clamp(ends - begun, 0.0, 1.0); }

// How it begins and ends along its way: coverage rises over the shorter of the thing and its way (at least a pixel),
// centred where the box of the longer one begins.
float streak_ramp_px(float way, float body) { return max(min(way, body), 1.0); }

// How far it has begun at a place along it, in ramps; the other end is streak_ends() less this.
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
