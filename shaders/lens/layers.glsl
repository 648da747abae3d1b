// layers.glsl - the layers over the scene: premultiplied color and coverage, and the depth of each pixel or of the
// whole layer. The includer has pixels.glsl.
// Where `layer` is a constant, one image is read. Software Vulkan reads all five otherwise.
#include "gpu/variants.glsl"

layout(set = 0, binding = 15) uniform sampler2D layer_color_0;
layout(set = 0, binding = 16) uniform sampler2D layer_color_1;
layout(set = 0, binding = 17) uniform sampler2D layer_color_2;
layout(set = 0, binding = 18) uniform sampler2D layer_color_3;
layout(set = 0, binding = 19) uniform sampler2D layer_color_4;
layout(set = 0, binding = 20) uniform sampler2D layer_depth_0;
layout(set = 0, binding = 21) uniform sampler2D layer_depth_1;
layout(set = 0, binding = 22) uniform sampler2D layer_depth_2;
layout(set = 0, binding = 23) uniform sampler2D layer_depth_3;
layout(set = 0, binding = 24) uniform sampler2D layer_depth_4;

// Runs a statement for each layer. LAYERS, a constant of the includer, is their number; but on GPUs from the second on
// it is the largest number, and this is a loop. A driver for GPUs takes seconds for all numbers.
#define FOR_LAYERS(what)                                    \
    if (FOR_GPU && LAYERS > 1u) {                           \
        for (uint layer = 0u; layer < view.layers; layer++) \
            what(layer);                                    \
    } else {                                                \
        if (LAYERS > 0u)                                    \
            what(0u);                                       \
        if (LAYERS > 1u)                                    \
            what(1u);                                       \
        if (LAYERS > 2u)                                    \
            what(2u);                                       \
        if (LAYERS > 3u)                                    \
            what(3u);                                       \
        if (LAYERS > 4u)                                    \
            what(4u);                                       \
    }

vec4 layer_color(uint layer, ivec2 pixel)
{
    switch (layer) {
    case 0u: return finite(texelFetch(layer_color_0, pixel, 0));
    case 1u: return finite(texelFetch(layer_color_1, pixel, 0));
    case 2u: return finite(texelFetch(layer_color_2, pixel, 0));
    case 3u: return finite(texelFetch(layer_color_3, pixel, 0));
    default: return finite(texelFetch(layer_color_4, pixel, 0));
    }
}

float layer_depth(uint layer, ivec2 pixel)
{
    switch (layer) {
    case 0u: return texelFetch(layer_depth_0, pixel, 0).r;
    case 1u: return texelFetch(layer_depth_1, pixel, 0).r;
    case 2u: return texelFetch(layer_depth_2, pixel, 0).r;
    case 3u: return texelFetch(layer_depth_3, pixel, 0).r;
    default: return texelFetch(layer_depth_4, pixel, 0).r;
    }
}

// Four pixels beside each other, in rows: `low` is the first of them, and `high` the last one. Not finite yet.
struct layer_four {
    vec4 a, b, c, d;
};

layer_four four_of(sampler2D image, ivec2 low, ivec2 high)
{
    return layer_four(texelFetch(image, low, 0), texelFetch(image, ivec2(high.x, low.y), 0),
                      texelFetch(image, ivec2(low.x, high.y), 0), texelFetch(image, high, 0));
}

layer_four layer_colors(uint layer, ivec2 low, ivec2 high)
{
    switch (layer) {
    case 0u: return four_of(layer_color_0, low, high);
    case 1u: return four_of(layer_color_1, low, high);
    case 2u: return four_of(layer_color_2, low, high);
    case 3u: return four_of(layer_color_3, low, high);
    default: return four_of(layer_color_4, low, high);
    }
}

vec4 depths_of_four(layer_four four) { return vec4(four.a.r, four.b.r, four.c.r, four.d.r); }

// All at once, if the last pixel is beside the first one.
vec4 gathered(sampler2D image, ivec2 high)
{
    return textureGather(image, vec2(high) / vec2(textureSize(image, 0))).wzxy;
}

vec4 layer_depths(uint layer, ivec2 low, ivec2 high)
{
    if (high == low + 1) {
        switch (layer) {
        case 0u: return gathered(layer_depth_0, high);
        case 1u: return gathered(layer_depth_1, high);
        case 2u: return gathered(layer_depth_2, high);
        case 3u: return gathered(layer_depth_3, high);
        default: return gathered(layer_depth_4, high);
        }
    }
    switch (layer) {
    case 0u: return depths_of_four(four_of(layer_depth_0, low, high));
    case 1u: return depths_of_four(four_of(layer_depth_1, low, high));
    case 2u: return depths_of_four(four_of(layer_depth_2, low, high));
    case 3u: return depths_of_four(four_of(layer_depth_3, low, high));
    default: return depths_of_four(four_of(layer_depth_4, low, high));
    }
}

// The signed circle of confusion (texels) of a layer at a texel: of the nearest of its pixels, or of those that have a
// part in the blurred image.
float layer_circle(uint layer, ivec2 texel)
{
    if (view.layer_inv_m[layer] > 0.0)
        return circle(view.layer_inv_m[layer]);
    float nearest = 1e9, nearest_blurred = 1e9;
    for (uint i = 0u; i < STEP * STEP; i++) {
        const float radius = circle(inverse_depth(layer_depth(layer, pixel_of(texel, i))));
        nearest = min(nearest, radius);
        nearest_blurred = blurriness(radius * float(STEP)) > 0.0 ? min(nearest_blurred, radius) : nearest_blurred;
    }
    return nearest_blurred < 1e9 ? nearest_blurred : nearest;
}

// The mean of a layer's pixels in a texel. At half resolution, of a layer with a depth for each pixel, the part of each
// that comes from the blurred images: what is in focus comes from the pixels themselves, see layer_at.
vec4 layer_mean(uint layer, ivec2 texel)
{
    const bool in_parts = HALVED && view.layer_inv_m[layer] <= 0.0;
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < STEP * STEP; i++) {
        const ivec2 pixel = pixel_of(texel, i);
        const float radius = in_parts ? circle(inverse_depth(layer_depth(layer, pixel))) * float(STEP) : 0.0;
        sum += (in_parts ? blurriness(radius) : 1.0) * layer_color(layer, pixel);
    }
    return sum / float(STEP * STEP);
}
