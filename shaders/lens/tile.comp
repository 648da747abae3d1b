// tile.comp - the largest circles of confusion in each tile: of the scene in front of the focus, of the scene behind
// it, and of the layers that have depths. And which levels of blocks have light of it, see levels.glsl.
//
// A tile tells them to all tiles that such a disc can reach into, or (at half resolution, where fields are read between
// texels) into a texel beside them. So the cost follows what is out of focus, and no tile has to look around. At half
// resolution it also tells those whose samples are read for such a tile: they lie beside it, or as far from it as what
// a wide near blur uncovers is filled in from.
//
// It looks at depths only. So colors are read only where something is out of focus, see sample.comp.
// One workgroup per tile. Reads: depth, layers. Writes: tiles, fields. The first one empties the lists.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"
#include "levels.glsl"
#include "texels.glsl"
#define LISTS_ACCESS
#include "lists.glsl"

const uint LAYERS = OWN_FORM; // the first that have a depth image are among these

layout(local_size_x = 64) in;
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;
layout(scalar, set = 0, binding = 9) buffer Tiles { virga_lens_tile_gpu tiles[]; };

// Words of floats that are not negative are in the same order as the floats.
shared uint found[4]; // the three radii, and the levels
shared int box[4];    // the first column and row that are out of focus, and the last ones

// The circle of confusion of a layer that has a depth image; 0 where there is none of it.
float layer_largest(uint layer, ivec2 texel)
{
    const bool own_depths = layer + 1u != view.on_scene && view.layer_inv_m[layer] == 0.0;
    return own_depths && layer_mean(layer, texel) != vec4(0.0) ? max(abs(layer_circle(layer, texel)), POINT) : 0.0;
}

void look_at_layer(uint layer, ivec2 texel, inout float largest_of_layers, inout uint levels)
{
    const float radius = layer_largest(layer, texel);
    largest_of_layers = max(largest_of_layers, radius);
    levels |= radius > 0.0 ? level_bit(2u, level_of(radius)) : 0u;
}

vec3 largest_at(ivec2 texel, inout uint levels)
{
    const vec4 of_pixels = circles_at(texel);
    float layers = 0.0;
    vec2 scene = vec2(0.0);
    if (any(greaterThan(abs(of_pixels), vec4(SHARP_REACH)))) { // else its mean is not more either
        const texel_circles circles = circles_of(of_pixels);
        const float radius = circles.radius;
        if (abs(radius) > POINT)
            levels |= level_bit(radius < 0.0 ? 1u : 0u, level_of(radius));
        scene = max(vec2(-radius, circles.farthest), vec2(0.0)); // of a single pixel, too
    }
#define LOOK(layer) look_at_layer(layer, texel, layers, levels)
    FOR_LAYERS(LOOK)
    return vec3(scene, layers);
}

// ---- what it tells the tiles around it

const float MARGIN = HALVED ? 2.5 : 1.0; // texels: half of one is the soft edge of a disc

// The distance (texels) along an axis from what is out of focus in this tile to another tile.
float gap(int tiles_apart, int first, int last)
{
    if (tiles_apart == 0)
        return 0.0;
    return float(abs(tiles_apart) * VIRGA_LENS_TILE - (tiles_apart > 0 ? last : VIRGA_LENS_TILE - 1 - first));
}

// (half resolution) How far samples are read for what these circles reach: the diagonal of a tile beyond that for discs
// from single texels, and for blocks (up to 8 texels wide, and 0.84 of that beyond them) the largest disc as well.
float samples_reach(vec2 scene)
{
    const float radius = max(scene.x, scene.y);
    if (!HALVED || radius == 0.0)
        return 0.0;
    return radius + MARGIN + 23.0 + (radius > float(VIRGA_LENS_FINE) ? radius + 15.0 : 0.0);
}

// Those of the levels of blocks whose discs reach so far.
uint levels_that_reach(vec3 radii, uint levels, float apart)
{
    uint near_enough = 0u;
    for (uint group = 0u; group < 3u; group++)
        for (uint level = 0u; level <= view.levels; level++) {
            const float radius = min(group == 0u ? radii.y : group == 1u ? radii.x : radii.z, level_radius(level));
            near_enough |= radius + MARGIN >= apart ? level_bit(group, level) : 0u;
        }
    return levels & near_enough;
}

