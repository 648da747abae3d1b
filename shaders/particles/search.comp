// search.comp - a round of the search for the median: counts the particles in each bin of cells, for each axis.
// Each invocation takes VIRGA_GRID_BOUNDS_EACH particles. Reads: particles, the grid's state. Writes: histogram.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"
#include "particles/histogram.glsl"

layout(local_size_x = VIRGA_GRID_LANES) in;

void main()
{
    for (uint i = 0u; i < VIRGA_GRID_BOUNDS_EACH; i++) {
        const uint group = gl_WorkGroupID.x * VIRGA_GRID_BOUNDS_EACH + i;
        const uint particle = group * VIRGA_GRID_LANES + gl_LocalInvocationIndex;
        if (particle >= frame.particles)
            break;
        const vec3 p = to_vec(particles[particle].position);
        if (!is_valid(p))
            continue;
        const ivec3 cell = cell_of(p);
        for (uint axis = 0u; axis < 3u; axis++) {
            const int bin = (cell[axis] - grid.from[axis]) / int(grid.width[axis]);
            if (cell[axis] >= grid.from[axis] && bin < VIRGA_GRID_BINS)
                atomicAdd(histogram[axis * VIRGA_GRID_BINS + bin], 1u);
        }
    }
}
