// scan.comp - prefix sum of the cells' counts, second part: over the sums of the workgroups.
// One workgroup, in which each invocation takes a run of sums. There may be others, so that it can be dispatched by the
// same arguments as the parts before and after it, or not at all. Reads and writes: group_starts, the grid's state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"
#include "particles/group_starts.glsl"
#define SCAN_LANES 256u
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_GRID_LANES) in;

void main()
{
    if (gl_WorkGroupID.x != 0u)
        return;
    const uint groups = grid.scan_groups[0];
    const uint each = (groups + VIRGA_GRID_LANES - 1u) / VIRGA_GRID_LANES;
    const uint first = min(gl_LocalInvocationIndex * each, groups), end = min(first + each, groups);
    uint sum = 0u;
    for (uint i = first; i < end; i++)
        sum += group_starts[i];
    uvec2 all;
    uint before = scan_group(uvec2(sum, 0u), all).x;
    for (uint i = first; i < end; i++) {
        const uint own = group_starts[i];
        group_starts[i] = before;
        before += own;
    }
    if (gl_LocalInvocationIndex != 0u)
        return;
    grid.sorted = all.x;
    grid.sorted_groups = uint[3]((all.x + VIRGA_GRID_LANES - 1u) / VIRGA_GRID_LANES, 1u, 1u);
    cell_starts[grid.cells] = all.x;
}
