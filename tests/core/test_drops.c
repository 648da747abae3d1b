/* test_drops.c - speed, shape and oscillation of single drops against published values. */
#include "check.h"

#include <virga/drops.h>

/* Gunn and Kinzer 1949: diameter (mm), terminal speed (m/s). */
static const double table[][2] = {
    {0.1, 0.27}, {0.2, 0.72}, {0.3, 1.17}, {0.4, 1.62}, {0.5, 2.06}, {0.6, 2.47}, {0.7, 2.87}, {0.8, 3.27}, {0.9, 3.67},
    {1.0, 4.03}, {1.2, 4.64}, {1.4, 5.17}, {1.6, 5.65}, {1.8, 6.09}, {2.0, 6.49}, {2.2, 6.90}, {2.4, 7.27}, {2.6, 7.57},
    {2.8, 7.82}, {3.0, 8.06}, {3.2, 8.26}, {3.4, 8.44}, {3.6, 8.60}, {3.8, 8.72}, {4.0, 8.83}, {4.2, 8.92}, {4.4, 8.98},
    {4.6, 9.03}, {4.8, 9.07}, {5.0, 9.09}, {5.2, 9.12}, {5.4, 9.14}, {5.6, 9.16}, {5.8, 9.17},
};
enum { entries = sizeof table / sizeof table[0] };

static double speed(double mm)
{
    return virga_drop_terminal_speed(mm * 1e-3, 0.0);
}

static void speed_is_that_of_the_table(void **state)
{
    (void)state;
    for (int i = 0; i < entries; i++) {
        assert_ratio(speed(table[i][0]), table[i][1], 0.005);
    }
}

/* Between the entries there is only the straight line to compare with; Atlas's fit (1973), itself within 2 % of the
 * table from 0.5 mm up, watches over the curve as a whole. */
static void speed_between_entries_is_near(void **state)
{
    (void)state;
    for (int i = 2; i + 1 < entries; i++) {
        for (int k = 0; k <= 10; k++) {
            double t = k / 10.0;
            double mm = table[i][0] + t * (table[i + 1][0] - table[i][0]);
            assert_ratio(speed(mm), table[i][1] + t * (table[i + 1][1] - table[i][1]), 0.02);
            if (mm >= 0.5) {
                assert_ratio(speed(mm), 9.65 - 10.3 * exp(-0.6 * mm), 0.025);
            }
        }
    }
}

static void speed_rises_smoothly(void **state)
{
    (void)state;
    assert_near(speed(0.0), 0.0, 0.0);
    for (int i = 0; i < 10000; i++) {
        double step = speed(0.001 * (i + 1)) - speed(0.001 * i);
        assert_true(step > 0.0 || i > 6500); /* later it has reached the top speed to the last digit */
        assert_true(step >= 0.0 && step < 0.006);
    }
    assert_true(speed(10.0) <= 9.2);
    assert_near(speed(6.8), 9.2, 0.01);
}

/* (rho_water - rho_air) g D^2 / 18 mu: 12 mm/s for a droplet of 20 um. */
static void smallest_drops_follow_stokes(void **state)
{
    (void)state;
    double stokes = (998.2 - 1.204) * 9.80665 * 20e-6 * 20e-6 / (18.0 * 1.813e-5);
    assert_ratio(speed(0.02), stokes, 0.025);
    assert_ratio(speed(0.002), stokes / 100.0, 0.0025);
}

static void thin_air_lets_drops_fall_faster(void **state)
{
    (void)state;
    double at_sea = virga_drop_terminal_speed(0.002, VIRGA_AIR_DENSITY);
    assert_near(at_sea, virga_drop_terminal_speed(0.002, 0.0), 1e-12);
    assert_ratio(virga_drop_terminal_speed(0.002, VIRGA_AIR_DENSITY / 2.0), at_sea * pow(2.0, 0.4), 1e-12);
}

