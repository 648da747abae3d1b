/* The table of rings: its waves are those of the equations, and travel and fade as they say. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "ground/ring_table.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
static float *table;

/* The equations again, not as the engine has them: lengths of capillarity and gravity, the rim's shape in r. */
static double omega(double k, double h)
{
    const double capillary_m2 = 0.0728 / (998.2 * 9.80665);
    return sqrt(9.80665 * k * (1 + capillary_m2 * k * k) * tanh(k * h));
}

/* Energy lost in the layer on the floor, rho U^2 sqrt(nu w / 8) an area with U = w A / sinh(k h), over twice the energy
 * rho (g + sigma k^2 / rho) A^2 / 2 of the wave. */
static double gamma_of(double k, double h)
{
    const double nu = 1.004e-6, w = omega(k, h), u = k * h < 300 ? w / sinh(k * h) : 0;
    return 2 * nu * k * k + u * u * sqrt(nu * w / 8) / (9.80665 + 0.0728 / 998.2 * k * k);
}

static double start_of(double a, double k)
{
    return pow(a, 4) * k * k / 8 * exp(-pow(a * k, 2) / 4);
}

/* Finer and farther than the engine's sum: 650 waves, to k a = 10.4. */
static double step_of(double a)
{
    return 0.016 / a;
}

static double exact_slope(double a, double h, double r, double t)
{
    double sum = 0;
    const double step = step_of(a);
    for (double k = step / 2; k < 650 * step; k += step)
        sum -= start_of(a, k) * cos(omega(k, h) * t) * exp(-gamma_of(k, h) * t) * j1(k * r) * k * k * step;
    return sum;
}

static double time_of(int layer, int j)
{
    return j * ring_life(layer) / (VIRGA_RING_TIMES - 1);
}

static const float *row(int layer, int time)
{
    return table + (layer * VIRGA_RING_TIMES + time) * VIRGA_RING_RADII;
}

static double highest(const float *slopes)
{
    double max = 0;
    for (int i = 0; i < VIRGA_RING_RADII; i++)
        max = fmax(max, fabs((double)slopes[i]));
    return max;
}

static double half_value(uint16_t half)
{
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    const double value = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return half & 0x8000 ? -value : value;
}

/* What all tests look at is the table as its image holds it. */
static int set_up(void **state)
{
    (void)state;
    const size_t values = (size_t)VIRGA_RING_LAYERS * VIRGA_RING_TIMES * VIRGA_RING_RADII;
    table = malloc(sizeof(float) * values);
    if (table)
        ring_table_fill(table, 0);
    for (size_t i = 0; table && i < values; i++)
        table[i] = (float)half_value(ring_half(table[i]));
    return table ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    free(table);
    return 0;
}

static void test_half_floats_are_the_nearest(void **state)
{
    (void)state;
    for (int half = 0; half < 0x7c00; half++) {
        const double own = half_value((uint16_t)half), next = half < 0x7bff ? half_value((uint16_t)(half + 1)) : 65536;
        const float middle = (float)(0.5 * (own + next)); /* exact: a bit more than a half float has */
        assert_int_equal(ring_half((float)own), half);
        assert_int_equal(ring_half((float)-own), half | 0x8000);
        assert_int_equal(ring_half(middle), half + (half & 1)); /* to the even one */
        assert_int_equal(ring_half(nextafterf(middle, 0)), half);
        assert_int_equal(ring_half(nextafterf(middle, 1e6f)), half + 1);
    }
    assert_int_equal(ring_half(-1e30f), 0xfc00);
}

static void test_the_slowest_wave_of_deep_water(void **state)
{
    (void)state;
    double min = 1, at = 0;
    for (double k = 50; k < 2000; k += 1)
        if (ring_omega(k, 10) / k < min) {
            min = ring_omega(k, 10) / k;
            at = k;
        }
    assert_float_equal(min, 0.231, 0.001);
    assert_float_equal(2 * pi / at, 0.0171, 0.0003);
    assert_float_equal(ring_omega(1, 2e-3), sqrt(9.80665 * 2e-3), 1e-4); /* long waves: sqrt(g h) */
}

