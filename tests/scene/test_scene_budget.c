/* test_scene_budget.c - a frame's time budget for ticks, and presets of definitions. On a stand-in for a device, which
 * says how long a pass took. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <virga/virga.h>

#include "stand_in.h"

#define TICK_S (1.0 / 60)

typedef struct budget_test {
    virga_context *context;
    virga_scene *scene;
    VkCommandBuffer cmd;
    uint64_t frame;
    uint32_t clamped, dropped; /* log lines */
} budget_test;

static void count_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    budget_test *t = user;
    (void)level;
    (void)text;
    t->clamped += id == VIRGA_LOG_CLAMPED;
    t->dropped += id == VIRGA_LOG_TICKS_DROPPED;
}

static void open_context(budget_test *t, bool timings)
{
    virga_context_def def = virga_default_context_def();
    memset(t, 0, sizeof *t);
    stand_in_open();
    stand_in.timestamp_ns = 1000000; /* each pass takes a millisecond */
    def.instance = stand_in_instance();
    def.physical_device = stand_in_physical();
    def.device = stand_in_device(0);
    def.get_instance_proc_addr = stand_in_get;
    def.timings = timings;
    def.log = count_line;
    def.log_user = t;
    assert_int_equal(virga_context_create(&def, &t->context), VIRGA_OK);
}

static void open_scene(budget_test *t, bool timings)
{
    virga_scene_def def = virga_default_scene_def();
    open_context(t, timings);
    assert_int_equal(virga_scene_create(t->context, &def, &t->scene), VIRGA_OK);
}

static void close_scene(budget_test *t)
{
    virga_scene_destroy(&t->scene);
    virga_context_destroy(&t->context);
    assert_true(stand_in_close());
}

/* A frame of so many ticks' time; returns the number of ticks that it ran. */
static uint32_t run_frame(budget_test *t, double dt_ticks, float budget_ms, virga_result expected)
{
    const virga_scene_frame frame = {.dt_s = dt_ticks * TICK_S, .step_budget_ms = budget_ms};
    uint32_t ticks;
    t->cmd = stand_in_begin(t->cmd);
    t->frame++;
    assert_int_equal(virga_frame_begin(t->context, t->frame, t->frame - 1), VIRGA_OK);
    assert_int_equal(virga_scene_record(t->scene, t->cmd, &frame), expected);
    virga_rain_ticks(virga_scene_rain(t->scene), NULL, &ticks);
    stand_in_submit(t->cmd);
    stand_in_done(stand_in_submitted());
    assert_int_equal(virga_frame_completed(t->context, t->frame), VIRGA_OK);
    return ticks;
}

/* By the library's own times. */
static double measured_tick_ms(const budget_test *t, uint32_t ticks)
{
    virga_pass_time times[64];
    double sum = 0;
    const uint32_t count = virga_timings_get(t->context, times, 64);
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(times[i].name, "rain.step") || !strcmp(times[i].name, "rain.impacts"))
            sum += times[i].milliseconds / ticks;
    return sum;
}

static uint64_t dropped(budget_test *t)
{
    virga_rain_stats stats;
    virga_rain_stats_get(virga_scene_rain(t->scene), &stats);
    return stats.ticks_dropped;
}

static void as_many_ticks_as_fit_are_run(void **state)
{
    budget_test t;
    (void)state;
    open_scene(&t, true);
    assert_int_equal(run_frame(&t, 10, 1, VIRGA_DEGRADED), 1); /* nothing was measured yet */
    assert_int_equal(dropped(&t), 9);
    const double one = measured_tick_ms(&t, 1);
    assert_true(one >= 1);
    assert_int_equal(run_frame(&t, 10, (float)(3.5 * one), VIRGA_DEGRADED), 3);
    assert_int_equal(dropped(&t), 9 + 7);
    assert_int_equal(run_frame(&t, 2, (float)(3.5 * one), VIRGA_OK), 2);       /* no more than there are */
    assert_int_equal(run_frame(&t, 5, (float)(0.1 * one), VIRGA_DEGRADED), 1); /* time goes on */
    assert_int_equal(run_frame(&t, 10, 0, VIRGA_OK), 10);
    assert_int_equal(dropped(&t), 9 + 7 + 4);
    assert_int_equal(t.dropped, 1); /* said once */
    close_scene(&t);
}

