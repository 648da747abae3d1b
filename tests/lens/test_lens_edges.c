/* test_lens_edges.c - edges of depth: nothing bleeds over what is in front of it, and what a near blur uncovers is
 * filled in. */
#include "lens_bar.h"

/* A gray wall in focus with a pole of one pixel before lamps at infinity: a test chart of 64 x 32 pixels. */
static void a_thin_pole_in_focus_keeps_its_color_before_bright_lamps(void **state)
{
    (void)state;
    for (int half = 0; half < 2; half++) {
        lens_fixture f;
        lens_fixture_open(&f, 64, 32, half);
        lens_paint_all(&f.scene, 500, 0);
        for (uint32_t y = 0; y < 32; y++)
            lens_paint(&f.scene, 32, y, 0.25f, 1);
        lens_fixture_run(&f);
        for (uint32_t y = 0; y < 32; y++)
            for (uint32_t x = 0; x < 64; x++) /* and the pole does not darken what is behind it */
                assert_float_equal(lens_result(&f, x, y), x == 32 ? 0.25 : 500, x == 32 ? 1e-3 : 0.5);
        lens_fixture_close(&f);
    }
}

static void a_lamp_before_a_wall_in_focus_covers_it_with_its_disc(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 64, 64, false);
    lens_paint_all(&f.scene, 0.5f, 1);
    lens_paint(&f.scene, 32, 32, 1000, 0.5); /* a radius of 10 px */
    lens_fixture_run(&f);
    const double disc = 1000 / (M_PI * 100);
    assert_float_equal(lens_result(&f, 32, 32), 0.5 + disc, 0.05 * disc);
    assert_float_equal(lens_result(&f, 39, 32), 0.5 + disc, 0.05 * disc);
    assert_float_equal(lens_result(&f, 44, 32), 0.5, 1e-3);
    assert_float_equal(lens_light(f.result, &f), 1000 + 0.5 * 64 * 64, 3);
    lens_fixture_close(&f);
}

static void a_hole_in_a_wall_in_focus_lets_no_blur_out(void **state)
{
    (void)state;
    for (int half = 0; half < 2; half++) {
        lens_fixture f;
        lens_fixture_open(&f, 64, 64, half);
        lens_paint_all(&f.scene, 0.5f, 1);
        for (uint32_t y = 27; y < 36; y++) /* not at the edges of texels */
            for (uint32_t x = 27; x < 36; x++)
                lens_paint(&f.scene, x, y, 100, 0);
        lens_fixture_run(&f);
        for (uint32_t y = 0; y < 64; y++)
            for (uint32_t x = 0; x < 64; x++) {
                const bool hole = x >= 27 && x < 36 && y >= 27 && y < 36;
                assert_float_equal(lens_result(&f, x, y), hole ? 100 : 0.5, hole ? 0.1 : 1e-3);
            }
        lens_fixture_close(&f);
    }
}

/* Half of the picture is a white thing in front, 10 px out of focus, before a gray wall in focus. Its edge is soft on
 * both sides: by the area of a disc left of a chord. */
static void a_near_edge_is_soft_on_both_sides_and_shows_the_wall(void **state)
{
    (void)state;
    for (int half = 0; half < 2; half++) {
        lens_fixture f;
        lens_fixture_open(&f, 64, 48, half);
        for (uint32_t y = 0; y < 48; y++)
            for (uint32_t x = 0; x < 64; x++)
                lens_paint(&f.scene, x, y, x < 32 ? 1 : 0.25f, x < 32 ? 0.5 : 1);
        lens_fixture_run(&f);
        for (uint32_t x = 16; x < 48; x++) {
            const double chord = fmin(fmax(((double)x - 31.5) / 10, -1), 1);
            const double near = (acos(chord) - chord * sqrt(1 - chord * chord)) / M_PI;
            assert_float_equal(lens_result(&f, x, 24), 0.25 + 0.75 * near, half ? 0.03 : 0.02);
        }
        lens_fixture_close(&f);
    }
}

