// puff_spot.glsl - a splash that is too small for its parts to be seen: a soft spot.

// A distant crown, with a total coverage of 1. Its wall flares from a circle to a wider rim, both ellipses on the
// picture, so there are a near and a far wall; seen from the side they are one. At the sides the view is along the
// wall, which makes it thicker there. Number and spacing of the fingers differ between crowns. Small ones are soft
// spots.
float one_crown_cover(vec2 at, float half_wide, float high, float sine, vec4 chance)
{
    const float hollow = clamp(0.3 * half_wide - 0.75, 0.0, 1.0), rim = sine * half_wide;
    const float up = clamp((at.y + rim) / (high + 2.0 * rim + 1e-3), 0.0, 1.0);
    const float thin = 1.0 / (half_wide * (1.0 - 0.35 * hollow * (1.0 - up)));
    const float x = clamp(at.x * thin, -1.0, 1.0), xx = x * x;
    const float depth = rim * sqrt(1.0 - xx);
    // Parabolas approximate a sine. Fingers lean.
    const float lean = chance.w - 0.5;
    const float wave = fract((0.5 + 0.8 * chance.y) * (x + 0.6 * lean * up) + 7.0 * chance.x) - 0.5;
    const float fingers = 8.0 * wave * (1.0 - 2.0 * abs(wave)), lower = hollow * (0.25 + 0.2 * xx);
    const float half_near = 0.5 * high * (1.0 - lower * (1.0 - fingers)),
                half_far = 0.5 * high * (1.0 - lower * (1.0 + fingers));
    const float near_by = 1.0 / (abs(half_near - 0.15 * depth) + 0.5), far_by = 1.0 / (half_far + 0.15 * depth + 0.5);
    const float to_near = (at.y - half_near + 0.85 * depth) * near_by,
                to_far = (at.y - half_far - 0.85 * depth) * far_by;
    const float walls = max(1.0 - to_near * to_near, 0.0) * near_by + max(1.0 - to_far * to_far, 0.0) * far_by;
    const float across = (1.0 - xx) * mix(1.875 * (1.0 - xx), (1.2 + 1.5 * xx) * (1.0 + 0.8 * lean * x), hollow);
    return 0.1875 * walls * across * thin;
}
