/* test_sizes.c - distributions of drop sizes: the rate that lands, medians, counts of impacts, tables, bad arguments.
 * Integrals here are plain midpoint sums over the diameter, independent of the library's. */
#include "check.h"

#include <virga/drops.h>

enum { steps = 5000 };

static const virga_sizes marshall_palmer = {.kind = VIRGA_SIZES_MARSHALL_PALMER};
static const virga_sizes best = {.kind = VIRGA_SIZES_BEST};

/* What falls on a level square metre in a second: drops of `from` or more (number) and their water (m^3). */
typedef struct landed {
    double drops, water;
} landed;

static landed what_lands(const virga_sizes *sizes, double rate, double air, double from_m)
{
    static double diameters[steps], densities[steps];
    double step = (VIRGA_DROP_MAX_M - from_m) / steps;
    for (int i = 0; i < steps; i++) {
        diameters[i] = from_m + (i + 0.5) * step;
    }
    assert_int_equal(virga_sizes_densities(sizes, rate, air, steps, diameters, densities), VIRGA_OK);
    landed sum = {0.0, 0.0};
    for (int i = 0; i < steps; i++) {
        double drops = densities[i] * virga_drop_terminal_speed(diameters[i], air) * step;
        sum.drops += drops;
        sum.water += drops * virga_drop_volume(diameters[i]);
    }
    return sum;
}

static double rate_that_lands(const virga_sizes *sizes, double rate, double air)
{
    return what_lands(sizes, rate, air, VIRGA_DROP_MIN_M).water * 3.6e6;
}

static void rate_lands(void **state)
{
    (void)state;
    const double rates[] = {0.1, 0.5, 1.0, 5.0, 25.0, 100.0, 150.0, 200.0};
    for (int i = 0; i < 8; i++) {
        assert_ratio(rate_that_lands(&marshall_palmer, rates[i], 0.0), rates[i], 0.001);
        assert_ratio(rate_that_lands(&best, rates[i], 0.0), rates[i], 0.001);
    }
    assert_ratio(rate_that_lands(&marshall_palmer, 25.0, 0.8), 25.0, 0.001);
}

/* Thin air: faster drops, so fewer of them hold the same rate. */
static void thin_air_holds_fewer_drops(void **state)
{
    (void)state;
    double sea = virga_sizes_density(&marshall_palmer, 25.0, 0.0, 0.001);
    double high = virga_sizes_density(&marshall_palmer, 25.0, VIRGA_AIR_DENSITY / 2.0, 0.001);
    assert_ratio(high, sea * pow(0.5, 0.4), 1e-9);
}

/* Marshall and Palmer's own N0, 8000 per m^3 and mm, rains too much. The unscaled formula is integrated from 0.1 to
 * 7 mm, as in the reference; the scaled one must be it, divided by what it rains too much. */
static landed unscaled_marshall_palmer(double rate, double from_mm)
{
    landed sum = {0.0, 0.0};
    double step = (7.0 - from_mm) / steps;
    for (int i = 0; i < steps; i++) {
        double mm = from_mm + (i + 0.5) * step;
        double drops = 8000.0 * exp(-4.1 * pow(rate, -0.21) * mm) * virga_drop_terminal_speed(mm * 1e-3, 0.0) * step;
        sum.drops += drops;
        sum.water += drops * virga_drop_volume(mm * 1e-3);
    }
    return sum;
}

static void unscaled_formula_rains_too_much(void **state)
{
    (void)state;
    assert_near(unscaled_marshall_palmer(1.0, 0.1).water * 3.6e6, 1.18, 0.01);
    assert_near(unscaled_marshall_palmer(25.0, 0.1).water * 3.6e6, 28.3, 0.1);
    assert_near(unscaled_marshall_palmer(100.0, 0.1).water * 3.6e6, 104.6, 0.3);
    assert_ratio(unscaled_marshall_palmer(25.0, 0.1).drops, 6900.0, 0.01);
}

static void impacts_are_as_many_as_published(void **state)
{
    (void)state;
    double too_much = 28.3 / 25.0;
    assert_ratio(what_lands(&marshall_palmer, 25.0, 0.0, 0.0005).drops * too_much, 5000.0, 0.02);
    assert_ratio(what_lands(&marshall_palmer, 25.0, 0.0, 0.001).drops * too_much, 2500.0, 0.02);
    assert_ratio(what_lands(&marshall_palmer, 25.0, 0.0, 0.002).drops * too_much, 430.0, 0.02);
}