void touch(ivec2 tile, vec3 radii, uint levels, float apart, bool sampled)
{
    const uint at = uint(tile.y) * view.tile_columns + uint(tile.x);
    const bvec3 reached = bvec3(vec3(greaterThan(radii, vec3(0.0))) *
                                vec3(greaterThanEqual(radii + MARGIN, vec3(apart))));
    const uint told = levels_that_reach(radii, levels, apart) | (sampled ? VIRGA_LENS_SAMPLED : 0u);
    if (reached.x)
        atomicMax(tiles[at].near, floatBitsToUint(radii.x));
    if (reached.y)
        atomicMax(tiles[at].far, floatBitsToUint(radii.y));
    if (reached.z)
        atomicMax(tiles[at].layers, floatBitsToUint(radii.z));
    if (told != 0u)
        atomicOr(tiles[at].told, told);
}

void touch_around(ivec2 own, vec3 radii, uint levels, uint lane)
{
    const float sampled = samples_reach(radii.xy);
    const float far = max(max(max(radii.x, radii.y), radii.z) + MARGIN, sampled);
    const int most = int(far - 1.0) / VIRGA_LENS_TILE + 1, side = 2 * most + 1;
    const ivec2 last = ivec2(view.tile_columns, view.tile_rows) - 1;
    const int count = radii == vec3(0.0) ? 0 : side * side;
    for (int i = int(lane); i < count; i += 64) {
        const ivec2 offset = ivec2(i % side, i / side) - most, tile = own + offset;
        const float apart = length(vec2(gap(offset.x, box[0], box[2]), gap(offset.y, box[1], box[3])));
        if (tile == clamp(tile, ivec2(0), last))
            touch(tile, radii, levels, apart, apart <= sampled);
    }
}

// (half resolution) Tiles that nothing reaches get no fields, but each part of the picture is drawn everywhere.
void empty_near_field(ivec2 texel)
{
    if (HALVED && !IN_PLACE && all(lessThan(texel, ivec2(view.columns, view.rows))))
        imageStore(fields, ivec3(texel, VIRGA_LENS_NEAR), vec4(0.0));
}

void empty_lists()
{
    for (uint i = 0u; i < VIRGA_LENS_LISTS; i++) {
        const bool has_tiles = HALVED && i != VIRGA_LENS_LIST_OF_BLOCKS;
        lists[i] = virga_lens_list_gpu(has_tiles ? TILE_GROUPS * TILE_GROUPS : 0u, 0u, 0u, 0u, 0u, 0u, 1u, 0u, 0u);
    }
}

void main()
{
    const ivec2 tile = ivec2(gl_WorkGroupID.xy), first = tile * VIRGA_LENS_TILE;
    const uint lane = gl_LocalInvocationIndex;
    if (lane < 4u) {
        found[lane] = 0u;
        box[lane] = lane < 2u ? VIRGA_LENS_TILE : -1;
    }
    barrier();
    vec3 largest = vec3(0.0);
    ivec2 low = ivec2(VIRGA_LENS_TILE), high = ivec2(-1);
    uint levels = 0u;
    for (uint i = lane; i < VIRGA_LENS_TILE * VIRGA_LENS_TILE; i += 64u) {
        const ivec2 texel = first + ivec2(i % VIRGA_LENS_TILE, i / VIRGA_LENS_TILE);
        empty_near_field(texel);
        const ivec2 seen = min(texel, ivec2(view.columns, view.rows) - 1);
        const vec3 radii = largest_at(seen, levels);
        largest = max(largest, radii);
        if (max(radii.x, radii.y) > SHARP_REACH || radii.z > 0.0) {
            low = min(low, seen - first);
            high = max(high, seen - first);
        }
    }
    largest.xy *= vec2(greaterThan(largest.xy, vec2(SHARP_REACH)));
    if (largest != vec3(0.0)) {
        atomicMax(found[0], floatBitsToUint(largest.x));
        atomicMax(found[1], floatBitsToUint(largest.y));
        atomicMax(found[2], floatBitsToUint(largest.z));
        atomicOr(found[3], levels);
        for (int axis = 0; axis < 2; axis++) {
            atomicMin(box[axis], low[axis]);
            atomicMax(box[2 + axis], high[axis]);
        }
    }
    barrier();
    touch_around(tile, uintBitsToFloat(uvec3(found[0], found[1], found[2])), found[3], lane);
    if (lane == 0u) {
        tiles[gl_WorkGroupID.y * view.tile_columns + gl_WorkGroupID.x].levels = found[3];
        if (gl_WorkGroupID.xy == uvec2(0u))
            empty_lists();
    }
}
