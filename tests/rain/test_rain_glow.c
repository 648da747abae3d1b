/* test_rain_glow.c - the light of lamps that the rain's haze scatters: against the integral over each ray in double,
 * and what hides a lamp. */
#include "rain_picture_fixture.h"

#include <virga/drops.h>

#define WIDTH  96
#define HEIGHT 72

static const double lamp_at[3] = {1.6, 1.2, -12}; /* from the camera */

/* Nothing but haze, dark all around, one lamp. */
static void open_night(shot *s)
{
    static const double diameters[2] = {0.0005, 0.0015}, numbers[2] = {1, 1};
    open_shot(s, 100);
    add_picture(s, WIDTH, HEIGHT);
    virga_rain_settings *settings = &s->f.settings;
    settings->sizes = (virga_sizes){VIRGA_SIZES_TABLE, diameters, numbers, 2};
    settings->streak_min_mm = 2;
    settings->haze = 2;
    settings->haze_sky_m = 0;
    memset(settings->lighting.environment_sh, 0, sizeof settings->lighting.environment_sh);
    virga_light *lamp = &settings->lighting.lights[0];
    for (int i = 0; i < 3; i++) {
        lamp->position_m[i] = s->f.camera[i] + lamp_at[i];
        lamp->intensity[i] = (float)(i + 1) * 40;
    }
    settings->lighting.light_count = 1;
    s->give_depth = true;
    aim_level(s);
}

static const float *draw_night(shot *s)
{
    apply_settings(s);
    const float *pixels = draw_frame(s, 0.02);
    assert_int_equal(streak_count(s), 0);
    return pixels;
}

/* ---- the reference */

/* Of the light's intensity on its axis, in a direction from it and at a distance. */
static double goes_out(const virga_light *lamp, const double direction[3], double distance)
{
    double cone = 1, ends = 1, length = 0, along = 0;
    for (int i = 0; i < 3; i++) {
        length += (double)lamp->direction[i] * (double)lamp->direction[i];
        along += (double)lamp->direction[i] * direction[i];
    }
    if (length > 0)
        cone = fmin(
            fmax((along / sqrt(length) - (double)lamp->cos_outer) / (double)(lamp->cos_inner - lamp->cos_outer), 0), 1);
    if (lamp->range_m > 0)
        ends = fmin(fmax(1 - pow(distance / (double)lamp->range_m, 4), 0), 1);
    return cone * cone * ends * ends;
}

static double lamp_along(const double ray[3])
{
    return ray[0] * lamp_at[0] + ray[1] * lamp_at[1] + ray[2] * lamp_at[2];
}

/* Single scattering along a ray from `begins` up to `ends`, by the half of the extinction that hits drops: the other
 * half is diffraction. The lamp is 0.1 m wide, and a pixel half of its own width. */
static double glow_along(const shot *s, const double ray[3], double begins, double ends)
{
    const virga_light *lamp = &s->f.settings.lighting.lights[0];
    const double k = 0.5 * virga_rain_extinction((double)s->f.settings.rate_mm_h) * (double)s->f.settings.haze;
    const int steps = 4000;
    const double pixel = 0.5 * lamp_along(ray) * 2 / (fabs((double)s->camera.clip_from_view[5]) * HEIGHT);
    const double min2 = 0.1 * 0.1 + pixel * pixel;
    double sum = 0;
    for (int i = 0; i < steps; i++) {
        const double t = begins + (ends - begins) * (i + 0.5) / steps;
        double out[3], r2 = min2;
        for (int axis = 0; axis < 3; axis++) {
            out[axis] = ray[axis] * t - lamp_at[axis];
            r2 += out[axis] * out[axis];
        }
        const double r = sqrt(r2);
        double bent = 0;
        for (int axis = 0; axis < 3; axis++) {
            out[axis] /= r;
            bent -= out[axis] * ray[axis];
        }
        sum +=
            goes_out(lamp, out, r) / r2 * virga_drop_phase(bent) * exp(-k * (t - begins + r)) * (ends - begins) / steps;
    }
    return k * sum * (double)s->f.settings.light_gain * (double)s->f.settings.glow;
}

