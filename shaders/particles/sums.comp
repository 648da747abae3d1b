// sums.comp - prefix sum of the cells' counts, first part: the sum of each workgroup's cells.
// Each invocation takes a run of cells. Reads: cell_starts (counts), kept. Writes: group_starts (sums).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "particles/grid.glsl"
#define KEPT_ACCESS readonly
#include "particles/kept.glsl"
#include "particles/group_starts.glsl"

layout(local_size_x = VIRGA_GRID_LANES) in;

shared uint group_sum;

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        group_sum = 0u;
    barrier();
    const uvec2 run = lane_cells();
    uint sum = 0u;
    for (uint cell = run.x; cell < run.y; cell++)
        sum += staying(cell, cell_starts[cell]);
    atomicAdd(group_sum, sum);
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        group_starts[gl_WorkGroupID.x] = group_sum;
}
