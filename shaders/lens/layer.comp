// layer.comp - a layer over the scene, out of focus: each pixel of it spreads its color and its coverage over its
// circle of confusion, so both stay premultiplied, and nothing is mixed with the black of pixels without water.
// One invocation per texel. Reads: samples, spreads, blocks, aperture, reaches. Writes: fields.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "blocks.glsl"
#include "spread.glsl"

const bool DEPTHS = (OWN_FORM & VIRGA_LENS_DEPTHS) != 0u; // each pixel of the layer has a depth of its own

layout(push_constant) uniform Which { uint layer; };
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 8) uniform sampler2D samples;
layout(set = 0, binding = 25) uniform sampler2D spreads;
layout(std430, set = 0, binding = 10) readonly buffer Reaches { vec4 reaches[]; };
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;

// All of the layer at one depth.
vec4 gather_plane(ivec2 texel, float radius, barrel cut)
{
    vec4 sum = vec4(0.0);
    const int rows = disc_rows(abs(radius));
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

// Each of its texels at its own depth. `reach` below 0: not at all, see gather.comp. Wide discs come from blocks.
vec4 gather_depths(ivec2 texel, float reach, barrel cut)
{
    vec4 sum = vec4(0.0);
    const float most = level_radius(0u);
    const int rows = reach < 0.0 ? -1 : disc_rows(reach);
    for (int y = -rows; y <= rows; y++) {
        const int columns = row_reach(reach, y);
        for (int x = -columns; x <= columns; x++) {
            const ivec2 apart = ivec2(x, y), from = inside(texel + apart);
            const vec2 spread_radius = texelFetch(spreads, from, 0).rg;
            const float radius = spread_radius.y;
            const float weight = abs(radius) <= most
                                     ? covers(radius < 0.0 ? apart : -apart, abs(radius), cut) * spread_radius.x : 0.0;
            sum += weight * texelFetch(samples, from, 0);
        }
    }
    return sum;
}

// How far it looks for those: not at all where all discs are wide.
float fine_reach(vec4 reach)
{
    return (uint(reach.w) & level_bit(2u, 0u)) != 0u ? min(reach.z, level_radius(0u)) : -1.0;
}

// The same of wide discs, from blocks of light in front of the focus or behind it.
vec4 gather_blocks(ivec2 texel, uint kind, uint level, float reach, barrel cut)
{
    vec4 sum = vec4(0.0);
    const seen_level at = see_level(level, texel, reach);
    const ivec2 rows = rows_of(at);
    for (int y = rows.x; y <= rows.y; y++) {
        const ivec2 columns = columns_of(at, y);
        for (int x = columns.x; x <= columns.y; x++) {
            const block source = block_at(at, ivec2(x, y), kind);
            sum += block_covers(source, source.radius, cut).xxxy * source.light;
        }
    }
    return sum / BLOCKS_PER_DISC;
}

vec4 gather_plane_blocks(ivec2 texel, float radius, barrel cut)
{
    const uint kind = radius < 0.0 ? VIRGA_LENS_BLOCKS_NEAR : VIRGA_LENS_BLOCKS_FAR;
    return gather_blocks(texel, kind, level_of(radius), abs(radius), cut);
}

vec4 gather_depth_blocks(ivec2 texel, vec4 reach, barrel cut)
{
    vec4 sum = vec4(0.0);
    for (int level = 1; level <= top_level(uint(reach.w) >> 8); level++) {
        const bool there = (uint(reach.w) & level_bit(2u, uint(level))) != 0u;
        const float most = there ? min(reach.z, level_radius(uint(level))) : -1.0;
        sum += gather_blocks(texel, VIRGA_LENS_BLOCKS_FAR, uint(level), most, cut) +
               gather_blocks(texel, VIRGA_LENS_BLOCKS_NEAR, uint(level), most, cut);
    }
    return sum;
}

void main()
{
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(view.columns) || texel.y >= int(view.rows))
        return;
    const ivec2 tile = texel / VIRGA_LENS_TILE;
    const vec4 reach = reaches[tile.y * int(view.tile_columns) + tile.x];
    const barrel cut = barrel_at(texel);
    const float radius = circle(view.layer_inv_m[layer]); // of a plane
    vec4 sum;
    if (DEPTHS)
        sum = gather_depths(texel, fine_reach(reach), cut) + gather_depth_blocks(texel, reach, cut);
    else if (level_of(radius) == 0u)
        sum = gather_plane(texel, radius, cut);
    else
        sum = gather_plane_blocks(texel, radius, cut);
    imageStore(fields, ivec3(texel, VIRGA_LENS_FIRST_LAYER + layer), vec4(sum.rgb, min(sum.a, 1.0)));
}
