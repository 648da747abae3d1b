/* test_focus.c - the points of a lens that sub-frames look from: in the aperture, and even over it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "shot/focus.h"

/* Whether a point is inside a regular polygon whose first blade's middle is at `turn`, and its corners at 1. */
static bool in_polygon(const double point[2], uint32_t sides, double turn)
{
    for (uint32_t i = 0; i < sides; i++) {
        const double angle = turn + 2 * M_PI * i / sides;
        if (point[0] * cos(angle) + point[1] * sin(angle) > cos(M_PI / sides) + 1e-9)
            return false;
    }
    return true;
}

/* Half of them are in the circle of half the area. */
static void points_of_a_round_lens_are_even(void **state)
{
    (void)state;
    const scene_camera camera = {.blades = 0};
    double sum[2] = {0, 0}, point[2];
    uint32_t inner = 0;
    for (uint32_t i = 0; i < 256; i++) {
        shot_lens_point(&camera, i, 256, point);
        const double distance = hypot(point[0], point[1]);
        assert_true(distance <= 1);
        inner += distance < sqrt(0.5);
        sum[0] += point[0];
        sum[1] += point[1];
    }
    assert_in_range(inner, 124, 132);
    assert_true(hypot(sum[0], sum[1]) / 256 < 0.01);
    shot_lens_point(&camera, 128, 256, point);
    assert_true(point[0] == 0 && point[1] == 0);
}

/* They fill it: some lie close to each corner. */
static void points_of_a_lens_with_blades_have_its_shape(void **state)
{
    (void)state;
    const scene_camera camera = {.blades = 5, .blade_rotation_deg = 20};
    double point[2], farthest[5] = {0};
    for (uint32_t i = 0; i < 256; i++) {
        shot_lens_point(&camera, i, 256, point);
        assert_true(in_polygon(point, 5, 20 * M_PI / 180));
        for (int k = 0; k < 5; k++) {
            const double angle = (20 + 36 + 72 * k) * M_PI / 180;
            farthest[k] = fmax(farthest[k], point[0] * cos(angle) + point[1] * sin(angle));
        }
    }
    for (int k = 0; k < 5; k++)
        assert_true(farthest[k] > 0.9);
}

/* In the middle of the picture all light comes through. In a corner, what is left is the area of two discs whose
 * centres are as far apart as the cat's eye says: 2 acos(d/2) - d/2 sqrt(4 - d^2) of pi. */
static void a_cats_eye_cuts_the_corners(void **state)
{
    (void)state;
    const scene_camera camera = {.cats_eye = 0.6};
    const double left = (2 * acos(0.3) - 0.3 * sqrt(4 - 0.36)) / M_PI;
    double middle = 0, corner = 0;
    for (uint32_t i = 0; i < 256; i++) {
        float weights[32 * 16];
        double point[2];
        shot_lens_point(&camera, i, 256, point);
        shot_lens_weights(&camera, point, 32, 16, weights);
        middle += (double)weights[8 * 32 + 16] / 256;
        corner += (double)weights[0] / 256;
    }
    assert_true(middle > 0.95);
    assert_float_equal(corner, left, 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_of_a_round_lens_are_even),
        cmocka_unit_test(points_of_a_lens_with_blades_have_its_shape),
        cmocka_unit_test(a_cats_eye_cuts_the_corners),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
