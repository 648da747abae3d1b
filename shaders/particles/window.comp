// window.comp - places the grid: the box of all particles with a margin, or, if that box has too many cells, a smaller
// box around the median of the particles. The median stays where most particles are; a mean would not, with one of them
// a kilometre away.
// One invocation. Reads and writes: the grid's state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"
#include "particles/box.glsl"

layout(local_size_x = 1) in;

uint[3] groups(uint items, uint each) { return uint[3]((items + each - 1u) / each, 1u, 1u); }

void main()
{
    const Box box = particle_box();
    uvec3 dims = box.dims;
    while (is_too_large(dims)) {
        const uint axis = dims.x >= dims.y && dims.x >= dims.z ? 0u : dims.y >= dims.z ? 1u : 2u;
        dims[axis] -= (dims[axis] + 7u) / 8u;
    }
    const ivec3 median = ivec3(grid.from[0], grid.from[1], grid.from[2]);
    const ivec3 first = clamp(median - ivec3(dims / 2u), box.low, box.low + ivec3(box.dims - dims));
    grid.first = int[3](first.x, first.y, first.z);
    grid.dims = uint[3](dims.x, dims.y, dims.z);
    grid.cells = dims.x * dims.y * dims.z;
    grid.scan_groups = groups(grid.cells, VIRGA_GRID_SCAN_CELLS);
    grid.cell_groups = groups(grid.cells, VIRGA_GRID_LANES);
    grid.word_groups = groups(grid.cells, 32u * VIRGA_GRID_LANES);
}
