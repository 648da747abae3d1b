/* test_lens_half.c - half resolution: tiles of every kind beside each other, and light. test_lens_edges.c has its edges
 * of depth. */
#include "lens_fixture.h"

static void paint_noise(lens_fixture *f, uint32_t from, uint32_t to, double depth_m)
{
    uint32_t hash = 5;
    for (uint32_t y = 0; y < f->scene.height; y++)
        for (uint32_t x = from; x < to; x++)
            lens_paint(&f->scene, x, y, (float)(int)(100 * lens_random(&hash)) / 64, depth_m);
}

/* A noisy wall in focus, a dark sky with a lamp behind it to the right, and a lamp before it to the left: tiles (32 px)
 * that are sharp, far only, and near. In the next frame all is in focus, then all is far: lists do not stay. */
static void tiles_that_are_sharp_far_and_near_are_beside_each_other(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 256, 96, true);
    for (int frame = 0; frame < 3; frame++) {
        lens_paint_all(&f.scene, 0, frame == 2 ? 0 : 1);
        paint_noise(&f, 80, 160, frame == 2 ? 0 : 1);
        for (uint32_t y = 0; y < 96 && !frame; y++)
            for (uint32_t x = 160; x < 256; x++)
                lens_paint(&f.scene, x, y, 0, 0);
        lens_paint(&f.scene, 208, 48, 1000, frame == 1 ? 1 : 0);
        lens_paint(&f.scene, 40, 48, 1000, frame == 1 ? 1 : frame ? 0 : 0.5);
        lens_fixture_run(&f);
        double left = 0, right = 0;
        for (uint32_t y = 0; y < 96; y++)
            for (uint32_t x = 0; x < 256; x++) {
                left += x < 64 ? lens_result(&f, x, y) : 0;
                right += x > 184 ? lens_result(&f, x, y) : 0;
                if (frame == 1 || (!frame && x >= 80 && x < 160))
                    assert_float_equal(lens_result(&f, x, y), (double)lens_pixel(&f.scene, x, y)[0], 0);
            }
        assert_float_equal(left, 1000, 1); /* 0.1 % */
        assert_float_equal(right, 1000, 1);
        assert_true(frame == 1 || (lens_result(&f, 208, 48) < 5 && lens_result(&f, 214, 48) > 2));
    }
    lens_fixture_close(&f);
}

/* The tile of the sky to the left of this lamp knows nothing that is near: the lamp's own disc ends before it. The
 * sky's discs do reach the lamp. */
static void a_lamp_a_little_before_the_focus_stays_out_of_the_far_field_around_it(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 128, 64, true);
    lens_paint_all(&f.scene, 0.25f, 0);
    for (uint32_t i = 0; i < 4; i++)
        lens_paint(&f.scene, 72 + i % 2, 32 + i / 2, 1000, 1 / 1.13); /* 1.3 px before the focus; sky: 10 px behind */
    lens_fixture_run(&f);
    for (uint32_t x = 48; x < 64; x++)
        assert_float_equal(lens_result(&f, x, 32), 0.25, 1e-3);
    lens_fixture_close(&f);
}

/* A gray wall in focus, and a lamp before it and one behind it whose discs have these radii (px). */
static void run_lamps_alone(lens_fixture *f, double near_px, double far_px)
{
    lens_paint_all(&f->scene, 0.25f, 1);
    for (uint32_t i = 0; i < 64; i++) {
        lens_paint(&f->scene, 70 + i % 8, 90 + i / 8, 20, 1 / (1 + near_px / 10));
        if (far_px > 0)
            lens_paint(&f->scene, 200 + i % 8, 90 + i / 8, 20, 1 / (1 - far_px / 10));
    }
    lens_fixture_run(f);
}

/* Only tiles that are read are sampled. A picture before it, of which all was bright and out of focus, changes nothing
 * in one of which little is. */
static void nothing_is_left_of_the_picture_before(void **state)
{
    (void)state;
    static const double radii[4][2] = {{3, 0}, {9, 9.5}, {34, 9}, {90, 9.9}};
    for (int i = 0; i < 4; i++) {
        static float alone[4 * 320 * 192];
        for (int after = 0; after < 2; after++) {
            lens_fixture f;
            lens_fixture_open(&f, 320, 192, true);
            f.settings.max_radius_px = 120;
            if (after) {
                lens_paint_all(&f.scene, 60000, 0.5);
                lens_fixture_run(&f);
            }
            run_lamps_alone(&f, radii[i][0], radii[i][1]);
            if (after)
                assert_memory_equal(f.result, alone, sizeof alone);
            memcpy(alone, f.result, sizeof alone);
            lens_fixture_close(&f);
        }
    }
}

