// tile_quads.comp - the list of tiles to be drawn, of each the box around all that it has to show, with four corners
// and two triangles between them. A lane for each tile. What a pixel shows is between four texels, so those beside the
// tile count too.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "tiles.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 19) writeonly buffer Corners { uvec2 corners[]; }; // two words at a time are quicker

// Without a branch: in one, software Vulkan reads lane by lane. None beyond the map's border.
uint found_in(ivec2 tile)
{
    const ivec2 near = clamp(tile, ivec2(0), ivec2(look.tile_columns, look.tile_rows) - 1);
    const uint found = tiles[tile_number(uvec2(near))].film;
    return near == tile ? found : 0u;
}

// Of a tile's columns or rows those that its neighbour counts: bit 0 is that before its own, bit 9 that behind them.
uint seen_from(uint spans, int side) { return side < 0 ? spans >> 7 : side > 0 ? (spans & 1u) << 9 : spans << 1; }

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    const ivec2 tile = ivec2(i % look.tile_columns, i / look.tile_columns);
    uint columns = 0u, rows = 0u, own = 0u;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            const uint found = found_in(tile + ivec2(x, y)), spans = found >> VIRGA_GLASS_SPANS_BIT;
            const uint wide = seen_from(spans & 0xffu, x), high = seen_from(spans >> 8, y);
            columns |= high != 0u ? wide : 0u;
            rows |= wide != 0u ? high : 0u;
            own = x == 0 && y == 0 ? found : own;
        }
    if (i >= look.tile_columns * look.tile_rows || (own & VIRGA_GLASS_SHOWN) == 0u)
        return;
    const uint turn = atomicAdd(work.drops.index_count, 6u) / 6u, first = 4u * turn;
    corners[3u * turn] = uvec2(first, first + 1u);
    corners[3u * turn + 1u] = uvec2(first + 2u);
    corners[3u * turn + 2u] = uvec2(first + 1u, first + 3u);
    corners[look.box_word / 2u + turn] = uvec2(i, uint(findLSB(columns)) | uint(findLSB(rows)) << 4 |
                                                      uint(findMSB(columns)) << 8 | uint(findMSB(rows)) << 12);
}
