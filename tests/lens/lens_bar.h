/* lens_bar.h - a black bar far in front of the focus, before a wall that goes through the focus: from 2 px behind it to
 * 4 px before it. How much of the wall the bar hides follows from the bar's own disc, wherever the focus is. */
#ifndef VIRGA_TESTS_LENS_BAR_H
#define VIRGA_TESTS_LENS_BAR_H

#include "lens_fixture.h"

#define LENS_BAR_WIDTH  192
#define LENS_BAR_HEIGHT 112
#define LENS_BAR_FROM   86 /* px */
#define LENS_BAR_STEPS  25

/* 10 px of circle of confusion for each 1/m. The bar has a radius and a width of so many pixels. */
static inline void lens_paint_bar(const lens_picture *scene, double focus_inv_m, double radius_px, uint32_t width,
                                  int step)
{
    for (uint32_t y = 0; y < LENS_BAR_HEIGHT; y++)
        for (uint32_t x = 0; x < LENS_BAR_WIDTH; x++) {
            const bool bar = x >= LENS_BAR_FROM && x < LENS_BAR_FROM + width;
            lens_paint(scene, x, y, bar ? 0 : 0.5f,
                       1 / (focus_inv_m + 0.1 * (bar ? radius_px : -2 + 6.0 * step / (LENS_BAR_STEPS - 1))));
        }
}

/* The part of a disc of radius 1 that is left of a chord. */
static inline double lens_left_of(double chord)
{
    const double x = fmin(fmax(chord, -1), 1);
    return 0.5 + (asin(x) + x * sqrt(1 - x * x)) / M_PI;
}

/* How far the middle row is from what it should be, and from that of the step before. */
static inline void lens_look_at_bar(const lens_fixture *f, double radius_px, uint32_t width, int step,
                                    float before[LENS_BAR_WIDTH], double *changes, double *apart)
{
    for (uint32_t x = 40; x < 144; x++) {
        const double hidden = lens_left_of((LENS_BAR_FROM + width - 0.5 - x) / radius_px) -
                              lens_left_of((LENS_BAR_FROM - 0.5 - x) / radius_px);
        const double value = lens_result(f, x, LENS_BAR_HEIGHT / 2);
        *apart = fmax(*apart, fabs(value - 0.5 * (1 - hidden)));
        if (step)
            *changes = fmax(*changes, fabs(value - (double)before[x]));
        before[x] = (float)value;
    }
}

#endif
