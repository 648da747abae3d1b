// reach.comp - how far each tile has to look for what reaches it: the largest circles of confusion, of each kind, of
// all tiles from which such a disc can reach into it, or (at half resolution, where fields are read between texels)
// into a texel beside it; and the levels of blocks that those discs are in. At half resolution it also puts the tile
// into a list by what reaches it. The first one says how many workgroups make blocks: none where no disc is wide.
// One invocation per tile. Reads: tiles. Writes: reaches, lists.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#define LISTS_ACCESS
#include "lists.glsl"
#include "levels.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 9) readonly buffer Tiles { vec4 tiles[]; };
layout(std430, set = 0, binding = 10) writeonly buffer Reaches { vec4 reaches[]; };

// The distance (texels) from a pixel of one tile to one of another along an axis.
float gap(int tiles_apart) { return float(max(abs(tiles_apart) - 1, 0) * VIRGA_LENS_TILE + min(abs(tiles_apart), 1)); }

const float MARGIN = HALVED ? 2.5 : 1.0; // texels: half of one is the soft edge of a disc

// Up to sharp_reach nothing of the fields is seen, see compose.glsl; up to POINT there is no near field.
uint kind_of(vec3 reach)
{
    const float sharp_reach = 0.25; // texels: half a pixel
    if (reach.x > POINT)
        return VIRGA_LENS_TILES_BLURRED;
    return max(reach.x, reach.y) > sharp_reach ? VIRGA_LENS_TILES_FAR : VIRGA_LENS_TILES_SHARP;
}

// Those of a tile's levels of blocks whose discs reach so far.
uint levels_that_reach(vec4 tile, float apart)
{
    uint near_enough = 0u;
    for (uint group = 0u; group < 3u; group++)
        for (uint level = 0u; level <= view.levels; level++) {
            const float radius = min(group == 0u ? tile.y : group == 1u ? tile.x : tile.z, level_radius(level));
            near_enough |= radius + MARGIN >= apart ? level_bit(group, level) : 0u;
        }
    return uint(tile.w) & near_enough;
}

void add_to_list(uint kind, uint tile)
{
    const uint entry = atomicAdd(lists[kind].count, 1u);
    const uint columns = min(entry + 1u, VIRGA_LENS_LIST_ROW), rows = entry / VIRGA_LENS_LIST_ROW + 1u;
    listed[kind * view.tile_columns * view.tile_rows + entry] = tile;
    atomicMax(lists[kind].gather_y, columns);
    atomicMax(lists[kind].gather_z, rows);
    atomicMax(lists[kind].combine_y, columns);
    atomicMax(lists[kind].combine_z, rows);
}

// Whether any disc needs blocks: of the scene, of a layer with depths, or of one that is all at one depth.
bool blocks_needed()
{
    bool plane = false;
    for (uint i = 0u; i < view.layers; i++)
        plane = plane || (view.layer_inv_m[i] > 0.0 && level_of(circle(view.layer_inv_m[i])) > 0u);
    return plane || (lists[0].levels & ~(level_bit(0u, 0u) | level_bit(1u, 0u) | level_bit(2u, 0u))) != 0u;
}

void main()
{
    if (gl_GlobalInvocationID.x >= view.tile_columns * view.tile_rows)
        return;
    if (gl_GlobalInvocationID.x == 0u && blocks_needed()) {
        const ivec2 groups = ivec2(max(level_size(1u).x, level_size(2u).x + level_size(3u).x), blocks_rows()) / 8;
        lists[VIRGA_LENS_TILE_KINDS].gather_x = uint(groups.x);
        lists[VIRGA_LENS_TILE_KINDS].gather_y = VIRGA_LENS_BLOCK_KINDS * uint(groups.y);
        lists[VIRGA_LENS_TILE_KINDS].gather_z = 1u;
    }
    const ivec2 size = ivec2(view.tile_columns, view.tile_rows);
    const ivec2 own = ivec2(gl_GlobalInvocationID.x % view.tile_columns, gl_GlobalInvocationID.x / view.tile_columns);
    const int most = int(view.max_radius) / VIRGA_LENS_TILE + 1;
    vec3 reach = vec3(0.0);
    uint levels = 0u;
    for (int y = max(own.y - most, 0); y <= min(own.y + most, size.y - 1); y++)
        for (int x = max(own.x - most, 0); x <= min(own.x + most, size.x - 1); x++) {
            const vec4 tile = tiles[y * size.x + x];
            const float apart = length(vec2(gap(x - own.x), gap(y - own.y)));
            reach = max(reach, tile.xyz * vec3(greaterThanEqual(tile.xyz + MARGIN, vec3(apart))));
            levels |= levels_that_reach(tile, apart);
        }
    reaches[gl_GlobalInvocationID.x] = vec4(reach, float(levels));
    if (HALVED)
        add_to_list(kind_of(reach), gl_GlobalInvocationID.x);
}
