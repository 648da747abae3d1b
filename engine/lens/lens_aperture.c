/* lens/lens_aperture.c - the area of the aperture's image on a grid of pixels.
 *
 * A point of light becomes an image of the aperture. Each pixel gets its coverage of that image, divided by the sum of
 * the coverage of all pixels, so no light is lost or added. The sum depends on the radius alone: it stands in a table,
 * which shaders/lens/spread.glsl reads. */
#include "lens/lens_internal.h"

#include <math.h>

#define PI   3.14159265358979323846
#define SIDE VIRGA_LENS_APERTURE

/* The same as shaders/lens/aperture.comp. */
static double aperture_reach(int x, int y, uint32_t blades, double roundness, double rotation)
{
    double edge = 1;
    if (blades) {
        const double blade = 2 * PI / blades, angle = (x || y ? atan2(y, x) : 0) - rotation;
        const double phi = angle - blade * floor(angle / blade + 0.5);
        edge = cos(0.5 * blade) / cos(phi) * (1 - roundness) + roundness;
    }
    return hypot(x, y) / edge;
}

/* The sum of the coverage of shaders/lens/aperture.glsl over the pixels in reach. */
static double covered_area(const double *reaches, double radius)
{
    const int around = (int)ceil(radius) + 1 < VIRGA_LENS_MAX_RADIUS ? (int)ceil(radius) + 1 : VIRGA_LENS_MAX_RADIUS;
    double sum = 0;
    for (int y = -around; y <= around; y++)
        for (int x = -around; x <= around; x++) {
            const double reach = reaches[(y + VIRGA_LENS_MAX_RADIUS) * SIDE + x + VIRGA_LENS_MAX_RADIUS];
            sum += fmin(fmax(fmax(radius, 0.5) - reach + 0.5, 0), 1);
        }
    return sum;
}

void lens_fill_areas(uint32_t blades, double roundness, double rotation_deg, float areas[VIRGA_LENS_SPREADS])
{
    double reaches[SIDE * SIDE];
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            reaches[y * SIDE + x] = aperture_reach(x - VIRGA_LENS_MAX_RADIUS, y - VIRGA_LENS_MAX_RADIUS, blades,
                                                   roundness, rotation_deg * PI / 180);
    for (int i = 0; i < VIRGA_LENS_SPREADS; i++)
        areas[i] = (float)covered_area(reaches, pow(i / (VIRGA_LENS_SPREADS - 1.0), 2) * VIRGA_LENS_MAX_RADIUS);
}
