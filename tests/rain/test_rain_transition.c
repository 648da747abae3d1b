/* test_rain_transition.c - from one rate to another: nothing pops, haze goes along, and no rate is no rain. */
#include "rain_live_fixture.h"

#include "camera.h"
#include "rain/rain_internal.h"

/* The sum of weights is the number of drops in the air. */
static double drops_in_the_air(const virga_point_gpu *points, uint32_t slots)
{
    double sum = 0;
    for (uint32_t i = 0; i < slots; i++)
        sum += (double)points[i].weight;
    return sum;
}

static void open_sky(rain_fixture *f, float rate_mm_h, float transition_s)
{
    open_live(f);
    f->settings.wind_m_s[0] = 0;
    f->settings.gust_m_s = 0;
    f->settings.rate_mm_h = rate_mm_h;
    f->settings.transition_s = transition_s;
    set(f);
}

/* From one rate to another the number of drops goes in a straight line. That of the drops seen is theirs, give or take
 * the noise of drops that come and go; 4 % of it are far more than 3 deviations here. */
static void check_transition(float from, float to)
{
    enum { TICKS = 30 };
    rain_fixture f;
    host_buffer read = {0};
    double numbers[TICKS + 6];
    open_sky(&f, from, (float)(TICKS * tick_s));
    const double first = drops_in_the_air(rain_fixture_points_step(&f, 0.2, &read), f.slots);
    f.settings.rate_mm_h = to;
    set(&f);
    for (int i = 0; i < TICKS + 6; i++)
        numbers[i] = drops_in_the_air(rain_fixture_points_step(&f, tick_s, &read), f.slots);
    const double last = numbers[TICKS + 5], noise = 0.04 * fmax(first, last);
    printf("from %.0f to %.0f drops\n", first, last);
    assert_true(fabs(last - first) > 0.3 * first);
    for (int i = 0; i < TICKS + 6; i++) {
        const double share = i + 1 < TICKS ? (i + 1.0) / TICKS : 1;
        assert_true(fabs(numbers[i] - (first + share * (last - first))) < noise);
        assert_true(fabs(numbers[i] - (i ? numbers[i - 1] : first)) < 2 * fabs(last - first) / TICKS + 0.02 * last);
    }
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

static void more_rain_eases_in(void **state)
{
    (void)state;
    check_transition(5, 60);
}

static void less_rain_eases_out(void **state)
{
    (void)state;
    check_transition(60, 5);
}

/* The sum of d^3 over that of d^2, of all that lands, in steps of 1 um. */
static double mean_diameter(double rate_mm_h)
{
    enum { STEPS = 6600 };
    static double diameters[STEPS], densities[STEPS];
    const virga_sizes sizes = {.kind = VIRGA_SIZES_MARSHALL_PALMER};
    double squares = 0, cubes = 0;
    for (int i = 0; i < STEPS; i++)
        diameters[i] = VIRGA_DROP_MIN_M + (i + 0.5) * 1e-6;
    assert_int_equal(virga_sizes_densities(&sizes, rate_mm_h, 0, STEPS, diameters, densities), VIRGA_OK);
    for (int i = 0; i < STEPS; i++) {
        const double d = diameters[i], landing = densities[i] * virga_drop_terminal_speed(d, 0) * d * d;
        squares += landing;
        cubes += landing * d;
    }
    return cubes / squares;
}

/* What lands on open ground goes from one rain to the other in a straight line. */
static void rainfall_has_what_lands_on_open_ground(void **state)
{
    (void)state;
    rain_fixture f;
    host_buffer read = {0};
    virga_rainfall fall;
    open_sky(&f, 10, (float)(20 * tick_s));
    rain_fixture_points_step(&f, 15.001 * tick_s, &read); /* so that sums of floats do not fall a tick short */
    virga_rain_rainfall_get(f.rain, &fall);
    assert_float_equal(fall.rate_mm_h, 10, 1e-4);
    assert_float_equal(fall.drop_m / mean_diameter(10), 1, 0.01);
    assert_float_equal(fall.reach_m, f.rain->def.range_m, 0);
    f.settings.rate_mm_h = 50;
    set(&f);
    rain_fixture_points_step(&f, 10 * tick_s, &read);
    virga_rain_rainfall_get(f.rain, &fall);
    assert_float_equal(fall.rate_mm_h, 30, 1e-3);
    rain_fixture_points_step(&f, 10 * tick_s, &read);
    virga_rain_rainfall_get(f.rain, &fall);
    assert_float_equal(fall.rate_mm_h, 50, 1e-4);
    assert_float_equal(fall.drop_m / mean_diameter(50), 1, 0.01);
    f.settings.rate_mm_h = 0;
    set(&f);
    for (int i = 0; i < 2; i++)
        rain_fixture_points_step(&f, 15.001 * tick_s, &read);
    virga_rain_rainfall_get(f.rain, &fall);
    assert_true(fall.rate_mm_h == 0 && fall.drop_m == 0);
    virga_rain_rainfall_get(NULL, &fall);
    assert_true(fall.reach_m == 0);
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

static bool in_the_middle(const virga_point_gpu *point)
{
    const float *p = point->position;
    return fmaxf(fabsf(p[0]), fmaxf(fabsf(p[1]), fabsf(p[2]))) < 0.2f;
}

/* A slot fades as the rate passes its rank: over a twentieth of all ranks, so over as many ticks as that takes. */
static void single_drops_fade_too(void **state)
{
    (void)state;
    rain_fixture f;
    host_buffer read = {0};
    uint32_t fading = 0;
    open_sky(&f, 10, 4);
    rain_fixture_points_step(&f, 0.2, &read);
    virga_point_gpu *before = malloc(f.slots * sizeof *before);
    f.settings.rate_mm_h = 40;
    set(&f);
    for (int tick = 0; tick < 20; tick++) {
        memcpy(before, read.mapped, f.slots * sizeof *before);
        const virga_point_gpu *after = rain_fixture_points_step(&f, tick_s, &read);
        for (uint32_t i = 0; i < f.slots; i++) {
            /* In the middle of the first box, where the rate alone changes the weight. */
            if (i >= f.slots / f.rain->levels || before[i].id != after[i].id || !in_the_middle(&before[i]) ||
                !in_the_middle(&after[i]))
                continue;
            fading += before[i].weight != after[i].weight;
            assert_true(fabsf(after[i].weight - before[i].weight) < 0.25f);
        }
    }
    printf("%u steps of weights\n", fading);
    assert_true(fading > 20);
    free(before);
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

/* A change in the middle of another goes on from where that was. */
static void a_change_in_the_middle_of_another_makes_no_jump(void **state)
{
    (void)state;
    rain_fixture f;
    host_buffer read = {0};
    open_sky(&f, 5, 0.5f);
    double before = drops_in_the_air(rain_fixture_points_step(&f, 0.2, &read), f.slots);
    const double first = before;
    for (int tick = 0; tick < 30; tick++) {
        f.settings.rate_mm_h = tick % 3 ? 60 : 5;
        f.settings.sizes.kind = tick % 2 ? VIRGA_SIZES_BEST : VIRGA_SIZES_MARSHALL_PALMER;
        set(&f);
        const double now = drops_in_the_air(rain_fixture_points_step(&f, tick_s, &read), f.slots);
        assert_true(fabs(now - before) < 0.15 * first); /* the whole way is more than its double */
        before = now;
    }
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

static void transition_0_is_at_once(void **state)
{
    (void)state;
    rain_fixture f;
    host_buffer read = {0};
    open_sky(&f, 5, 0);
    const double before = drops_in_the_air(rain_fixture_points_step(&f, 0.2, &read), f.slots);
    f.settings.rate_mm_h = 60;
    set(&f);
    const double next = drops_in_the_air(rain_fixture_points_step(&f, tick_s, &read), f.slots);
    const double later = drops_in_the_air(rain_fixture_points_step(&f, 0.2, &read), f.slots);
    assert_true(next > 1.3 * before && fabs(later - next) < 0.04 * next);
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

/* ---- haze */

/* Haze beyond all boxes, as a prepare has it. */
static double haze_of_a_prepare(rain_fixture *f)
{
    const host_camera_key key = {0, {0, 1.7, 0}, {0, 1.7, -5}, 0, false};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 40, .near_m = 0.1, .far_m = 100};
    host_camera camera;
    virga_view view = virga_default_view();
    host_camera_at(&path, 0, 160, 120, NULL, &camera);
    host_camera_view(&camera, &camera, 1.0 / 96, &view);
    const VkCommandBuffer cmd = rain_fixture_begin_frame(f);
    rain_fixture_record_step(f, cmd, tick_s);
    REQUIRE(virga_rain_prepare(f->rain, cmd, &view, virga_rain_time(f->rain)) == VIRGA_OK);
    const rain_view_block *written =
        (const void *)((const char *)f->rain->view_ring.buffer->memory.block.mapped + f->rain->view_offset);
    const double extinction = (double)written->look.haze_per_m[f->rain->levels];
    rain_fixture_end_frame(f);
    return extinction;
}

static void haze_eases_with_the_rate(void **state)
{
    (void)state;
    enum { TICKS = 30 };
    for (int up = 0; up < 2; up++) {
        rain_fixture f;
        open_sky(&f, up ? 2 : 60, (float)(TICKS * tick_s));
        double before = haze_of_a_prepare(&f);
        assert_true(fabs(before / (0.5 * virga_rain_extinction(up ? 2 : 60)) - 1) < 1e-3);
        f.settings.rate_mm_h = up ? 60 : 0;
        set(&f);
        const double target = 0.5 * virga_rain_extinction(up ? 60 : 0), way = fabs(target - before);
        for (int tick = 0; tick < TICKS; tick++) {
            const double now = haze_of_a_prepare(&f);
            assert_true(fabs(now - before) < 0.2 * way);
            before = now;
        }
        assert_true(fabs(haze_of_a_prepare(&f) - target) < 1e-3 * way);
        rain_fixture_close(&f);
    }
}

/* ---- no rain */

static void no_rate_is_no_impacts_after_the_transition(void **state)
{
    (void)state;
    rain_fixture f;
    const virga_impact_gpu *list;
    open_live(&f);
    f.settings.transition_s = 0.2f;
    set(&f);
    rain_fixture_step(&f, 0.2);
    assert_true(rain_fixture_impacts(&f, &list)->count > 100);
    f.settings.rate_mm_h = 0;
    set(&f);
    rain_fixture_step(&f, 0.1);
    assert_true(rain_fixture_impacts(&f, &list)->count > 10); /* still raining a little */
    rain_fixture_step(&f, 0.1);
    for (int i = 0; i < 4; i++) {
        rain_fixture_step(&f, 0.2);
        const virga_impacts_gpu *head = rain_fixture_impacts(&f, &list);
        assert_int_equal(head->count, 0);
        assert_int_equal(head->water_nl_low | head->water_nl_high, 0);
    }
    f.settings.rate_mm_h = 20;
    set(&f);
    rain_fixture_step(&f, 0.25);
    rain_fixture_step(&f, 0.2);
    assert_true(rain_fixture_impacts(&f, &list)->count > 100);
    rain_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(more_rain_eases_in),
        cmocka_unit_test(rainfall_has_what_lands_on_open_ground),
        cmocka_unit_test(less_rain_eases_out),
        cmocka_unit_test(single_drops_fade_too),
        cmocka_unit_test(a_change_in_the_middle_of_another_makes_no_jump),
        cmocka_unit_test(transition_0_is_at_once),
        cmocka_unit_test(haze_eases_with_the_rate),
        cmocka_unit_test(no_rate_is_no_impacts_after_the_transition),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
