// thin.comp - thins out the particles of cells that have far too many, such as thousands at one position: each is kept
// with a probability that leaves about VIRGA_GRID_CELL_MAX. Their volume goes to those that are kept, see copy.comp.
// Without this, a damaged file would take hours: the work grows with the square of the number in a cell.
// One invocation per particle. Reads: cell_starts (counts). Writes: tickets, kept (counts of thinned cells).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "particles/grid.glsl"
#include "shared/random.h"
#include "particles/tickets.glsl"
#include "particles/kept.glsl"

layout(local_size_x = VIRGA_GRID_LANES) in;

void main()
{
    const uint particle = gl_GlobalInvocationID.x;
    if (particle >= frame.particles)
        return;
    const uint cell = tickets[particle].x;
    if (cell == VIRGA_GRID_NO_CELL)
        return;
    const uint count = cell_starts[cell];
    if (count <= VIRGA_GRID_CELL_MAX)
        return;
    // By its index, not by its order of arrival: the same ones are kept in every run.
    if (virga_unit(virga_hash1(particle)) * float(count) < float(VIRGA_GRID_CELL_MAX))
        tickets[particle].y = atomicAdd(kept[cell], 1u);
    else
        tickets[particle].x = VIRGA_GRID_NO_CELL;
}
