/* heights.c - see heights.h. */
#include "heights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NOTHING_M (-1e9f)
#define MAX_SIDE  4096
#define STEP_M    0.5 /* by which a look along the rain rises */
#define MAX_STEPS 128
#define ABOVE_M   0.1 /* over its top, so that a model is not in its own way */

bool host_heights_begin(const double low_m[2], const double high_m[2], double cell_m, host_heights *h)
{
    const double size_m[2] = {fmax(high_m[0] - low_m[0], 0), fmax(high_m[1] - low_m[1], 0)};
    memset(h, 0, sizeof *h);
    h->cell_m = fmax(cell_m, fmax(size_m[0], size_m[1]) / (MAX_SIDE - 3));
    h->columns = (uint32_t)(size_m[0] / h->cell_m) + 3;
    h->rows = (uint32_t)(size_m[1] / h->cell_m) + 3;
    h->highest_m = (double)NOTHING_M;
    for (int axis = 0; axis < 2; axis++)
        h->low_m[axis] = low_m[axis] - h->cell_m;
    const size_t cells = (size_t)h->columns * h->rows;
    h->high_m = malloc(cells * sizeof *h->high_m);
    for (size_t i = 0; h->high_m && i < cells; i++)
        h->high_m[i] = NOTHING_M;
    return h->high_m;
}

void host_heights_free(host_heights *heights)
{
    free(heights->high_m);
    memset(heights, 0, sizeof *heights);
}

static float *cell_at(const host_heights *h, double x, double z)
{
    const double column = (x - h->low_m[0]) / h->cell_m, row = (z - h->low_m[1]) / h->cell_m;
    if (!(column >= 0 && row >= 0 && column < h->columns && row < h->rows))
        return NULL;
    return &h->high_m[(size_t)row * h->columns + (size_t)column];
}

/* Marks the cells of a triangle, by points on it that are half a cell apart: walls have no area from above. */
static void mark_triangle(host_heights *h, const float *a, const float *b, const float *c)
{
    double u[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)b[k] - (double)a[k];
        w[k] = (double)c[k] - (double)a[k];
    }
    const double longest = fmax(hypot(u[0], u[2]), fmax(hypot(w[0], w[2]), hypot(u[0] - w[0], u[2] - w[2])));
    const int steps = (int)fmin(ceil(longest / (0.5 * h->cell_m)), 4 * MAX_SIDE) + 1;
    for (int i = 0; i <= steps; i++)
        for (int k = 0; i + k <= steps; k++) {
            const double s = (double)i / steps, t = (double)k / steps;
            float *high = cell_at(h, (double)a[0] + s * u[0] + t * w[0], (double)a[2] + s * u[2] + t * w[2]);
            if (high)
                *high = fmaxf(*high, (float)((double)a[1] + s * u[1] + t * w[1]));
        }
}

/* Whether a triangle is beside the grid. */
static bool is_outside(const host_heights *h, const float *a, const float *b, const float *c)
{
    const uint32_t cells[2] = {h->columns, h->rows};
    for (int axis = 0; axis < 2; axis++) {
        const int k = 2 * axis;
        if ((double)fmaxf(fmaxf(a[k], b[k]), c[k]) < h->low_m[axis] ||
            (double)fminf(fminf(a[k], b[k]), c[k]) > h->low_m[axis] + cells[axis] * h->cell_m)
            return true;
    }
    return false;
}

void host_heights_add(host_heights *h, const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices)
{
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const host_primitive *primitive = &mesh->primitives[i];
        for (uint32_t k = 0; k + 2 < primitive->index_count && primitive->cover > 0.99f; k += 3) {
            const uint32_t *index = &indices[primitive->first_index + k];
            const float *a = vertices[index[0]].position, *b = vertices[index[1]].position,
                        *c = vertices[index[2]].position;
            if (!is_outside(h, a, b, c))
                mark_triangle(h, a, b, c);
        }
    }
    const size_t cells = (size_t)h->columns * h->rows;
    for (size_t i = 0; i < cells; i++)
        h->highest_m = fmax(h->highest_m, (double)h->high_m[i]);
}

bool host_heights_of_mesh(const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices, double cell_m,
                          host_heights *heights)
{
    const double low_m[2] = {(double)mesh->low[0], (double)mesh->low[2]},
                 high_m[2] = {(double)mesh->high[0], (double)mesh->high[2]};
    if (!host_heights_begin(low_m, high_m, cell_m, heights))
        return false;
    host_heights_add(heights, mesh, vertices, indices);
    return true;
}

/* Of the four cells around a point, the share that is higher, by how near their middles are. */
static double covered(const host_heights *h, double x, double y, double z)
{
    const double half_m = 0.5 * h->cell_m, column = (x - half_m - h->low_m[0]) / h->cell_m,
                 row = (z - half_m - h->low_m[1]) / h->cell_m;
    const double u = column - floor(column), v = row - floor(row);
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        const int right = i & 1, down = i >> 1;
        const float *high = cell_at(h, x - half_m + right * h->cell_m, z - half_m + down * h->cell_m);
        sum += high && (double)*high > y ? (right ? u : 1 - u) * (down ? v : 1 - v) : 0;
    }
    return sum;
}

double host_heights_shelter(const host_heights *h, const double at_m[3], const double slant[2])
{
    double most = 0;
    for (int k = 0; k < MAX_STEPS && h->high_m && at_m[1] + k * STEP_M < h->highest_m && most < 1; k++) {
        const double up_m = k * STEP_M;
        most = fmax(most, covered(h, at_m[0] - slant[0] * up_m, at_m[1] + up_m, at_m[2] - slant[1] * up_m));
    }
    return most;
}

void host_heights_shade(const host_heights *heights, double top_m, const float slant[2], virga_drip_site *sites,
                        uint32_t count)
{
    const double falls[2] = {(double)slant[0], (double)slant[1]};
    for (uint32_t i = 0; i < count; i++) {
        const double at_m[3] = {sites[i].position_m[0], top_m + ABOVE_M, sites[i].position_m[2]};
        sites[i].shelter = (float)host_heights_shelter(heights, at_m, falls);
    }
}
