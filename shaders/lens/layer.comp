// layer.comp - a layer over the scene, out of focus: each pixel of it spreads its color and its coverage over its
// circle of confusion, so both stay premultiplied, and nothing is mixed with the black of pixels without water.
// One invocation per texel. Reads: a layer, aperture, reaches. Writes: fields.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "aperture.glsl"
#include "pixels.glsl"
#include "layers.glsl"
#include "spread.glsl"

layout(constant_id = 0) const uint LAYER = 0u;

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, set = 0, binding = 10) readonly buffer Reaches { float reaches[]; };
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;

void main()
{
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy), last = ivec2(view.columns, view.rows) - 1;
    if (texel.x > last.x || texel.y > last.y)
        return;
    const ivec2 tile = texel / VIRGA_LENS_TILE;
    const int reach = int(ceil(reaches[tile.y * int(view.tile_columns) + tile.x]));
    const bool one_depth = view.layer_inv_m[LAYER] > 0.0;
    const float plane = one_depth ? circle(view.layer_inv_m[LAYER]) : 0.0;
    const int around = one_depth ? int(ceil(abs(plane))) : reach;
    const float plane_spread = spread(plane);
    vec4 sum = vec4(0.0);
    for (int y = -around; y <= around; y++)
        for (int x = -around; x <= around; x++) {
            const ivec2 apart = ivec2(x, y), from = clamp(texel + apart, ivec2(0), last);
            const vec4 source = layer_mean(LAYER, from);
            if (source == vec4(0.0))
                continue;
            const float radius = one_depth ? plane : layer_circle(LAYER, from);
            const ivec2 position = radius < 0.0 ? apart : -apart;
            sum += covers(position, abs(radius), texel) * (one_depth ? plane_spread : spread(radius)) * source;
        }
    imageStore(fields, ivec3(texel, VIRGA_LENS_FIRST_LAYER + LAYER), vec4(sum.rgb, min(sum.a, 1.0)));
}
