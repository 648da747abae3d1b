// bloom.glsl - light that wet air diffracts on its way to the camera, and levels of it, each half as fine.
//
// out(x) = (1 - (1 - w_0) S(x)) L(x) + sum over levels k of G_k * (w_k S L)
//
// L is the light of the picture, S the share of it that is diffracted, by the depth of the pixel where it comes from,
// G_k the filter of level k, close to a Gaussian of sqrt(4^k / 2 - 1) pixels, and w_k its weights, see aureole.c; w_0
// is of light that is spread by less than a pixel. Their sum is 1, so no light is lost. They depend on depth as well:
// w_k = single_k + h more_k, so two pictures, S L and h S L, have all that the levels need.
#include "frame_gpu.h"

layout(push_constant) uniform Bloom { host_bloom_gpu bloom; };

// Metres of air before a pixel.
float air_before(float stored, ivec2 pixel, ivec2 size)
{
    const vec2 clip = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    const vec2 aside = (clip + bloom.ray.zw) * bloom.ray.xy;
    return stored >= 1.0 ? bloom.depth.z : bloom.depth.y / (stored + bloom.depth.x) * sqrt(1.0 + dot(aside, aside));
}

// x: the share of light that is diffracted at least once; y: how much of `more` it has.
vec2 diffracted(float stored, ivec2 pixel, ivec2 size)
{
    const float t = bloom.depth.w * max(air_before(stored, pixel, size), 0.0);
    const float share = t < 0.02 ? t * (1.0 - t * (0.5 - t / 6.0)) : 1.0 - exp(-t);
    const float once = share > 0.0 ? t * exp(-t) / share : 1.0; // of that share, by Poisson
    return vec2(share, clamp((1.0 - once) * bloom.single.w, 0.0, 1.0));
}

// Bilinear between texels of the level above, whose sides are twice as long; beyond its edge it is as there.
vec4 from_coarse(sampler2D coarse, ivec2 texel)
{
    const ivec2 low = (texel - 1) >> 1, last = ivec2(bloom.columns, bloom.rows) - 1;
    const vec2 at = vec2(0.25) + 0.5 * vec2((texel + 1) & 1);
    const ivec2 a = clamp(low, ivec2(0), last), b = clamp(low + 1, ivec2(0), last);
    return mix(mix(texelFetch(coarse, a, 0), texelFetch(coarse, ivec2(b.x, a.y), 0), at.x),
               mix(texelFetch(coarse, ivec2(a.x, b.y), 0), texelFetch(coarse, b, 0), at.x), at.y);
}
