// blocks.comp - sums light that spreads over wide discs in blocks of texels, see levels.glsl.
//
// The kinds of blocks: light behind the focus of the level's radii; all that is not in front of the focus, or is behind
// light of the smallest wide discs, for what a near blur uncovers; light in front of the focus of the level's radii.
// Each kind is left out where nothing in the picture needs it.
// One invocation per block and kind. Reads: samples, spreads, tiles, lists, the layer on the scene. Writes: blocks.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "lists.glsl"
#include "levels.glsl"
#include "on_scene.glsl"

const bool LAYER = OWN_FORM == VIRGA_LENS_BLOCKS_LAYER;       // the samples are those of a layer
const bool ON_SCENE = OWN_FORM == VIRGA_LENS_BLOCKS_ON_SCENE; // a layer lies on the scene

layout(push_constant) uniform Which { uint layer; };
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 8) uniform sampler2D samples;
layout(set = 0, binding = 25) uniform sampler2D spreads;
layout(scalar, set = 0, binding = 9) readonly buffer Tiles { virga_lens_tile_gpu tiles[]; };
layout(set = 0, binding = 31, rgba32ui) uniform writeonly uimage2DArray blocks;

uint bits_of(uint kind, uint level)
{
    if (LAYER)
        return level_bit(2u, level);
    if (kind == VIRGA_LENS_BLOCKS_ALL) // there is near light, and discs that are wide
        return level_bit(1u, 0u) | level_bit(1u, 1u) | level_bit(1u, 2u) | level_bit(1u, 3u);
    return level_bit(kind == VIRGA_LENS_BLOCKS_NEAR ? 1u : 0u, level);
}

// Whether any texel needs this kind of blocks at this level.
bool needed(uint kind, uint level)
{
    if (LAYER && view.layer_inv_m[layer] > 0.0) {
        const float radius = circle(view.layer_inv_m[layer]);
        return level_of(radius) == level && (radius < 0.0) == (kind == VIRGA_LENS_BLOCKS_NEAR);
    }
    return (lists[0].levels & bits_of(kind, level)) != 0u;
}

// How much light of a sample goes into the block.
float share_of(uint kind, uint level, float radius, float spread)
{
    if (kind == VIRGA_LENS_BLOCKS_ALL)
        return behind_share(radius, -float(VIRGA_LENS_FINE));
    if (level_of(radius) != level || (radius < 0.0) != (kind == VIRGA_LENS_BLOCKS_NEAR))
        return 0.0;
    return LAYER || kind == VIRGA_LENS_BLOCKS_NEAR ? spread : 1.0;
}

// Where something is: its amount, and moments of it.
struct moments {
    float amount;
    vec2 at;
    float squares;
};

struct block_sum {
    vec4 light, on;
    float radius;
    moments bright, weight;
};

void add_to(inout moments sum, float amount, vec2 offset)
{
    sum.amount += amount;
    sum.at += amount * offset;
    sum.squares += amount * dot(offset, offset);
}

void add(uint kind, uint level, ivec2 texel, vec2 offset, inout block_sum sum)
{
    const vec4 source = texelFetch(samples, texel, 0);
    const vec2 spread_radius = texelFetch(spreads, texel, 0).rg;
    const float radius = LAYER ? spread_radius.y : source.a;
    const float share = share_of(kind, level, radius, spread_radius.x);
    const vec4 light = LAYER ? source : vec4(source.rgb, 1.0);
    sum.light += share * light;
    if (ON_SCENE && share > 0.0)
        sum.on += share * on_scene_mean(texel);
    sum.radius += share * (light.a + 1e-6) * radius;
    add_to(sum.bright, share * (dot(max(source.rgb, vec3(0.0)), vec3(1.0)) + 1e-6), offset);
    add_to(sum.weight, share * (light.a + 1e-6), offset);
}

// The centroid from the block's centre, for offsets from the middle of its first texel.
vec2 middle_of(moments sum, float side) { return sum.at / max(sum.amount, 1e-30) + 0.5 - 0.5 * side; }

// The width of a disc's edge: that of an even light of the same variance. An even texel has a variance of 1/12, and so
// does each axis of it here.
float softness(moments sum)
{
    const vec2 mean = sum.at / max(sum.amount, 1e-30);
    return sqrt(1.0 + 6.0 * max(sum.squares / max(sum.amount, 1e-30) - dot(mean, mean), 0.0));
}

uvec2 light_words(vec4 light) { return uvec2(packHalf2x16(light.xy), packHalf2x16(light.zw)); }

void store(ivec2 at, uint kind, uint part, uvec4 words)
{
    imageStore(blocks, ivec3(at, kind * PARTS + part), words);
}

void write(ivec2 at, uint kind, uint level, block_sum sum)
{
    const float side = float(1 << level), radius = sum.radius / max(sum.weight.amount, 1e-30);
    const uint sizes = size_word(radius, vec2(softness(sum.bright), softness(sum.weight)), level);
    const float read_radius = radius_of(sizes);
    const vec2 softs = softs_of(sizes, side);
    vec2 scales = vec2(1.0 / (side * side));
    // The area of the disc of a texel's light, which was divided out, over that of the disc that will be drawn.
    if (LAYER || kind == VIRGA_LENS_BLOCKS_NEAR)
        scales = BLOCKS_PER_DISC * (radius * radius + 1.0 / 12.0) /
                 max(vec2(soft_area(read_radius, softs.x), soft_area(read_radius, softs.y)), 1.0);
    const vec4 places = vec4(middle_of(sum.bright, side), middle_of(sum.weight, side)) / (0.5 * side);
    store(at, kind, VIRGA_LENS_BLOCK_LIGHT,
          uvec4(light_words(scales.xxxy * sum.light), sizes, packSnorm4x8(places)));
    if (ON_SCENE)
        store(at, kind, VIRGA_LENS_BLOCK_ON_SCENE, uvec4(light_words(scales.y * sum.on), 0u, 0u));
}

void main()
{
    // Workgroups of the kinds are below each other, and a workgroup is in one level.
    const int rows = blocks_rows();
    const uint kind = gl_GlobalInvocationID.y / uint(rows);
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy) - ivec2(0, int(kind) * rows);
    const uint level = at.y < level_size(1u).y ? 1u : at.x < level_size(2u).x ? 2u : 3u;
    if (level > view.levels || !needed(kind, level))
        return;
    const ivec2 index = at - level_origin(level) - 1;
    if (any(greaterThan(index, level_blocks(level))))
        return;
    const int side = 1 << level;
    const ivec2 first = index * side;
    const uint tile_levels = tiles[tile_of(inside(first))].levels;
    const bool here = kind == VIRGA_LENS_BLOCKS_ALL || (tile_levels & bits_of(kind, level)) != 0u ||
                      (LAYER && view.layer_inv_m[layer] > 0.0);
    const moments nothing = moments(0.0, vec2(0.0), 0.0);
    block_sum sum = block_sum(vec4(0.0), vec4(0.0), 0.0, nothing, nothing);
    for (int i = 0; i < (here ? side * side : 0); i++) {
        const ivec2 offset = ivec2(i & (side - 1), i >> int(level));
        add(kind, level, inside(first + offset), vec2(offset), sum);
    }
    write(at, kind, level, sum);
}
