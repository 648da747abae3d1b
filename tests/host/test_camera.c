/* test_camera.c - paths of keys, matrices, and light in harmonics: closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "camera.h"
#include "environment.h"
#include "panorama.h"

static const host_camera_key keys[] = {
    {.time_s = 0.0, .position_m = {0, 1, 0}, .look_at_m = {0, 1, -5}},
    {.time_s = 1.0, .position_m = {4, 1, 0}, .look_at_m = {4, 1, -5}},
    {.time_s = 3.0, .position_m = {4, 2, -9}, .look_at_m = {0, 1, -9}},
    {.time_s = 4.0, .position_m = {100, 1, 0}, .look_at_m = {100, 1, -5}, .cut = true},
    {.time_s = 6.0, .position_m = {110, 1, 0}, .look_at_m = {110, 1, -5}},
};
static const host_camera_path path = {.keys = keys, .count = 5, .fov_deg = 50.0, .near_m = 0.1, .far_m = 500.0};

static void path_at(double time_s, double out[3])
{
    host_camera camera;
    host_camera_at(&path, time_s, 160, 90, NULL, &camera);
    memcpy(out, camera.position_m, sizeof camera.position_m);
}

static void goes_through_keys(void **state)
{
    (void)state;
    double p[3];
    for (int i = 0; i < 5; i++) {
        path_at(keys[i].time_s, p);
        for (int c = 0; c < 3; c++)
            assert_float_equal(p[c], keys[i].position_m[c], 1e-9);
    }
    path_at(-5.0, p);
    assert_float_equal(p[0], 0.0, 0.0);
    path_at(50.0, p);
    assert_float_equal(p[0], 110.0, 0.0);
}

/* Speed before and after a key differ by no more than the step makes them. */
static void speed_is_continuous(void **state)
{
    (void)state;
    const double step = 1e-5;
    double before[3], on[3], after[3];
    path_at(1.0 - step, before);
    path_at(1.0, on);
    path_at(1.0 + step, after);
    for (int c = 0; c < 3; c++)
        assert_float_equal((on[c] - before[c]) / step, (after[c] - on[c]) / step, 1e-3);
}

static void two_keys_are_a_line(void **state)
{
    (void)state;
    double p[3];
    path_at(4.5, p);
    assert_float_equal(p[0], 102.5, 1e-9);
}

static void cut_holds_and_jumps(void **state)
{
    (void)state;
    double p[3];
    path_at(3.999, p);
    assert_float_equal(p[0], 4.0, 1e-9);
    path_at(4.0, p);
    assert_float_equal(p[0], 100.0, 1e-9);
    assert_float_equal(host_camera_shot_start(&path, 5.0), 4.0, 0.0);
    assert_true(isinf(host_camera_shot_start(&path, 3.0)));
}

static void bad_paths(void **state)
{
    (void)state;
    char error[256];
    host_camera_key bad[2] = {keys[0], keys[0]};
    host_camera_path p = {.keys = bad, .count = 2, .fov_deg = 50.0, .near_m = 0.1, .far_m = 500.0};
    assert_false(host_camera_path_check(&p, error, sizeof error));
    assert_non_null(strstr(error, "key 1"));
    bad[1].time_s = 2.0;
    assert_true(host_camera_path_check(&p, error, sizeof error));
    bad[1].position_m[2] = NAN;
    assert_false(host_camera_path_check(&p, error, sizeof error));
    p = (host_camera_path){.keys = keys, .count = 5, .fov_deg = 190.0, .near_m = 0.1, .far_m = 500.0};
    assert_false(host_camera_path_check(&p, error, sizeof error));
    p = (host_camera_path){.keys = keys, .count = 5, .fov_deg = 50.0, .near_m = 1.0, .far_m = 0.5};
    assert_false(host_camera_path_check(&p, error, sizeof error));
    p = (host_camera_path){.keys = keys, .count = 0, .fov_deg = 50.0, .near_m = 0.1, .far_m = 500.0};
    assert_false(host_camera_path_check(&p, error, sizeof error));
}

