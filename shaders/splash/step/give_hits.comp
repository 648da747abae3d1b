// give_hits.comp - gives spray that has hit a pane in this step to the pane's list of impacts, behind those that are
// there. Where the list is full, its last entry gets the water of the rest.
// One workgroup, in which each invocation takes a run of the returns. Reads: returns. Writes: the pane's list.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/splash_gpu.h"
#include "shared/impact.h"
#define SCAN_LANES VIRGA_SPLASH_LANES
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_SPLASH_LANES) in;

layout(scalar, set = 0, binding = 0) readonly buffer Returns
{
    virga_impacts_gpu returns_head;
    virga_impact_gpu returns[];
};
layout(scalar, set = 0, binding = 1) coherent buffer Hits
{
    virga_impacts_gpu hits_head;
    virga_impact_gpu hits[];
};
layout(push_constant) uniform Push
{
    uint pane;     // its number
    uint capacity; // of its list
};

bool is_hit(uint i) { return VIRGA_IMPACT_PANE(returns[i].material) == pane + 1u; }

void main()
{
    const uint lane = gl_LocalInvocationIndex, all = returns_head.count;
    const uint run = (all + VIRGA_SPLASH_LANES - 1u) / VIRGA_SPLASH_LANES;
    const uint begin = min(lane * run, all), end = min(begin + run, all), listed = min(hits_head.count, capacity);
    uint own = 0u;
    for (uint i = begin; i < end; i++)
        own += is_hit(i) ? 1u : 0u;
    uvec2 found;
    uint index = listed + scan_group(uvec2(own, 0u), found).x;
    const uint rank = index;
    for (uint i = begin; i < end; i++)
        if (is_hit(i)) {
            if (index < capacity) {
                hits[index] = returns[i];
                hits[index].material &= 255u;
            }
            index++;
        }
    memoryBarrierBuffer();
    barrier();
    index = rank;
    for (uint i = begin; i < end; i++)
        if (is_hit(i) && index++ >= capacity)
            atomicAdd(hits[capacity - 1u].water_nl, returns[i].water_nl);
    if (lane != 0u)
        return;
    hits_head.count = min(listed + found.x, capacity);
    hits_head.group_count = uint[3]((hits_head.count + 63u) / 64u, 1u, 1u);
}
