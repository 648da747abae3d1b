// lists.glsl - tiles of the work image, and (half resolution) lists of them by what reaches them, so that passes do for
// each tile only what it needs. The order in a list depends on the device, but each tile writes texels of its own, so
// no result does.
#ifndef LISTS_ACCESS
#define LISTS_ACCESS readonly
#endif
layout(std430, set = 0, binding = 28) LISTS_ACCESS buffer Lists
{
    virga_lens_list_gpu lists[VIRGA_LENS_LISTS];
    uint listed[];
};

const uint TILE_GROUPS = VIRGA_LENS_TILE / 8u; // workgroups of 8 x 8 texels along a tile's side

// The index of the tile that a texel is in.
uint tile_of(ivec2 texel)
{
    const uvec2 tile = uvec2(texel) / VIRGA_LENS_TILE;
    return tile.y * view.tile_columns + tile.x;
}

// (half resolution) Whether nothing of the fields is seen in a tile, by the largest circles of confusion in front of
// the focus and behind it that reach it: they are below half a pixel, see compose.glsl.
#define SHARP_REACH 0.25 // texels
bool is_sharp(vec2 reach) { return max(reach.x, reach.y) <= SHARP_REACH; }

// An entry of a list: column and row of the tile. Each lane would divide an index.
uint entry_of(uvec2 tile) { return tile.x | tile.y << 16; }

#ifdef LISTS_DRAWN
// The tile of an entry.
uvec2 listed_tile(uint kind, uint entry)
{
    const uint tile = listed[kind * view.tile_columns * view.tile_rows + entry];
    return uvec2(tile & 0xFFFFu, tile >> 16);
}
#else
// The first texel of a workgroup of 8 x 8, in a pass over one list. Negative where the last row of workgroups is longer
// than the list.
ivec2 listed_first(uint kind)
{
    const uint entry = gl_WorkGroupID.z * VIRGA_LENS_LIST_ROW + gl_WorkGroupID.y;
    if (entry >= lists[kind].count)
        return ivec2(-1);
    const uint tile = listed[kind * view.tile_columns * view.tile_rows + entry];
    const uvec2 at = uvec2(tile & 0xFFFFu, tile >> 16) * TILE_GROUPS;
    return ivec2(at + uvec2(gl_WorkGroupID.x & (TILE_GROUPS - 1u), gl_WorkGroupID.x / TILE_GROUPS)) * 8;
}
#endif