/* Projects a world point to pixels and depth. */
static void project(const host_camera *camera, const float world[3], float out[3])
{
    float m[16], clip[4];
    host_matrix_multiply(camera->clip_from_view, camera->view_from_world, m);
    for (int r = 0; r < 4; r++)
        clip[r] = m[r] * world[0] + m[4 + r] * world[1] + m[8 + r] * world[2] + m[12 + r];
    out[0] = (clip[0] / clip[3] * 0.5f + 0.5f) * (float)camera->width;
    out[1] = (clip[1] / clip[3] * 0.5f + 0.5f) * (float)camera->height;
    out[2] = clip[2] / clip[3];
}

static void projection(void **state)
{
    (void)state;
    host_camera camera;
    float out[3];
    const float jitter[2] = {0.25f, -0.5f};
    host_camera_at(&path, 0.0, 160, 90, jitter, &camera);
    project(&camera, (const float[3]){0, 1, -10}, out);
    assert_float_equal(out[0], 80.25, 1e-3);
    assert_float_equal(out[1], 44.5, 1e-3);
    assert_float_equal(host_camera_distance(&camera, out[2]), 10.0, 0.01);
    project(&camera, (const float[3]){1, 2, -10}, out); /* right is right and up is up */
    assert_true(out[0] > 81.0f && out[1] < 44.0f);
    project(&camera, (const float[3]){0, 1, -500}, out);
    assert_float_equal(out[2], 1.0, 1e-5);
    assert_true(isinf(host_camera_distance(&camera, 1.0f)));
}

/* A camera that was measured: fx X / Z + cx, and below fy, in a picture of its size and in one half as large. In a
 * window of another aspect the height is the same, and so are the shapes. */
static void a_calibrated_camera_projects_by_its_numbers(void **state)
{
    (void)state;
    const float points[3][3] = {{0.5f, 1.25f, -2}, {-3, 4, -9}, {7, 0.5f, -20}}; /* the camera is at y = 1 */
    host_camera_path own = path;
    own.calibration = (host_camera_calibration){{1242, 376}, {721.5, 702.25}, {609.6, 172.9}};
    for (int half = 0; half < 2; half++)
        for (int i = 0; i < 3; i++) {
            const double x = (double)points[i][0], down = 1 - (double)points[i][1], ahead = -(double)points[i][2];
            const double size = half ? 0.5 : 1;
            const float jitter[2] = {0.25f, -0.5f};
            host_camera camera;
            float out[3];
            host_camera_at(&own, 0, half ? 621 : 1242, half ? 188 : 376, jitter, &camera);
            project(&camera, points[i], out);
            assert_float_equal(out[0], size * (721.5 * x / ahead + 609.6) + 0.25, 1e-3);
            assert_float_equal(out[1], size * (702.25 * down / ahead + 172.9) - 0.5, 1e-3);
            host_camera_at(&own, 0, 188, 188, NULL, &camera);
            project(&camera, points[i], out);
            assert_float_equal(out[0], 0.5 * (721.5 * x / ahead + 609.6 - 621) + 94, 1e-3);
            assert_float_equal(out[1], 0.5 * (702.25 * down / ahead + 172.9), 1e-3);
        }
    assert_true(host_camera_same_aspect(own.calibration.size_px, 621, 188));
    assert_true(host_camera_same_aspect(own.calibration.size_px, 320, 97));
    assert_false(host_camera_same_aspect(own.calibration.size_px, 320, 99));
    assert_false(host_camera_same_aspect(own.calibration.size_px, 188, 188));
}

/* The camera that a calibration in the middle describes is that of the angle of view. */
static void a_calibration_can_be_an_angle_of_view(void **state)
{
    (void)state;
    host_camera a, b;
    host_camera_path own = path;
    const double focal = 45 / tan(25 * 3.14159265358979323846 / 180);
    own.calibration = (host_camera_calibration){{160, 90}, {focal, focal}, {80, 45}};
    host_camera_at(&path, 0.5, 320, 180, NULL, &a);
    host_camera_at(&own, 0.5, 320, 180, NULL, &b);
    for (int i = 0; i < 16; i++)
        assert_float_equal(a.clip_from_view[i], b.clip_from_view[i], 1e-6);
}

