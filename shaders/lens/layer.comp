// layer.comp - a layer over the scene, out of focus: each pixel of it spreads its color and its coverage over its
// circle of confusion, so both stay premultiplied, and nothing is mixed with the black of pixels without water.
// One invocation per texel. Reads: samples, spreads, aperture, reaches. Writes: fields.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "aperture.glsl"
#include "spread.glsl"

const bool DEPTHS = (OWN_FORM & VIRGA_LENS_DEPTHS) != 0u; // each pixel of the layer has a depth of its own

layout(push_constant) uniform Which { uint layer; };
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 8) uniform sampler2D samples;
layout(set = 0, binding = 25) uniform sampler2D spreads;
layout(std430, set = 0, binding = 10) readonly buffer Reaches { vec4 reaches[]; };
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;

// The nearest texel of the work image.
ivec2 inside(ivec2 texel) { return clamp(texel, ivec2(0), ivec2(view.columns, view.rows) - 1); }

// All of the layer at one depth.
vec4 gather_plane(ivec2 texel, float radius, barrel cut)
{
    vec4 sum = vec4(0.0);
    const int rows = int(ceil(abs(radius)));
    for (int y = -rows; y <= rows; y++) {
        const int columns = row_reach(abs(radius), y);
        for (int x = -columns; x <= columns; x++) {
            const ivec2 apart = ivec2(x, y);
            sum += covers(radius < 0.0 ? apart : -apart, abs(radius), cut) *
                   texelFetch(samples, inside(texel + apart), 0);
        }
    }
    return spread(radius) * sum;
}

// Each of its texels at its own depth. `reach` below 0: not at all, see gather.comp.
vec4 gather_depths(ivec2 texel, float reach, barrel cut)
{
    vec4 sum = vec4(0.0);
    const int rows = int(ceil(reach));
    for (int y = -rows; y <= rows; y++) {
        const int columns = row_reach(reach, y);
        for (int x = -columns; x <= columns; x++) {
            const ivec2 apart = ivec2(x, y), from = inside(texel + apart);
            const vec2 spread_radius = texelFetch(spreads, from, 0).rg;
            const float radius = spread_radius.y;
            sum += covers(radius < 0.0 ? apart : -apart, abs(radius), cut) * spread_radius.x *
                   texelFetch(samples, from, 0);
        }
    }
    return sum;
}

void main()
{
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(view.columns) || texel.y >= int(view.rows))
        return;
    const ivec2 tile = texel / VIRGA_LENS_TILE;
    const float reach = reaches[tile.y * int(view.tile_columns) + tile.x].z;
    const barrel cut = barrel_at(texel);
    const vec4 sum =
        DEPTHS ? gather_depths(texel, reach, cut) : gather_plane(texel, circle(view.layer_inv_m[layer]), cut);
    imageStore(fields, ivec3(texel, VIRGA_LENS_FIRST_LAYER + layer), vec4(sum.rgb, min(sum.a, 1.0)));
}
