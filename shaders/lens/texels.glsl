// texels.glsl - the circles of confusion of a texel's pixels. A texel has that of the pixels that are about as near as
// the nearest one. Two passes compute it and have to agree to the last bit, see tile.comp and sample.comp.
// The includer has lens.glsl and pixels.glsl.
#include "gpu/variants.glsl"

layout(set = 0, binding = 4) uniform sampler2D scene_depth;

struct texel_circles {
    vec4 of_pixels; // in rows; four times the same at full resolution
    vec4 weights;   // of the pixels in the texel
    float weight;   // their sum
    float radius;   // of the texel
    float nearest, farthest; // of the pixels
};

float stored_at(ivec2 pixel) { return texelFetch(scene_depth, pixel, 0).r; }

vec4 circles_at(ivec2 texel)
{
    if (view.depth_given == 0u)
        return vec4(0.0);
    const depth_line line = line_of_depths();
    const ivec2 low = pixel_of(texel, 0u), high = pixel_of(texel, 3u);
    if (!HALVED)
        return depth_circles(line, vec4(stored_at(low)));
    if (FOR_GPU && high == low + 1) // all in the picture: four depths at once
        return depth_circles(line, textureGather(scene_depth, vec2(high) / vec2(textureSize(scene_depth, 0))).wzxy);
    return depth_circles(line, vec4(stored_at(low), stored_at(ivec2(high.x, low.y)), stored_at(ivec2(low.x, high.y)),
                        stored_at(high)));
}

texel_circles circles_of(vec4 of_pixels)
{
    texel_circles of;
    const vec2 less = min(of_pixels.xy, of_pixels.zw), more = max(of_pixels.xy, of_pixels.zw);
    const float nearest = min(less.x, less.y), per_radius = 1.0 / max(abs(nearest), 1.0);
    of.of_pixels = of_pixels;
    of.nearest = nearest;
    of.farthest = max(more.x, more.y);
    // 1 - (r - nearest) / radius, by fused operations, which are the same in every pass.
    precise const vec4 weights = max(fma(of_pixels, vec4(-per_radius), vec4(fma(nearest, per_radius, 1.0))), 0.0);
    precise const float weight = weights.x + weights.y + weights.z + weights.w;
    precise const float first = weights.x * of_pixels.x;
    precise const float radius =
        fma(weights.w, of_pixels.w, fma(weights.z, of_pixels.z, fma(weights.y, of_pixels.y, first)));
    of.weights = weights;
    of.weight = weight;
    of.radius = HALVED ? radius / weight : of_pixels.x;
    return of;
}
