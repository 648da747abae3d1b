// starts.comp - prefix sum over the splash particles: counts become the index of a particle's first droplet.
// One workgroup, in which each invocation takes a run of particles. Reads and writes: droplet_starts, state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#define SCAN_LANES 256u
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint count = state.splashes, each = (count + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES;
    const uint first = min(gl_LocalInvocationIndex * each, count), end = min(first + each, count);
    uint sum = 0u;
    for (uint i = first; i < end; i++)
        sum += droplet_starts[i];
    uvec2 all;
    uint before = scan_group(uvec2(sum, 0u), all).x;
    for (uint i = first; i < end; i++) {
        const uint own = droplet_starts[i];
        droplet_starts[i] = before;
        before += own;
    }
    if (gl_LocalInvocationIndex != 0u)
        return;
    state.droplets_wanted = all.x;
    state.droplets = min(all.x, frame.max_droplets);
}