/* Diameter (mm) with half of the water in smaller drops, in the air or (weighted by speed) of what lands. */
static double median_mm(const virga_sizes *sizes, double rate, bool landing)
{
    static double diameters[steps], densities[steps];
    double step = (VIRGA_DROP_MAX_M - VIRGA_DROP_MIN_M) / steps;
    for (int i = 0; i < steps; i++) {
        diameters[i] = VIRGA_DROP_MIN_M + (i + 0.5) * step;
    }
    assert_int_equal(virga_sizes_densities(sizes, rate, 0.0, steps, diameters, densities), VIRGA_OK);
    double all = 0.0;
    for (int i = 0; i < steps; i++) {
        densities[i] *= virga_drop_volume(diameters[i]);
        densities[i] *= landing ? virga_drop_terminal_speed(diameters[i], 0.0) : 1.0;
        all += densities[i];
    }
    double below = 0.0;
    int i = 0;
    while (below < 0.5 * all) {
        below += densities[i++];
    }
    return diameters[i - 1] * 1000.0;
}

static void medians_are_as_published(void **state)
{
    (void)state;
    assert_near(median_mm(&marshall_palmer, 25.0, false), 1.76, 0.01);
    assert_near(median_mm(&marshall_palmer, 25.0, true), 2.05, 0.01);
}

/* Best: F(D) = 1/2 at 1.3 R^0.232 (ln 2)^(1/2.25). The ends of the range cut off up to 3 % of the water (100 mm/h). */
static void best_has_its_median(void **state)
{
    (void)state;
    const double rates[] = {1.0, 5.0, 25.0, 100.0};
    for (int i = 0; i < 4; i++) {
        assert_ratio(median_mm(&best, rates[i], false), 1.3 * pow(rates[i], 0.232) * pow(log(2.0), 1.0 / 2.25), 0.015);
    }
}

static void landing_share_is_the_share(void **state)
{
    (void)state;
    const virga_sizes *both[] = {&marshall_palmer, &best};
    for (int k = 0; k < 2; k++) {
        double all = what_lands(both[k], 25.0, 0.0, VIRGA_DROP_MIN_M).drops;
        for (double mm = 0.3; mm < 6.0; mm += 0.7) {
            double larger = what_lands(both[k], 25.0, 0.0, mm * 1e-3).drops;
            assert_near(virga_sizes_landing_share(both[k], 25.0, 0.0, mm * 1e-3), 1.0 - larger / all, 1e-4);
        }
        assert_near(virga_sizes_landing_share(both[k], 25.0, 0.0, VIRGA_DROP_MIN_M), 0.0, 0.0);
        assert_near(virga_sizes_landing_share(both[k], 25.0, 0.0, VIRGA_DROP_MAX_M), 1.0, 1e-12);
        assert_near(virga_sizes_landing_share(both[k], 25.0, 0.0, 1.0), 1.0, 1e-12);
    }
}

static void table_of_a_host_is_scaled(void **state)
{
    (void)state;
    double diameters[] = {0.0, 0.001, 0.002, 0.004};
    double numbers[] = {0.0, 4.0, 2.0, 0.0};
    virga_sizes table = {VIRGA_SIZES_TABLE, diameters, numbers, 4};
    assert_ratio(rate_that_lands(&table, 10.0, 0.0), 10.0, 0.001);
    double at[] = {0.001, 0.0015, 0.003, 0.005};
    double density[4];
    assert_int_equal(virga_sizes_densities(&table, 10.0, 0.0, 4, at, density), VIRGA_OK);
    assert_ratio(density[1] / density[0], 3.0 / 4.0, 1e-9); /* linear between entries */
    assert_ratio(density[2] / density[0], 1.0 / 4.0, 1e-9);
    assert_near(density[3], 0.0, 0.0); /* zero outside */
}

/* Drops all of one size, 2 to 2.002 mm: number times speed times volume is the rate. */
static void narrow_table_is_integrated(void **state)
{
    (void)state;
    double diameters[] = {0.002, 0.002002};
    double numbers[] = {1.0, 1.0};
    virga_sizes table = {VIRGA_SIZES_TABLE, diameters, numbers, 2};
    double number = virga_sizes_density(&table, 36.0, 0.0, 0.002001) * 2e-6;
    double volume = virga_drop_volume(0.002001);
    assert_ratio(number * virga_drop_terminal_speed(0.002001, 0.0) * volume, 36.0 / 3.6e6, 1e-4);
    assert_near(virga_sizes_landing_share(&table, 36.0, 0.0, 0.0019), 0.0, 0.0);
    assert_near(virga_sizes_landing_share(&table, 36.0, 0.0, 0.0021), 1.0, 1e-12);
}

static void largest_table_works(void **state)
{
    (void)state;
    double diameters[256], numbers[256];
    for (int i = 0; i < 256; i++) {
        diameters[i] = (0.1 + 0.025 * i) * 1e-3;
        numbers[i] = virga_sizes_density(&marshall_palmer, 25.0, 0.0, diameters[i]);
    }
    virga_sizes table = {VIRGA_SIZES_TABLE, diameters, numbers, 256};
    assert_ratio(virga_sizes_density(&table, 25.0, 0.0, 0.002), numbers[76], 0.01);
    table.table_count = 257;
    assert_int_equal(virga_sizes_densities(&table, 25.0, 0.0, 0, NULL, NULL), VIRGA_ERROR_INVALID);
}

