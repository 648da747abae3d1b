// grid.glsl - the neighbour grid: buffers, cells of positions, and the particles around a cell.
//
// Cells are cubes whose side is the kernel's radius h, so that all neighbours of a particle are in the 27 cells around
// it. The grid is a box of cells around all particles; if there is no memory for such a box, it is a smaller one around
// their median. Cells are numbered along x first: the three cells of a row lie side by side, and so do their particles.
//
// The particles of a cell are in the order of their ids. The result of a sum over them does not depend on the order
// in which atomics arrived.
#define VIRGA_GLSL
#include "shared/particle.h"
#include "shared/particle_grid.h"
#include "gpu/vectors.glsl"

#ifndef GRID_STEP // the uniform block of the effect; it begins with the members of this one
#define GRID_STEP virga_particle_step_gpu
#endif
#ifndef PARTICLES_ACCESS
#define PARTICLES_ACCESS readonly
#endif
#ifndef GRID_ACCESS
#define GRID_ACCESS readonly
#endif

layout(scalar, set = 0, binding = 0) uniform Step { GRID_STEP frame; };
layout(scalar, set = 0, binding = 2) PARTICLES_ACCESS buffer Particles { virga_particle_gpu particles[]; };
layout(scalar, set = 0, binding = 3) GRID_ACCESS buffer Grid { virga_particle_grid_gpu grid; };
// For each cell: the number of its particles. After the prefix sum: index of its first sorted particle.
layout(std430, set = 0, binding = 4) GRID_ACCESS buffer CellStarts { uint cell_starts[]; };
// For each sorted particle: its position and the part of its volume that counts.
layout(std430, set = 0, binding = 5) GRID_ACCESS buffer Sorted { vec4 sorted[]; };
// For each sorted particle: its index among the particles.
layout(std430, set = 0, binding = 6) GRID_ACCESS buffer SortedIndices { uint sorted_indices[]; };

bool is_valid(vec3 p)
{
    // Also false for NaN.
    return all(lessThan(abs(p), vec3(frame.cell_m * float(VIRGA_GRID_COORDINATE - 8))));
}

ivec3 cell_of(vec3 p) { return ivec3(floor(p * frame.inv_cell_m)); }

ivec3 grid_first() { return ivec3(grid.first[0], grid.first[1], grid.first[2]); }
uvec3 grid_dims() { return uvec3(grid.dims[0], grid.dims[1], grid.dims[2]); }

uint cell_index(uvec3 local, uvec3 dims) { return (local.z * dims.y + local.y) * dims.x + local.x; }

uvec3 cell_local(uint index, uvec3 dims)
{
    return uvec3(index % dims.x, index / dims.x % dims.y, index / (dims.x * dims.y));
}

// Index of the cell that a position is in; VIRGA_GRID_NO_CELL outside the grid or in its margin.
uint cell_at(vec3 p)
{
    const uvec3 dims = grid_dims();
    const ivec3 local = cell_of(p) - grid_first();
    if (!is_valid(p) || any(lessThan(local, ivec3(VIRGA_GRID_MARGIN))) ||
        any(greaterThanEqual(local, ivec3(dims) - VIRGA_GRID_MARGIN)))
        return VIRGA_GRID_NO_CELL;
    return cell_index(uvec3(local), dims);
}

// The middle cell of one of the nine rows of three cells around a cell that is not at the grid's border.
uint row_middle(uint cell, uint row, uvec3 dims)
{
    return cell + (row % 3u) * dims.x + (row / 3u) * dims.x * dims.y - dims.x - dims.x * dims.y;
}

// The sorted particles in such a row: the first one, and one past the last.
uvec2 neighbour_row(uint cell, uint row, uvec3 dims)
{
    const uint middle = row_middle(cell, row, dims);
    return uvec2(cell_starts[middle - 1u], cell_starts[middle + 2u]);
}
