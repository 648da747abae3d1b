// pane.glsl - what all passes over drops share: buffers, cells, and the pane's local frame at a point.
#define VIRGA_GLSL
#include "shared/glass_gpu.h"
#include "shared/random.h"
#include "gpu/vectors.glsl"

layout(scalar, set = 0, binding = 0) uniform Tick { virga_glass_tick_gpu tick; };
layout(scalar, set = 0, binding = 1) buffer State { virga_glass_state_gpu state; };
// What one invocation writes and another reads later in the same pass must be coherent.
#ifdef ONE_WORKGROUP
#define EXCHANGED coherent
#else
#define EXCHANGED
#endif
layout(scalar, set = 0, binding = 2) EXCHANGED buffer Drops { virga_glass_drop_gpu drops[]; };
// two arrays, one behind the other, with a claim per cell
layout(scalar, set = 0, binding = 5) EXCHANGED buffer Claims { uint claims[]; };
// Slot + 1; 0: no drop. Behind these is what flood.glsl describes.
layout(scalar, set = 0, binding = 6) EXCHANGED buffer Occupants { uint occupants[]; };
layout(scalar, set = 0, binding = 7) EXCHANGED buffer Film { uint film[]; }; // nl; behind these what fog.glsl describes
// The tick in which a cell was last wetted, and where the drop went that left its film. 0: never.
layout(scalar, set = 0, binding = 8) EXCHANGED buffer Passed { uint passed[]; };
layout(scalar, set = 0, binding = 9) buffer Seeds { virga_glass_seed_gpu seeds[]; };
layout(scalar, set = 0, binding = 12) readonly buffer Surface { uint surface[]; };
#define NODES_BINDING 13
#include "glass/nodes.glsl"

#define PANE tick.pane
#define FILM_BLOCKS_BINDING 17
#include "glass/film_blocks.glsl"

#define NONE VIRGA_GLASS_NONE
#define OUTSIDE 0xfffffffeu // target of a drop that runs over the edge
#define KG_OF_NL 0.9982e-9

uint cell_count() { return tick.pane.columns * tick.pane.rows; }
// Number of seeds for drops that land: first those of the rain rate, then those of the host's list.
uint landing_count() { return tick.arrivals + state.impacts; }

vec2 to_vec2(float a[2]) { return vec2(a[0], a[1]); }
float[2] to_array(vec2 v) { return float[2](v.x, v.y); }

ivec2 cell_at(vec2 point) { return ivec2(floor(point / tick.pane.cell_m)); }

bool on_pane(ivec2 cell)
{
    if (any(lessThan(cell, ivec2(0))) || cell.x >= int(tick.pane.columns) || cell.y >= int(tick.pane.rows))
        return false;
    return (surface[uint(cell.x) + uint(cell.y) * tick.pane.columns] & 0x1000000u) != 0u;
}

// The last cells may reach beyond the pane's edge; a drop may not.
vec2 to_pane(vec2 point) { return clamp(point, vec2(0.0), vec2(tick.pane.width_m, tick.pane.height_m)); }
bool has_glass(vec2 point) { return point == to_pane(point) && on_pane(cell_at(point)); }

uint cell_number(ivec2 cell) { return uint(cell.x) + uint(cell.y) * tick.pane.columns; }
ivec2 cell_coordinates(uint cell) { return ivec2(cell % tick.pane.columns, cell / tick.pane.columns); }
vec2 cell_middle(uint cell) { return to_pane((vec2(cell_coordinates(cell)) + 0.5) * tick.pane.cell_m); }

// Marks the block of a cell that got film. Several invocations may do so.
void mark_film(uint cell)
{
    const uvec2 block = uvec2(cell_coordinates(cell)) / VIRGA_GLASS_FILM_BLOCK;
    film_blocks[block.x + block.y * film_block_counts().x] = 1u;
}

// ---- a packed cell: affinity, normal of the bump map, glass or not

// The logarithm of a cell's affinity, in standard deviations.
float cell_affinity(uint packed_cell) { return (float(packed_cell & 0xffu) - 128.0) * (1.0 / 32.0); }

// The unit normal of the bump map, in the pane's frame at the cell.
vec3 cell_normal(uint packed_cell)
{
    const vec2 n = (vec2(float(packed_cell >> 8 & 0xffu), float(packed_cell >> 16 & 0xffu)) - 128.0) * (1.0 / 128.0);
    return vec3(n, sqrt(max(1.0 - dot(n, n), 0.01)));
}

uint wetted_now() { return tick.tick & VIRGA_GLASS_WETTED; }

// How wet the path over a cell still is: 1 just after a drop ran over it.
float cell_wet(uint cell)
{
    const uint last = passed[cell], ticks = (tick.tick - last) & VIRGA_GLASS_WETTED;
    return last == 0u ? 0.0 : exp(-float(ticks) * tick.tick_s / tick.path_dry_s);
}

// The same for a cell that may be beyond the pane: 0 there.
float path_wet(ivec2 cell) { return on_pane(cell) ? cell_wet(cell_number(cell)) : 0.0; }

// ---- the pane's frame

Frame frame_at(vec2 point)
{
    return frame_between(clamp(point / vec2(tick.pane.width_m, tick.pane.height_m), vec2(0.0), vec2(1.0)));
}

// ---- drops

uint kind_of(virga_glass_drop_gpu drop) { return drop.kind & VIRGA_GLASS_KIND; }

// Radius of a drop's base; its volume is drop_nl_of_m3 a^3.
float base_radius(uint water_nl) { return pow(float(water_nl) / tick.drop_nl_of_m3, 1.0 / 3.0); }

// Rounds x up or down at random, so that the mean is x.
uint round_randomly(float x, uint hash) { return uint(max(x, 0.0) + virga_unit(hash)); }