static void no_rain_is_no_drops(void **state)
{
    (void)state;
    double diameters[] = {0.0003, 0.001, 0.005};
    double densities[] = {1.0, 1.0, 1.0};
    assert_int_equal(virga_sizes_densities(&marshall_palmer, 0.0, 0.0, 3, diameters, densities), VIRGA_OK);
    for (int i = 0; i < 3; i++) {
        assert_near(densities[i], 0.0, 0.0);
    }
    const double rates[] = {1e-300, 1e-9, 1e-3};
    for (int i = 0; i < 3; i++) {
        assert_ratio(rate_that_lands(&marshall_palmer, rates[i], 0.0), rates[i], 0.01);
        assert_true(isfinite(virga_sizes_landing_share(&best, rates[i], 0.0, 0.001)));
    }
}

static void drops_outside_the_field_are_none(void **state)
{
    (void)state;
    const double outside[] = {0.0, 0.00019, 0.0069, -1.0, NAN, INFINITY};
    for (int i = 0; i < 6; i++) {
        assert_near(virga_sizes_density(&marshall_palmer, 25.0, 0.0, outside[i]), 0.0, 0.0);
        assert_near(virga_sizes_density(&best, 25.0, 0.0, outside[i]), 0.0, 0.0);
    }
}

static void assert_table_refused(const double *diameters, const double *numbers, uint32_t count)
{
    virga_sizes table = {VIRGA_SIZES_TABLE, diameters, numbers, count};
    assert_int_equal(virga_sizes_densities(&table, 25.0, 0.0, 0, NULL, NULL), VIRGA_ERROR_INVALID);
    assert_near(virga_sizes_density(&table, 25.0, 0.0, 0.001), 0.0, 0.0);
    assert_near(virga_sizes_landing_share(&table, 25.0, 0.0, 0.001), 0.0, 0.0);
}

static void wrong_tables_are_refused(void **state)
{
    (void)state;
    const double rising[] = {0.001, 0.002, 0.003}, falling[] = {0.001, 0.003, 0.002}, twice[] = {0.001, 0.001, 0.002};
    const double far[] = {0.01, 0.02, 0.03}, broken[] = {0.001, NAN, 0.003};
    const double ones[] = {1.0, 1.0, 1.0}, negative[] = {1.0, -1.0, 1.0}, none[] = {0.0, 0.0, 0.0};
    const double huge[] = {INFINITY, 1.0, 1.0};
    assert_table_refused(NULL, ones, 3);
    assert_table_refused(rising, NULL, 3);
    assert_table_refused(rising, ones, 1);
    assert_table_refused(falling, ones, 3);
    assert_table_refused(twice, ones, 3);
    assert_table_refused(far, ones, 3);
    assert_table_refused(broken, ones, 3);
    assert_table_refused(rising, negative, 3);
    assert_table_refused(rising, none, 3);
    assert_table_refused(rising, huge, 3);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    double diameter = 0.001, density = 7.0;
    const double rates[] = {-1.0, 201.0, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(virga_sizes_densities(&best, rates[i], 0.0, 1, &diameter, &density), VIRGA_ERROR_INVALID);
    }
    virga_sizes unknown = {.kind = (virga_sizes_kind)3};
    assert_int_equal(virga_sizes_densities(&unknown, 1.0, 0.0, 1, &diameter, &density), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_sizes_densities(NULL, 1.0, 0.0, 1, &diameter, &density), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_sizes_densities(&best, 1.0, 0.0, 1, NULL, &density), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_sizes_densities(&best, 1.0, 0.0, 1, &diameter, NULL), VIRGA_ERROR_INVALID);
    assert_near(density, 7.0, 0.0); /* untouched */
    assert_int_equal(virga_sizes_densities(&best, 1.0, 0.0, 0, NULL, NULL), VIRGA_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rate_lands),
        cmocka_unit_test(thin_air_holds_fewer_drops),
        cmocka_unit_test(unscaled_formula_rains_too_much),
        cmocka_unit_test(impacts_are_as_many_as_published),
        cmocka_unit_test(medians_are_as_published),
        cmocka_unit_test(best_has_its_median),
        cmocka_unit_test(landing_share_is_the_share),
        cmocka_unit_test(table_of_a_host_is_scaled),
        cmocka_unit_test(narrow_table_is_integrated),
        cmocka_unit_test(largest_table_works),
        cmocka_unit_test(no_rain_is_no_drops),
        cmocka_unit_test(drops_outside_the_field_are_none),
        cmocka_unit_test(wrong_tables_are_refused),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return cmocka_run_group_tests_name("core/sizes", tests, NULL, NULL);
}
