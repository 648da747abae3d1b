/* test_rain_walls.c - driving rain on walls: the flux is that of the drops, and its water adds up to the nanolitre. On
 * the host: no device. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <setjmp.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rain/rain_internal.h"

#include <virga/material.h>

static const double pi = 3.14159265358979323846, tick_s = 1.0 / 60;
static rain_classes classes;

static virga_rain_settings weather(float rate_mm_h, float wind_x, float wind_z, float gust)
{
    virga_rain_settings s = {
        .rate_mm_h = rate_mm_h, .wind_m_s = {wind_x, 0, wind_z}, .gust_m_s = gust, .gust_time_s = 4};
    s.walls = (virga_walls_settings){.on = true, .share = 1, .evaporation_mm_h = 0.2f};
    rain_walls_default(s.walls.materials);
    rain_classes_init(&classes, 1, 4096, 40);
    rain_classes_set_rain(&classes, &s.sizes, (double)rate_mm_h, 0, 0);
    const double wind[3] = {(double)wind_x, 0, (double)wind_z};
    rain_classes_settle(&classes, wind);
    return s;
}

/* Steps of 1 um over the sizes, as many as there are drops per volume: what falls on level ground is the rate. */
static double expected_mm_h(double rate_mm_h, double toward_m_s)
{
    enum { STEPS = 6600 };
    static double diameters[STEPS], densities[STEPS];
    const virga_sizes sizes = {.kind = VIRGA_SIZES_MARSHALL_PALMER};
    double water = 0, fall = 0;
    for (int i = 0; i < STEPS; i++)
        diameters[i] = VIRGA_DROP_MIN_M + (i + 0.5) * 1e-6;
    assert_int_equal(virga_sizes_densities(&sizes, rate_mm_h, 0, STEPS, diameters, densities), VIRGA_OK);
    for (int i = 0; i < STEPS; i++) {
        water += densities[i] * virga_drop_volume(diameters[i]);
        fall += densities[i] * virga_drop_volume(diameters[i]) * virga_drop_terminal_speed(diameters[i], 0);
    }
    return rate_mm_h * toward_m_s * water / fall;
}

static void a_wall_gets_the_water_in_the_air_times_the_wind(void **state)
{
    (void)state;
    const float rates[3] = {2, 10, 50};
    for (int i = 0; i < 3; i++) {
        double flux[VIRGA_WALL_ROWS];
        weather(rates[i], -3, 4, 0);
        rain_walls_flux(&classes, 1, flux);
        assert_true(fabs(flux[VIRGA_WALL_LEVEL] * 3600 / (double)rates[i] - 1) < 1e-6);
        for (int side = 0; side < VIRGA_WALL_SIDES; side++) {
            const double turn = 2 * pi * side / VIRGA_WALL_SIDES, toward = 3 * cos(turn) - 4 * sin(turn);
            const double expected = expected_mm_h((double)rates[i], fmax(toward, 0));
            assert_true(fabs(flux[side] * 3600 - expected) < 0.01 * expected_mm_h((double)rates[i], 5));
        }
        /* The formula of ISO 15927-3 was made for rain as Best has it. */
        const double formula = 2.0 / 9 * 5 * pow((double)rates[i], 0.88);
        printf("%g mm/h: %.3f mm/h on a wall, the formula has %.3f\n", (double)rates[i],
               expected_mm_h((double)rates[i], 5), formula);
        assert_true(fabs(expected_mm_h((double)rates[i], 5) / formula - 1) < 0.25);
    }
}

/* The mean over gusts is that of many gusts: a wall in the lee gets some, too. */
static void gusts_count_before_the_first_tick(void **state)
{
    (void)state;
    enum { GRID = 400 };
    virga_rain_settings s = weather(20, -1, 0, 1);
    static rain_walls walls;
    s.walls.start_h = 1;
    rain_walls_begin(&walls, &classes, &s);
    for (int side = 0; side < VIRGA_WALL_SIDES; side += 4) {
        double mean = 0, sum = 0;
        for (int i = 0; i < GRID; i++) { /* of a normal distribution along the wall's normal */
            const double gust = 12 * (i + 0.5) / GRID - 6, weight = exp(-0.5 * gust * gust);
            sum += weight;
            mean += weight * expected_mm_h(20, fmax(cos(2 * pi * side / VIRGA_WALL_SIDES) + gust, 0));
        }
        const double fell_mm = (double)walls.walls[side][0].ways_nl[RAIN_WALL_FELL] * 1e-9;
        printf("side %d: %.3f mm, of many gusts %.3f\n", side, fell_mm, mean / sum);
        assert_true(fabs(fell_mm - mean / sum) < 0.05 * expected_mm_h(20, 1));
    }
}

/* A number in [0; 1). */
static double any(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed / 4294967296.0;
}

