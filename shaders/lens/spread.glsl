// spread.glsl - 1 / area of the aperture's image on the grid of texels: the sum of its coverage. The table has the
// areas of radii (i / last)^2 x largest radius: they are close together where a texel more or less matters. It is in
// the image of the aperture, see aperture.comp.
// With AREAS_OF_VIEW it reads the words of the block itself, for a pass that has no use for that image.
#ifdef AREAS_OF_VIEW
float area_at(int entry) { return view.areas[entry]; }
#else
#include "aperture_image.glsl"

float area_at(int entry)
{
    const ivec2 texel = ivec2(entry % VIRGA_LENS_APERTURE, VIRGA_LENS_APERTURE + entry / VIRGA_LENS_APERTURE);
    return texelFetch(aperture_image, texel, 0).r;
}
#endif

float spread(float radius)
{
    const float last = VIRGA_LENS_SPREADS - 1.0;
    const float size = min(abs(radius), VIRGA_LENS_MAX_RADIUS);
    const float entry = min(floor(last * sqrt(size / VIRGA_LENS_MAX_RADIUS)), last - 1.0);
    const vec2 ends = pow(vec2(entry, entry + 1.0) / last, vec2(2.0)) * VIRGA_LENS_MAX_RADIUS;
    const float part = (size - ends.x) / (ends.y - ends.x);
    return 1.0 / mix(area_at(int(entry)), area_at(int(entry) + 1), part);
}
