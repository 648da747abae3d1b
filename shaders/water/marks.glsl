// marks.glsl - which of the 27 cells around a cell the surface may run through, by the particles of this cell: a bit
// for each, number 13 + x + 3 y + 9 z for the cell at the offset (x, y, z).
//
// The surface runs near particles of low density. It is never farther from one of them than frame.reach, in cells: that
// is how far the density of a half space of water reaches beyond its outermost particles, see water_surface.c. An edge
// that leads from the last points of a cell to the first ones of the next needs the points of both: on the high sides
// cells are within reach from one step of the grid farther away.
layout(std430, set = 0, binding = 7) buffer CellMarks { uint cell_marks[]; };

// 1 for the cell itself and for its neighbours on an axis within reach: bits 0, 1 and 2 for the offsets -1, 0 and 1.
uint reached_on_axis(float at)
{
    const float inside = at - floor(at);
    return (inside < frame.reach ? 1u : 0u) | 2u | (inside > 1.0 - frame.reach - 1.0 / VIRGA_WATER_SIDE ? 4u : 0u);
}

uint repeated(uint bits, uint times, uint width)
{
    return ((times & 1u) != 0u ? bits : 0u) | ((times & 2u) != 0u ? bits << width : 0u) |
           ((times & 4u) != 0u ? bits << 2u * width : 0u);
}

// The cells within reach of a position, in cells.
uint reached_cells(vec3 at)
{
    return repeated(repeated(reached_on_axis(at.x), reached_on_axis(at.y), 3u), reached_on_axis(at.z), 9u);
}
