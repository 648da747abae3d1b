// particles.glsl - particles (Goto et al. 2009, section 4.2): circles of one radius that push each other. Neighbours
// are found through a grid whose cells hold linked lists. The order of a list is not defined, so the pushes of
// neighbours are summed as integers.
//
// A particle's number here is its index among the active slots, which list all particles first. So the positions of
// particles are close together in memory.

// Heads of the lists of all cells, then each particle's next: a particle + 1; 0: none.
layout(scalar, set = 0, binding = 11) buffer Grid { uint grid[]; };
layout(scalar, set = 0, binding = 10) buffer Ranks { uint ranks[]; };
// Positions, in two arrays: a round reads one and writes the other.
layout(scalar, set = 0, binding = 15) buffer Moved { vec2 moved[]; };

#define UNIT_M 1e-8 // the unit in which displacements are summed

ivec2 grid_cell(vec2 point)
{
    return clamp(ivec2(floor(point / tick.grid_m)), ivec2(0), ivec2(tick.grid_columns, tick.grid_rows) - 1);
}

uint grid_head(ivec2 cell) { return uint(cell.x) + uint(cell.y) * tick.grid_columns; }
uint grid_next(uint particle) { return tick.grid_columns * tick.grid_rows + particle; }
uint moved_at(uint particle, uint round_number) { return particle + (round_number & 1u) * tick.pane.max_drops; }
