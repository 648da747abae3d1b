/* test_rain_wind.c - gusts are the noise that rain.h describes, drops follow by drag, and a host's 3D wind moves them
 * as the law of motion does. */
#include "rain_fixture.h"

#include <math.h>

#include "rain/rain_internal.h"

/* ---- gusts, on the host */

enum { KNOTS = 12000, A_KNOT = 8, SAMPLES = KNOTS * A_KNOT };

static const double vertical_share = 0.4;

static virga_rain_settings gusty(void)
{
    virga_rain_settings settings = virga_default_rain_settings();
    settings.wind_m_s[0] = 5;
    settings.wind_m_s[1] = -0.5f;
    settings.wind_m_s[2] = -2;
    settings.gust_m_s = 3;
    settings.gust_time_s = 4;
    return settings;
}

/* A long run of ticks, each an eighth of a gust's time; deviations from the mean in units of their documented size. */
static double (*gust_run(uint32_t seed))[3]
{
    const virga_rain_settings settings = gusty();
    double(*gusts)[3] = malloc(SAMPLES * sizeof *gusts);
    rain_wind wind = {0};
    for (int i = 0; i < SAMPLES; i++) {
        double velocity[3];
        rain_wind_at(&wind, &settings, seed, velocity);
        for (int axis = 0; axis < 3; axis++)
            gusts[i][axis] = (velocity[axis] - (double)settings.wind_m_s[axis]) /
                             ((double)settings.gust_m_s * (axis == 1 ? vertical_share : 1));
        rain_wind_tick(&wind, (double)settings.gust_time_s / A_KNOT, (double)settings.gust_time_s);
    }
    return gusts;
}

static double mean_product(const double (*gusts)[3], int a, int b, int lag)
{
    double sum = 0;
    for (int i = 0; i + lag < SAMPLES; i++)
        sum += gusts[i][a] * gusts[i + lag][b];
    return sum / (SAMPLES - lag);
}

static void gusts_have_no_mean_and_the_deviation_asked_for(void **state)
{
    (void)state;
    double(*gusts)[3] = gust_run(1);
    for (int axis = 0; axis < 3; axis++) {
        double mean = 0;
        for (int i = 0; i < SAMPLES; i++)
            mean += gusts[i][axis] / SAMPLES;
        const double deviation = sqrt(mean_product(gusts, axis, axis, 0));
        printf("axis %d: mean %.4f, deviation %.4f\n", axis, mean, deviation);
        /* As many independent gusts as knots, within three deviations. */
        assert_true(fabs(mean) < 3 / sqrt(KNOTS));
        assert_true(fabs(deviation - 1) < 3 / sqrt(KNOTS));
    }
    free(gusts);
}

/* Not only on average: between knots too. */
static void gusts_are_as_strong_at_any_time_between_knots(void **state)
{
    (void)state;
    double(*gusts)[3] = gust_run(2);
    for (int phase = 0; phase < A_KNOT; phase++) {
        double squares = 0;
        for (int i = phase; i < SAMPLES; i += A_KNOT)
            squares += gusts[i][0] * gusts[i][0] / KNOTS;
        assert_true(fabs(squares - 1) < 5 * sqrt(2.0 / KNOTS));
    }
    free(gusts);
}

static void components_of_gusts_are_independent(void **state)
{
    (void)state;
    double(*gusts)[3] = gust_run(3);
    for (int a = 0; a < 3; a++)
        for (int lag = 0; lag < 3 * A_KNOT; lag += A_KNOT / 2)
            assert_true(fabs(mean_product(gusts, a, (a + 1) % 3, lag)) < 5 / sqrt(KNOTS));
    free(gusts);
}

static double bspline(double x)
{
    x = fabs(x);
    return x < 1 ? 2.0 / 3 - x * x + 0.5 * x * x * x : x < 2 ? (2 - x) * (2 - x) * (2 - x) / 6 : 0;
}

/* Covariance of a cubic spline through independent knots at two times, in knots. */
static double spline_covariance(double a, double b)
{
    double sum = 0;
    for (int k = -8; k <= 16; k++)
        sum += bspline(a - k) * bspline(b - k);
    return sum;
}

