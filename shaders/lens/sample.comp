// sample.comp - the scene as samples: color and circle of confusion of each texel of the work image. At half resolution
// a texel is the mean of those of its pixels that are about as near as the nearest one: a mean over an edge would be a
// color that is nowhere, at a depth that is nowhere. In front of the focus it spreads as much light as it has such
// pixels.
// One invocation per texel. Reads: color, depth, state. Writes: samples, spreads.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#define SCENE_LINEAR (OWN_FORM == 1u)
#include "scene_color.glsl"
#include "spread.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4) uniform sampler2D scene_depth;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D samples;
layout(set = 0, binding = 7, rgba32f) uniform writeonly image2D spreads;

float circle_at(ivec2 pixel)
{
    return view.depth_given != 0u ? circle(inverse_depth(texelFetch(scene_depth, pixel, 0).r)) : 0.0;
}

void main()
{
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(view.columns) || texel.y >= int(view.rows))
        return;
    const uint pixels = STEP * STEP;
    float radii[4], nearest = 1e9;
    for (uint i = 0u; i < pixels; i++) {
        radii[i] = circle_at(pixel_of(texel, i));
        nearest = min(nearest, radii[i]);
    }
    vec4 sum = vec4(0.0);
    float radius = 0.0, before_focus = 0.0;
    for (uint i = 0u; i < pixels; i++) {
        const float weight = max(1.0 - (radii[i] - nearest) / max(abs(nearest), 1.0), 0.0);
        sum += weight * vec4(scene_color(pixel_of(texel, i)), 1.0);
        radius += weight * radii[i];
        before_focus += radii[i] < -POINT ? 1.0 : 0.0;
    }
    radius /= sum.a;
    const float share = HALVED && radius < -POINT ? before_focus / float(pixels) : 1.0;
    imageStore(samples, texel, vec4(sum.rgb / sum.a, radius));
    imageStore(spreads, texel, vec4(share * spread(radius), radius, 0.0, 0.0));
}
