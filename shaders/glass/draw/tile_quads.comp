// tile_quads.comp - the quads to draw: for each tile that shows something, a quad around the texels with water, with
// its six indices. A pixel interpolates four texels, so texels of the neighbouring tiles count too.
//
// Quads are in the order of their tiles. They overlap a little at their borders, and there the last one wins: in
// another order a pixel would differ in its last bits. Each workgroup counts the quads of all tiles before its own,
// which is a few thousand bits to read. A pass of its own costs more.
// One invocation per tile. Reads: the tiles' bits. Writes: index buffer, quads, draw arguments.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "tiles.glsl"
#define SCAN_LANES uint(VIRGA_GLASS_GROUP)
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
// writing two words at a time is faster
layout(scalar, set = 0, binding = 19) writeonly buffer Corners { uvec2 corners[]; };

// The bits of a tile; 0 beyond the map's border. Without a branch: inside one, software Vulkan reads lane by lane.
uint tile_bits(ivec2 tile)
{
    const ivec2 clamped = clamp(tile, ivec2(0), ivec2(look.tile_columns, look.tile_rows) - 1);
    const uint bits = tiles[tile_number(uvec2(clamped))].film;
    return clamped == tile ? bits : 0u;
}

// Moves a tile's bits of columns (or rows) into those of the tile beside it: bit 0 is the one before its own first, bit
// 9 the one behind its last.
uint shift_spans(uint spans, int side) { return side < 0 ? spans >> 7 : side > 0 ? (spans & 1u) << 9 : spans << 1; }

bool is_shown(uint tile) { return (tiles[tile].film & VIRGA_GLASS_SHOWN) != 0u; }

// The tiles of earlier workgroups that show something, as far as this invocation counts them.
uint shown_before()
{
    uint count = 0u;
    for (uint tile = gl_LocalInvocationIndex; tile < gl_WorkGroupID.x * VIRGA_GLASS_GROUP; tile += VIRGA_GLASS_GROUP)
        count += is_shown(tile) ? 1u : 0u;
    return count;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    const ivec2 tile = ivec2(i % look.tile_columns, i / look.tile_columns);
    const bool shown = i < look.tile_columns * look.tile_rows && is_shown(i);
    uvec2 all;
    const uint before = scan_group(uvec2(shown ? 1u : 0u, shown_before()), all).x;
    if (i == (gl_NumWorkGroups.x - 1u) * VIRGA_GLASS_GROUP)
        atomicAdd(work.drops.index_count, 6u * (all.y + all.x)); // it was 0; passes beside this one read other words
    uint columns = 0u, rows = 0u;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            const uint bits = tile_bits(tile + ivec2(x, y)), spans = bits >> VIRGA_GLASS_SPANS_BIT;
            const uint columns_here = shift_spans(spans & 0xffu, x), rows_here = shift_spans(spans >> 8, y);
            columns |= rows_here != 0u ? columns_here : 0u;
            rows |= columns_here != 0u ? rows_here : 0u;
        }
    if (!shown)
        return;
    const uint index = all.y + before, first = 4u * index;
    corners[3u * index] = uvec2(first, first + 1u);
    corners[3u * index + 1u] = uvec2(first + 2u);
    corners[3u * index + 2u] = uvec2(first + 1u, first + 3u);
    corners[look.bounds_offset / 2u + index] =
        uvec2(packed_tile(uvec2(tile)), uint(findLSB(columns)) | uint(findLSB(rows)) << 4 |
                                            uint(findMSB(columns)) << 8 | uint(findMSB(rows)) << 12);
}
