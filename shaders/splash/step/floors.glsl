// floors.glsl - the ground below spray. Droplets of splashes fall back on the surface that they come from; spray comes
// from water and may land anywhere.
#include "shared/ground_cell.h"
#include "shared/ground_window.glsl"

layout(scalar, set = 0, binding = 22) readonly buffer Floors { virga_floor_gpu floors[]; };

// Height of a position above the ground; very large where there is none.
float height_above_floor(vec3 position)
{
    if (tick.tiles == 0u)
        return 1e9;
    const vec2 cells = (position.xz - vec2(tick.low[0], tick.low[1])) * tick.inv_cell_m;
    const ivec2 low = ivec2(tick.low_tile[0], tick.low_tile[1]);
    const uint cell_index = window_cell_index(ivec2(floor(cells)) + (low << TILE_SHIFT), low, tick.tiles);
    if (any(greaterThan(abs(cells), vec2(1e6))) || cell_index == NO_CELL || floors[cell_index].material == NO_GROUND)
        return 1e9;
    return position.y - tick.base - float(floors[cell_index].height_um) * 1e-6;
}
