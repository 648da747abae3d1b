// layer_sample.comp - a layer over the scene as samples: color and coverage of each texel of the work image, and its
// circle of confusion. The samples of the scene were gathered before, so these take their place.
// One invocation per texel. Reads: a layer, state. Writes: samples, spreads.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"
#include "spread.glsl"

const uint LAYER = OWN_FORM;

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D samples;
layout(set = 0, binding = 7, rgba32f) uniform writeonly image2D spreads;

void main()
{
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(view.columns) || texel.y >= int(view.rows))
        return;
    const float radius = layer_circle(LAYER, texel);
    imageStore(samples, texel, layer_mean(LAYER, texel));
    imageStore(spreads, texel, vec4(spread(radius), radius, 0.0, 0.0));
}