static double compare_glow(const shot *s, const float *pixels, double begin_m, double depth_m, double tolerance)
{
    const float *p = s->camera.clip_from_view;
    double max = 0, max_error = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        max = fmax(max, (double)pixels[i * 4]);
    for (int i = 0; i < WIDTH * HEIGHT; i += 5) {
        const double x = ((i % WIDTH + 0.5) / WIDTH * 2 - 1) / (double)p[0],
                     y = ((i / WIDTH + 0.5) / HEIGHT * 2 - 1) / (double)p[5], length = sqrt(1 + x * x + y * y);
        const double ray[3] = {x / length, y / length, -1 / length};
        const double expected = 40 * glow_along(s, ray, begin_m * length, depth_m > 0 ? depth_m * length : 100);
        const double off = fabs((double)pixels[i * 4] - expected) / (expected + 0.02 * max);
        max_error = fmax(max_error, off);
        assert_true(fabs((double)pixels[i * 4 + 2] - 3 * (double)pixels[i * 4]) <
                    3e-3 * (double)pixels[i * 4 + 2] + 1e-6);
    }
    printf("brightest %.4f, off by %.1f %%\n", max, 100 * max_error);
    assert_true(max > 0 && max_error < tolerance);
    return max;
}

static double check_glow(shot *s, double depth_m, double tolerance)
{
    s->scene_depth = depth_m > 0 ? stored_depth(s, depth_m) : 1;
    return compare_glow(s, draw_night(s), 0, depth_m, tolerance);
}

/* ---- tests */

static void a_lamp_glows_by_the_integral_over_each_ray(void **state)
{
    (void)state;
    shot s;
    open_night(&s);
    check_glow(&s, 0, 0.01);  /* before the sky */
    check_glow(&s, 30, 0.01); /* before a wall behind the lamp */
    s.f.settings.light_gain = 2;
    s.f.settings.glow = 3;
    check_glow(&s, 12.4, 0.01); /* on one that it stands before */
    close_shot(&s);
}

/* From a plane 9 m ahead on: the haze before it is another picture's, and dims no lamp. */
static void a_glow_of_haze_alone_begins_at_its_plane(void **state)
{
    (void)state;
    shot s;
    open_night(&s);
    const double begin[4] = {0, 0, 1, s.f.camera[2] - 9};
    s.scene_depth = stored_depth(&s, 30);
    apply_settings(&s);
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&s.f);
    rain_fixture_record_step(&s.f, cmd, 0.02);
    record_scene_depth(&s, cmd);
    const virga_view view = view_of(&s);
    host_target_begin_layer(&s.picture, cmd);
    REQUIRE(virga_rain_draw_haze(s.f.rain, cmd, &view, begin, s.layer) == VIRGA_OK);
    host_target_end_layer(&s.picture, cmd);
    host_target_copy_out(&s.picture, cmd, 1u << HOST_LAYER);
    rain_fixture_end_frame(&s.f);
    compare_glow(&s, host_target_floats(&s.f.gpu.device, &s.picture, HOST_LAYER), 9, 30, 0.02);
    close_shot(&s);
}

static void a_spot_glows_in_its_cone(void **state)
{
    (void)state;
    static const float aims[][3] = {{0, -1, 0}, {-1, -0.3f, 0.2f}, {0.1f, 0.2f, 1}, {0.3f, 0, -1}};
    shot s;
    open_night(&s);
    virga_light *lamp = &s.f.settings.lighting.lights[0];
    lamp->cos_inner = 0.9f;
    lamp->cos_outer = 0.7f;
    for (size_t i = 0; i < sizeof aims / sizeof aims[0]; i++) {
        memcpy(lamp->direction, aims[i], sizeof aims[i]);
        check_glow(&s, 0, 0.16); /* the most where it comes back by the rainbow, which begins sharply */
    }
    lamp->cos_inner = 0.2f; /* wider than half of all */
    lamp->cos_outer = -0.4f;
    check_glow(&s, 0, 0.12);
    close_shot(&s);
}

