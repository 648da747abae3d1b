// group_starts.glsl - for each workgroup of the prefix sum over cells: the sum of its cells, then the sum of all cells
// before it.
layout(std430, set = 0, binding = 9) buffer GroupStarts { uint group_starts[]; };

// The cells of this invocation: the first one, and one past the last.
uvec2 lane_cells()
{
    const uint each = VIRGA_GRID_SCAN_CELLS / VIRGA_GRID_LANES;
    const uint first = gl_GlobalInvocationID.x * each;
    return min(uvec2(first, first + each), uvec2(grid.cells));
}
