// ground_window.glsl - where the cells of the ground's window are in its buffers.
//
// The world is a grid of cells in x and z, counted from its origin. 64 x 64 cells are a tile. A tile's slot is its
// coordinates modulo the window's width in tiles, a power of two.
#define NO_CELL 0xffffffffu
#define NO_GROUND 0xffu
#define TILE_SHIFT 6

// The index of a cell in the buffers; NO_CELL outside of the window, whose low corner is the tile `low`.
uint window_cell_index(ivec2 cell, ivec2 low, uint tiles)
{
    const ivec2 tile = cell >> TILE_SHIFT;
    const uvec2 inside = uvec2(tile - low);
    const uvec2 slot = uvec2(tile) & (tiles - 1u), local = uvec2(cell) & uint((1 << TILE_SHIFT) - 1);
    const uint cell_index = ((slot.y * tiles + slot.x) << (2 * TILE_SHIFT)) | (local.y << TILE_SHIFT) | local.x;
    return max(inside.x, inside.y) < tiles ? cell_index : NO_CELL;
}