/* What smooth noise with knots gust_time_s apart has: half of it is gone after about one knot, all of it after four. */
static void gusts_forget_over_the_time_asked_for(void **state)
{
    (void)state;
    static const int lags[] = {2, 4, 8, 12, 16, 24, 32, 48};
    double(*gusts)[3] = gust_run(4);
    for (size_t i = 0; i < sizeof lags / sizeof lags[0]; i++) {
        double expected = 0;
        for (int phase = 0; phase < A_KNOT; phase++) {
            const double a = (double)phase / A_KNOT, b = a + (double)lags[i] / A_KNOT;
            expected += spline_covariance(a, b) / sqrt(spline_covariance(a, a) * spline_covariance(b, b)) / A_KNOT;
        }
        const double got = 0.5 * (mean_product(gusts, 0, 0, lags[i]) + mean_product(gusts, 2, 2, lags[i]));
        printf("after %.2f gust times: %.4f, expected %.4f\n", (double)lags[i] / A_KNOT, got, expected);
        assert_true(fabs(got - expected) < 4 / sqrt(KNOTS));
    }
    free(gusts);
}

static void without_gusts_the_wind_is_its_mean(void **state)
{
    (void)state;
    virga_rain_settings settings = gusty();
    rain_wind wind = {.phase = 3.3};
    double velocity[3];
    settings.gust_m_s = 0;
    rain_wind_at(&wind, &settings, 1, velocity);
    for (int axis = 0; axis < 3; axis++)
        assert_true(velocity[axis] == (double)settings.wind_m_s[axis]);
}

/* ---- on the device */

typedef struct air {
    rain_fixture f;
    host_buffer read;
    host_image texture;
    virga_image given;
} air;

static void open_air(air *a, double tick_s, bool texture)
{
    virga_rain_def def = virga_default_rain_def();
    memset(a, 0, sizeof *a);
    def.max_drops = 4096;
    def.range_m = 8;
    def.occlusion_size = 0;
    def.points = true;
    def.tick_s = tick_s;
    def.max_ticks_per_step = 64;
    def.wind_texture = texture;
    rain_fixture_open(&a->f);
    rain_fixture_rain(&a->f, &def);
}

static void close_air(air *a)
{
    host_buffer_destroy(&a->f.gpu.device, &a->read);
    host_image_destroy(&a->f.gpu.device, &a->texture);
    rain_fixture_close(&a->f);
}

static void set_wind(air *a, float x, float y, float z)
{
    a->f.settings.wind_m_s[0] = x;
    a->f.settings.wind_m_s[1] = y;
    a->f.settings.wind_m_s[2] = z;
    assert_int_equal(virga_rain_set(a->f.rain, &a->f.settings), VIRGA_OK);
}

static const virga_point_gpu *step(air *a, double dt_s)
{
    return rain_fixture_points_step(&a->f, dt_s, &a->read);
}

/* The wind that a step says it had is the one at its tick. */
static void the_step_takes_the_gust_of_its_tick(void **state)
{
    (void)state;
    air a;
    open_air(&a, 1.0 / 30, false);
    const virga_rain_settings settings = a.f.settings = gusty();
    assert_int_equal(virga_rain_set(a.f.rain, &settings), VIRGA_OK);
    rain_wind wind = {0};
    for (int i = 0; i < 10; i++) {
        virga_rain_stats stats;
        double velocity[3];
        step(&a, 0.5);
        for (int tick = 0; tick < 15; tick++)
            rain_wind_tick(&wind, 1.0 / 30, (double)settings.gust_time_s);
        rain_wind_at(&wind, &settings, 1, velocity);
        assert_int_equal(virga_frame_completed(a.f.context, a.f.gpu.device.frame), VIRGA_OK);
        virga_rain_stats_get(a.f.rain, &stats);
        for (int axis = 0; axis < 3; axis++)
            assert_true(fabs((double)stats.wind_m_s[axis] - velocity[axis]) < 1e-5);
    }
    close_air(&a);
}

/* A new time scale goes on from where the noise was. */
static void a_new_gust_time_makes_no_jump(void **state)
{
    (void)state;
    air a;
    open_air(&a, 1.0 / 60, false);
    a.f.settings = gusty();
    float last[3] = {0};
    for (int i = 0; i < 60; i++) {
        virga_rain_stats stats;
        a.f.settings.gust_time_s = i % 7 < 3 ? 2 : 11;
        assert_int_equal(virga_rain_set(a.f.rain, &a.f.settings), VIRGA_OK);
        step(&a, 1.0 / 60);
        assert_int_equal(virga_frame_completed(a.f.context, a.f.gpu.device.frame), VIRGA_OK);
        virga_rain_stats_get(a.f.rain, &stats);
        for (int axis = 0; axis < 3 && i; axis++)
            assert_true(fabsf(stats.wind_m_s[axis] - last[axis]) < 3 * 3.0f / 2 / 60 * 2);
        memcpy(last, stats.wind_m_s, sizeof last);
    }
    close_air(&a);
}