static void relaxation_is_speed_over_gravity(void **state)
{
    (void)state;
    assert_near(virga_drop_relaxation_time(0.002, 0.0), 6.49 / 9.80665, 1e-6);
    assert_near(virga_drop_relaxation_time(0.0005, 0.0), 2.06 / 9.80665, 1e-6);
}

static void large_drops_are_flat(void **state)
{
    (void)state;
    assert_near(virga_drop_axis_ratio(0.002), 0.938, 0.001);
    assert_near(virga_drop_axis_ratio(0.004), 0.788, 0.001);
    assert_near(virga_drop_axis_ratio(0.0003), 1.0, 0.0);
    double before = 1.0;
    for (int i = 0; i <= 1000; i++) {
        double ratio = virga_drop_axis_ratio(i * 1e-5);
        assert_true(ratio >= 0.5 && ratio <= before);
        before = ratio;
    }
}

static void drops_swing_as_rayleigh_says(void **state)
{
    (void)state;
    assert_near(virga_drop_oscillation_hz(0.001), 344.0, 1.0);
    assert_near(virga_drop_oscillation_hz(0.002), 122.0, 1.0);
    assert_near(virga_drop_oscillation_hz(0.003), 66.0, 0.5);
    assert_near(virga_drop_oscillation_hz(0.004), 43.0, 0.5);
}

static void volume_is_that_of_a_sphere(void **state)
{
    (void)state;
    assert_ratio(virga_drop_volume(0.002), 4.18879020e-9, 1e-8);
    assert_near(virga_drop_volume(0.0), 0.0, 0.0);
}

static double passed_over_100_m(double rate_mm_h)
{
    return exp(-100.0 * virga_rain_extinction(rate_mm_h));
}

static void extinction_is_that_of_atlas(void **state)
{
    (void)state;
    assert_near(passed_over_100_m(5.0), 0.91, 0.005);
    assert_near(passed_over_100_m(25.0), 0.76, 0.005);
    assert_near(passed_over_100_m(50.0), 0.65, 0.005);
    assert_near(passed_over_100_m(100.0), 0.51, 0.005);
    assert_near(virga_rain_extinction(0.0), 0.0, 0.0);
}

/* A slip of a host's must not spread NaN: beyond a range its end counts, and NaN counts as the lower end. */
static void arguments_outside_are_clamped(void **state)
{
    (void)state;
    const double bad[] = {-1.0, NAN, INFINITY, -INFINITY, 1.0};
    for (int i = 0; i < 5; i++) {
        double d = bad[i];
        assert_true(isfinite(virga_drop_terminal_speed(d, 1.0)) && virga_drop_terminal_speed(d, 1.0) >= 0.0);
        assert_true(isfinite(virga_drop_terminal_speed(0.002, d)) && virga_drop_terminal_speed(0.002, d) > 0.0);
        assert_true(isfinite(virga_drop_relaxation_time(d, d)));
        assert_true(isfinite(virga_drop_axis_ratio(d)));
        assert_true(isfinite(virga_drop_oscillation_hz(d)));
    }
    assert_near(virga_drop_terminal_speed(1.0, 0.0), virga_drop_terminal_speed(0.01, 0.0), 0.0);
    assert_near(virga_drop_volume(NAN), 0.0, 0.0);
    assert_near(virga_rain_extinction(NAN), 0.0, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(speed_is_that_of_the_table),
        cmocka_unit_test(speed_between_entries_is_near),
        cmocka_unit_test(speed_rises_smoothly),
        cmocka_unit_test(smallest_drops_follow_stokes),
        cmocka_unit_test(thin_air_lets_drops_fall_faster),
        cmocka_unit_test(relaxation_is_speed_over_gravity),
        cmocka_unit_test(large_drops_are_flat),
        cmocka_unit_test(drops_swing_as_rayleigh_says),
        cmocka_unit_test(volume_is_that_of_a_sphere),
        cmocka_unit_test(extinction_is_that_of_atlas),
        cmocka_unit_test(arguments_outside_are_clamped),
    };
    return cmocka_run_group_tests_name("core/drops", tests, NULL, NULL);
}