static void without_times_there_is_no_budget(void **state)
{
    budget_test t;
    (void)state;
    open_scene(&t, false);
    assert_int_equal(run_frame(&t, 10, 1, VIRGA_OK), 10);
    close_scene(&t);
}

static void a_wrong_budget_is_refused(void **state)
{
    static const float wrong[] = {-1, 1001, NAN, INFINITY};
    budget_test t;
    (void)state;
    open_scene(&t, true);
    for (int i = 0; i < 4; i++)
        assert_int_equal(run_frame(&t, 1, wrong[i], VIRGA_ERROR_INVALID), 0);
    close_scene(&t);
}

/* A host whose frames take as long as their ticks: 40 ms each, more than a tick lasts. After one slow frame, each is
 * slower than the one before, up to the most that a step may run; a budget ends that. */
static uint32_t ticks_after_a_slow_frame(budget_test *t, float budget_ms)
{
    double frame_s = 0.1;
    uint32_t ticks = 0;
    for (int i = 0; i < 30; i++) {
        const virga_scene_frame frame = {.dt_s = frame_s, .step_budget_ms = budget_ms};
        t->cmd = stand_in_begin(t->cmd);
        t->frame++;
        assert_int_equal(virga_frame_begin(t->context, t->frame, t->frame - 1), VIRGA_OK);
        assert_true(virga_scene_record(t->scene, t->cmd, &frame) >= 0);
        virga_rain_ticks(virga_scene_rain(t->scene), NULL, &ticks);
        stand_in_submit(t->cmd);
        stand_in_done(stand_in_submitted());
        frame_s = 0.005 + 0.04 * ticks;
    }
    return ticks;
}

static void a_slow_frame_makes_no_slower_ones(void **state)
{
    budget_test t;
    (void)state;
    open_scene(&t, true);
    stand_in.timestamp_ns = 20000000;
    assert_int_equal(ticks_after_a_slow_frame(&t, 0), 16); /* what the budget is for */
    assert_int_equal(ticks_after_a_slow_frame(&t, 8), 1);
    close_scene(&t);
}

/* ---- presets */

static void high_is_the_default_but_for_ticks(void **state)
{
    virga_scene_def def = virga_default_scene_def();
    virga_glass_def pane = virga_default_glass_def();
    (void)state;
    virga_scene_apply_quality(VIRGA_QUALITY_HIGH, &def);
    virga_glass_apply_quality(VIRGA_QUALITY_HIGH, &pane);
    assert_int_equal(def.rain.max_ticks_per_step, 4);
    const uint32_t ticks = virga_default_rain_def().max_ticks_per_step;
    def.rain.max_ticks_per_step = def.ground.max_ticks_per_step = def.splash.max_ticks_per_step = ticks;
    pane.max_ticks_per_step = ticks;
    const virga_scene_def same = virga_default_scene_def();
    const virga_glass_def same_pane = virga_default_glass_def();
    assert_memory_equal(&def.rain, &same.rain, sizeof def.rain);
    assert_memory_equal(&def.ground, &same.ground, sizeof def.ground);
    assert_memory_equal(&def.splash, &same.splash, sizeof def.splash);
    assert_memory_equal(&pane, &same_pane, sizeof pane);
    assert_memory_equal(&def.water, &same.water, sizeof def.water);
    virga_fluid_def fluid = virga_default_fluid_def();
    const virga_fluid_def same_fluid = virga_default_fluid_def();
    virga_fluid_apply_quality(VIRGA_QUALITY_HIGH, &fluid);
    assert_memory_equal(&fluid, &same_fluid, sizeof fluid);
}

