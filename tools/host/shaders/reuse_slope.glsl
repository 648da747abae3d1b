// reuse_slope.glsl - what depth rises by from pixel to pixel on the surface that a pixel shows. Depth is affine on it,
// so two pixels to one side and the pixel itself lie on a line, to whichever side the surface goes on. Where it does to
// neither side, it is too narrow to tell.
#define REUSE_NARROW  2.0 // no depth rises by so much
#define REUSE_AS_NEAR 0.1

float reuse_rise(sampler2D picture, ivec2 pixel, float here, ivec2 next)
{
    const float before = texelFetch(picture, reuse_inside(pixel - next), 0).r;
    const float after = texelFetch(picture, reuse_inside(pixel + next), 0).r;
    const float bent_before = abs(here - 2.0 * before + texelFetch(picture, reuse_inside(pixel - 2 * next), 0).r);
    const float bent_after = abs(here - 2.0 * after + texelFetch(picture, reuse_inside(pixel + 2 * next), 0).r);
    const float rise = bent_before < bent_after ? here - before : after - here;
    return min(bent_before, bent_after) <= reuse_tolerance(here) ? rise : REUSE_NARROW;
}

vec2 reuse_slope(sampler2D picture, ivec2 pixel, float here)
{
    return vec2(reuse_rise(picture, pixel, here, ivec2(1, 0)), reuse_rise(picture, pixel, here, ivec2(0, 1)));
}

// How far a depth is from the plane through a pixel: `farther` by depth and `away` on the picture. Of a leaf or a twig
// no plane is known: what is about as near and of the same material counts as it.
float reuse_apart(vec2 slope, float farther, vec2 away)
{
    const bvec2 narrow = greaterThan(slope, vec2(1.0));
    const vec2 known = mix(slope, vec2(0.0), narrow);
    return abs(farther - dot(known, away)) * (any(narrow) ? REUSE_AS_NEAR : 1.0);
}
