// texels.glsl - the circles of confusion of a texel's pixels. A texel has that of the pixels that are about as near as
// the nearest one. Two passes compute it and have to agree to the last bit, see tile.comp and sample.comp.
// The includer has lens.glsl and pixels.glsl.
layout(set = 0, binding = 4) uniform sampler2D scene_depth;

const uint PIXELS = STEP * STEP; // of a texel

struct texel_circles {
    float of_pixels[4];
    float weights[4]; // of the pixels in the texel
    float weight;     // their sum
    float radius;     // of the texel
    float farthest;   // of the pixels
};

float circle_at(ivec2 pixel)
{
    return view.depth_given != 0u ? circle(inverse_depth(texelFetch(scene_depth, pixel, 0).r)) : 0.0;
}

texel_circles circles_of(ivec2 texel)
{
    texel_circles of;
    float nearest = 1e9;
    of.farthest = -1e9;
    for (uint i = 0u; i < PIXELS; i++) {
        of.of_pixels[i] = circle_at(pixel_of(texel, i));
        nearest = min(nearest, of.of_pixels[i]);
        of.farthest = max(of.farthest, of.of_pixels[i]);
    }
    const float per_radius = 1.0 / max(abs(nearest), 1.0);
    precise float sum = 0.0, radius = 0.0;
    for (uint i = 0u; i < PIXELS; i++) {
        precise const float weight = max(1.0 - (of.of_pixels[i] - nearest) * per_radius, 0.0);
        of.weights[i] = weight;
        sum += weight;
        radius += weight * of.of_pixels[i];
    }
    of.weight = sum;
    of.radius = HALVED ? radius / sum : of.of_pixels[0];
    return of;
}
