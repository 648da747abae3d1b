// meniscus.glsl - where standing water climbs what stands in it: a strip of 3 mm that mirrors by all slopes from level
// to nearly upright. It is only drawn: water that is level on the maps has the same volume with it as without.
//
// A surface of water before an upright wall has, at a height z above the level, the slope phi with
//     1 - cos phi = z^2 / (2 a^2), so z = 2 a sin(phi / 2), where a = sqrt(gamma / (rho g))
// (Landau and Lifshitz, Fluid Mechanics, section 61: the first integral of Young and Laplace's equation). By tan phi =
// -dz/dx, so far from the wall
//     x = a (ln cot(phi / 4) - 2 cos(phi / 2)) - the same of the slope at the wall.

const float MENISCUS_M = 0.00273;   // a of water: gamma 0.073 N/m
const float MENISCUS_ANGLE = 0.349; // contact angle: 20 degrees, on what was wet before (an estimate)
const float MENISCUS_STEEPEST = 1.75;

// Distance from a wall, in a, but for a constant.
float meniscus_way(float slope) { return -log(tan(0.25 * slope)) - 2.0 * cos(0.5 * slope); }

// The slope of the surface where it meets a wall with this normal.
float meniscus_top(vec3 n) { return clamp(acos(n.y) - MENISCUS_ANGLE, 0.1, MENISCUS_STEEPEST); }

// How the surface is seen: where a ray that meets it at some slope would meet the wall.
struct MeniscusView {
    float top;  // slope at the wall
    float rise; // of the ray to the eye, per metre away from the wall
    float lean; // of the wall: how far it recedes, per metre up
};

// That height above the level (m). It grows with the slope.
float meniscus_height(MeniscusView view, float slope)
{
    const float z = 2.0 * sin(0.5 * slope), x = meniscus_way(slope) - meniscus_way(view.top);
    const float held = view.rise * view.lean, top = 2.0 * sin(0.5 * view.top);
    return MENISCUS_M * (z - view.rise * x + held * top) / (1.0 + held);
}

// Height on the wall that is seen per radian of slope (m).
float meniscus_width(MeniscusView view, float slope)
{
    return MENISCUS_M * cos(0.5 * slope) * (1.0 + view.rise / tan(slope)) / (1.0 + view.rise * view.lean);
}

// The slope that is seen before a height on the wall (m).
float meniscus_slope(MeniscusView view, float height_m)
{
    float low = 1e-3, high = view.top;
    for (int i = 0; i < 12; i++) {
        const float middle = 0.5 * (low + high);
        const bool is_under = meniscus_height(view, middle) < height_m;
        low = is_under ? middle : low;
        high = is_under ? high : middle;
    }
    return 0.5 * (low + high);
}

// What a pixel of `pixel_m` along the wall, so far above the level, has of it: the slopes it shows, from x to y, and
// the share of the pixel that they cover (z). The lowest pixel that shows the wall has all from the level on, also what
// is in the pixel below: ground is seen there, which does not know of the strip. So all pixels of a column together
// have the strip's height, wherever its foot is between them.
vec3 meniscus_seen(MeniscusView view, float height_m, float pixel_m)
{
    const float top_m = 2.0 * MENISCUS_M * sin(0.5 * view.top);
    const float low_m = height_m < pixel_m ? 0.0 : height_m - 0.5 * pixel_m;
    const float high_m = min(height_m + 0.5 * pixel_m, top_m), share = (high_m - low_m) / max(pixel_m, 1e-6);
    if (share <= 0.0)
        return vec3(0.0);
    return vec3(meniscus_slope(view, low_m), meniscus_slope(view, high_m), min(share, 1.0));
}
