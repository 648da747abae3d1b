// fit.comp - if the box of all particles has too many cells, begins the search for the median of the particles.
// One invocation. Reads and writes: the grid's state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"
#include "particles/box.glsl"

layout(local_size_x = 1) in;

void main()
{
    const Box box = particle_box();
    const bool too_large = is_too_large(box.dims);
    const uint each = VIRGA_GRID_LANES * VIRGA_GRID_BOUNDS_EACH;
    for (uint axis = 0u; axis < 3u; axis++) {
        grid.from[axis] = box.low[axis];
        grid.width[axis] = (box.dims[axis] + VIRGA_GRID_BINS - 1u) / VIRGA_GRID_BINS;
        grid.below[axis] = 0u;
    }
    grid.search_groups = uint[3](too_large ? (frame.particles + each - 1u) / each : 0u, 1u, 1u);
}