/* dv/dt = -g - (g / vt^2) |v - w| (v - w) */
static void acceleration(const double v[3], const double w[3], double terminal, double out[3])
{
    double speed2 = 0;
    for (int i = 0; i < 3; i++)
        speed2 += (v[i] - w[i]) * (v[i] - w[i]);
    for (int i = 0; i < 3; i++)
        out[i] = -VIRGA_GRAVITY / (terminal * terminal) * sqrt(speed2) * (v[i] - w[i]) - (i == 1 ? VIRGA_GRAVITY : 0);
}

/* A wind that is linear in the position: at + by x, y and z. */
typedef struct linear_wind {
    double at[3], by[3][3];
} linear_wind;

static void wind_at(const linear_wind *wind, const double p[3], double w[3])
{
    for (int i = 0; i < 3; i++)
        w[i] = wind->at[i] + wind->by[i][0] * p[0] + wind->by[i][1] * p[1] + wind->by[i][2] * p[2];
}

/* Midpoint rule with steps of a tenth of a millisecond: right to a millionth of the way here. */
static void integrate(const linear_wind *wind, double terminal, double seconds, double p[3], double v[3])
{
    const int steps = (int)(seconds * 1e4 + 0.5);
    const double h = seconds / steps;
    for (int n = 0; n < steps; n++) {
        double w[3], k[3], middle_p[3], middle_v[3];
        wind_at(wind, p, w);
        acceleration(v, w, terminal, k);
        for (int i = 0; i < 3; i++) {
            middle_p[i] = p[i] + 0.5 * h * v[i];
            middle_v[i] = v[i] + 0.5 * h * k[i];
        }
        wind_at(wind, middle_p, w);
        acceleration(middle_v, w, terminal, k);
        for (int i = 0; i < 3; i++) {
            p[i] += h * middle_v[i];
            v[i] += h * k[i];
        }
    }
}

static void drops_follow_a_step_of_wind_by_their_drag(void **state)
{
    (void)state;
    static const double wind_step[3] = {8, 0, -3};
    air a;
    open_air(&a, 1.0 / 1000, false);
    step(&a, 0.01);
    set_wind(&a, (float)wind_step[0], 0, (float)wind_step[2]);
    for (int look = 1; look <= 4; look++) {
        const virga_point_gpu *points = step(&a, 0.05);
        double slowest_small = 1e9, fastest_big = 0;
        for (uint32_t i = 0; i < a.f.slots; i++) {
            const double diameter = (double)points[i].diameter_m, x = (double)points[i].velocity[0];
            slowest_small = diameter < 0.0005 ? fmin(slowest_small, x) : slowest_small;
            fastest_big = diameter > 0.002 ? fmax(fastest_big, x) : fastest_big;
            if (i % 16)
                continue;
            const linear_wind wind = {{wind_step[0], 0, wind_step[2]}, {{0}}};
            const double terminal = virga_drop_terminal_speed(diameter, 0);
            double p[3] = {0}, v[3] = {0, -terminal, 0};
            integrate(&wind, terminal, 0.05 * look, p, v);
            for (int axis = 0; axis < 3; axis++)
                assert_true(fabs((double)points[i].velocity[axis] - v[axis]) < 0.01 * wind_step[0]);
        }
        printf("after %.2f s below 0.5 mm at least %.2f m/s, above 2 mm at most %.2f\n", 0.05 * look, slowest_small,
               fastest_big);
        assert_true(slowest_small > 1.5 * fastest_big);
    }
    close_air(&a);
}

static void drops_at_rest_with_the_wind_fall_by_their_terminal_speed(void **state)
{
    (void)state;
    air a;
    open_air(&a, 1.0 / 60, false);
    step(&a, 0.1);
    set_wind(&a, 6, 1, -2);
    for (int i = 0; i < 10; i++)
        step(&a, 1);
    const virga_point_gpu *points = step(&a, 0.1);
    for (uint32_t i = 0; i < a.f.slots; i++) {
        const double terminal = virga_drop_terminal_speed((double)points[i].diameter_m, 0);
        assert_true(fabs((double)points[i].velocity[0] - 6) < 2e-3);
        assert_true(fabs((double)points[i].velocity[1] - 1 + terminal) < 2e-3);
        assert_true(fabs((double)points[i].velocity[2] + 2) < 2e-3);
    }
    close_air(&a);
}

/* ---- a host's 3D wind */