static void test_damping_is_of_the_water_and_of_the_floor(void **state)
{
    (void)state;
    assert_float_equal(ring_gamma(500, 1), 2 * 1.004e-6 * 500 * 500, 1e-9);
    for (double h = 1e-3; h < 0.1; h *= 1.5)
        for (double k = 30; k < 1600; k *= 1.3)
            assert_float_equal(ring_gamma(k, h) / gamma_of(k, h), 1, 1e-6);
}

static void test_entries_are_the_integral(void **state)
{
    (void)state;
    for (int n = 0; n < 3000; n++) {
        const int layer = n % VIRGA_RING_LAYERS, j = n * 71 % VIRGA_RING_TIMES, i = n * 37 % VIRGA_RING_RADII;
        const double t = time_of(layer, j), r = i * ring_reach(layer, t) / (VIRGA_RING_RADII - 1);
        const double exact = exact_slope(ring_width(layer), ring_depth(layer), r, t);
        assert_float_equal(row(layer, j)[i], exact, 0.005 * highest(row(layer, j)));
    }
}

/* Halfway between entries in both directions, where linear interpolation errs most, and at irregular points. */
static void test_reading_between_entries_is_within_6_percent(void **state)
{
    (void)state;
    for (int n = 0; n < 1500; n++) {
        const int layer = n % VIRGA_RING_LAYERS, j = n * 71 % (VIRGA_RING_TIMES - 1);
        const double t = time_of(layer, j) + time_of(layer, 1) * (n % 3 ? 0.5 : 0.27);
        const double r =
            (n * 37 % (VIRGA_RING_RADII - 1) + (n % 2 ? 0.5 : 0.81)) * ring_reach(layer, t) / (VIRGA_RING_RADII - 1);
        const double exact = exact_slope(ring_width(layer), ring_depth(layer), r, t);
        assert_float_equal(ring_table_slope(table, layer, r, t), exact, 0.06 * highest(row(layer, j)));
    }
}

/* The part of the table's wave with number k at a time: Hankel's transform, with J1, of the slopes at all radii. */
static double amplitude(int layer, int time, double k)
{
    const double step = ring_reach(layer, time_of(layer, time)) / (VIRGA_RING_RADII - 1);
    double sum = 0;
    for (int i = 0; i < VIRGA_RING_RADII; i++)
        sum += (double)row(layer, time)[i] * j1(k * i * step) * i * step * step;
    return sum;
}

/* Phase speed from the time between two zero crossings of that part, which goes as cos(w t). */
static double measured_speed(int layer, double k)
{
    double crossings[2] = {0, 0};
    int found = 0;
    double before = amplitude(layer, 0, k);
    for (int j = 1; j < VIRGA_RING_TIMES && found < 2; j++) {
        const double now = amplitude(layer, j, k);
        if ((now < 0) != (before < 0))
            crossings[found++] = time_of(layer, j) - now / (now - before) * time_of(layer, 1);
        before = now;
    }
    assert_int_equal(found, 2);
    return pi / (crossings[1] - crossings[0]) / k;
}

static void test_phase_speeds_follow_the_dispersion_relation(void **state)
{
    (void)state;
    static const double depths[4] = {0.001, 0.002, 0.005, 0.05}, lengths[3] = {0.008, 0.017, 0.04};
    for (int d = 0; d < 4; d++)
        for (int i = 0; i < 6; i++) { /* long waves of wide craters, too; these make none of 8 mm */
            if (i == 3)
                continue;
            const double k = 2 * pi / lengths[i % 3], expected = omega(k, depths[d]) / k;
            const double speed = measured_speed(ring_layer(i / 3, depths[d]), k);
            if (!(fabs(speed / expected - 1) < 0.05))
                fail_msg("%g mm of water, waves of %g mm: %g m/s, expected %g", depths[d] * 1e3, lengths[i % 3] * 1e3,
                         speed, expected);
        }
}

