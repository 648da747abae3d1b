/* place.c - see place.h. */
#include "place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <virga/shared/sh.h>

#define NOTHING_M (-1e9f)
#define MAX_SIDE  4096
#define AROUND    24   /* directions, in each of which the sky begins somewhere */
#define ABOVE     16   /* bands of equal solid angle, over the horizon and below it */
#define FAR_M     60.0 /* what is farther hides less than a tenth of a house does */
#define CLEAR_M   2.0  /* a post or a bridge beside or above the camera is no wall */
#define FRONTS    0.22 /* albedo of brick and plaster */
#define ROAD      0.06 /* of wet asphalt */

/* ---- heights */

/* Marks the cells of a triangle, by points on it that are half a cell apart: walls have no area from above. */
static void mark_triangle(place_heights *h, const float *a, const float *b, const float *c)
{
    double u[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)b[k] - (double)a[k];
        w[k] = (double)c[k] - (double)a[k];
    }
    const double longest = fmax(hypot(u[0], u[2]), fmax(hypot(w[0], w[2]), hypot(u[0] - w[0], u[2] - w[2])));
    const int steps = (int)fmin(ceil(longest / (0.5 * PLACE_CELL_M)), 4 * MAX_SIDE) + 1;
    for (int i = 0; i <= steps; i++)
        for (int k = 0; i + k <= steps; k++) {
            const double s = (double)i / steps, t = (double)k / steps;
            const double x = (double)a[0] + s * u[0] + t * w[0], z = (double)a[2] + s * u[2] + t * w[2];
            const uint32_t column = (uint32_t)((x - h->low_m[0]) / PLACE_CELL_M),
                           row = (uint32_t)((z - h->low_m[1]) / PLACE_CELL_M);
            float *high = &h->high_m[row * h->columns + column];
            *high = fmaxf(*high, (float)((double)a[1] + s * u[1] + t * w[1]));
        }
}

bool place_heights_make(const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices,
                        place_heights *heights)
{
    uint32_t *const sides[2] = {&heights->columns, &heights->rows};
    for (int axis = 0; axis < 2; axis++) {
        const double size_m = (double)mesh->high[2 * axis] - (double)mesh->low[2 * axis];
        heights->low_m[axis] = (double)mesh->low[2 * axis] - PLACE_CELL_M;
        *sides[axis] = (uint32_t)fmin(fmax(size_m, 0) / PLACE_CELL_M + 3, MAX_SIDE);
    }
    const size_t cells = (size_t)heights->columns * heights->rows;
    heights->high_m = malloc(cells * sizeof *heights->high_m);
    if (!heights->high_m)
        return false;
    for (size_t i = 0; i < cells; i++)
        heights->high_m[i] = NOTHING_M;
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const host_primitive *primitive = &mesh->primitives[i];
        for (uint32_t k = 0; k + 2 < primitive->index_count && primitive->cover > 0.99f; k += 3) {
            const uint32_t *index = &indices[primitive->first_index + k];
            mark_triangle(heights, vertices[index[0]].position, vertices[index[1]].position,
                          vertices[index[2]].position);
        }
    }
    return true;
}

void place_heights_free(place_heights *heights)
{
    free(heights->high_m);
    memset(heights, 0, sizeof *heights);
}

/* ---- light */

/* The sine of the angle up to which things hide the sky in a direction; 0: nothing does. */
static double horizon(const place_heights *h, const double at_m[3], double x, double z)
{
    double steepest = 0;
    for (double way = CLEAR_M; way < FAR_M; way += 0.5 * PLACE_CELL_M) {
        const double column = (at_m[0] + way * x - h->low_m[0]) / PLACE_CELL_M,
                     row = (at_m[2] + way * z - h->low_m[1]) / PLACE_CELL_M;
        if (!(column >= 0 && row >= 0 && column < h->columns && row < h->rows))
            break;
        const float high = h->high_m[(size_t)row * h->columns + (size_t)column];
        steepest = fmax(steepest, ((double)high - at_m[1]) / way);
    }
    return steepest / sqrt(1 + steepest * steepest);
}

static void basis(const double d[3], double y[9])
{
    y[0] = VIRGA_SH_00;
    y[1] = VIRGA_SH_1 * d[1];
    y[2] = VIRGA_SH_1 * d[2];
    y[3] = VIRGA_SH_1 * d[0];
    y[4] = VIRGA_SH_2 * d[0] * d[1];
    y[5] = VIRGA_SH_2 * d[1] * d[2];
    y[6] = VIRGA_SH_20 * (3 * d[2] * d[2] - 1);
    y[7] = VIRGA_SH_2 * d[0] * d[2];
    y[8] = VIRGA_SH_22 * (d[0] * d[0] - d[1] * d[1]);
}

/* Adds a direction's part of the whole sphere: that of the sky, times `open`, and of what is lit by it. */
static void add_direction(const float sky[9][3], const float lit[3], const double d[3], double open, double albedo,
                          double angle, double sum[9][3])
{
    double y[9];
    basis(d, y);
    for (int c = 0; c < 3; c++) {
        double radiance = 0;
        for (int k = 0; k < 9; k++)
            radiance += (double)sky[k][c] * y[k];
        radiance = open * fmax(radiance, 0) + (1 - open) * albedo * (double)lit[c];
        for (int k = 0; k < 9; k++)
            sum[k][c] += angle * radiance * y[k];
    }
}

/* Between the sky and what hides it the harmonics are summed up over bands of equal solid angle: the height of a
 * direction, y, is uniform on a sphere (Archimedes). A band that the horizon cuts has both, by its shares.
 *
 * What stands there has the light of half of the sky's mean radiance, as a wall sees it, which a road between houses
 * does as well: irradiance over pi. In the open, where nothing hides anything, above the horizon it is the sky. */
void place_light(const place_heights *heights, const float sky[9][3], const double at_m[3], float out[9][3])
{
    const double angle = 2 * M_PI / AROUND * 2 / (2 * ABOVE);
    double sum[9][3] = {{0}};
    float lit[3];
    for (int c = 0; c < 3; c++) /* the mean over the upper half, in which y is 1/2 on average */
        lit[c] = 0.5f * fmaxf((float)VIRGA_SH_00 * sky[0][c] + 0.5f * (float)VIRGA_SH_1 * sky[1][c], 0);
    for (int i = 0; i < AROUND; i++) {
        const double a = 2 * M_PI * (i + 0.5) / AROUND, x = cos(a), z = sin(a);
        const double begins = heights->high_m ? horizon(heights, at_m, x, z) : 0;
        for (int k = 0; k < 2 * ABOVE; k++) {
            const double low = (double)(k - ABOVE) / ABOVE, y = low + 0.5 / ABOVE, out_y = sqrt(1 - y * y);
            const double d[3] = {x * out_y, y, z * out_y};
            const double open = y > 0 ? fmin(fmax((low + 1.0 / ABOVE - begins) * ABOVE, 0), 1) : 0;
            add_direction(sky, lit, d, open, y > 0 ? FRONTS : ROAD, angle, sum);
        }
    }
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 3; c++)
            out[k][c] = (float)sum[k][c];
}
