/* ground/ring_table.c - see ring_table.h. */
#include "ground/ring_table.h"

#include <math.h>

#define GRAVITY   9.80665
#define TENSION   (0.0728 / 998.2) /* sigma / rho */
#define VISCOSITY 1.004e-6
#define NUMBERS   160    /* of waves: k from 0 to K_MOST */
#define K_MOST    1600.0 /* exp(-a^2 k^2 / 4) is 4e-5 there */

double ring_omega(double k, double h)
{
    return sqrt((GRAVITY * k + TENSION * k * k * k) * tanh(k * h));
}

double ring_gamma(double k, double h)
{
    if (k <= 0)
        return 0;
    const double bottom = k * h < 300 ? sqrt(VISCOSITY * ring_omega(k, h) / 2) * k / sinh(2 * k * h) : 0;
    return 2 * VISCOSITY * k * k + bottom;
}

double ring_depth(int layer)
{
    static const double depths_m[VIRGA_RING_DEPTHS] = VIRGA_RING_DEPTH_LIST;
    return depths_m[layer];
}

static double spectrum(double k)
{
    const double a = RING_CRATER_M;
    return a * a * a * a * k * k / 8 * exp(-a * a * k * k / 4);
}

/* One time of one depth: the sum over all waves, for all radii. */
static void fill_time(const double weights[NUMBERS], const float *bessel, float *slope)
{
    for (int r = 0; r < VIRGA_RING_RADII; r++) {
        double sum = 0;
        for (int i = 0; i < NUMBERS; i++)
            sum -= weights[i] * (double)bessel[r * NUMBERS + i];
        slope[r] = (float)sum;
    }
}

void ring_table_fill(float *slope)
{
    static const double step = K_MOST / NUMBERS;
    float bessel[VIRGA_RING_RADII * NUMBERS];
    for (int r = 0; r < VIRGA_RING_RADII; r++)
        for (int i = 0; i < NUMBERS; i++)
            bessel[r * NUMBERS + i] = (float)j1((i + 0.5) * step * r * VIRGA_RING_RADIUS_M / (VIRGA_RING_RADII - 1));
    for (int layer = 0; layer < VIRGA_RING_DEPTHS; layer++)
        for (int j = 0; j < VIRGA_RING_TIMES; j++) {
            const double t = j * VIRGA_RING_TIME_S / (VIRGA_RING_TIMES - 1), h = ring_depth(layer);
            double weights[NUMBERS];
            for (int i = 0; i < NUMBERS; i++) {
                const double k = (i + 0.5) * step;
                weights[i] = spectrum(k) * cos(ring_omega(k, h) * t) * exp(-ring_gamma(k, h) * t) * k * k * step;
            }
            fill_time(weights, bessel, slope + (layer * VIRGA_RING_TIMES + j) * VIRGA_RING_RADII);
        }
}
