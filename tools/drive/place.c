/* place.c - see place.h. */
#include "place.h"

#include <math.h>

#include <virga/shared/sh.h>

#define AROUND  24   /* directions, in each of which the sky begins somewhere */
#define ABOVE   16   /* bands of equal solid angle, over the horizon and below it */
#define FAR_M   60.0 /* what is farther hides less than a tenth of a house does */
#define CLEAR_M 2.0  /* a post or a bridge beside or above the camera is no wall */
#define FRONTS  0.22 /* albedo of brick and plaster */
#define ROAD    0.06 /* of wet asphalt */

/* ---- light */

/* The sine of the angle up to which things hide the sky in a direction; 0: nothing does. */
static double horizon(const host_heights *h, const double at_m[3], double x, double z)
{
    double steepest = 0;
    for (double way = CLEAR_M; way < FAR_M; way += 0.5 * h->cell_m) {
        const double column = (at_m[0] + way * x - h->low_m[0]) / h->cell_m,
                     row = (at_m[2] + way * z - h->low_m[1]) / h->cell_m;
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
void place_light(const host_heights *heights, const float sky[9][3], const double at_m[3], float out[9][3])
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
