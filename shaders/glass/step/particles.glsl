// particles.glsl - particles (Goto et al. 2009, section 4.2): circles of one radius that push each other. Neighbours
// are found through a grid: particles are sorted by its cells, so those of a cell are side by side, and invocations
// beside each other have the same neighbours. The order of cells, and within a cell, is not defined, so the pushes of
// neighbours are summed as integers. A linked list per cell took twice as long before a crowded blade.
//
//     particle_grid    counts the particles of each cell
//     particle_starts  gives each cell that has any its place among the sorted particles
//     particle_sort    writes them there
//     push_particles   moves them, in rounds; in the last it looks for those that merge
//     merge_particles  merges them
//
// A particle's number here is its index among the active slots, which list all particles first. Its place is its index
// among the sorted particles.

// Particles in each cell, then each particle's number within its cell.
layout(scalar, set = 0, binding = 11) buffer Grid { uint grid[]; };
layout(scalar, set = 0, binding = 10) buffer Ranks { uint ranks[]; };
// Sorted particles, in two arrays: a round reads one and writes the other. x, y: position, as bits; z: number
layout(scalar, set = 0, binding = 15) buffer Moved { uvec3 moved[]; };
// Behind them, in words: the number of particles that have a place, then the place of each cell's first.
layout(scalar, set = 0, binding = 15) buffer Places { uint places[]; };

#define UNIT_M 1e-8 // the unit in which displacements are summed

ivec2 grid_cell(vec2 point)
{
    return clamp(ivec2(floor(point / tick.grid_m)), ivec2(0), ivec2(tick.grid_columns, tick.grid_rows) - 1);
}

uint grid_head(ivec2 cell) { return uint(cell.x) + uint(cell.y) * tick.grid_columns; }
uint grid_rank(uint particle) { return tick.grid_columns * tick.grid_rows + particle; }
uint moved_at(uint place, uint round_number) { return place + (round_number & 1u) * tick.pane.max_drops; }
uint places_taken() { return 6u * tick.pane.max_drops; }
uint place_of_cell(uint head) { return places_taken() + 1u + head; }
