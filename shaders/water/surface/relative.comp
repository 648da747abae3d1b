// relative.comp - the shares of particles become shares of the water around them, see cover.comp.
// One invocation per sorted particle; no workgroups where all particles are whole. Reads: sorted_velocities. Reads and
// writes: sorted.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "water/grid.glsl"
#include "water/packed_share.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(std430, set = 0, binding = 15) readonly buffer SortedVelocities { vec4 sorted_velocities[]; };

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    if (own >= grid.sorted)
        return;
    const float cover = sorted_velocities[own].w;
    sorted[own].w = with_share(sorted[own].w / max(cover, 1e-6), cover);
}
