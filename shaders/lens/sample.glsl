// sample.glsl - a texel of the work image as a sample. At half resolution it is the mean of those of its pixels that
// are about as near as the nearest one: a mean over an edge would be a color that is nowhere, at a depth that is
// nowhere. In front of the focus it spreads as much light as it has such pixels.
// The includer has lens.glsl, pixels.glsl, scene_color.glsl, spread.glsl and texels.glsl.
struct texel_sample {
    vec3 color;
    float radius;
    float share; // of its light that is spread in front of the focus
};

// From the colors of its pixels, in rows.
texel_sample mean_sample(vec3 a, vec3 b, vec3 c, vec3 d, texel_circles of)
{
    const vec3 sum = of.weights.x * a + of.weights.y * b + of.weights.z * c + of.weights.w * d;
    float share = 1.0;
    if (of.radius < -POINT)
        share = dot(vec4(lessThan(of.of_pixels, vec4(-POINT))), vec4(0.25));
    return texel_sample(sum * (1.0 / of.weight), of.radius, share);
}

texel_sample sample_with(ivec2 texel, texel_circles of)
{
    const ivec2 low = pixel_of(texel, 0u), high = pixel_of(texel, 3u);
    if (!HALVED)
        return texel_sample(scene_color(low), of.radius, 1.0);
    return mean_sample(scene_color(low), scene_color(ivec2(high.x, low.y)), scene_color(ivec2(low.x, high.y)),
                       scene_color(high), of);
}

texel_sample sample_of(ivec2 texel) { return sample_with(texel, circles_of(circles_at(texel))); }
