// divide_scan.comp - prefix sum over the visible surfels: where their parts are. The first surfel whose parts find no
// room is not divided, and neither are those after it.
// One workgroup, in which each invocation takes a run of surfels. Reads: the list. Reads and writes: divisions,
// prepared.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "prepared.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 4
#define COMPACT_LIST_BINDING 5
#include "gpu/compact_buffers.glsl"
#define SCAN_LANES 256u
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;
layout(std430, set = 0, binding = 24) buffer Divisions { uvec2 divisions[]; };

shared uint added; // by those that are divided

void main()
{
    const uint count = list.count, each = (count + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES;
    const uint first = min(gl_LocalInvocationIndex * each, count), end = min(first + each, count);
    uint sum = 0u;
    for (uint i = first; i < end; i++)
        sum += divisions[i].y;
    if (gl_LocalInvocationIndex == 0u)
        added = 0u;
    uvec2 all;
    uint before = scan_group(uvec2(sum, 0u), all).x, most = 0u;
    for (uint i = first; i < end; i++) {
        const uint own = divisions[i].y;
        divisions[i].y = before;
        before += own;
        if (before <= look.max_parts)
            most = before;
    }
    atomicMax(added, most);
    barrier();
    if (gl_LocalInvocationIndex != 0u)
        return;
    prepared.parts_added = added;
    prepared.part_vertices = 3u * (count + added);
    prepared.part_instances = 1u;
    prepared.part_first_vertex = prepared.part_first_instance = 0u;
}
