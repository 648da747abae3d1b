// particles.glsl - particles (Goto et al. 2009, section 4.2): circles of one radius that push each other. Neighbours
// are
// found through a grid whose cells hold linked lists; lists come in any order, so what neighbours do is summed up in
// whole units.
//
// A particle's number here is its place in the list of awake ones, which has all particles first: positions lie close
// together.
// Heads of all cells, then the next of each; + 1, 0: none.
layout(scalar, set = 0, binding = 11) buffer Grid { uint grid[]; };
layout(scalar, set = 0, binding = 10) buffer Ranks { uint ranks[]; };
layout(scalar, set = 0, binding = 15) buffer Moved { vec2 moved[]; }; // positions in every other round

#define UNIT_M 1e-8 // of displacements

ivec2 grid_cell(vec2 place)
{
    return clamp(ivec2(floor(place / tick.grid_m)), ivec2(0), ivec2(tick.grid_columns, tick.grid_rows) - 1);
}

uint grid_head(ivec2 cell) { return uint(cell.x) + uint(cell.y) * tick.grid_columns; }
uint grid_next(uint particle) { return tick.grid_columns * tick.grid_rows + particle; }
uint moved_at(uint particle, uint turn) { return particle + (turn & 1u) * tick.pane.max_drops; }
