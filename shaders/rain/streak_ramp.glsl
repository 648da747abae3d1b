// streak_ramp.glsl - how a streak begins and ends: it rises over the shorter of the drop and its way (at least a pixel),
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
