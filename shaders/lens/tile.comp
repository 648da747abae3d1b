// tile.comp - the largest circles of confusion in each tile: of the scene in front of the focus, of the scene behind
// it, and of the layers that have depths.
// One workgroup per tile. Reads: samples, depths of layers. Writes: tiles.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"

const uint LAYERS = OWN_FORM; // the first that have a depth image are among these

layout(local_size_x = 64) in;
layout(set = 0, binding = 8) uniform sampler2D samples;
layout(std430, set = 0, binding = 9) writeonly buffer Tiles { vec4 tiles[]; };

shared vec4 largest[64];

// The circle of confusion of a layer that has a depth image; 0 where there is none of it.
float layer_largest(uint layer, ivec2 texel)
{
    const bool own_depths = layer + 1u != view.on_scene && view.layer_inv_m[layer] == 0.0;
    return own_depths && layer_mean(layer, texel) != vec4(0.0) ? abs(layer_circle(layer, texel)) : 0.0;
}

vec4 largest_at(ivec2 texel)
{
    const float radius = texelFetch(samples, texel, 0).a;
    float layers = 0.0;
    if (LAYERS > 0u)
        layers = layer_largest(0u, texel);
    if (LAYERS > 1u)
        layers = max(layers, layer_largest(1u, texel));
    if (LAYERS > 2u)
        layers = max(layers, layer_largest(2u, texel));
    if (LAYERS > 3u)
        layers = max(layers, layer_largest(3u, texel));
    if (LAYERS > 4u)
        layers = max(layers, layer_largest(4u, texel));
    return vec4(max(-radius, 0.0), max(radius, 0.0), layers, 0.0);
}

void main()
{
    const ivec2 first = ivec2(gl_WorkGroupID.xy) * VIRGA_LENS_TILE;
    const uint lane = gl_LocalInvocationIndex;
    vec4 radius = vec4(0.0);
    for (uint i = lane; i < VIRGA_LENS_TILE * VIRGA_LENS_TILE; i += 64u) {
        const ivec2 texel = first + ivec2(i % VIRGA_LENS_TILE, i / VIRGA_LENS_TILE);
        radius = max(radius, largest_at(min(texel, ivec2(view.columns, view.rows) - 1)));
    }
    largest[lane] = radius;
    barrier();
    for (uint half_count = 32u; half_count > 0u; half_count /= 2u) {
        if (lane < half_count)
            largest[lane] = max(largest[lane], largest[lane + half_count]);
        barrier();
    }
    if (lane == 0u)
        tiles[gl_WorkGroupID.y * view.tile_columns + gl_WorkGroupID.x] = largest[0];
}