/* In the full resolution, and in half of it. */
static void what_is_little_before_the_focus_is_seen_through_what_is_far_before_it(void **state)
{
    static float before[LENS_BAR_WIDTH];
    (void)state;
    for (int half = 0; half < 2; half++) {
        lens_fixture f;
        double changes = 0, apart = 0;
        lens_fixture_open(&f, LENS_BAR_WIDTH, LENS_BAR_HEIGHT, half);
        for (int step = 0; step < LENS_BAR_STEPS; step++) {
            lens_paint_bar(&f.scene, 1, 10, 12, step);
            lens_fixture_run(&f);
            lens_look_at_bar(&f, 10, 12, step, before, &changes, &apart);
        }
        printf("half %d: up to %.4f apart, a step changes up to %.4f\n", half, apart, changes);
        assert_true(apart < (half ? 0.04 : 0.025) && changes < (half ? 0.03 : 0.01));
        lens_fixture_close(&f);
    }
}

static void layers_never_mix_with_the_black_around_them(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 64, 64, false);
    lens_paint_all(&f.scene, 1, 1);
    const lens_picture *drops = lens_fixture_layer(&f, 0.5f);
    for (uint32_t y = 20; y < 44; y++)
        for (uint32_t x = 20; x < 44; x++)
            lens_paint(drops, x, y, 1, 0);
    lens_fixture_run(&f);
    for (uint32_t y = 0; y < 64; y++)
        for (uint32_t x = 0; x < 64; x++)
            assert_float_equal(lens_result(&f, x, y), 1, 2e-3); /* white over white stays white */
    lens_fixture_close(&f);
}

static void a_layer_is_blurred_by_its_own_depth_and_keeps_its_light(void **state)
{
    (void)state;
    for (int own_depths = 0; own_depths < 2; own_depths++) {
        lens_fixture f;
        lens_fixture_open(&f, 64, 64, false);
        lens_paint_all(&f.scene, 0, 1);
        const lens_picture *rain = lens_fixture_layer(&f, own_depths ? 0 : 0.5f);
        lens_paint(rain, 32, 32, 10, 0.5);
        lens_fixture_run(&f);
        assert_float_equal(lens_light(f.result, &f), 10, 0.02);
        assert_float_equal(lens_result(&f, 38, 32), 10 / (M_PI * 100), 1e-3);
        assert_float_equal(lens_result(&f, 44, 32), 0, 1e-4);
        lens_fixture_close(&f);
    }
}

static void what_is_near_covers_a_layer_behind_it(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 48, 48, false);
    lens_paint_all(&f.scene, 0.25f, 0.4); /* all of it is in front of the layer */
    lens_paint_all(lens_fixture_layer(&f, 1), 5, 0);
    lens_fixture_run(&f);
    assert_float_equal(lens_result(&f, 24, 24), 0.25, 1e-3);
    f.layer_depths_m[0] = 0.3f;
    lens_fixture_run(&f);
    assert_float_equal(lens_result(&f, 24, 24), 5, 0.01); /* discs of blocks overlap to 0.2 %, see blocks.glsl */
    lens_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_thin_pole_in_focus_keeps_its_color_before_bright_lamps),
        cmocka_unit_test(a_lamp_before_a_wall_in_focus_covers_it_with_its_disc),
        cmocka_unit_test(a_hole_in_a_wall_in_focus_lets_no_blur_out),
        cmocka_unit_test(a_near_edge_is_soft_on_both_sides_and_shows_the_wall),
        cmocka_unit_test(what_is_little_before_the_focus_is_seen_through_what_is_far_before_it),
        cmocka_unit_test(layers_never_mix_with_the_black_around_them),
        cmocka_unit_test(a_layer_is_blurred_by_its_own_depth_and_keeps_its_light),
        cmocka_unit_test(what_is_near_covers_a_layer_behind_it),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