static void presets_are_in_range_and_take_more_and_more(void **state)
{
    VkDeviceSize before = 0;
    (void)state;
    for (int quality = VIRGA_QUALITY_LOW; quality <= VIRGA_QUALITY_FILM; quality++) {
        budget_test t;
        virga_scene_def def = virga_default_scene_def();
        virga_glass_def pane = virga_default_glass_def();
        open_context(&t, true);
        virga_scene_apply_quality((virga_quality)quality, &def);
        virga_glass_apply_quality((virga_quality)quality, &pane);
        def.with_ground = def.with_splash = def.with_water = true;
        def.panes = &pane;
        def.pane_count = 1;
        const VkDeviceSize bytes = virga_scene_estimate(&def);
        assert_true(bytes > before + before / 4);
        before = bytes;
        assert_int_equal(virga_scene_create(t.context, &def, &t.scene), VIRGA_OK);
        assert_int_equal(t.clamped, 0);
        close_scene(&t);
    }
}

static void presets_of_a_fluid_and_a_lens_are_in_range(void **state)
{
    VkDeviceSize fluid_before = 0, lens_before = 0;
    (void)state;
    for (int quality = VIRGA_QUALITY_LOW; quality <= VIRGA_QUALITY_FILM; quality++) {
        budget_test t;
        virga_fluid_def fluid_def = virga_default_fluid_def();
        virga_lens_def lens_def = virga_default_lens_def();
        virga_fluid *fluid = NULL;
        virga_lens *lens = NULL;
        open_context(&t, true);
        virga_fluid_apply_quality((virga_quality)quality, &fluid_def);
        virga_lens_apply_quality((virga_quality)quality, &lens_def);
        assert_true(virga_fluid_estimate(&fluid_def) > fluid_before);
        assert_true(virga_lens_estimate(&lens_def) >= lens_before);
        fluid_before = virga_fluid_estimate(&fluid_def);
        lens_before = virga_lens_estimate(&lens_def);
        assert_int_equal(virga_fluid_create(t.context, &fluid_def, &fluid), VIRGA_OK);
        assert_int_equal(virga_lens_create(t.context, &lens_def, &lens), VIRGA_OK);
        assert_int_equal(t.clamped, 0);
        virga_fluid_destroy(&fluid);
        virga_lens_destroy(&lens);
        close_scene(&t);
    }
}

/* ---- what presets take */

static const VkPhysicalDeviceType slow_to_fast[] = {VK_PHYSICAL_DEVICE_TYPE_CPU, VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU,
                                                    VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU};

static virga_scene_costs cost_of(virga_quality quality, VkPhysicalDeviceType kind, uint32_t width, uint32_t height)
{
    virga_scene_def def = virga_default_scene_def();
    virga_glass_def pane = virga_default_glass_def();
    virga_scene_costs costs;
    virga_scene_apply_quality(quality, &def);
    virga_glass_apply_quality(quality, &pane);
    def.with_ground = def.with_splash = def.with_water = true;
    def.panes = &pane;
    def.pane_count = 1;
    assert_int_equal(virga_scene_cost(&def, kind, width, height, &costs), VIRGA_OK);
    assert_true(costs.memory_bytes == virga_scene_estimate(&def));
    return costs;
}

static void better_qualities_cost_more_and_faster_devices_less(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++)
        for (int quality = VIRGA_QUALITY_LOW; quality <= VIRGA_QUALITY_FILM; quality++) {
            const virga_scene_costs costs = cost_of((virga_quality)quality, slow_to_fast[kind], 1280, 720);
            const virga_scene_costs small = cost_of((virga_quality)quality, slow_to_fast[kind], 640, 360);
            if (getenv("VIRGA_TEST_VERBOSE"))
                printf("%d %-6s tick %8.2f, frame %8.2f, draw %8.2f ms, %6.0f MiB\n", (int)slow_to_fast[kind],
                       virga_quality_name((virga_quality)quality), (double)costs.tick_ms, (double)costs.frame_ms,
                       (double)costs.draw_ms, (double)costs.memory_bytes / 1048576);
            assert_true(costs.tick_ms > 0 && small.tick_ms == costs.tick_ms);
            assert_true(small.draw_ms < costs.draw_ms && small.frame_ms < costs.frame_ms);
            if (kind > 0) {
                const virga_scene_costs slower = cost_of((virga_quality)quality, slow_to_fast[kind - 1], 1280, 720);
                assert_true(costs.tick_ms < slower.tick_ms && costs.frame_ms < slower.frame_ms);
            }
            if (quality > VIRGA_QUALITY_LOW) {
                const virga_scene_costs lower = cost_of((virga_quality)(quality - 1), slow_to_fast[kind], 1280, 720);
                assert_true(costs.tick_ms > lower.tick_ms && costs.frame_ms > lower.frame_ms);
            }
        }
}

