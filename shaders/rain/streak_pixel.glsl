// streak_pixel.glsl - what thin and wide streaks do alike at a pixel.
#include "gpu/scene_depth.glsl"

// A box filter of a pixel on the edge; the profile of a disc's chords where it is wide enough to show. Narrow streaks
// get its mean, pi / 4, so coverage does not depend on the resolution.
float streak_profile(float from_middle, float half_width)
{
    const float u = min(from_middle / half_width, 1.0);
    const float edge = clamp(half_width + 0.5 - from_middle, 0.0, 1.0);
    return edge * mix(0.785398, sqrt(1.0 - u * u), clamp(half_width - 0.75, 0.0, 1.0));
}

// Share of the full coverage at a place between the ends, see streak_ramp.glsl.
float streak_length(float begun, float ends) { return clamp(begun, 0.0, 1.0) * clamp(ends - begun, 0.0, 1.0); }

// Light varies as the drop oscillates: a cosine of turns, as near as a cubic comes (1.1 % of its height).
float streak_wave(float turns, float size)
{
    const float saw = 4.0 * abs(fract(turns) - 0.5) - 1.0;
    return 1.0 + size * saw * (1.5 - 0.5 * saw * saw);
}
