/* test_lens_physical.c - the blur of a lens: against double precision on random pictures, the size and the light of the
 * discs that lamps become. */
#include "lens_reference.h"

/* The table of areas, which the passes read between its entries. */
static void areas_between_entries_of_the_table_are_within_a_thousandth_from_four_pixels_on(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 16, 16, false);
    f.settings.blades = 6;
    f.settings.blade_rotation_deg = 11;
    REQUIRE(virga_lens_set(f.lens, &f.settings) == VIRGA_OK);
    const float *areas = f.lens->areas;
    for (double radius = 0.5; radius < 40; radius += 0.031) {
        const int entry = (int)(511 * sqrt(radius / 63));
        const double from = pow(entry / 511.0, 2) * 63, to = pow((entry + 1) / 511.0, 2) * 63;
        const double part = (radius - from) / (to - from);
        const double between = (1 - part) * (double)areas[entry] + part * (double)areas[entry + 1];
        const double error = fabs(between / lens_disc_area(&f.settings, radius) - 1);
        assert_true(error < (radius < 4 ? 0.012 : 1e-3));
    }
    lens_fixture_close(&f);
}

static void check_random_picture(uint32_t seed, uint32_t blades)
{
    lens_fixture f;
    uint32_t hash = seed;
    lens_fixture_open(&f, 37, 29, false);
    f.settings.max_radius_px = 5;
    f.settings.blades = blades;
    f.settings.blade_roundness = 0.3f;
    f.settings.blade_rotation_deg = 17;
    for (uint32_t y = 0; y < f.scene.height; y++)
        for (uint32_t x = 0; x < f.scene.width; x++)
            lens_paint(&f.scene, x, y, (float)lens_random(&hash), 0.6 + 3 * lens_random(&hash));
    lens_fixture_run(&f);
    for (uint32_t y = 0; y < f.scene.height; y++)
        for (uint32_t x = 0; x < f.scene.width; x++)
            assert_float_equal(lens_result(&f, x, y), lens_reference(&f, (int)x, (int)y), 3e-3);
    lens_fixture_close(&f);
}

static void a_random_picture_is_that_of_the_reference(void **state)
{
    (void)state;
    check_random_picture(3, 0);
    check_random_picture(4, 5);
}

/* ---- lamps */

/* A lamp in the middle of a dark picture that is all at one depth. Measures the radius of its disc by the second
 * moment, which is r^2 / 2 for a disc and pixels add 1/6, and its light. */
static void measure_lamp(lens_fixture *f, double depth_m, double *radius, double *light)
{
    const uint32_t middle_x = f->scene.width / 2, middle_y = f->scene.height / 2;
    double moment = 0;
    lens_paint_all(&f->scene, 0, depth_m);
    lens_paint(&f->scene, middle_x, middle_y, 1000, depth_m);
    lens_fixture_run(f);
    *light = lens_light(f->result, f);
    for (uint32_t y = 0; y < f->scene.height; y++)
        for (uint32_t x = 0; x < f->scene.width; x++)
            moment += lens_result(f, x, y) * (pow((double)x - middle_x, 2) + pow((double)y - middle_y, 2));
    *radius = sqrt(2 * fmax(moment / *light - 1.0 / 12, 0));
}

static void a_lamp_becomes_a_disc_of_the_thin_lens_with_all_its_light(void **state)
{
    (void)state;
    lens_fixture f;
    double radius, light;
    lens_fixture_open(&f, 96, 96, false);
    f.settings.focus_m = 2;
    f.settings.max_radius_px = 40;
    const double depths_m[] = {0.25, 0.4, 0.7, 1.2, 5, 30, 0};
    for (size_t i = 0; i < sizeof depths_m / sizeof *depths_m; i++) {
        measure_lamp(&f, depths_m[i], &radius, &light);
        assert_float_equal(light, 1000, 1); /* 0.1 % */
        assert_float_equal(radius, 10 * fabs(0.5 - (depths_m[i] > 0 ? 1 / depths_m[i] : 0)), 0.15);
    }
    lens_fixture_close(&f);
}

static void focus_at_infinity_and_at_ten_centimetres(void **state)
{
    (void)state;
    lens_fixture f;
    double radius, light;
    lens_fixture_open(&f, 96, 96, false);
    f.settings.focus_m = 0;
    measure_lamp(&f, 0, &radius, &light);
    assert_float_equal(lens_result(&f, 48, 48), 1000, 0.5);
    measure_lamp(&f, 0.5, &radius, &light);
    assert_float_equal(radius, 20, 0.2);
    f.settings.focus_m = 0.1f;
    measure_lamp(&f, 0.1, &radius, &light);
    assert_float_equal(lens_result(&f, 48, 48), 1000, 0.5);
    measure_lamp(&f, 0.2, &radius, &light); /* 50 px, cut to max_radius_px */
    assert_float_equal(radius, 32, 0.2);
    assert_float_equal(light, 1000, 1);
    lens_fixture_close(&f);
}

static void a_pinhole_changes_nothing(void **state)
{
    (void)state;
    lens_fixture f;
    uint32_t hash = 9;
    lens_fixture_open(&f, 40, 24, false);
    f.settings.aperture_f = 0;
    for (uint32_t y = 0; y < f.scene.height; y++)
        for (uint32_t x = 0; x < f.scene.width; x++)
            lens_paint(&f.scene, x, y, (float)(int)(100 * lens_random(&hash)), 0.2 + 9 * lens_random(&hash));
    lens_fixture_run(&f);
    for (size_t i = 0; i < 4u * 40 * 24; i++)
        assert_float_equal(f.result[i], f.scene.color[i], 0);
    lens_fixture_close(&f);
}

