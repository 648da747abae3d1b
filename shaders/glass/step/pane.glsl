// pane.glsl - what glass's passes over drops share: buffers, cells, and the pane's frame at a place.
#define VIRGA_GLSL
#include "shared/glass_gpu.h"
#include "shared/random.h"
#include "gpu/vectors.glsl"

layout(scalar, set = 0, binding = 0) uniform Tick { virga_glass_tick_gpu tick; };
layout(scalar, set = 0, binding = 1) buffer State { virga_glass_state_gpu state; };
layout(scalar, set = 0, binding = 2) buffer Drops { virga_glass_drop_gpu drops[]; };
layout(scalar, set = 0, binding = 5) buffer Claims { uint claims[]; }; // two for each cell, one behind the other
layout(scalar, set = 0, binding = 6) buffer Occupants { uint occupants[]; }; // place + 1 of a cell's drop; 0: none
layout(scalar, set = 0, binding = 7) buffer Film { uint film[]; }; // nl
// Tick in which a cell was last run over; 0: never.
layout(scalar, set = 0, binding = 8) buffer Passed { uint passed[]; };
layout(scalar, set = 0, binding = 9) buffer Seeds { virga_glass_seed_gpu seeds[]; };
layout(scalar, set = 0, binding = 12) readonly buffer Surface { uint surface[]; };
#define NODES_BINDING 13
#include "glass/nodes.glsl"

#define PANE tick.pane
#define FILM_BLOCKS_BINDING 17
#include "glass/film_blocks.glsl"

#define NOWHERE VIRGA_GLASS_NOWHERE
#define OUTSIDE 0xfffffffeu // a target: over the edge
#define KG_OF_NL 0.9982e-9

uint cell_count() { return tick.pane.columns * tick.pane.rows; }
// Seeds of drops that land: of the rate, then of the host's list.
uint landing_count() { return tick.arrivals + state.impacts; }

vec2 to_vec2(float a[2]) { return vec2(a[0], a[1]); }
float[2] to_array(vec2 v) { return float[2](v.x, v.y); }

ivec2 cell_at(vec2 place) { return ivec2(floor(place / tick.pane.cell_m)); }

bool on_pane(ivec2 cell)
{
    if (any(lessThan(cell, ivec2(0))) || cell.x >= int(tick.pane.columns) || cell.y >= int(tick.pane.rows))
        return false;
    return (surface[uint(cell.x) + uint(cell.y) * tick.pane.columns] & 0x1000000u) != 0u;
}

// The last cells may reach beyond the pane's edge; what is on it may not.
vec2 to_pane(vec2 place) { return clamp(place, vec2(0.0), vec2(tick.pane.width_m, tick.pane.height_m)); }
bool has_glass(vec2 place) { return place == to_pane(place) && on_pane(cell_at(place)); }

uint cell_number(ivec2 cell) { return uint(cell.x) + uint(cell.y) * tick.pane.columns; }
ivec2 cell_place(uint cell) { return ivec2(cell % tick.pane.columns, cell / tick.pane.columns); }
vec2 cell_middle(uint cell) { return to_pane((vec2(cell_place(cell)) + 0.5) * tick.pane.cell_m); }

// Film has come to a cell. Several may say so of a block.
void mark_film(uint cell)
{
    const uvec2 block = uvec2(cell_place(cell)) / VIRGA_GLASS_FILM_BLOCK;
    film_blocks[block.x + block.y * film_block_counts().x] = 1u;
}

// ---- what a cell's word holds: affinity, slopes of the bump map, glass or not

// The logarithm of a cell's affinity, in standard deviations.
float cell_affinity(uint word) { return (float(word & 0xffu) - 128.0) * (1.0 / 32.0); }

// The unit normal of the bump map, in the pane's frame at the cell.
vec3 cell_normal(uint word)
{
    const vec2 n = (vec2(float(word >> 8 & 0xffu), float(word >> 16 & 0xffu)) - 128.0) * (1.0 / 128.0);
    return vec3(n, sqrt(max(1.0 - dot(n, n), 0.01)));
}

// How wet a cell's path still is: 1 just after a drop ran over it.
float cell_wet(uint cell)
{
    const uint last = passed[cell];
    return last == 0u ? 0.0 : exp(-float(tick.tick - last) * tick.tick_s / tick.path_s);
}

// ---- the pane's frame

Frame frame_at(vec2 place)
{
    return frame_between(clamp(place / vec2(tick.pane.width_m, tick.pane.height_m), vec2(0.0), vec2(1.0)));
}

// ---- drops

uint kind_of(virga_glass_drop_gpu drop) { return drop.kind & VIRGA_GLASS_KIND; }

// Radius of the base of a drop: its water is drop_nl_of_m3 a^3.
float base_radius(uint water_nl) { return pow(float(water_nl) / tick.drop_nl_of_m3, 1.0 / 3.0); }

// A whole number whose mean is x: the fraction is left to chance.
uint round_by_chance(float x, uint hash) { return uint(max(x, 0.0) + virga_unit(hash)); }
