// kept.glsl - for each cell that is thinned out: the number of particles that stay. 0 for other cells.
#ifndef KEPT_ACCESS
#define KEPT_ACCESS
#endif
layout(std430, set = 0, binding = 8) KEPT_ACCESS buffer Kept { uint kept[]; };

uint staying(uint cell, uint count) { return count > VIRGA_GRID_CELL_MAX ? kept[cell] : count; }
