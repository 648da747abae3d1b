// spray_part.glsl - the part of a particle that leaves the surface as spray: 1 below frame.spray_low, 0 above
// frame.spray_high.
float spray_part(float density)
{
    const float range = max(frame.spray_high - frame.spray_low, 1e-6);
    const float t = clamp((frame.spray_high - density) / range, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}
