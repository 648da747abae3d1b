// fill.comp - writes the index of each particle into its cell's part of the sorted list, in the order of arrival.
// One invocation per particle. Reads: tickets, cell_starts. Writes: sorted_indices.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"
#include "particles/tickets.glsl"

layout(local_size_x = VIRGA_GRID_LANES) in;

void main()
{
    const uint particle = gl_GlobalInvocationID.x;
    if (particle >= frame.particles)
        return;
    const uvec2 ticket = tickets[particle];
    if (ticket.x != VIRGA_GRID_NO_CELL)
        sorted_indices[cell_starts[ticket.x] + ticket.y] = particle;
}
