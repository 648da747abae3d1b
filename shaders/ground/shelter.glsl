// shelter.glsl - where something keeps the rain off, from the far map. Include cells.glsl and standing.glsl before.
layout(scalar, set = 0, binding = 23) readonly buffer FarFloors { virga_far_floor_gpu far_floors[]; };

float open_at(ivec2 far_cell)
{
    const uint side = tick.far_cells;
    const uint found = far_floors[uint(far_cell.y) * side + uint(far_cell.x)].traits;
    return far_open(found);
}

// Whether something is above a cell; false outside of the far map.
bool is_sheltered(ivec2 cell)
{
    const ivec2 far_cell = (cell >> VIRGA_GROUND_FAR_SHIFT) - ivec2(tick.far_low[0], tick.far_low[1]);
    const bool inside = min(far_cell.x, far_cell.y) >= 0 && max(far_cell.x, far_cell.y) < int(tick.far_cells);
    return inside && open_at(inside ? far_cell : ivec2(0)) < 0.5;
}
