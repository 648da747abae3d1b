/* The table of rings: waves travel as the dispersion relation says. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "ground/ring_table.h"

#include <math.h>
#include <string.h>

static float *table;

static const float *row(int layer, int time)
{
    return table + (layer * VIRGA_RING_TIMES + time) * VIRGA_RING_RADII;
}

static int set_up(void **state)
{
    (void)state;
    table = malloc(sizeof(float) * VIRGA_RING_DEPTHS * VIRGA_RING_TIMES * VIRGA_RING_RADII);
    if (table)
        ring_table_fill(table);
    return table ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    free(table);
    return 0;
}

static void test_the_slowest_wave_of_deep_water(void **state)
{
    (void)state;
    double least = 1, at = 0;
    for (double k = 50; k < 2000; k += 1)
        if (ring_omega(k, 10) / k < least) {
            least = ring_omega(k, 10) / k;
            at = k;
        }
    assert_float_equal(least, 0.231, 0.001);
    assert_float_equal(2 * 3.14159265 / at, 0.0171, 0.0003);
    assert_float_equal(ring_omega(1, 2e-3), sqrt(9.80665 * 2e-3), 1e-4); /* long waves: sqrt(g h) */
}

/* The part of the table's wave with number k at a time: Hankel's transform, with J1, of the slopes at all radii. */
static double amplitude(const float *slopes, double k)
{
    double sum = 0;
    const double step = VIRGA_RING_RADIUS_M / (VIRGA_RING_RADII - 1);
    for (int i = 0; i < VIRGA_RING_RADII; i++)
        sum += (double)slopes[i] * j1(k * i * step) * i * step * step;
    return sum;
}

/* Phase speed from the time between two zero crossings of that part, which goes as cos(w t). */
static double measured_speed(int layer, double k)
{
    double crossings[2];
    int found = 0;
    const double dt = VIRGA_RING_TIME_S / (VIRGA_RING_TIMES - 1);
    double before = amplitude(row(layer, 0), k);
    for (int j = 1; j < VIRGA_RING_TIMES && found < 2; j++) {
        const double now = amplitude(row(layer, j), k);
        if ((now < 0) != (before < 0))
            crossings[found++] = (j - now / (now - before)) * dt;
        before = now;
    }
    assert_int_equal(found, 2);
    return 3.14159265 / (crossings[1] - crossings[0]) / k;
}

static void test_phase_speeds_follow_the_dispersion_relation(void **state)
{
    (void)state;
    static const double lengths[3] = {0.008, 0.014, 0.03};
    for (int layer = 0; layer < VIRGA_RING_DEPTHS; layer++)
        for (int i = 0; i < 3; i++) {
            const double k = 2 * 3.14159265 / lengths[i], expected = ring_omega(k, ring_depth(layer)) / k;
            const double speed = measured_speed(layer, k);
            if (!(fabs(speed / expected - 1) < 0.05))
                fail_msg("%g mm of water, waves of %g mm: %g m/s, expected %g", ring_depth(layer) * 1e3,
                         lengths[i] * 1e3, speed, expected);
        }
}

static void test_it_starts_as_the_crater(void **state)
{
    (void)state;
    const double a = RING_CRATER_M, step = VIRGA_RING_RADIUS_M / (VIRGA_RING_RADII - 1);
    for (int i = 0; i < 12; i++) {
        const double r = i * step, x = r * r / (a * a);
        /* d/dr of (1 - x) exp(-x) */
        const double expected = -2 * r / (a * a) * (2 - x) * exp(-x);
        assert_float_equal(row(2, 0)[i], expected, 0.01 * 2 / a);
    }
}

static void test_the_wave_only_loses_energy(void **state)
{
    (void)state;
    const double step = VIRGA_RING_RADIUS_M / (VIRGA_RING_RADII - 1);
    for (int layer = 0; layer < VIRGA_RING_DEPTHS; layer++) {
        /* While all of it is inside the table. Slopes alone swing with the wave; their mean over 0.1 s only falls. */
        double last = 1e9;
        for (int j = 0; j + 40 < VIRGA_RING_TIMES / 2; j += 40) {
            double sum = 0;
            for (int t = j; t < j + 40; t++)
                for (int i = 0; i < VIRGA_RING_RADII; i++)
                    sum += (double)(row(layer, t)[i] * row(layer, t)[i]) * i * step;
            assert_true(sum <= last * 1.001);
            last = sum;
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_slowest_wave_of_deep_water),
        cmocka_unit_test(test_phase_speeds_follow_the_dispersion_relation),
        cmocka_unit_test(test_it_starts_as_the_crater),
        cmocka_unit_test(test_the_wave_only_loses_energy),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