static uint16_t half_of(double value)
{
    int exponent;
    if (value == 0)
        return 0;
    const double mantissa = frexp(fabs(value), &exponent); /* [0.5; 1) */
    const int bits = (int)floor(mantissa * 2048 + 0.5) - 1024;
    return (uint16_t)((value < 0 ? 0x8000 : 0) | (((exponent + 14) << 10) + bits));
}

enum { TEXELS = 8 };

/* A wind in a texture of 8 x 8 x 8 halves over a box of 16 m around the origin. */
static void give_texture(air *a, const linear_wind *wind)
{
    const double side = 16;
    const host_image_def def = {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                .extent = {TEXELS, TEXELS, TEXELS},
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .name = "wind"};
    static uint16_t texels[TEXELS][TEXELS][TEXELS][4];
    for (int z = 0; z < TEXELS; z++)
        for (int y = 0; y < TEXELS; y++)
            for (int x = 0; x < TEXELS; x++) {
                const double p[3] = {((x + 0.5) / TEXELS - 0.5) * side, ((y + 0.5) / TEXELS - 0.5) * side,
                                     ((z + 0.5) / TEXELS - 0.5) * side};
                double w[3];
                wind_at(wind, p, w);
                for (int i = 0; i < 3; i++)
                    texels[z][y][x][i] = half_of(w[i]);
            }
    rain_fixture *f = &a->f;
    REQUIRE(host_image_create(&f->gpu.device, &def, &a->texture, f->gpu.error, sizeof f->gpu.error));
    REQUIRE(
        host_image_upload(&f->gpu.device, &a->texture, texels, sizeof texels, 8, f->gpu.error, sizeof f->gpu.error));
    const virga_image_state read = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                    VK_ACCESS_SHADER_READ_BIT};
    a->given = (virga_image){.image = a->texture.image,
                             .view = a->texture.view,
                             .format = def.format,
                             .extent = def.extent,
                             .before = read,
                             .after = read};
    f->settings.wind_texture = &a->given;
    for (int i = 0; i < 3; i++) {
        f->settings.wind_min_m[i] = -0.5 * side;
        f->settings.wind_max_m[i] = 0.5 * side;
    }
    assert_int_equal(virga_rain_set(f->rain, &f->settings), VIRGA_OK);
}

static void an_even_texture_is_a_uniform_wind(void **state)
{
    (void)state;
    const linear_wind even = {{5, 0.5, -2}, {{0}}};
    air uniform, textured;
    open_air(&uniform, 1.0 / 60, false);
    open_air(&textured, 1.0 / 60, true);
    set_wind(&uniform, 6, 0.5f, -2);
    set_wind(&textured, 1, 0, 0);
    give_texture(&textured, &even);
    const virga_point_gpu *a = NULL, *b = NULL;
    for (int i = 0; i < 8; i++) {
        a = step(&uniform, 1);
        b = step(&textured, 1);
    }
    for (uint32_t i = 0; i < uniform.f.slots; i++)
        for (int axis = 0; axis < 3; axis++)
            assert_true(fabsf(a[i].velocity[axis] - b[i].velocity[axis]) < 3e-3f);
    close_air(&uniform);
    close_air(&textured);
}

/* Distances of a drop from where the law of motion puts it. False if it is not the same drop, or where the texture is
 * not linear: outside the centres of its texels. Slots without weight wait at the edges of their boxes, in
 * two winds. */
static bool compare_with_law(const linear_wind *wind, double seconds, const virga_point_gpu *from,
                             const virga_point_gpu *to, double *off, double *off_velocity)
{
    double p[3], v[3];
    for (int axis = 0; axis < 3; axis++) {
        p[axis] = (double)from->position[axis];
        v[axis] = (double)from->velocity[axis];
    }
    if (from->id != to->id || from->weight <= 0 || to->weight <= 0 || fabs(p[0]) > 4 || fabs(p[1]) > 4 ||
        fabs(p[2]) > 4)
        return false;
    integrate(wind, virga_drop_terminal_speed((double)from->diameter_m, 0), seconds, p, v);
    *off = *off_velocity = 0;
    for (int axis = 0; axis < 3; axis++) {
        *off = fmax(*off, fabs((double)to->position[axis] - p[axis]));
        *off_velocity = fmax(*off_velocity, fabs((double)to->velocity[axis] - v[axis]));
    }
    return fabs(p[1]) < 6.5;
}

