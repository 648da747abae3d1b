// haze.glsl - extinction along a way through the rain's haze. The includer has haze_extinction(box) per metre in each
// of the boxes around the camera, and with box VIRGA_RAIN_MAX_LEVELS beyond the last.
float haze_extinction(uint box);

// Optical thickness of a way (m) that begins at the camera, or anywhere where all boxes are alike; `inner` is half the
// side of the innermost box.
float haze_thickness(float way, float inner)
{
    float thick = 0.0, from = 0.0, to = inner;
    for (uint box = 0u; box < VIRGA_RAIN_MAX_LEVELS; box++, from = to, to *= 2.0)
        thick += haze_extinction(box) * clamp(way - from, 0.0, to - from);
    return thick + haze_extinction(VIRGA_RAIN_MAX_LEVELS) * max(way - from, 0.0);
}