/* A roll of 50 degrees a key, through more than a turn: from axes to keys, and at each key the same axes. */
static void keys_of_axes_roll_without_jumps(void **state)
{
    (void)state;
    enum { COUNT = 12 };
    const double pi = 3.14159265358979323846;
    host_camera_key made[COUNT];
    double axes[COUNT][3][3];
    for (int i = 0; i < COUNT; i++) {
        const double turn = 0.3 * i, roll = i * 50 * pi / 180, c = cos(roll), s = sin(roll);
        const double level[3][3] = {{cos(turn), 0, -sin(turn)}, {0, 1, 0}, {sin(turn), 0, cos(turn)}};
        for (int k = 0; k < 3; k++) {
            axes[i][0][k] = c * level[0][k] - s * level[1][k];
            axes[i][1][k] = s * level[0][k] + c * level[1][k];
            axes[i][2][k] = level[2][k];
        }
        made[i] = host_camera_key_of_axes(0.1 * i, (const double[3]){i, 2, 0.5 * i}, axes[i]);
    }
    host_camera_unwrap_rolls(made, COUNT);
    const host_camera_path own = {.keys = made, .count = COUNT, .fov_deg = 50, .near_m = 0.1, .far_m = 100};
    for (int i = 0; i < COUNT; i++) {
        host_camera camera;
        host_camera_at(&own, 0.1 * i, 160, 90, NULL, &camera);
        assert_float_equal(made[i].roll_deg, 50 * i, 1e-3);
        for (int axis = 0; axis < 3; axis++)
            for (int k = 0; k < 3; k++)
                assert_float_equal(camera.view_from_world[4 * k + axis], axes[i][axis][k], 1e-6);
    }
}

/* From a point of a lens, what is in focus at s stays. What is at d moves by lens (1/s - 1/d): right is right,
 * and down is down. */
static void a_point_of_the_lens_keeps_what_is_in_focus(void **state)
{
    (void)state;
    const float points[2][3] = {{0.5f, 1.25f, -2}, {0.5f, 1.25f, -8}};
    const double lens[2] = {0.03, -0.02}, pixels = 45 / tan(25 * 3.14159265358979323846 / 180);
    host_camera before, after;
    host_camera_at(&path, 0.0, 160, 90, NULL, &before);
    after = before;
    host_camera_move_on_lens(&after, lens, 2);
    for (int i = 0; i < 2; i++) {
        float from[3], to[3];
        const double apart = pixels * (0.5 + 1 / (double)points[i][2]);
        project(&before, points[i], from);
        project(&after, points[i], to);
        assert_float_equal(to[0] - from[0], lens[0] * apart, 1e-3);
        assert_float_equal(to[1] - from[1], -lens[1] * apart, 1e-3);
    }
    assert_float_equal(after.position_m[0], 0.03, 1e-6);
    assert_float_equal(after.position_m[1], 0.98, 1e-6);
    after = before;
    host_camera_move_on_lens(&after, lens, 0); /* at infinity nothing but the position changes */
    assert_memory_equal(after.clip_from_view, before.clip_from_view, sizeof before.clip_from_view);
}

/* Of all samples, or of those that stand for `share` each. */
static void mean_jitter(uint32_t count, uint32_t share, double mean_px[2])
{
    mean_px[0] = mean_px[1] = 0;
    for (uint32_t group = 0; group < count / share; group++) {
        float j[2];
        host_camera_jitter(host_camera_jitter_index(group * share, share), count, j);
        for (int axis = 0; axis < 2; axis++) {
            assert_true(fabsf(j[axis]) <= ((count & (count - 1)) == 0 ? 0.5f : 0.505f));
            mean_px[axis] += (double)j[axis] * share / count;
        }
    }
}

static void jitter_moves_no_picture(void **state)
{
    (void)state;
    float single[2];
    for (uint32_t count = 1; count <= 256; count++) {
        double mean_px[2];
        mean_jitter(count, 1, mean_px);
        assert_float_equal(mean_px[0], 0, 1e-6);
        assert_float_equal(mean_px[1], 0, 1e-6);
    }
    host_camera_jitter(0, 1, single);
    assert_true(single[0] == 0.0f && single[1] == 0.0f);
}

