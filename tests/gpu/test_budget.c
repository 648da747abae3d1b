/* test_budget.c - the memory budget of a context: never passed, not wasted, and what gives way for it. */
#include "gpu_fixture.h"

/* Memory stays within every budget, and a failure allocates nothing. */
static void budget_is_never_passed(void **state)
{
    gpu_fixture *f = *state;
    bool refused = false, made = false, smaller = false;
    for (VkDeviceSize budget = (VkDeviceSize)64 << 10; budget <= (VkDeviceSize)128 << 20; budget = budget * 3 / 2) {
        virga_context_def def = gpu_context_def(f);
        virga_rain_def rain_def = gpu_rain_def();
        virga_context *context = NULL;
        virga_rain *rains[3] = {NULL};
        rain_def.max_drops = 16384; /* so that there is something to shrink */
        def.memory_budget = budget;
        watch.max_bytes = 0;
        REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
        for (int i = 0; i < 3; i++) {
            gpu_forget_log(f);
            const virga_result result = virga_rain_create(context, &rain_def, &rains[i]);
            refused = refused || result < 0;
            made = made || !result;
            smaller = smaller || result == VIRGA_DEGRADED;
            if (result < 0) {
                assert_int_equal(result, VIRGA_ERROR_DEVICE_MEMORY);
                assert_one_error(f, VIRGA_LOG_DEVICE_MEMORY);
            }
            assert_int_equal(f->lines[VIRGA_LOG_SHRUNK], result == VIRGA_DEGRADED);
        }
        const VkDeviceSize max = watch.max_bytes;
        for (int i = 0; i < 3; i++)
            virga_rain_destroy(&rains[i]);
        virga_context_destroy(&context);
        if (max > budget)
            fail_msg("%llu bytes were taken, of a budget of %llu", (unsigned long long)max, (unsigned long long)budget);
    }
    assert_true(refused && made && smaller);
}

/* A budget that holds the rain and a few per cent is enough: it is not eaten by a page of which little is used. */
static void budget_is_for_what_is_used(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    const virga_rain_def rain_def = virga_default_rain_def();
    virga_rain *rain = NULL;
    virga_memory_stats stats;
    REQUIRE(virga_rain_create(context, &rain_def, &rain) == VIRGA_OK);
    virga_memory_get(context, &stats);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);

    virga_context_def def = gpu_context_def(f);
    def.memory_budget = stats.device_used + stats.device_used / 16;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    const virga_result result = virga_rain_create(context, &rain_def, &rain);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
    if (result)
        fail_msg("%llu bytes are used, and a budget of %llu was not enough: %s", (unsigned long long)stats.device_used,
                 (unsigned long long)def.memory_budget, f->last);
}