static void a_glow_ends_with_its_lamps_range(void **state)
{
    (void)state;
    shot s;
    open_night(&s);
    s.f.settings.lighting.lights[0].range_m = 3;
    check_glow(&s, 0, 0.02);
    s.f.settings.lighting.lights[0].range_m = 15;
    check_glow(&s, 0, 0.02);
    close_shot(&s);
}

static void a_hidden_lamp_has_no_glow(void **state)
{
    (void)state;
    shot s;
    open_night(&s);
    s.scene_depth = 1;
    const double open = sum_of(&s, draw_night(&s), 0);
    s.scene_depth = stored_depth(&s, 11.8); /* its own lantern: nearly all of the light is scattered before it */
    assert_true(sum_of(&s, draw_night(&s), 0) > 0.7 * open);
    s.scene_depth = stored_depth(&s, 10);
    assert_true(sum_of(&s, draw_night(&s), 0) == 0);
    close_shot(&s);
}

/* A lamp's rectangle ends where its glow has faded: no edge is seen. */
static void a_far_lamps_glow_fades_before_its_rectangle_ends(void **state)
{
    (void)state;
    shot s;
    open_night(&s);
    for (int c = 0; c < 3; c++)
        s.f.settings.lighting.environment_sh[0][c] = 300;
    s.scene_depth = 1; /* haze itself does not show before the sky */
    const float *pixels = draw_night(&s);
    double max = 0, step = 0;
    int dark = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double here = (double)pixels[i * 4], beside = i % WIDTH ? (double)pixels[i * 4 - 4] : here;
        max = fmax(max, here);
        dark += here == 0;
        if (here == 0 || beside == 0)
            step = fmax(step, fabs(here - beside));
    }
    printf("brightest %.4f, largest step to nothing %.6f, %d of %d dark\n", max, step, dark, WIDTH * HEIGHT);
    assert_true(dark > WIDTH * HEIGHT / 4 && dark < WIDTH * HEIGHT && step < 0.01 * max);
    close_shot(&s);
}

/* Wherever it is, also at and behind the camera: finite, and nothing behind. */
static void a_lamp_may_be_anywhere(void **state)
{
    (void)state;
    static const double positions[][3] = {{0, 0, 0},   {0, 0, -0.01}, {0.3, 0, 0.2},  {0, 40, 0},
                                          {60, 0, -1}, {0, 0, 80},    {1e6, 0, -1e6}, {-3, 0.1, -0.2}};
    shot s;
    open_night(&s);
    s.scene_depth = stored_depth(&s, 20);
    for (size_t i = 0; i < sizeof positions / sizeof positions[0]; i++) {
        for (int axis = 0; axis < 3; axis++)
            s.f.settings.lighting.lights[0].position_m[axis] = s.f.camera[axis] + positions[i][axis];
        const float *pixels = draw_night(&s);
        for (int j = 0; j < WIDTH * HEIGHT * 4; j++)
            assert_true(pixels[j] >= 0 && pixels[j] < 1e4f);
        assert_true(positions[i][2] < 50 || sum_of(&s, pixels, 0) == 0);
    }
    close_shot(&s);
}

static void without_glow_or_depth_lamps_leave_haze_dark(void **state)
{
    (void)state;
    shot s;
    open_night(&s);
    s.scene_depth = stored_depth(&s, 30);
    s.f.settings.glow = 0;
    assert_true(sum_of(&s, draw_night(&s), 0) == 0);
    s.f.settings.glow = 1;
    assert_true(sum_of(&s, draw_night(&s), 0) > 0);
    s.give_depth = false;
    assert_true(sum_of(&s, draw_night(&s), 0) == 0);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_glows_by_the_integral_over_each_ray),
        cmocka_unit_test(a_glow_of_haze_alone_begins_at_its_plane),
        cmocka_unit_test(a_spot_glows_in_its_cone),
        cmocka_unit_test(a_glow_ends_with_its_lamps_range),
        cmocka_unit_test(a_hidden_lamp_has_no_glow),
        cmocka_unit_test(a_far_lamps_glow_fades_before_its_rectangle_ends),
        cmocka_unit_test(a_lamp_may_be_anywhere),
        cmocka_unit_test(without_glow_or_depth_lamps_leave_haze_dark),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
