/* lens_ways.h - a lens that blurs in place by the passes of GPUs, with wide discs from a quarter of the resolution, or
 * by those for discs of any width. */
#ifndef VIRGA_TESTS_LENS_WAYS_H
#define VIRGA_TESTS_LENS_WAYS_H

#include "lens_host.h"

#define WIDTH  192
#define HEIGHT 112
#define COUNT  ((size_t)WIDTH * HEIGHT)

/* A depth (m) with a circle of confusion of so many pixels. Less than 0: in front of the focus. */
static inline double depth_of(double radius_px)
{
    return 1 / (4 - radius_px / 10);
}

static inline void open_way(host *h, bool wide)
{
    effect_fixture_variants = wide ? VIRGA_VARIANTS_GPU : VIRGA_VARIANTS_SOFTWARE;
    REQUIRE(open_host(h, VIRGA_TARGET_RENDER_PASS, WIDTH, HEIGHT, 1));
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
    h->f.settings.focus_m = 0.25f;
    h->f.settings.max_radius_px = 32;
}

static inline void run_way(host *h, bool wide)
{
    run(h);
    assert_int_equal(h->f.lens->prepared[0].wide, wide);
}

/* How much of the light is elsewhere than in the picture before, which it replaces. */
static inline double change(const host *h, float *before)
{
    double sum = 0, light = 0;
    for (size_t i = 0; i < COUNT; i++) {
        sum += fabs((double)h->f.result[4 * i] - (double)before[i]);
        light += (double)h->f.result[4 * i];
        before[i] = h->f.result[4 * i];
    }
    return sum / light;
}

static inline void assert_finite(const host *h)
{
    for (size_t i = 0; i < 4 * COUNT; i++)
        assert_true(isfinite(h->f.result[i]));
}

/* A picture of few pixels with the widest discs, by the passes of GPUs: the i-th of these. */
#define FEW_PIXELS 4

static inline void open_few_pixels(host *h, int i)
{
    static const uint32_t sizes[FEW_PIXELS][2] = {{1, 1}, {1, 7}, {5, 2}, {3, 3}};
    effect_fixture_variants = VIRGA_VARIANTS_GPU;
    REQUIRE(open_host(h, VIRGA_TARGET_RENDER_PASS, sizes[i][0], sizes[i][1], 1));
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
    h->f.settings.focus_m = 0.25f;
    h->f.settings.aperture_f = 0.001f;
}

/* All of it has to be of this gray. */
static inline void run_few_pixels(host *h, double gray)
{
    run_way(h, true);
    for (size_t i = 0; i < (size_t)h->f.scene.width * h->f.scene.height; i++)
        assert_float_equal(h->f.result[4 * i], gray, 4e-3);
    close_host(h);
}

#endif
