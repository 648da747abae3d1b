/* test_plate_light.c - the panorama that is made of a plate: what the picture shows is where the camera looks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "shot/plate_light.h"

enum { WIDTH = 64, HEIGHT = 48, ACROSS = 64, DOWN = 32 };

static float picture[WIDTH * HEIGHT * 4], panorama[ACROSS * DOWN * 3];

/* 50 degrees of height, from the origin to a point. */
static host_camera look_at(double x, double y, double z)
{
    const host_camera_key key = {.look_at_m = {x, y, z}};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 50, .near_m = 0.1, .far_m = 100};
    host_camera camera;
    host_camera_at(&path, 0, WIDTH, HEIGHT, NULL, &camera);
    return camera;
}

/* Red at the left, blue at the right, green in the lower half. */
static void paint(void)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        picture[i * 4] = i % WIDTH < WIDTH / 2 ? 1 : 0;
        picture[i * 4 + 1] = i / WIDTH >= HEIGHT / 2 ? 1 : 0;
        picture[i * 4 + 2] = i % WIDTH < WIDTH / 2 ? 0 : 1;
        picture[i * 4 + 3] = 1;
    }
}

/* Degrees to the right of -Z, and up. */
static void expect(double right, double up, float r, float g, float b)
{
    const int column = (int)floor((right / 360 + 0.5) * ACROSS), row = (int)floor((0.5 - up / 180) * DOWN);
    const float *at = &panorama[(row * ACROSS + column) * 3];
    if (fabsf(at[0] - r) > 0.01f || fabsf(at[1] - g) > 0.01f || fabsf(at[2] - b) > 0.01f)
        fail_msg("%g right and %g up: %.3f %.3f %.3f, expected %.3f %.3f %.3f", right, up, (double)at[0], (double)at[1],
                 (double)at[2], (double)r, (double)g, (double)b);
}

static void the_picture_is_where_the_camera_looks(void **state)
{
    (void)state;
    paint();
    const host_camera ahead = look_at(0, 0, -1), right = look_at(1, 0, 0);
    plate_light_panorama(picture, &ahead, panorama, ACROSS, DOWN);
    expect(-20, 12, 1, 0, 0);
    expect(20, 12, 0, 0, 1);
    expect(-20, -12, 1, 1, 0);
    expect(20, -12, 0, 1, 1);
    plate_light_panorama(picture, &right, panorama, ACROSS, DOWN);
    expect(70, 12, 1, 0, 0);
    expect(110, -12, 0, 1, 1);
}

/* The picture is 63.7 degrees wide: mirrored at 31.9 degrees, its middle comes again at 63.7. */
static void it_goes_on_mirrored(void **state)
{
    (void)state;
    paint();
    const host_camera ahead = look_at(0, 0, -1);
    plate_light_panorama(picture, &ahead, panorama, ACROSS, DOWN);
    expect(45, 12, 0, 0, 1);
    expect(80, 12, 1, 0, 0);
    expect(-45, 12, 1, 0, 0);
    expect(-80, 12, 0, 0, 1);
}

/* The axis of the camera meets the picture at its left edge and a quarter from above, so that all of it is to the right
 * of where the camera looks. 64 pixels at a focal length of 64 are 45 degrees. */
static void a_picture_beside_the_axis_is_beside_it(void **state)
{
    (void)state;
    const host_camera_key key = {.look_at_m = {0, 0, -1}};
    const host_camera_path path = {.keys = &key,
                                   .count = 1,
                                   .fov_deg = 50,
                                   .near_m = 0.1,
                                   .far_m = 100,
                                   .calibration = {{WIDTH, HEIGHT}, {WIDTH, HEIGHT}, {0, HEIGHT / 4.0}}};
    host_camera camera;
    paint();
    host_camera_at(&path, 0, WIDTH, HEIGHT, NULL, &camera);
    plate_light_panorama(picture, &camera, panorama, ACROSS, DOWN);
    expect(12, -7, 1, 0, 0);
    expect(40, 7, 0, 0, 1);
    expect(12, -30, 1, 1, 0);
    expect(-12, 7, 1, 0, 0); /* mirrored */
    expect(80, 7, 1, 0, 0);
}

static void above_and_below_are_means_of_rows(void **state)
{
    (void)state;
    paint();
    const host_camera ahead = look_at(0, 0, -1);
    plate_light_panorama(picture, &ahead, panorama, ACROSS, DOWN);
    for (int right = -175; right < 180; right += 25) {
        expect(right, 70, 0.5f, 0, 0.5f);
        expect(right, -70, 0.5f, 1, 0.5f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_picture_is_where_the_camera_looks),
        cmocka_unit_test(it_goes_on_mirrored),
        cmocka_unit_test(a_picture_beside_the_axis_is_beside_it),
        cmocka_unit_test(above_and_below_are_means_of_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