static void test_it_starts_as_the_crater(void **state)
{
    (void)state;
    for (int n = 0; n < 2 * VIRGA_RING_RADII; n++) {
        const int i = n / 2, layer = n % 2 ? 2 : 2 + VIRGA_RING_DEPTHS;
        const double a = ring_width(layer);
        const double r = i * ring_reach(layer, 0) / (VIRGA_RING_RADII - 1), x = r * r / (a * a);
        /* d/dr of (1 - x) exp(-x) */
        assert_float_equal(row(layer, 0)[i], -2 * r / (a * a) * (2 - x) * exp(-x), 0.003 / a);
    }
}

/* The volume under a surface that ends at 0 is -pi int slope r^2 dr; here in parts of the crater's own. */
static void test_it_has_no_volume(void **state)
{
    (void)state;
    for (int layer = 0; layer < VIRGA_RING_LAYERS; layer++) {
        double sum = 0, size = 0;
        for (int i = 0; i < VIRGA_RING_RADII; i++) {
            sum += (double)row(layer, 0)[i] * i * i;
            size += fabs((double)row(layer, 0)[i]) * i * i;
        }
        assert_float_equal(sum / size, 0, 0.002);
    }
}

/* Parseval: int slope^2 r dr = int (S cos(w t) exp(-gamma t))^2 k^3 dk. All of the wave is in the table, and viscosity
 * alone makes it fade. */
static void test_energy_only_fades_as_viscosity_takes_it(void **state)
{
    (void)state;
    for (int layer = 0; layer < VIRGA_RING_LAYERS; layer++)
        for (int j = 0; j < VIRGA_RING_TIMES; j += 9) {
            const double t = time_of(layer, j), h = ring_depth(layer), a = ring_width(layer), dk = step_of(a);
            const double step = ring_reach(layer, t) / (VIRGA_RING_RADII - 1);
            double sum = 0, exact = 0;
            for (int i = 0; i < VIRGA_RING_RADII; i++)
                sum += (double)(row(layer, j)[i] * row(layer, j)[i]) * i * step * step;
            for (double k = dk / 2; k < 650 * dk; k += dk)
                exact += pow(start_of(a, k) * cos(omega(k, h) * t) * exp(-gamma_of(k, h) * t), 2) * k * k * k * dk;
            if (!(fabs(sum / exact - 1) < 0.01))
                fail_msg("%g mm of water at %g s: %g, expected %g", h * 1e3, t, sum, exact);
        }
}

/* Swings between slope and speed average out over 0.1 s. */
static void test_energy_never_grows(void **state)
{
    (void)state;
    for (int layer = 0; layer < VIRGA_RING_LAYERS; layer++) {
        double last = INFINITY;
        for (int j = 0; j + 40 <= VIRGA_RING_TIMES; j += 40) {
            double sum = 0;
            for (int t = j; t < j + 40; t++)
                for (int i = 0; i < VIRGA_RING_RADII; i++)
                    sum += pow((double)row(layer, t)[i] * ring_reach(layer, time_of(layer, t)), 2) * i;
            assert_true(sum < last);
            last = sum;
        }
    }
}

static void test_nothing_is_outside(void **state)
{
    (void)state;
    for (int layer = 0; layer < VIRGA_RING_LAYERS; layer++) {
        assert_float_equal(ring_table_slope(table, layer, ring_reach(layer, 0.1) * 1.01, 0.1), 0, 0);
        assert_float_equal(ring_table_slope(table, layer, 0.01, ring_life(layer) * 1.01), 0, 0);
    }
}

/* So that the last tenth can be softened away: it holds under 1 % of the square of the slope, its end under 2 % of the
 * highest slope. */