/* By hand: rain alone moves drops, finds impacts and prepares; 8 and 7 dispatches and 4 maps. */
static void rain_alone_costs_what_its_rows_say(void **state)
{
    virga_scene_def def = virga_default_scene_def();
    virga_scene_costs costs;
    (void)state;
    def.rain.max_drops = 100000;
    def.rain.max_streaks = 2000;
    assert_int_equal(virga_scene_cost(&def, VK_PHYSICAL_DEVICE_TYPE_CPU, 100, 100, &costs), VIRGA_OK);
    assert_float_equal(costs.tick_ms, 100000 * 50e-6 + 8 * 0.045, 1e-4);
    assert_float_equal(costs.frame_ms, 100000 * 35e-6 + 4 * 1024 * 1024 * 4e-6 + 11 * 0.045, 1e-3);
    assert_float_equal(costs.draw_ms, 2000 * (330 + 0.58 * 100) * 1e-6 + 10000 * 15e-6 + 2 * 0.045, 1e-4);
}

static void a_cost_of_nothing_is_refused(void **state)
{
    virga_scene_def def = virga_default_scene_def(), wrong = def;
    virga_scene_costs costs;
    const VkPhysicalDeviceType cpu = VK_PHYSICAL_DEVICE_TYPE_CPU;
    (void)state;
    wrong.cookie = 0;
    assert_int_equal(virga_scene_cost(NULL, cpu, 64, 64, &costs), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_scene_cost(&wrong, cpu, 64, 64, &costs), VIRGA_ERROR_INVALID);
    assert_true(costs.tick_ms == 0 && costs.memory_bytes == 0);
    assert_int_equal(virga_scene_cost(&def, cpu, 64, 64, NULL), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_scene_cost(&def, cpu, 0, 64, &costs), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_scene_cost(&def, cpu, 64, 16385, &costs), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_scene_cost(&def, (VkPhysicalDeviceType)5, 64, 64, &costs), VIRGA_ERROR_INVALID);
}

static void what_does_not_exist_changes_nothing(void **state)
{
    const virga_rain_def same = virga_default_rain_def();
    virga_rain_def def = virga_default_rain_def();
    (void)state;
    virga_rain_apply_quality((virga_quality)4, &def);
    virga_rain_apply_quality((virga_quality)-1, &def);
    virga_rain_apply_quality(VIRGA_QUALITY_LOW, NULL);
    virga_scene_apply_quality(VIRGA_QUALITY_LOW, NULL);
    assert_memory_equal(&def, &same, sizeof def);
    assert_string_equal(virga_quality_name(VIRGA_QUALITY_FILM), "film");
    assert_string_equal(virga_quality_name((virga_quality)4), "unknown");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_many_ticks_as_fit_are_run),
        cmocka_unit_test(without_times_there_is_no_budget),
        cmocka_unit_test(a_wrong_budget_is_refused),
        cmocka_unit_test(a_slow_frame_makes_no_slower_ones),
        cmocka_unit_test(high_is_the_default_but_for_ticks),
        cmocka_unit_test(presets_are_in_range_and_take_more_and_more),
        cmocka_unit_test(presets_of_a_fluid_and_a_lens_are_in_range),
        cmocka_unit_test(what_does_not_exist_changes_nothing),
        cmocka_unit_test(better_qualities_cost_more_and_faster_devices_less),
        cmocka_unit_test(rain_alone_costs_what_its_rows_say),
        cmocka_unit_test(a_cost_of_nothing_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
