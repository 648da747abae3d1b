// box.glsl - the box of all particles with its margin, in cells.
struct Box {
    ivec3 low;
    uvec3 dims;
};

Box particle_box()
{
    ivec3 low = ivec3(0), high = ivec3(0);
    if (grid.valid > 0u) {
        low = ivec3(grid.low[0], grid.low[1], grid.low[2]);
        high = ivec3(grid.high[0], grid.high[1], grid.high[2]);
    }
    return Box(low - VIRGA_GRID_MARGIN, uvec3(high - low + 1 + 2 * VIRGA_GRID_MARGIN));
}

bool is_too_large(uvec3 dims)
{
    // In two steps: the product of all three may not fit into 32 bits.
    const uint max_area = frame.max_cells / dims.z;
    return dims.x > max_area || dims.y > max_area / dims.x;
}
