// copy.comp - copies positions, shares and velocities into the sorted lists, so that neighbours lie side by side in
// memory.
// One invocation per sorted particle. Reads: sorted_indices, particles, tickets, kept. Writes: sorted,
// sorted_velocities; the grid's state, if a particle is not whole.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"
#include "particles/tickets.glsl"
#define KEPT_ACCESS readonly
#include "particles/kept.glsl"

layout(std430, set = 0, binding = 10) writeonly buffer SortedVelocities { vec4 sorted_velocities[]; };

layout(local_size_x = VIRGA_GRID_LANES) in;

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= grid.sorted)
        return;
    const uint particle = sorted_indices[i], factor = kept[tickets[particle].x];
    const float share = min(particles[particle].share, 1.0) * (factor > 0u ? uintBitsToFloat(factor) : 1.0);
    const vec3 velocity = to_vec(particles[particle].velocity);
    sorted_velocities[i] = vec4(all(lessThan(abs(velocity), vec3(1e4))) ? velocity : vec3(0.0), 1.0);
    // The lowest bits are free: see water/packed_share.glsl.
    sorted[i] = vec4(to_vec(particles[particle].position), uintBitsToFloat(floatBitsToUint(share) & ~0xffu));
    if (particles[particle].share < 1.0 && grid.fading_groups[0] == 0u)
        atomicMax(grid.fading_groups[0], grid.sorted_groups[0]);
}
