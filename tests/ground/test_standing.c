/* Water on ground where no drop is counted: what came is there, in pores, as a film, in hollows, by closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "ground/ground_internal.h"

#include <math.h>
#include <string.h>

#define TICK_S    (1.0 / 60)
#define NL_PER_UM 2500.0 /* cells of 5 cm */
#define MM        2.5e6  /* nl on a cell */
#define RAIN_MM_H 36.0   /* 0.01 mm a second */
#define PLAIN     3

static ground_standing cells[GROUND_STANDING];
static virga_soil_gpu soils[VIRGA_GROUND_MATERIALS];
static ground_weather weather;

/* Pores of 0.2 mm, roughness that holds 0.3 mm, bumps of 4 mm; nothing sinks, nothing dries. */
static int begin(void **state)
{
    (void)state;
    memset(soils, 0, sizeof soils);
    memset(cells, 0, sizeof cells);
    soils[PLAIN] = (virga_soil_gpu){
        .capacity_nl = (uint32_t)(0.2 * MM), .retention_nl = (uint32_t)(0.3 * MM), .drying = 1, .bumps_um = 4000};
    weather = (ground_weather){.rain_nl = RAIN_MM_H / 3600 * TICK_S * MM, .tick_s = TICK_S, .nl_per_um = NL_PER_UM};
    return 0;
}

static void run_s(double s)
{
    for (uint32_t i = 0, ticks = (uint32_t)(s / TICK_S + 0.5); i < ticks; i++)
        ground_standing_tick(cells, soils, &weather);
}

static void check(const ground_standing *cell, double held_mm, double film_mm, double level_mm)
{
    assert_float_equal(cell->held_nl / MM, held_mm, 1e-4);
    assert_float_equal(cell->film_nl / MM, film_mm, 1e-4);
    assert_float_equal(cell->level_um * 1e-3, level_mm, 1e-3);
}

static void test_pores_fill_then_a_film_then_hollows(void **state)
{
    (void)state;
    run_s(10);
    check(&cells[PLAIN], 0.1, 0, 0);
    run_s(20);
    check(&cells[PLAIN], 0.2, 0.1, 0);
    run_s(20);
    check(&cells[PLAIN], 0.2, 0.3, 0);
    run_s(1);
    assert_true(cells[PLAIN].level_um > 0);
}

/* Depth of water, as a mean, that fills hollows to a level x standard deviations above the middle of bumps: the mean of
 * what a normal distribution lies below it. Bumps spread by 1.18 of what their material says. */
static double mean_below(double level)
{
    const double x = level / 1.18;
    return 1.18 * (x * 0.5 * erfc(-x / sqrt(2)) + exp(-0.5 * x * x) / sqrt(8 * atan(1)));
}

static void test_hollows_hold_what_came(void **state)
{
    (void)state;
    for (int i = 1; i < 5; i++) {
        begin(state);
        run_s(50 + i * 15); /* 0.15 mm each that are above film and pores */
        const double level = cells[PLAIN].level_um * 1e-3 / 4;
        assert_float_equal(4 * (mean_below(level - 0.5) - mean_below(-0.5)), i * 0.15, 1e-3);
    }
}

static void test_hollows_that_are_full_run_over(void **state)
{
    (void)state;
    run_s(1000);
    check(&cells[PLAIN], 0.2, 0.3, 2);
    virga_ground_settings settings = {.start_water_mm = 6}; /* more than that stays */
    ground_standing_start(cells, &settings, soils);
    run_s(100);
    check(&cells[PLAIN], 0.2, 0.3, 6);
}

static void test_under_cover_it_stays_dry(void **state)
{
    (void)state;
    weather.spots = 0.01;
    run_s(100);
    check(&cells[VIRGA_GROUND_MATERIALS + PLAIN], 0, 0, 0);
    assert_true(cells[VIRGA_GROUND_MATERIALS + PLAIN].spots == 0);
}

static void test_without_rain_nothing_comes(void **state)
{
    (void)state;
    weather.rain_nl = 0;
    weather.evaporation_nl = 1;
    run_s(100);
    check(&cells[PLAIN], 0, 0, 0);
}

/* A film and puddles go down evenly, then pores dry ever slower: e^(-t / T), T what they hold over the evaporation. */
static void test_it_dries(void **state)
{
    (void)state;
    virga_ground_settings settings = {.start_water_mm = 1};
    ground_standing_start(cells, &settings, soils);
    check(&cells[PLAIN], 0.2, 0.15, 1);
    weather.rain_nl = 0;
    weather.evaporation_nl = 0.001 * MM * TICK_S; /* 1 um a second */
    run_s(100);
    check(&cells[PLAIN], 0.2, 0.05, 0.9);
    run_s(50 + 200);
    check(&cells[PLAIN], 0.2 * exp(-1), 0, 0.65);
    check(&cells[VIRGA_GROUND_MATERIALS + PLAIN], 0.2 * exp(-1), 0, 0.65);
}

static void test_what_sinks_faster_than_it_rains_leaves_none(void **state)
{
    (void)state;
    soils[PLAIN].sink_nl_s = (float)(0.02 * MM);
    run_s(100);
    check(&cells[PLAIN], 0.2, 0, 0);
    virga_ground_settings settings = {.start_water_mm = 1};
    ground_standing_start(cells, &settings, soils);
    run_s(50); /* 0.01 mm a second less */
    check(&cells[PLAIN], 0.2, 0, 0.5);
}

static void test_a_drain_holds_nothing(void **state)
{
    (void)state;
    virga_ground_settings settings = {.start_water_mm = 1};
    soils[PLAIN].drain = 1;
    ground_standing_start(cells, &settings, soils);
    run_s(100);
    check(&cells[PLAIN], 0.2, 0, 0);
}

/* As many spots as come with the rain, and none when it is dry. */
static void test_spots_come_and_go(void **state)
{
    (void)state;
    weather.spots = 0.001;
    run_s(5);
    assert_float_equal(cells[PLAIN].spots, 0.3, 1e-9);
    weather = (ground_weather){.evaporation_nl = 0.05 * MM, .tick_s = TICK_S, .nl_per_um = NL_PER_UM};
    soils[PLAIN].capacity_nl = 1;
    cells[PLAIN].held_nl = 0;
    run_s(1);
    assert_true(cells[PLAIN].spots == 0);
}

static void test_the_device_gets_shares(void **state)
{
    (void)state;
    virga_standing_gpu out[GROUND_STANDING];
    cells[PLAIN] = (ground_standing){.held_nl = 0.05 * MM, .film_nl = 7, .level_um = 9, .spots = 0.5};
    ground_standing_fill(cells, soils, out);
    assert_float_equal(out[PLAIN].held, 0.25, 1e-6);
    assert_true(out[PLAIN].film_nl == 7 && out[PLAIN].level_um == 9 && out[PLAIN].spots == 0.5f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_pores_fill_then_a_film_then_hollows, begin),
        cmocka_unit_test_setup(test_hollows_hold_what_came, begin),
        cmocka_unit_test_setup(test_hollows_that_are_full_run_over, begin),
        cmocka_unit_test_setup(test_under_cover_it_stays_dry, begin),
        cmocka_unit_test_setup(test_without_rain_nothing_comes, begin),
        cmocka_unit_test_setup(test_it_dries, begin),
        cmocka_unit_test_setup(test_what_sinks_faster_than_it_rains_leaves_none, begin),
        cmocka_unit_test_setup(test_a_drain_holds_nothing, begin),
        cmocka_unit_test_setup(test_spots_come_and_go, begin),
        cmocka_unit_test_setup(test_the_device_gets_shares, begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