static void water_adds_up_in_any_weather(void **state)
{
    (void)state;
    static rain_walls walls;
    uint32_t seed = 7;
    virga_rain_settings s = weather(60, 5, 0, 0);
    s.walls.start_h = 0.3f;
    rain_walls_begin(&walls, &classes, &s);
    for (int tick = 0; tick < 1500; tick++) {
        if (tick % 100 == 0) {
            const float rate = any(&seed) < 0.3 ? 0 : (float)(150 * any(&seed));
            s = weather(rate, (float)(40 * any(&seed) - 20), (float)(40 * any(&seed) - 20), 0);
            s.walls.evaporation_mm_h = (float)(100 * any(&seed));
            s.walls.materials[any(&seed) < 0.5 ? 4 : 9].capacity_mm = (float)any(&seed); /* pores that shrink keep it */
        }
        rain_walls_tick(&walls, &classes, &s, tick_s);
    }
    uint64_t dried = 0, ran = 0, sunk = 0;
    for (int row = 0; row < VIRGA_WALL_ROWS; row++)
        for (int i = 0; i < VIRGA_WALL_MATERIALS; i++) {
            const rain_wall *w = &walls.walls[row][i];
            const uint64_t *ways = w->ways_nl;
            assert_true(ways[RAIN_WALL_FELL] == w->pores_nl + w->film_nl + ways[RAIN_WALL_DRIED] +
                                                    ways[RAIN_WALL_SUNK] + ways[RAIN_WALL_RAN_OFF]);
            dried += ways[RAIN_WALL_DRIED];
            ran += ways[RAIN_WALL_RAN_OFF];
            sunk += ways[RAIN_WALL_SUNK];
        }
    assert_true(dried && ran && sunk);
}

/* 0.4 mm of pores and 0.06 mm that cling to wood: then as much runs off as comes, less what sinks and dries. */
static void a_dry_wall_fills_then_runs(void **state)
{
    (void)state;
    static rain_walls walls;
    virga_rain_settings s = weather(30, -4, 0, 0);
    const virga_wall_material *wood = &s.walls.materials[VIRGA_MATERIAL_WOOD];
    const rain_wall *facing = &walls.walls[0][VIRGA_MATERIAL_WOOD];
    rain_walls_begin(&walls, &classes, &s);
    double flux[VIRGA_WALL_ROWS];
    rain_walls_flux(&classes, 1, flux);
    const double until_full_s = ((double)wood->capacity_mm + (double)wood->film_mm) / flux[0];
    for (int tick = 0; tick < 0.9 * until_full_s / tick_s; tick++)
        rain_walls_tick(&walls, &classes, &s, tick_s);
    assert_true(facing->ways_nl[RAIN_WALL_RAN_OFF] == 0 && facing->pores_nl > 350000000);
    for (int tick = 0; tick < 0.4 * until_full_s / tick_s; tick++)
        rain_walls_tick(&walls, &classes, &s, tick_s);
    const uint64_t before = facing->ways_nl[RAIN_WALL_RAN_OFF];
    rain_walls_tick(&walls, &classes, &s, tick_s);
    const double lost = ((double)wood->sink_mm_h + 0.2 * (double)wood->drying) / 3600;
    const double running = (double)(facing->ways_nl[RAIN_WALL_RAN_OFF] - before) * 1e-9 / tick_s;
    assert_true(fabs(running / (flux[0] - lost) - 1) < 0.01);
    const rain_wall *lee = &walls.walls[VIRGA_WALL_SIDES / 2][VIRGA_MATERIAL_WOOD];
    assert_true(lee->ways_nl[RAIN_WALL_FELL] == 0 && lee->pores_nl == 0);
}

/* The line of fall is that of the drops, whatever the slope of the rain's spread. */
static void the_slant_is_that_of_the_rain(void **state)
{
    (void)state;
    static virga_rain rain;
    static virga_walls seen;
    rain.settings = weather(10, 3, -1, 0);
    rain_walls_begin(&rain.walls, &classes, &rain.settings);
    virga_rain_walls_get(&rain, &seen);
    /* The drops that bring the most water have 1 to 3 mm, and fall at 4 to 8 m/s. */
    assert_true(seen.slant[0] > 3.0f / 8 && seen.slant[0] < 3.0f / 4);
    assert_true(fabsf(seen.slant[1] / seen.slant[0] + 1.0f / 3) < 1e-3f);
    assert_true(seen.spread > 0.02f && seen.spread < 0.3f);
    const float calm = seen.spread;
    rain.settings.gust_m_s = 2;
    rain_walls_begin(&rain.walls, &classes, &rain.settings);
    virga_rain_walls_get(&rain, &seen);
    assert_true(seen.spread > 1.5f * calm);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_gets_the_water_in_the_air_times_the_wind),
        cmocka_unit_test(gusts_count_before_the_first_tick),
        cmocka_unit_test(water_adds_up_in_any_weather),
        cmocka_unit_test(a_dry_wall_fills_then_runs),
        cmocka_unit_test(the_slant_is_that_of_the_rain),
    };
    return cmocka_run_group_tests_name("rain walls", tests, NULL, NULL);
}
