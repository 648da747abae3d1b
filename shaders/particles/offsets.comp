// offsets.comp - prefix sum of the cells' counts, third part: counts become the index of the cell's first sorted
// particle. For cells that were thinned out, `kept` becomes the factor of the volume of those that stay.
// Each invocation takes a run of cells. Reads: group_starts. Reads and writes: cell_starts, kept.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"
#include "particles/kept.glsl"
#include "particles/group_starts.glsl"
#define SCAN_LANES 256u
#include "gpu/group_scan.glsl"

layout(local_size_x = VIRGA_GRID_LANES) in;

void main()
{
    const uvec2 run = lane_cells();
    uint sum = 0u;
    for (uint cell = run.x; cell < run.y; cell++)
        sum += staying(cell, cell_starts[cell]);
    uvec2 all;
    uint start = group_starts[gl_WorkGroupID.x] + scan_group(uvec2(sum, 0u), all).x;
    for (uint cell = run.x; cell < run.y; cell++) {
        const uint count = cell_starts[cell], stay = staying(cell, count);
        if (count > stay && stay > 0u)
            kept[cell] = floatBitsToUint(float(count) / float(stay));
        cell_starts[cell] = start;
        start += stay;
    }
}
