// blocks.glsl - blocks: cells that the surface may run through, with the density at 4 x 4 x 4 grid points in each.
// Point (x, y, z) of a block is number 16 z + 4 y + x. Points lie on the low faces of their cell, not on the high ones,
// which are the low faces of the next cell.
#ifndef BLOCKS_ACCESS
#define BLOCKS_ACCESS readonly
#endif
layout(std430, set = 0, binding = 11) BLOCKS_ACCESS buffer BlockOf { uint block_of[]; }; // for each cell
layout(std430, set = 0, binding = 12) BLOCKS_ACCESS buffer Fields { float fields[]; };   // for each point
layout(std430, set = 0, binding = 13) BLOCKS_ACCESS buffer BlockStarts { uint block_starts[]; };
layout(std430, set = 0, binding = 9) BLOCKS_ACCESS buffer BlockInsides { uvec2 block_insides[]; }; // point bits

#define NO_BLOCK 0xffffffffu

// Position of a cell's first grid point.
vec3 cell_corner(uint cell)
{
    return vec3(ivec3(cell_local(cell, grid_dims())) + grid_first()) * frame.cell_m;
}
