/* glass/glass_cells.c - how many cells a pane has. */
#include "glass/glass_internal.h"

#include <math.h>

uint32_t glass_cells_along(float length_m, float cell_m)
{
    const double cells = ceil((double)length_m / (double)cell_m - 1e-4);
    return cells < 1 ? 1 : (uint32_t)cells;
}

uint32_t glass_film_blocks(const virga_glass_def *def)
{
    const uint32_t side = VIRGA_GLASS_FILM_BLOCK;
    const uint32_t columns = glass_cells_along(def->width_m, def->cell_m);
    const uint32_t rows = glass_cells_along(def->height_m, def->cell_m);
    return (columns + side - 1) / side * ((rows + side - 1) / side);
}