/* Rain for half the memory that it asks for: it is made smaller, says so once, and falls. */
static void rain_over_the_budget_is_smaller_and_falls(void **state)
{
    gpu_fixture *f = *state;
    virga_context_def def = gpu_context_def(f);
    const virga_rain_def rain_def = virga_default_rain_def();
    virga_context *context = NULL;
    virga_rain *rain = NULL;
    virga_rain_stats stats;
    const virga_rain_step_info step = {.dt_s = 1.0 / 30, .camera_m = {0, 1.7, 0}};
    def.memory_budget = virga_rain_estimate(&rain_def) / 2;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    /* A frame under way must not keep what was tried in vain. */
    VkCommandBuffer cmd = gpu_begin_frame(f, context);
    gpu_forget_log(f);
    assert_int_equal(virga_rain_create(context, &rain_def, &rain), VIRGA_DEGRADED);
    assert_int_equal(f->lines[VIRGA_LOG_SHRUNK], 1);
    assert_int_equal(f->errors, 0);
    assert_int_equal(virga_rain_step(rain, cmd, &step), VIRGA_OK);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_stats_get(rain, &stats);
    assert_in_range(stats.slots, rain_def.max_drops / 8, rain_def.max_drops * 7 / 8);
    assert_true(watch.max_bytes <= def.memory_budget);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

/* Water, and its solver, for half the memory that they ask for. */
static void water_over_the_budget_is_smaller(void **state)
{
    gpu_fixture *f = *state;
    virga_water_def water_def = virga_default_water_def();
    water_def.max_width = water_def.max_height = 256; /* images do not shrink, and are more than half otherwise */
    const virga_fluid_def fluid_def = virga_default_fluid_def();
    const VkDeviceSize whole[2] = {virga_water_estimate(&water_def), virga_fluid_estimate(&fluid_def)};
    for (int i = 0; i < 4; i++) {
        virga_context_def def = gpu_context_def(f);
        virga_context *context = NULL;
        virga_water *water = NULL;
        virga_fluid *fluid = NULL;
        def.pipeline_build_mode = VIRGA_PIPELINES_DEFERRED;                          /* none of which are built */
        def.memory_budget = i < 2 ? whole[i] / 2 : whole[i - 2] + whole[i - 2] / 16; /* pages are not full */
        watch.max_bytes = 0;
        REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
        gpu_forget_log(f);
        const virga_result result =
            i & 1 ? virga_fluid_create(context, &fluid_def, &fluid) : virga_water_create(context, &water_def, &water);
        if (result != (i < 2 ? VIRGA_DEGRADED : VIRGA_OK))
            fail_msg("%d: %s: %s", i, virga_result_name(result), f->last);
        assert_int_equal(f->lines[VIRGA_LOG_SHRUNK], i < 2);
        assert_int_equal(f->errors, 0);
        virga_fluid_destroy(&fluid);
        virga_water_destroy(&water);
        virga_context_destroy(&context);
        assert_true(watch.max_bytes <= def.memory_budget);
        assert_int_equal(watch_sum(watch.live), 0);
    }
}

/* Splashes whose memory is nearly all for water that falls back: this list becomes smaller too, but not smaller than
 * the spawns of a step, whose water may all come back at once. */
static void list_of_returned_droplets_gives_way(void **state)
{
    gpu_fixture *f = *state;
    virga_context_def def = gpu_context_def(f);
    virga_splash_def splash_def = virga_default_splash_def();
    splash_def.max_splashes = splash_def.max_droplets = 256;
    splash_def.max_spawns = 16384;
    def.pipeline_build_mode = VIRGA_PIPELINES_DEFERRED; /* none of which are built */
    splash_def.max_returned_droplets = splash_def.max_spawns;
    const VkDeviceSize min = virga_splash_estimate(&splash_def);
    splash_def.max_returned_droplets = 1 << 20;
    const VkDeviceSize max = virga_splash_estimate(&splash_def);
    for (int i = 0; i < 3; i++) {
        virga_context *context = NULL;
        virga_splash *splash = NULL;
        def.memory_budget = (VkDeviceSize[]){max / 2, min + min / 4, min / 2}[i];
        watch.max_bytes = 0;
        REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
        gpu_forget_log(f);
        assert_int_equal(virga_splash_create(context, &splash_def, &splash),
                         i < 2 ? VIRGA_DEGRADED : VIRGA_ERROR_DEVICE_MEMORY);
        assert_int_equal(f->lines[VIRGA_LOG_SHRUNK], i < 2); /* all other sizes are the least already */
        virga_splash_destroy(&splash);
        virga_context_destroy(&context);
        assert_true(watch.max_bytes <= def.memory_budget);
    }
}

static virga_scene_def scene_def_of_all(const virga_glass_def *pane)
{
    virga_scene_def def = virga_default_scene_def();
    def.rain.max_drops = 32768;
    def.ground.cells = 512;
    def.with_ground = def.with_splash = true;
    def.panes = pane;
    def.pane_count = 1;
    return def;
}

/* A scene in a context with that budget, of which nothing is left over. */
static virga_result make_scene(gpu_fixture *f, const virga_scene_def *scene_def, VkDeviceSize budget)
{
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    virga_scene *scene = NULL;
    def.memory_budget = budget;
    def.pipeline_build_mode = VIRGA_PIPELINES_DEFERRED; /* none of which are built */
    watch.max_bytes = 0;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    const virga_result result = virga_scene_create(context, scene_def, &scene);
    virga_scene_destroy(&scene);
    virga_context_destroy(&context);
    assert_true(watch.max_bytes <= budget);
    assert_int_equal(watch_sum(watch.live), 0);
    return result;
}

/* The estimate of a scene is a sufficient budget for it, though pages are larger than the buffers in them. */
static void estimate_of_a_scene_is_enough(void **state)
{
    const virga_glass_def pane = virga_default_glass_def();
    for (int parts = 0; parts < 8; parts++) {
        virga_scene_def def = scene_def_of_all(&pane);
        def.with_ground = parts & 1;
        def.with_splash = (parts & 3) == 3;
        def.pane_count = parts >> 2;
        assert_int_equal(make_scene(*state, &def, virga_scene_estimate(&def)), VIRGA_OK);
    }
}

/* Each effect of a scene gives way for those that follow only as far as it must; a scene in any budget that holds the
 * smallest of all works, and none is passed. */
static void scene_fits_into_any_budget(void **state)
{
    const virga_glass_def pane = virga_default_glass_def();
    const virga_scene_def def = scene_def_of_all(&pane);
    const VkDeviceSize whole = virga_scene_estimate(&def);
    bool refused = false, smaller = false, made = false;
    for (VkDeviceSize budget = whole / 64; budget <= 2 * whole; budget *= 2) {
        const virga_result result = make_scene(*state, &def, budget);
        assert_true(result == VIRGA_OK || result == VIRGA_DEGRADED || result == VIRGA_ERROR_DEVICE_MEMORY);
        refused = refused || result < 0;
        smaller = smaller || result == VIRGA_DEGRADED;
        made = made || result == VIRGA_OK;
    }
    assert_true(refused && smaller && made);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(budget_is_never_passed),
        gpu_kept_test(budget_is_for_what_is_used),
        gpu_kept_test(rain_over_the_budget_is_smaller_and_falls),
        gpu_kept_test(water_over_the_budget_is_smaller),
        gpu_kept_test(list_of_returned_droplets_gives_way),
        gpu_kept_test(estimate_of_a_scene_is_enough),
        gpu_kept_test(scene_fits_into_any_budget),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("budget", tests, NULL, NULL));
}
