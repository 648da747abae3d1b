// sample.glsl - a texel of the work image as a sample. At half resolution it is the mean of those of its pixels that
// are about as near as the nearest one: a mean over an edge would be a color that is nowhere, at a depth that is
// nowhere. In front of the focus it spreads as much light as it has such pixels.
// The includer has lens.glsl, pixels.glsl, scene_color.glsl, spread.glsl and texels.glsl.
struct texel_sample {
    vec3 color;
    float radius;
    float share; // of its light that is spread in front of the focus
};

texel_sample sample_of(ivec2 texel)
{
    const texel_circles of = circles_of(circles_at(texel));
    const ivec2 low = pixel_of(texel, 0u), high = pixel_of(texel, 3u);
    if (!HALVED)
        return texel_sample(scene_color(low), of.radius, 1.0);
    const vec3 sum = of.weights.x * scene_color(low) + of.weights.y * scene_color(ivec2(high.x, low.y)) +
                     of.weights.z * scene_color(ivec2(low.x, high.y)) + of.weights.w * scene_color(high);
    const float before_focus = dot(vec4(lessThan(of.of_pixels, vec4(-POINT))), vec4(0.25));
    return texel_sample(sum / of.weight, of.radius, of.radius < -POINT ? before_focus : 1.0);
}
