/* test_lens_paper.c - focus as in Sato et al. 2002: equations 1 to 6 in double precision. */
#include "lens_fixture.h"

static const lens_picture *of; /* the picture that is filtered */

static double at(int x, int y, int channel)
{
    const int right = (int)of->width - 1, bottom = (int)of->height - 1;
    x = x < 0 ? 0 : x > right ? right : x;
    y = y < 0 ? 0 : y > bottom ? bottom : y;
    return (double)lens_pixel(of, (uint32_t)x, (uint32_t)y)[channel];
}

/* Equation 1: the cross, or the square, with the weight f in the middle. */
static double filtered(const lens_picture *picture, int x, int y, int channel, int which, double f)
{
    double sum = 0, weights = 0;
    of = picture;
    for (int down = -1; down <= 1; down++)
        for (int right = -1; right <= 1; right++) {
            const double weight = !down && !right ? f : which == 1 && down && right ? 0 : 1;
            sum += weight * at(x + right, y + down, channel);
            weights += weight;
        }
    return sum / weights;
}

/* Equation 2. */
static double blurred_background(const lens_fixture *f, int x, int y)
{
    const double depth_m = 1 / (double)f->scene.depth[y * (int)f->scene.width + x];
    const double difference = fabs(depth_m - (double)f->settings.focus_m);
    of = &f->scene;
    if (difference <= (double)f->settings.threshold_m[0])
        return at(x, y, 0);
    if (difference <= (double)f->settings.threshold_m[1])
        return filtered(&f->scene, x, y, 0, 1, (double)f->settings.filter_weight[0]);
    return filtered(&f->scene, x, y, 0, 2, (double)f->settings.filter_weight[1]);
}

static void a_random_picture_with_drops_is_that_of_equations_1_to_6(void **state)
{
    (void)state;
    lens_fixture f;
    uint32_t hash = 21;
    lens_fixture_open(&f, 33, 25, false);
    f.settings.style = VIRGA_LENS_STYLE_PAPER;
    f.settings.focus_m = 30;
    const lens_picture *drops = lens_fixture_layer(&f, 0.5f);
    for (uint32_t y = 0; y < 25; y++)
        for (uint32_t x = 0; x < 33; x++) {
            lens_paint(&f.scene, x, y, (float)lens_random(&hash), 20 + 60 * lens_random(&hash));
            if (lens_random(&hash) < 0.3) /* equation 3: 1 where there is a drop */
                lens_paint(drops, x, y, (float)lens_random(&hash), 0);
        }
    lens_fixture_run(&f);
    const double weight = (double)f.settings.filter_weight[1];
    for (int y = 0; y < 25; y++)
        for (int x = 0; x < 33; x++) {
            /* Equation 4: f2 over a Iw, divided by f2 over a. Equation 5: f2 over a. Equation 6. */
            const double water = filtered(drops, x, y, 0, 2, weight), alpha = filtered(drops, x, y, 3, 2, weight);
            const double droplet = alpha > 0 ? water / alpha : 0;
            const double expected = (1 - alpha) * blurred_background(&f, x, y) + alpha * droplet;
            assert_float_equal(lens_result(&f, (uint32_t)x, (uint32_t)y), expected, 1e-3);
        }
    lens_fixture_close(&f);
}

static void the_second_filter_is_the_stronger_one(void **state)
{
    (void)state;
    lens_fixture f;
    double spread[2];
    lens_fixture_open(&f, 24, 24, false);
    f.settings.style = VIRGA_LENS_STYLE_PAPER;
    f.settings.focus_m = 1;
    for (int i = 0; i < 2; i++) {
        lens_paint_all(&f.scene, 0, i ? 100 : 10);
        lens_paint(&f.scene, 12, 12, 1, i ? 100 : 10);
        lens_fixture_run(&f);
        spread[i] = 0;
        for (uint32_t y = 0; y < 24; y++)
            for (uint32_t x = 0; x < 24; x++)
                spread[i] += lens_result(&f, x, y) * (pow((double)x - 12, 2) + pow((double)y - 12, 2));
        assert_float_equal(lens_light(f.result, &f), 1, 1e-3);
    }
    assert_float_equal(spread[0], 0.8, 1e-3);
    assert_float_equal(spread[1], 12.0 / 13, 1e-3);
    lens_fixture_close(&f);
}

static void drops_in_focus_are_sharp(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 24, 24, false);
    f.settings.style = VIRGA_LENS_STYLE_PAPER;
    f.settings.focus_m = 1;
    lens_paint_all(&f.scene, 0, 1);
    lens_paint(lens_fixture_layer(&f, 1), 12, 12, 8, 0);
    lens_fixture_run(&f);
    assert_float_equal(lens_result(&f, 12, 12), 8, 0);
    assert_float_equal(lens_result(&f, 13, 12), 0, 0);
    lens_fixture_close(&f);
}

static void the_sky_is_in_focus_if_the_focus_is_at_infinity(void **state)
{
    (void)state;
    lens_fixture f;
    lens_fixture_open(&f, 24, 24, false);
    f.settings.style = VIRGA_LENS_STYLE_PAPER;
    f.settings.focus_m = 0;
    lens_paint_all(&f.scene, 0, 0);
    lens_paint(&f.scene, 12, 12, 8, 0);
    lens_fixture_run(&f);
    assert_float_equal(lens_result(&f, 12, 12), 8, 0);
    f.settings.focus_m = 10;
    lens_fixture_run(&f);
    assert_float_equal(lens_result(&f, 12, 12), 8 * 5.0 / 13, 1e-2);
    lens_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_random_picture_with_drops_is_that_of_equations_1_to_6),
        cmocka_unit_test(the_second_filter_is_the_stronger_one),
        cmocka_unit_test(drops_in_focus_are_sharp),
        cmocka_unit_test(the_sky_is_in_focus_if_the_focus_is_at_infinity),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
