// count.comp - counts the particles of each cell. Each particle remembers its cell and the number of those that came
// before it. Particles outside the box are left out.
// One invocation per slot. Reads: particles. Writes: cell_starts (counts), tickets.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#define VIRGA_GLSL
#include "shared/fluid_gpu.h"
#define GRID_STEP virga_fluid_step_gpu
#include "particles/grid.glsl"
#include "particles/tickets.glsl"

layout(local_size_x = VIRGA_FLUID_LANES) in;

void main()
{
    const uint slot = gl_GlobalInvocationID.x;
    if (slot >= frame.particles)
        return;
    const vec3 p = to_vec(particles[slot].position);
    uint cell = VIRGA_GRID_NO_CELL, before = 0u;
    if (particles[slot].share > 0.0 && all(greaterThanEqual(p, to_vec(frame.low_m))) &&
        all(lessThanEqual(p, to_vec(frame.high_m))))
        cell = cell_at(p);
    if (cell != VIRGA_GRID_NO_CELL)
        before = atomicAdd(cell_starts[cell], 1u);
    tickets[slot] = uvec2(cell, before);
}
