/* test_lens_blocks.c - wide discs from blocks of texels, against discs from single texels in double precision. */
#include "lens_reference.h"

#define FOCUS_M 0.25

/* A view depth (m) at which discs have a radius (px), less than 0 in front of the focus. */
static double depth_of(double radius)
{
    return 1 / (1 / FOCUS_M - radius / 10);
}

/* Five walls beside each other, of noise with a few lamps. */
static void paint_walls(lens_fixture *f, const double radii[5])
{
    uint32_t hash = 7;
    for (uint32_t y = 0; y < f->scene.height; y++)
        for (uint32_t x = 0; x < f->scene.width; x++) {
            const double random = lens_random(&hash);
            lens_paint(&f->scene, x, y, random > 0.98 ? 20 : (float)random, depth_of(radii[5 * x / f->scene.width]));
        }
}

/* What lies behind a near wall is made up of what is around it, of blocks too. In its last columns those are of two
 * walls in one, and they are not compared. */
static bool is_made_up(const double radii[5], uint32_t x, uint32_t columns)
{
    const uint32_t wall = 5 * x / columns;
    return radii[wall] < 0 && wall < 4 && 5 * (x + 2) / columns != wall;
}

static void check_walls(const double radii[5], uint32_t blades)
{
    lens_fixture f;
    double worst = 0, sum = 0;
    lens_fixture_open(&f, 91, 45, false); /* no whole number of blocks */
    f.settings.max_radius_px = 40;
    f.settings.blades = blades;
    f.settings.blade_roundness = 0.3f;
    f.settings.focus_m = (float)FOCUS_M;
    paint_walls(&f, radii);
    lens_fixture_run(&f);
    for (uint32_t y = 0; y < f.scene.height; y += 3)
        for (uint32_t x = y % 2; x < f.scene.width; x += 2) {
            const double error = fabs(lens_result(&f, x, y) - lens_reference(&f, (int)x, (int)y));
            worst = fmax(worst, is_made_up(radii, x, f.scene.width) ? 0 : error);
            sum += error / (15 * 45.5);
        }
    print_message("%u blades: worst %.4f, mean %.4f of about 0.9\n", blades, worst, sum);
    assert_true(worst < 0.1 && sum < 0.015);
    lens_fixture_close(&f);
}

static void wide_discs_are_those_of_single_texels(void **state)
{
    (void)state;
    const double even[5] = {20, 20, 20, 20, 20}, behind[5] = {9, 30, 18, 12, 38}, both[5] = {-14, 0, 20, -30, 35};
    check_walls(even, 0);
    check_walls(behind, 0);
    check_walls(behind, 5);
    check_walls(both, 0);
}

/* A lamp whose disc has a radius of 20 px goes through three blocks, behind the focus and in front of it. */
static void the_disc_of_a_lamp_moves_as_the_lamp_does(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 80, 64, false);
    for (int side = -1; side <= 1; side += 2)
        for (uint32_t step = 0; step < 9; step++) {
            double light = 0, place = 0;
            f.settings.focus_m = (float)FOCUS_M;
            lens_paint_all(&f.scene, 0, depth_of(20 * side));
            lens_paint(&f.scene, 35 + step, 31, 1000, depth_of(20 * side));
            lens_fixture_run(&f);
            for (uint32_t i = 0; i < 80 * 64; i++) {
                light += lens_result(&f, i % 80, i / 80);
                place += lens_result(&f, i % 80, i / 80) * (i % 80);
            }
            assert_float_equal(light, 1000, 1.5);
            assert_float_equal(place / light, 35 + step, 0.05);
            assert_float_equal(lens_result(&f, 35 + step - 18, 31), 1000 / (M_PI * 400), 0.01); /* an even disc */
            assert_float_equal(lens_result(&f, 35 + step + 22, 31), 0, 0.001);                  /* with a sharp edge */
        }
    lens_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wide_discs_are_those_of_single_texels),
        cmocka_unit_test(the_disc_of_a_lamp_moves_as_the_lamp_does),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