static void test_the_table_reaches_as_far_as_the_waves(void **state)
{
    (void)state;
    for (int layer = 0; layer < VIRGA_RING_LAYERS; layer++)
        for (int j = 0; j < VIRGA_RING_TIMES; j++) {
            double all = 0, end = 0;
            for (int i = 0; i < VIRGA_RING_RADII; i++) {
                const double part = (double)(row(layer, j)[i] * row(layer, j)[i]) * i;
                all += part;
                end += i > VIRGA_RING_RADII * 9 / 10 ? part : 0;
            }
            assert_true(end < 0.01 * all);
            assert_float_equal(row(layer, j)[VIRGA_RING_RADII - 1], 0, 0.02 * highest(row(layer, j)));
        }
}

static void test_water_takes_the_nearest_depth(void **state)
{
    (void)state;
    for (int layer = 0; layer < VIRGA_RING_LAYERS; layer++) {
        const int width = layer / VIRGA_RING_DEPTHS;
        assert_int_equal(ring_layer(width, ring_depth(layer)), layer);
        assert_int_equal(ring_layer(width, ring_depth(layer) * 1.1), layer);
        assert_int_equal(ring_layer(width, ring_depth(layer) * 0.9), layer);
    }
    assert_int_equal(ring_layer(0, 0), 0);
    assert_int_equal(ring_layer(VIRGA_RING_WIDTHS - 1, 5), VIRGA_RING_LAYERS - 1);
}

/* The fits that shaders/ground/rings.glsl has. */
static double fitted_calm_time(int width, double mm)
{
    return width == 0 ? 0.1415 * (1 - exp(-pow(mm / 1.55, 1.3))) : 0.26 * (1 - exp(-pow(mm / 2.05, 0.85)));
}

static void test_calm_time_is_the_faded_table_summed_over_time(void **state)
{
    (void)state;
    for (int layer = 0; layer < VIRGA_RING_DROP_WIDTHS * VIRGA_RING_DEPTHS; layer++) {
        const double h = ring_depth(layer);
        double held = 0, before = 0;
        for (int j = 0; j < VIRGA_RING_TIMES; j++) {
            const double share = j / (VIRGA_RING_TIMES - 1.0);
            const double x = fmax((share - VIRGA_RING_FADES) / (1 - VIRGA_RING_FADES), 0),
                         fade = 1 - x * x * (3 - 2 * x);
            double sum = 0;
            for (int i = 0; i < VIRGA_RING_RADII; i++)
                sum += pow((double)row(layer, j)[i] * ring_reach(layer, time_of(layer, j)), 2) * i;
            before = j ? before : sum;
            held += fade * fade * sum * time_of(layer, 1) * (j && j < VIRGA_RING_TIMES - 1 ? 1 : 0.5);
        }
        const int width = layer / VIRGA_RING_DEPTHS;
        assert_float_equal(held / before / ring_calm_time(width, h), 1, 0.02);
        assert_float_equal(fitted_calm_time(width, h * 1e3) / ring_calm_time(width, h), 1, 0.03); /* as said */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_half_floats_are_the_nearest),
        cmocka_unit_test(test_the_slowest_wave_of_deep_water),
        cmocka_unit_test(test_damping_is_of_the_water_and_of_the_floor),
        cmocka_unit_test(test_entries_are_the_integral),
        cmocka_unit_test(test_reading_between_entries_is_within_6_percent),
        cmocka_unit_test(test_phase_speeds_follow_the_dispersion_relation),
        cmocka_unit_test(test_it_starts_as_the_crater),
        cmocka_unit_test(test_it_has_no_volume),
        cmocka_unit_test(test_energy_only_fades_as_viscosity_takes_it),
        cmocka_unit_test(test_energy_never_grows),
        cmocka_unit_test(test_nothing_is_outside),
        cmocka_unit_test(test_the_table_reaches_as_far_as_the_waves),
        cmocka_unit_test(test_water_takes_the_nearest_depth),
        cmocka_unit_test(test_calm_time_is_the_faded_table_summed_over_time),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
