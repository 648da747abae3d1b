// tile.comp - the largest circles of confusion in each tile: of the scene in front of the focus, of the scene behind
// it, and of the layers that have depths. And which levels of blocks have light of it, see levels.glsl.
// One workgroup per tile. Reads: samples, depths of layers. Writes: tiles, lists.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"
#include "levels.glsl"
#define LISTS_ACCESS
#include "lists.glsl"

const uint LAYERS = OWN_FORM; // the first that have a depth image are among these

layout(local_size_x = 64) in;
layout(set = 0, binding = 8) uniform sampler2D samples;
layout(std430, set = 0, binding = 9) writeonly buffer Tiles { vec4 tiles[]; };

shared vec4 largest[64];
shared uint found_levels;

// The circle of confusion of a layer that has a depth image; 0 where there is none of it.
float layer_largest(uint layer, ivec2 texel)
{
    const bool own_depths = layer + 1u != view.on_scene && view.layer_inv_m[layer] == 0.0;
    return own_depths && layer_mean(layer, texel) != vec4(0.0) ? abs(layer_circle(layer, texel)) : 0.0;
}

void look_at_layer(uint layer, ivec2 texel, inout float largest_of_layers, inout uint levels)
{
    const float radius = layer_largest(layer, texel);
    largest_of_layers = max(largest_of_layers, radius);
    levels |= radius > 0.0 ? level_bit(2u, level_of(radius)) : 0u;
}

vec4 largest_at(ivec2 texel, inout uint levels)
{
    const float radius = texelFetch(samples, texel, 0).a;
    float layers = 0.0;
    if (abs(radius) > POINT)
        levels |= level_bit(radius < 0.0 ? 1u : 0u, level_of(radius));
    if (LAYERS > 0u)
        look_at_layer(0u, texel, layers, levels);
    if (LAYERS > 1u)
        look_at_layer(1u, texel, layers, levels);
    if (LAYERS > 2u)
        look_at_layer(2u, texel, layers, levels);
    if (LAYERS > 3u)
        look_at_layer(3u, texel, layers, levels);
    if (LAYERS > 4u)
        look_at_layer(4u, texel, layers, levels);
    return vec4(max(-radius, 0.0), max(radius, 0.0), layers, 0.0);
}

void main()
{
    const ivec2 first = ivec2(gl_WorkGroupID.xy) * VIRGA_LENS_TILE;
    const uint lane = gl_LocalInvocationIndex;
    vec4 radius = vec4(0.0);
    uint levels = 0u;
    if (lane == 0u)
        found_levels = 0u;
    barrier();
    for (uint i = lane; i < VIRGA_LENS_TILE * VIRGA_LENS_TILE; i += 64u) {
        const ivec2 texel = first + ivec2(i % VIRGA_LENS_TILE, i / VIRGA_LENS_TILE);
        radius = max(radius, largest_at(min(texel, ivec2(view.columns, view.rows) - 1), levels));
    }
    largest[lane] = radius;
    if (levels != 0u)
        atomicOr(found_levels, levels);
    barrier();
    for (uint half_count = 32u; half_count > 0u; half_count /= 2u) {
        if (lane < half_count)
            largest[lane] = max(largest[lane], largest[lane + half_count]);
        barrier();
    }
    if (lane == 0u) {
        tiles[gl_WorkGroupID.y * view.tile_columns + gl_WorkGroupID.x] = vec4(largest[0].xyz, float(found_levels));
        atomicOr(lists[0].levels, found_levels);
    }
}
