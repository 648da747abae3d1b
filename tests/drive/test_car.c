/* test_car.c - the sample's car: it keeps to the way, stands on it, and moves as it says that it does. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "car.h"

static track load(const char *path)
{
    track t;
    char error[512];
    if (!track_load(path, &t, error, sizeof error))
        fail_msg("%s", error);
    return t;
}

/* A lap by itself, never so far off that it would be pushed back, and around within ten minutes. */
static void drive_a_lap(const char *path)
{
    track t = load(path);
    car c;
    const car_keys none = {0};
    uint32_t steps = 0, before = 0;
    bool around = false;
    for (car_place(&c, &t, 10); !around && steps < 36000; steps++, before = c.nearest) {
        car_drive(&c, &t, &none, 1.0 / 60);
        const double off =
            hypot((double)t.points[c.nearest][0] - c.position_m[0], (double)t.points[c.nearest][2] - c.position_m[2]);
        if (off > 0.95 * t.half_width_m)
            fail_msg("%.2f m off the way at %.1f, %.1f", off, c.position_m[0], c.position_m[2]);
        around = c.nearest < 20 && before > t.count - 20;
    }
    assert_true(around);
    track_free(&t);
}

static void the_car_keeps_to_its_way(void **state)
{
    (void)state;
    drive_a_lap(DRIVE_ASSETS "/scenes/street.track");
    drive_a_lap(DRIVE_ASSETS "/scenes/street-1.track");
}

/* Way is speed times time, to the 1 % that a step of 1/60 s leaves while it speeds up; the axes stay a rotation. */
static void velocity_is_that_of_the_way(void **state)
{
    (void)state;
    track t = load(DRIVE_ASSETS "/scenes/street.track");
    car c;
    const car_keys gas = {.gas = true};
    car_place(&c, &t, 30);
    for (int i = 0; i < 60; i++) {
        const double x = c.position_m[0], z = c.position_m[2];
        car_drive(&c, &t, &gas, 1.0 / 60);
        const double way = hypot(c.position_m[0] - x, c.position_m[2] - z) * 60;
        assert_true(fabs(way - c.speed_m_s) < 0.01 * c.speed_m_s + 1e-6);
        double length = 0, across = 0;
        for (int k = 0; k < 3; k++) {
            length += (double)c.velocity_m_s[k] * (double)c.velocity_m_s[k];
            across += (double)c.axes[k] * (double)c.axes[6 + k];
        }
        assert_true(fabs(sqrt(length) - c.speed_m_s) < 1e-4 && fabs(across) < 1e-6);
    }
    assert_false(c.autopilot);
    track_free(&t);
}

static double dot(const float a[3], const float b[3])
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

/* All four rotate about axles that point out of the car, at one height. A wheel's lowest point, fixed to the wheel,
 * moves backwards as far as the car moves forwards: it does not slide. */
static void wheels_roll(void **state)
{
    (void)state;
    track t = load(DRIVE_ASSETS "/scenes/street.track");
    car c;
    const car_keys gas = {.gas = true};
    car_place(&c, &t, 30);
    for (int i = 0; i < 60; i++)
        car_drive(&c, &t, &gas, 1.0 / 60);
    const double dt_s = 1e-3, way_m = c.speed_m_s * dt_s;
    double before[4][3], after[3];
    float axes[4][9], rolled[9];
    for (int wheel = 0; wheel < 4; wheel++)
        car_wheel(&c, wheel, before[wheel], axes[wheel]);
    car next = c;
    car_drive(&next, &t, &gas, dt_s);
    for (int wheel = 0; wheel < 4; wheel++) {
        const float *a = axes[wheel];
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(dot(a + 3 * i, a + 3 * i) - 1) < 1e-5);
            assert_true(fabs(dot(a + 3 * i, a + 3 * ((i + 1) % 3))) < 1e-5);
        }
        assert_true(dot(a, c.axes) * (wheel % 2 ? 1 : -1) > 0.7);
        car_wheel(&next, wheel, after, rolled);
        const double radius = dot(c.axes + 3, (const float[3]){(float)(before[wheel][0] - c.position_m[0]),
                                                               (float)(before[wheel][1] - c.position_m[1]),
                                                               (float)(before[wheel][2] - c.position_m[2])});
        float low[3], moved[3]; /* the lowest point in the wheel's own axes, and how far it gets */
        for (int i = 0; i < 3; i++)
            low[i] = (float)-radius * (float)dot(a + 3 * i, c.axes + 3);
        for (int k = 0; k < 3; k++) {
            moved[k] = 0;
            for (int i = 0; i < 3; i++)
                moved[k] += low[i] * (rolled[3 * i + k] - a[3 * i + k]);
        }
        assert_true(fabs(dot(moved, c.axes + 6) - way_m) < 0.05 * way_m);
    }
    track_free(&t);
}

static void parts_are_found_by_material(void **state)
{
    (void)state;
    assert_int_equal(car_part_of("paint"), CAR_BODY);
    assert_int_equal(car_part_of("cabin_dash"), CAR_CABIN);
    assert_int_equal(car_part_of("glass_side_frit"), CAR_WINDOWS);
    assert_int_equal(car_part_of("wheel_rim"), CAR_WHEEL);
    assert_int_equal(car_part_of("rain_cover"), CAR_COVER);
    assert_int_equal(car_part_of("rain_screen"), CAR_SCREEN);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_car_keeps_to_its_way),
        cmocka_unit_test(velocity_is_that_of_the_way),
        cmocka_unit_test(wheels_roll),
        cmocka_unit_test(parts_are_found_by_material),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
