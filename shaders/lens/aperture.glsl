// aperture.glsl - how much of a pixel the image of a point covers.
//
// Seen from a point of the aperture that is to the right, what is behind the focus moves to the right against it, and
// what is in front of it to the left. So the image of a point behind the focus is an upright image of the aperture, and
// that of a point in front of it is upside down. Both functions take the position in the aperture, in pixels.
//
// The image of a point is an image of the aperture, scaled to the radius of the circle of confusion. `reach` is the
// radius of the aperture's image whose edge goes through the centre of a pixel, so coverage falls from 1 to 0 as reach
// goes from half a pixel inside to half a pixel outside. A radius below half a pixel is a point: the pixel itself.
#include "aperture_image.glsl"

const bool SHAPED = (OWN_FORM & VIRGA_LENS_SHAPED) != 0u;

float coverage(ivec2 apart, float radius)
{
    const float reach =
        SHAPED ? texelFetch(aperture_image, apart + VIRGA_LENS_MAX_RADIUS, 0).r : length(vec2(apart));
    return clamp(max(radius, 0.5) - reach + 0.5, 0.0, 1.0);
}

// Cat's eye: away from the picture's centre the rim of the lens's barrel cuts the bundle of light. Light from above
// comes down through the rim: where it passes the aperture at height a, it passed the rim, which is L before it, at
// a + L tan(angle). So it also has to pass a second aperture of the same size that is shifted towards the centre.
float second_coverage(vec2 apart, float radius, vec2 shift)
{
    return clamp(max(radius, 0.5) - length(apart - shift * radius) + 0.5, 0.0, 1.0);
}

// The area of the intersection of two discs of radius 1 that are `apart` of each other, over pi.
float lens_area(float apart)
{
    const float half_apart = 0.5 * min(apart, 2.0);
    return 2.0 / 3.14159265 * (acos(half_apart) - half_apart * sqrt(1.0 - half_apart * half_apart));
}

// The shift of the second aperture, in radii, for the light that comes to a texel of the work image.
vec2 cats_eye_shift(vec2 texel)
{
    const vec2 half_size = 0.5 * vec2(WORK_SIZE);
    return view.cats_eye * (half_size - texel - 0.5) / length(half_size);
}

// What the cat's eye does to the light that comes to a texel. Which points of the aperture a ray to a texel may pass
// depends on the texel alone, whatever distance the ray comes from. Light is divided by the share of the aperture that
// is left there, as a camera corrects its vignetting, so an even picture stays even. The light of a lamp's disc is then
// that which passes the barrel: not the same in front of the focus and behind it.
struct barrel {
    vec2 shift;       // of the second aperture, in radii
    float per_share;  // 1 / share of the aperture that is left
};

barrel barrel_at(ivec2 texel)
{
    if (!SHAPED)
        return barrel(vec2(0.0), 1.0);
    const vec2 shift = cats_eye_shift(vec2(texel));
    return barrel(shift, 1.0 / max(lens_area(length(shift)), 0.05));
}

// The coverage of a texel by the image of a point, at a position in the aperture (px).
float covers(ivec2 apart, float radius, barrel cut)
{
    if (!SHAPED)
        return coverage(apart, radius);
    return min(coverage(apart, radius), second_coverage(vec2(apart), radius, cut.shift)) * cut.per_share;
}

// How far a disc of some radius covers anything: half of a pixel is its soft edge. Rows above and below its middle, and
// pixels to both sides in one of these rows.
int disc_rows(float radius) { return int(max(radius, 0.5) + 0.5); }

int row_reach(float radius, int y)
{
    const float reach = max(radius, 0.5) + 0.5;
    return int(sqrt(max(reach * reach - float(y * y), 0.0)));
}
