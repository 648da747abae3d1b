// exchange.glsl - the lists of water that goes into a simulation and comes back, see shared/exchange.h. Include
// cells.glsl before.
#include "shared/exchange.h"

layout(scalar, set = 0, binding = 28) buffer Exchange {
    virga_exchange_gpu exchange;
    virga_exchanged_gpu entries[]; // taken ones, then given ones
};

// Clamped to the list, because a host's buffer is not trusted.
uint given_count() { return min(exchange.given, exchange.capacity); }

// The cell below a position; NO_CELL where there is no ground.
uint cell_below(float position[3])
{
    const vec2 at = vec2(position[0] + tick.exchange_offset[0], position[2] + tick.exchange_offset[2]);
    const vec2 cell = at * tick.inv_cell_m;
    if (!all(lessThan(abs(cell), vec2(1e6)))) // also for NaN
        return NO_CELL;
    const ivec2 low = ivec2(tick.low_tile[0], tick.low_tile[1]) * VIRGA_GROUND_TILE;
    const uint cell_index = index_of_cell(ivec2(floor(cell)) + low);
    return is_ground(cell_index) ? cell_index : NO_CELL;
}