/* A wall in focus, and a layer that has grains out of focus, each with a depth of its own. Where it is empty it has a
 * depth in focus too, as a layer of drops has. The light of the layer. */
static double run_grains(bool half_resolution, float *result)
{
    lens_fixture f;
    uint32_t hash = 3;
    lens_fixture_open(&f, 128, 64, half_resolution);
    lens_paint_all(&f.scene, 0, 1);
    const lens_picture *layer = lens_fixture_layer(&f, 0);
    for (size_t i = 0; i < (size_t)128 * 64; i++)
        layer->depth[i] = 1;
    for (int i = 0; i < 60; i++) {
        const uint32_t x = 24 + (uint32_t)(40 * lens_random(&hash)) * 2,
                       y = 16 + (uint32_t)(16 * lens_random(&hash)) * 2;
        for (uint32_t k = 0; k < 4; k++)
            lens_paint(layer, x + k % 2, y + k / 2, 4, 1 / 1.8); /* 8 px */
    }
    lens_fixture_run(&f);
    memcpy(result, f.result, sizeof(float) * 4 * 128 * 64);
    const double light = lens_light(f.result, &f);
    lens_fixture_close(&f);
    return light;
}

static void discs_of_a_layer_cover_what_is_in_focus_there(void **state)
{
    (void)state;
    static float half[4 * 128 * 64], full[4 * 128 * 64];
    const double light = run_grains(true, half), expected = run_grains(false, full);
    double worst = 0, most = 0;
    for (size_t i = 0; i < (size_t)128 * 64; i++) {
        worst = fmax(worst, fabs((double)half[4 * i] - (double)full[4 * i]));
        most = fmax(most, (double)full[4 * i]);
    }
    printf("up to %.3f of %.3f apart, light %.2f of %.2f\n", worst, most, light, expected);
    assert_true(most > 0.2 && worst < 0.15 * most);
    assert_float_equal(light, expected, 0.002 * expected); /* half floats */
}

/* Ground a little in front of the focus, by less than is blurred, drops in focus before it, and a bit of sky in each
 * tile, so that there are discs. */
static void what_is_nearly_in_focus_hides_no_layer(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 64, 64, true);
    lens_paint_all(&f.scene, 0.25f, 1 / 1.03); /* 0.3 px */
    for (uint32_t i = 0; i < 16; i++)
        lens_paint(&f.scene, 14 + i % 2 + i / 2 % 2 * 34, 14 + i / 4 % 2 + i / 8 * 34, 1, 0);
    const lens_picture *layer = lens_fixture_layer(&f, 1);
    for (uint32_t i = 0; i < 16; i++)
        lens_paint(layer, 24 + i % 4 * 4, 24 + i / 4 * 4, 2, 1);
    lens_fixture_run(&f);
    for (uint32_t i = 0; i < 16; i++)
        assert_float_equal(lens_result(&f, 24 + i % 4 * 4, 24 + i / 4 * 4), 2, 1e-3);
    assert_float_equal(lens_result(&f, 8, 8), 0.25, 1e-3);
    lens_fixture_close(&f);
}

/* Through a pole in focus, as it goes out of focus, the sky beside it does not jump. */
static void an_edge_does_not_jump_as_the_focus_moves(void **state)
{
    (void)state;
    lens_fixture f;
    double last = 0;
    lens_fixture_open(&f, 64, 32, true);
    lens_paint_all(&f.scene, 1, 0);
    for (uint32_t i = 0; i < 3 * 32; i++)
        lens_paint(&f.scene, 31 + i % 3, i / 3, 0, 1);
    for (int frame = 0; frame < 48; frame++) {
        f.settings.focus_m = (float)(1 / (1 + 0.3 * frame / 47)); /* up to 3 px */
        lens_fixture_run(&f);
        const double beside = lens_result(&f, 35, 16);
        assert_true(frame == 0 || fabs(beside - last) < 0.06);
        last = beside;
    }
    lens_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_that_are_sharp_far_and_near_are_beside_each_other),
        cmocka_unit_test(a_lamp_a_little_before_the_focus_stays_out_of_the_far_field_around_it),
        cmocka_unit_test(nothing_is_left_of_the_picture_before),
        cmocka_unit_test(discs_of_a_layer_cover_what_is_in_focus_there),
        cmocka_unit_test(what_is_nearly_in_focus_hides_no_layer),
        cmocka_unit_test(an_edge_does_not_jump_as_the_focus_moves),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
