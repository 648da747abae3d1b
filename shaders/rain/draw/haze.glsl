// haze.glsl - optical thickness of haze. The includer defines haze_extinction(box): haze per metre in each of the
// boxes around the camera, and beyond the last one for box VIRGA_RAIN_MAX_LEVELS.
float haze_extinction(uint box);

// Optical thickness of a path (m) from the camera, or from anywhere where all boxes have the same extinction. `inner`
// is half the side of the innermost box.
float haze_thickness(float path_m, float inner)
{
    float thickness = 0.0, from = 0.0, to = inner;
    for (uint box = 0u; box < VIRGA_RAIN_MAX_LEVELS; box++, from = to, to *= 2.0)
        thickness += haze_extinction(box) * clamp(path_m - from, 0.0, to - from);
    return thickness + haze_extinction(VIRGA_RAIN_MAX_LEVELS) * max(path_m - from, 0.0);
}