static void a_drop_moves_as_the_law_says_in_a_shear(void **state)
{
    (void)state;
    const linear_wind shear = {{1, 0, 0.5}, {{0, 0.75, 0.25}, {0, 0, 0}, {0.5, 0, -0.25}}};
    const double seconds = 0.25;
    air a;
    open_air(&a, 1.0 / 1000, true);
    give_texture(&a, &shear);
    for (int i = 0; i < 8; i++)
        step(&a, 0.06);
    virga_point_gpu *before = malloc(a.f.slots * sizeof *before);
    memcpy(before, step(&a, 0), a.f.slots * sizeof *before);
    for (int i = 0; i < 5; i++)
        step(&a, seconds / 5);
    const virga_point_gpu *after = step(&a, 0);
    uint32_t checked = 0, strange = 0;
    double max_error = 0, max_velocity_error = 0;
    for (uint32_t i = 0; i < a.f.slots; i++) {
        double off, off_velocity;
        if (!compare_with_law(&shear, seconds, &before[i], &after[i], &off, &off_velocity))
            continue;
        /* A slot whose drop left its box shows another one, whose id is the same once in 1024 times. */
        strange += off >= 0.01;
        if (off >= 0.01)
            continue;
        max_error = fmax(max_error, off);
        max_velocity_error = fmax(max_velocity_error, off_velocity);
        checked++;
    }
    printf("%u drops, at most %.4f m and %.4f m/s off after %.2f s; %u are others\n", checked, max_error,
           max_velocity_error, seconds, strange);
    assert_true(checked > 200 && strange <= checked / 100);
    assert_true(max_error < 0.004 && max_velocity_error < 0.02);
    free(before);
    close_air(&a);
}

/* A texture of still air adds nothing, also while the uniform wind changes. */
static void a_texture_of_still_air_changes_nothing(void **state)
{
    (void)state;
    const linear_wind still = {{0}, {{0}}};
    air plain, textured;
    open_air(&plain, 1.0 / 60, false);
    open_air(&textured, 1.0 / 60, true);
    give_texture(&textured, &still);
    step(&plain, 0.1);
    step(&textured, 0.1);
    set_wind(&plain, 8, 0, 0);
    set_wind(&textured, 8, 0, 0);
    for (int look = 0; look < 4; look++) {
        const virga_point_gpu *a = step(&plain, 0.05), *b = step(&textured, 0.05);
        double max_error = 0;
        for (uint32_t i = 0; i < plain.f.slots; i++)
            max_error = fmax(max_error, (double)fabsf(a[i].velocity[0] - b[i].velocity[0]));
        printf("%.2f s after the step of wind: at most %.3f m/s apart\n", 0.05 * (look + 1), max_error);
        assert_true(max_error < 2e-3);
    }
    close_air(&plain);
    close_air(&textured);
}

static void drops_calm_down_when_the_texture_goes(void **state)
{
    (void)state;
    const linear_wind even = {{5, 0, -2}, {{0}}};
    air a;
    open_air(&a, 1.0 / 60, true);
    give_texture(&a, &even);
    step(&a, 1);
    a.f.settings.wind_texture = NULL;
    assert_int_equal(virga_rain_set(a.f.rain, &a.f.settings), VIRGA_OK);
    const virga_point_gpu *points = step(&a, 1.0 / 60);
    uint32_t moving = 0;
    for (uint32_t i = 0; i < a.f.slots; i++)
        moving += points[i].velocity[0] > 1; /* at once would be a jump */
    assert_true(moving > a.f.slots / 2);
    for (int i = 0; i < 8; i++)
        points = step(&a, 1);
    for (uint32_t i = 0; i < a.f.slots; i++)
        assert_true(fabsf(points[i].velocity[0]) < 3e-3f && fabsf(points[i].velocity[2]) < 3e-3f);
    close_air(&a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gusts_have_no_mean_and_the_deviation_asked_for),
        cmocka_unit_test(gusts_are_as_strong_at_any_time_between_knots),
        cmocka_unit_test(components_of_gusts_are_independent),
        cmocka_unit_test(gusts_forget_over_the_time_asked_for),
        cmocka_unit_test(without_gusts_the_wind_is_its_mean),
        cmocka_unit_test(the_step_takes_the_gust_of_its_tick),
        cmocka_unit_test(a_new_gust_time_makes_no_jump),
        cmocka_unit_test(drops_follow_a_step_of_wind_by_their_drag),
        cmocka_unit_test(drops_at_rest_with_the_wind_fall_by_their_terminal_speed),
        cmocka_unit_test(an_even_texture_is_a_uniform_wind),
        cmocka_unit_test(a_drop_moves_as_the_law_says_in_a_shear),
        cmocka_unit_test(a_texture_of_still_air_changes_nothing),
        cmocka_unit_test(drops_calm_down_when_the_texture_goes),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
