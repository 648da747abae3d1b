// block_mark.comp - the list of blocks, first pass: selects the cells that the surface may run through, as particles of
// low density near them have marked them.
// One invocation per cell. Reads: cell_marks. Writes: selection, block_of (reset).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#include "water/marks.glsl"
#define BLOCKS_ACCESS
#include "water/blocks.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 8
#define COMPACT_LIST_BINDING 10
#include "gpu/compact_mark.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

bool is_block(uint cell)
{
    const uvec3 dims = grid_dims(), local = cell_local(cell, dims);
    if (any(lessThan(local, uvec3(1u))) || any(greaterThanEqual(local, dims - 1u)))
        return false;
    uint marked = 0u;
    for (uint i = 0u; i < 27u; i++) {
        // The neighbour at the offset (x, y, z) sees this cell at (-x, -y, -z).
        const uint neighbour = cell + i % 3u + (i / 3u % 3u) * dims.x + (i / 9u) * dims.x * dims.y - 1u - dims.x -
                               dims.x * dims.y;
        marked |= cell_marks[neighbour] >> 26u - i & 1u;
    }
    return marked != 0u;
}

void main()
{
    const uint cell = gl_GlobalInvocationID.x;
    bool selected = false;
    if (cell < grid.cells) {
        selected = is_block(cell);
        block_of[cell] = NO_BLOCK;
    }
    mark_selected(selected ? FIRST_KIND : NOT_SELECTED);
}