static void jitter_that_stands_for_others_moves_no_picture(void **state)
{
    (void)state;
    for (uint32_t count = 4; count <= 256; count += 2) {
        const uint32_t share = count >= 16 && count % 4 == 0 ? 4 : 2;
        const bool whole = (count & (count - 1)) == 0;
        double mean_px[2];
        mean_jitter(count, share, mean_px);
        assert_float_equal(mean_px[0], 0, whole ? 1e-6 : 0.1);
        assert_float_equal(mean_px[1], 0, whole ? 1e-6 : 0.1);
    }
}

/* One in each of as many columns, and rows, as there are samples. */
static void jitter_is_even_along_both_axes(void **state)
{
    (void)state;
    for (uint32_t count = 2; count <= 64; count *= 2)
        for (int axis = 0; axis < 2; axis++) {
            uint64_t found = 0;
            for (uint32_t i = 0; i < count; i++) {
                float j[2];
                host_camera_jitter(i, count, j);
                found |= 1ull << (uint32_t)((j[axis] + 0.5f) * (float)count);
            }
            assert_true(found == (count == 64 ? UINT64_MAX : (1ull << count) - 1));
        }
}

/* A sky of radiance 1 + y/2: irradiance on a level surface is pi (1 + 1/3), beside it pi, below it pi (1 - 1/3). */
static void irradiance(void **state)
{
    (void)state;
    panorama p;
    float sh[9][3], rgb[3];
    assert_true(panorama_alloc(&p, 128, 64));
    for (uint32_t y = 0; y < 64; y++)
        for (uint32_t x = 0; x < 128; x++)
            for (int c = 0; c < 3; c++)
                p.rgba[(y * 128 + x) * 4 + (uint32_t)c] = 1.0f + 0.5f * cosf(((float)y + 0.5f) / 64.0f * 3.14159265f);
    panorama_project(&p, 0.0f, sh);
    host_environment_irradiance(sh, (const float[3]){0, 1, 0}, rgb);
    assert_float_equal(rgb[0], 3.14159265 * 4.0 / 3.0, 0.005);
    host_environment_irradiance(sh, (const float[3]){1, 0, 0}, rgb);
    assert_float_equal(rgb[1], 3.14159265, 0.005);
    host_environment_irradiance(sh, (const float[3]){0, -1, 0}, rgb);
    assert_float_equal(rgb[2], 3.14159265 * 2.0 / 3.0, 0.005);
    panorama_free(&p);
}

/* A spot in the middle column is seen along -Z; turned by 90 degrees, along -X. */
static void rotation(void **state)
{
    (void)state;
    panorama p;
    float sh[9][3];
    assert_true(panorama_alloc(&p, 64, 32));
    for (uint32_t x = 30; x < 34; x++)
        p.rgba[(16 * 64 + x) * 4] = 10.0f;
    panorama_project(&p, 0.0f, sh);
    assert_true(sh[2][0] < 0.0f && fabsf(sh[3][0]) < 0.01f * fabsf(sh[2][0]));
    panorama_project(&p, 3.14159265f / 2.0f, sh);
    assert_true(sh[3][0] < 0.0f && fabsf(sh[2][0]) < 0.01f * fabsf(sh[3][0]));
    panorama_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(goes_through_keys),
        cmocka_unit_test(speed_is_continuous),
        cmocka_unit_test(two_keys_are_a_line),
        cmocka_unit_test(cut_holds_and_jumps),
        cmocka_unit_test(bad_paths),
        cmocka_unit_test(projection),
        cmocka_unit_test(a_calibrated_camera_projects_by_its_numbers),
        cmocka_unit_test(a_calibration_can_be_an_angle_of_view),
        cmocka_unit_test(keys_of_axes_roll_without_jumps),
        cmocka_unit_test(a_point_of_the_lens_keeps_what_is_in_focus),
        cmocka_unit_test(jitter_moves_no_picture),
        cmocka_unit_test(jitter_that_stands_for_others_moves_no_picture),
        cmocka_unit_test(jitter_is_even_along_both_axes),
        cmocka_unit_test(irradiance),
        cmocka_unit_test(rotation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
