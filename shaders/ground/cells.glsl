// cells.glsl - what all passes of ground share: buffers, positions of cells, heights of water, states, counters.
//
// The world is a grid of cells in x and z, counted from its origin. 64 x 64 cells are a tile. The window has tiles x
// tiles of them. A tile's slot in the buffers is its coordinates modulo the window's width, so it stays there while the
// window moves.
#include "tick.glsl"
#include "shared/random.h"
#include "shared/impact.h"
#include "shared/landing.h"
#include "gpu/texels.glsl"

layout(scalar, set = 0, binding = 3) buffer Floors { virga_floor_gpu floors[]; };
layout(scalar, set = 0, binding = 4) buffer Cells { virga_cell_gpu cells[]; };
// The same buffer with two words at a time, and as texels of two cells each. A pass does not read cells as texels that
// it writes.
layout(scalar, set = 0, binding = 4) buffer CellWords { uvec2 cell_words[]; };
TEXELS(floor_texel, 21, 3)
TEXELS(cell_texel, 22, 4)
layout(scalar, set = 0, binding = 9) buffer Counts { virga_ground_count_gpu counts[]; };

#include "shared/ground_window.glsl"
#define MAX_STEP_NL 300000000 // limit of height differences between neighbours, so that sums of five fit into an int

// The index of a cell in the buffers; NO_CELL outside of the window.
uint index_of_cell(ivec2 cell)
{
    return window_cell_index(cell, ivec2(tick.low_tile[0], tick.low_tile[1]), tick.tiles);
}

// The cell of the world at an index.
ivec2 cell_at_index(uint cell_index)
{
    const uint tile = cell_index >> (2 * TILE_SHIFT);
    const ivec2 low = ivec2(tick.low_tile[0], tick.low_tile[1]);
    const ivec2 slot = ivec2(tile & (tick.tiles - 1u), tile >> findLSB(tick.tiles));
    const ivec2 local =
        ivec2(cell_index & uint(VIRGA_GROUND_TILE - 1), (cell_index >> TILE_SHIFT) & uint(VIRGA_GROUND_TILE - 1));
    return ((low + ((slot - low) & int(tick.tiles - 1u))) << TILE_SHIFT) + local;
}

uvec2 half_of(uvec4 texel, uint cell_index) { return (cell_index & 1u) == 0u ? texel.xy : texel.zw; }

virga_floor_gpu floor_of(uint cell_index)
{
    const uvec2 words = half_of(floor_texel(cell_index >> 1), cell_index);
    return virga_floor_gpu(int(words.x), words.y);
}

virga_cell_gpu cell_of(uint cell_index)
{
    const uvec2 words = half_of(cell_texel(cell_index >> 1), cell_index);
    return virga_cell_gpu(words.x, words.y);
}

// Depth of the water, m.
float depth_at(uint cell_index)
{
    return cell_index == NO_CELL ? 0.0 : float(cell_of(cell_index).free_nl) * tick.m_per_nl;
}

bool is_ground(uint cell_index) { return cell_index != NO_CELL && floor_of(cell_index).material != NO_GROUND; }

// Height of the water's surface on a cell above a floor, in nanolitres on a cell.
int surface_above(uint cell_index, int floor_um, int min_nl, int max_nl)
{
    const int step_um = max_nl / tick.nl_per_um;
    const int rise = clamp(floor_of(cell_index).height_um - floor_um, -step_um, step_um) * tick.nl_per_um;
    return clamp(rise + int(min(cell_of(cell_index).free_nl, uint(max_nl))), min_nl, max_nl);
}

uint cell_state(virga_cell_gpu cell, uint material)
{
    const uint um = cell.free_nl / uint(tick.nl_per_um); // an integer, so that 3 mm are exactly 3 mm
    if (um >= 3000u)
        return um >= 10000u ? VIRGA_GROUND_PUDDLE_10 : um >= 5000u ? VIRGA_GROUND_PUDDLE_5 : VIRGA_GROUND_PUDDLE_3;
    // Steel absorbs nothing. It is wet from a film of 0.02 mm on; below that its drops are separate.
    const bool saturated = cell.held_nl >= tick.soils[material].capacity_nl;
    return saturated && um >= 20u ? VIRGA_GROUND_WET : VIRGA_GROUND_DRY;
}

// Water on a cell that is not visible: water held back by more than the grain of paving is among blades of grass and
// clods of earth, and has no open surface.
uint hidden_nl(virga_soil_gpu soil)
{
    const float retention_mm = float(soil.retention_nl) * tick.m_per_nl * 1e3;
    return uint(float(soil.retention_nl) * smoothstep(0.35, 1.0, retention_mm));
}

void count_water(uint index, uint nl)
{
    const uint old = atomicAdd(counts[index].low, nl);
    if (old + nl < old)
        atomicAdd(counts[index].high, 1u);
}

// Rounds x up or down at random, so that the mean is x.
uint round_randomly(float x, uint hash) { return uint(floor(x + virga_unit(hash))); }
