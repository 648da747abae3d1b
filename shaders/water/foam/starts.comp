// starts.comp - prefix sum over the particles that make foam: which of the new particles is the first of each. Ends the
// step: sets the number of particles, and the time.
// One workgroup, in which each invocation takes a run of particles. Reads: the list. Reads and writes: emissions,
// state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "foam.glsl"
#include "sources.glsl"
#define SCAN_LANES 256u
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

void main()
{
    const uint count = source_list.count, each = (count + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES;
    const uint first = min(gl_LocalInvocationIndex * each, count), end = min(first + each, count);
    uint sum = 0u;
    for (uint i = first; i < end; i++)
        sum += emissions[sources[i]].x;
    uvec2 all;
    uint before = scan_group(uvec2(sum, 0u), all).x;
    for (uint i = first; i < end; i++) {
        emissions[sources[i]].z = before;
        before += emissions[sources[i]].x;
    }
    if (gl_LocalInvocationIndex != 0u)
        return;
    state.foam_first = state.foam;
    state.foam_wanted = all.x;
    state.foam += min(all.x, frame.max_foam - state.foam);
    state.foam_groups = uint[3]((state.foam + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES, 1u, 1u);
    state.foam_vertices = uint[4](3u * state.foam, 1u, 0u, 0u);
    state.foam_gap_s = max(foam_gap_s(), 0.0);
    state.foam_clock_us = frame.foam_now_us;
    state.foam_started = 1u;
}
