// count.comp - counts the particles of each cell. Each particle remembers its cell and the number of those that came
// before it.
// One invocation per particle. Reads: particles, the grid's state. Writes: cell_starts (counts), tickets.
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
    uint cell = VIRGA_GRID_NO_CELL, before = 0u;
    if (particles[particle].share > 0.0)
        cell = cell_at(to_vec(particles[particle].position));
    if (cell != VIRGA_GRID_NO_CELL)
        before = atomicAdd(cell_starts[cell], 1u);
    tickets[particle] = uvec2(cell, before);
}
