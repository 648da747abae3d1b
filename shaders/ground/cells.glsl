// cells.glsl - what ground's passes share: buffers, where a cell lies, heights of water, states, counts.
//
// The world is a grid of cells in x and z, counted from its origin; 64 x 64 of them are a tile. The window holds
// tiles x tiles of them. A tile lies in the buffers where its coordinates fall modulo the window's width, so it stays
// in its place while the window moves.
#include "tick.glsl"
#include "shared/random.h"
#include "shared/impact.h"
#include "shared/landing.h"
#include "gpu/texels.glsl"

layout(scalar, set = 0, binding = 3) buffer Floors { virga_floor_gpu floors[]; };
layout(scalar, set = 0, binding = 4) buffer Cells { virga_cell_gpu cells[]; };
// The same two words at a time, and as texels of two cells each. What a pass writes it does not read as texels.
layout(scalar, set = 0, binding = 4) buffer CellWords { uvec2 cell_words[]; };
TEXELS(floor_texel, 21, 3)
TEXELS(cell_texel, 22, 4)
layout(scalar, set = 0, binding = 9) buffer Counts { virga_ground_count_gpu counts[]; };

#define NO_CELL 0xffffffffu
#define NO_GROUND 0xffu
#define TILE_SHIFT 6
#define MOST_STEP_NL 300000000 // heights of neighbours differ by no more than this, so that sums of five fit an int

// Place of a cell of the world in the buffers.
uint cell_place(ivec2 cell)
{
    const ivec2 tile = cell >> TILE_SHIFT;
    const uvec2 inside = uvec2(tile - ivec2(tick.low_tile[0], tick.low_tile[1]));
    const uvec2 slot = uvec2(tile) & (tick.tiles - 1u), local = uvec2(cell) & uint(VIRGA_GROUND_TILE - 1);
    const uint place = ((slot.y * tick.tiles + slot.x) << (2 * TILE_SHIFT)) | (local.y << TILE_SHIFT) | local.x;
    return max(inside.x, inside.y) < tick.tiles ? place : NO_CELL;
}

// The cell of the world that lies at a place.
ivec2 cell_at_place(uint place)
{
    const uint tile = place >> (2 * TILE_SHIFT);
    const ivec2 low = ivec2(tick.low_tile[0], tick.low_tile[1]);
    const ivec2 slot = ivec2(tile & (tick.tiles - 1u), tile >> findLSB(tick.tiles));
    const ivec2 local = ivec2(place & uint(VIRGA_GROUND_TILE - 1), (place >> TILE_SHIFT) & uint(VIRGA_GROUND_TILE - 1));
    return ((low + ((slot - low) & int(tick.tiles - 1u))) << TILE_SHIFT) + local;
}

uvec2 half_of(uvec4 texel, uint place) { return (place & 1u) == 0u ? texel.xy : texel.zw; }

virga_floor_gpu floor_of(uint place)
{
    const uvec2 words = half_of(floor_texel(place >> 1), place);
    return virga_floor_gpu(int(words.x), words.y);
}

virga_cell_gpu cell_of(uint place)
{
    const uvec2 words = half_of(cell_texel(place >> 1), place);
    return virga_cell_gpu(words.x, words.y);
}

// Depth of water, m.
float depth_at(uint place) { return place == NO_CELL ? 0.0 : float(cell_of(place).free_nl) * tick.m_per_nl; }

bool is_ground(uint place) { return place != NO_CELL && floor_of(place).material != NO_GROUND; }

// Height of the water's surface at a place above a floor, in nanolitres on one cell.
int surface_above(uint place, int floor_um, int least, int most)
{
    const int step_um = most / tick.nl_per_um;
    const int rise = clamp(floor_of(place).height_um - floor_um, -step_um, step_um) * tick.nl_per_um;
    return clamp(rise + int(min(cell_of(place).free_nl, uint(most))), least, most);
}

uint cell_state(virga_cell_gpu cell, uint material)
{
    const uint um = cell.free_nl / uint(tick.nl_per_um); // whole, so that 3 mm are 3 mm
    if (um >= 3000u)
        return um >= 10000u ? VIRGA_GROUND_PUDDLE_10 : um >= 5000u ? VIRGA_GROUND_PUDDLE_5 : VIRGA_GROUND_PUDDLE_3;
    // Steel holds nothing; it is wet from a film of 0.02 mm on, until then its drops lie apart.
    const bool saturated = cell.held_nl >= tick.soils[material].capacity_nl;
    return saturated && um >= 20u ? VIRGA_GROUND_WET : VIRGA_GROUND_DRY;
}

// Water on a cell that nobody sees: what is held back by more than the grain of paving is among blades of grass and
// clods, and has no surface.
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

// A whole number whose mean is x.
uint round_fairly(float x, uint hash) { return uint(floor(x + virga_unit(hash))); }