/* Brightness at an offset from the lamp in the middle. */
static double beside_lamp(const lens_fixture *f, double distance, double angle_deg)
{
    const double angle = angle_deg * M_PI / 180;
    return lens_result(f, (uint32_t)lround(48 + distance * cos(angle)), (uint32_t)lround(48 + distance * sin(angle)));
}

static void straight_blades_make_a_polygon_that_is_upside_down_in_front_of_the_focus(void **state)
{
    (void)state;
    lens_fixture f;
    double radius, light;
    lens_fixture_open(&f, 96, 96, false);
    f.settings.blades = 3; /* its middles of blades are at 0, 120 and 240 degrees, half a radius away */
    f.settings.focus_m = 0.5f;
    measure_lamp(&f, 0, &radius, &light); /* 20 px behind */
    assert_true(beside_lamp(&f, 16, 180) > 0 && beside_lamp(&f, 16, 0) == 0);
    measure_lamp(&f, 0.25, &radius, &light); /* 20 px in front */
    assert_true(beside_lamp(&f, 16, 180) == 0 && beside_lamp(&f, 16, 0) > 0);
    assert_float_equal(light, 1000, 1);
    lens_fixture_close(&f);
}

/* The share of the aperture that a barrel leaves at a pixel, where its rim is shifted by so many radii. */
static double open_share(double shift)
{
    const double half = fmin(shift, 2) / 2;
    return 2 / M_PI * (acos(half) - half * sqrt(1 - half * half));
}

/* The light of a lamp's disc under a cat's eye of 1, as a share of its light in focus: the integral of the light that
 * passes the barrel, each point of it divided by the share of the aperture that is open there. `side`: 1 behind the
 * focus, -1 in front of it, where the disc is upside down. */
static double light_through_barrel(double lamp, double radius, double side)
{
    enum { STEPS = 800 };
    double sum = 0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        const double right = 2 * (i % STEPS + 0.5) / STEPS - 1, down = 2 * (i / STEPS + 0.5) / STEPS - 1;
        const double x = (64 - (lamp + 0.5 + side * right * radius)) / hypot(64, 64);
        const double y = (64 - (lamp + 0.5 + side * down * radius)) / hypot(64, 64);
        if (hypot(right, down) <= 1 && hypot(right - x, down - y) <= 1)
            sum += 1 / open_share(hypot(x, y));
    }
    return sum * 4 / (STEPS * STEPS) / M_PI;
}

/* In the middle and near a corner, in front of the focus and behind it: to 0.1 %. */
static void cats_eye_keeps_the_light_that_passes_the_barrel(void **state)
{
    (void)state;
    lens_fixture f;
    double covered[2] = {0};
    lens_fixture_open(&f, 128, 128, false);
    f.settings.cats_eye = 1;
    for (int kind = 0; kind < 4; kind++) {
        const int lamp = kind & 1 ? 24 : 64;
        f.settings.focus_m = kind & 2 ? 1 : 0; /* 10 px behind, or 20 px in front */
        lens_paint_all(&f.scene, 0, kind & 2 ? INFINITY : 0.5f);
        lens_paint(&f.scene, (uint32_t)lamp, (uint32_t)lamp, 1000, kind & 2 ? INFINITY : 0.5f);
        lens_fixture_run(&f);
        const double light = lens_light(f.result, &f) / 1000;
        const double expected = light_through_barrel(lamp, kind & 2 ? 10 : 20, kind & 2 ? 1 : -1);
        print_message("light %.4f, expected %.4f\n", light, expected);
        assert_float_equal(light / expected, 1, 1e-3);
        for (size_t i = 0; i < 128 * 128 && kind < 2; i++)
            covered[kind] += f.result[4 * i] > 0.1f;
    }
    assert_true(covered[1] < 0.8 * covered[0]);
    lens_fixture_close(&f);
}

static void cats_eye_leaves_an_even_picture_even(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 64, 64, false);
    f.settings.focus_m = 0.5f;
    f.settings.cats_eye = 1;
    lens_paint_all(&f.scene, 3, 2);
    lens_fixture_run(&f);
    for (uint32_t i = 0; i < 64; i++)
        assert_float_equal(lens_result(&f, i, i), 3, 5e-3);
    lens_fixture_close(&f);
}

static void half_resolution_keeps_the_light_and_what_is_in_focus(void **state)
{
    (void)state;
    lens_fixture f;
    double radius, light;
    uint32_t hash = 5;
    lens_fixture_open(&f, 96, 96, true);
    measure_lamp(&f, 0.5, &radius, &light);
    assert_float_equal(light, 1000, 1); /* 0.1 % */
    assert_float_equal(radius, 10, 0.5);
    for (uint32_t y = 0; y < 96; y++)
        for (uint32_t x = 0; x < 96; x++)
            lens_paint(&f.scene, x, y, (float)(int)(100 * lens_random(&hash)), 1);
    lens_fixture_run(&f);
    for (size_t i = 0; i < 4u * 96 * 96; i++)
        assert_float_equal(f.result[i], f.scene.color[i], 0);
    lens_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_between_entries_of_the_table_are_within_a_thousandth_from_four_pixels_on),
        cmocka_unit_test(a_random_picture_is_that_of_the_reference),
        cmocka_unit_test(a_lamp_becomes_a_disc_of_the_thin_lens_with_all_its_light),
        cmocka_unit_test(focus_at_infinity_and_at_ten_centimetres),
        cmocka_unit_test(a_pinhole_changes_nothing),
        cmocka_unit_test(straight_blades_make_a_polygon_that_is_upside_down_in_front_of_the_focus),
        cmocka_unit_test(cats_eye_keeps_the_light_that_passes_the_barrel),
        cmocka_unit_test(cats_eye_leaves_an_even_picture_even),
        cmocka_unit_test(half_resolution_keeps_the_light_and_what_is_in_focus),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
