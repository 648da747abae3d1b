// spread.glsl - 1 / area of the aperture's image on the grid of texels: the sum of its coverage. The table has the
// areas of radii (i / last)^2 x largest radius: they are close together where a texel more or less matters.
float spread(float radius)
{
    const float last = VIRGA_LENS_SPREADS - 1.0;
    const float size = min(abs(radius), VIRGA_LENS_MAX_RADIUS);
    const float entry = min(floor(last * sqrt(size / VIRGA_LENS_MAX_RADIUS)), last - 1.0);
    const vec2 ends = pow(vec2(entry, entry + 1.0) / last, vec2(2.0)) * VIRGA_LENS_MAX_RADIUS;
    const float part = (size - ends.x) / (ends.y - ends.x);
    return 1.0 / mix(view.areas[uint(entry)], view.areas[uint(entry) + 1u], part);
}
