/* test_nothing.c - an effect that the library does not know: a folder of its own and one row in the scene's table. */
#include "../gpu/gpu_fixture.h"
#include "nothing.h"

enum { FRAMES = 6, TICKS_A_FRAME = 2 };

static virga_scene *make_scene(virga_context *context)
{
    virga_scene_def def = virga_default_scene_def();
    virga_scene *scene = NULL;
    def.rain = gpu_rain_def();
    REQUIRE(virga_scene_create(context, &def, &scene) == VIRGA_OK);
    return scene;
}

static void run(gpu_fixture *f, virga_context *context, virga_scene *scene)
{
    const virga_scene_frame frame = {.dt_s = TICKS_A_FRAME / 60.0, .camera_m = {0, 1.7, 0}};
    for (uint32_t number = 0; number < FRAMES; number++) {
        REQUIRE(virga_scene_record(scene, gpu_begin_frame(f, context), &frame) == VIRGA_OK);
        gpu_submit(f);
    }
    gpu_wait(f);
}

static void a_scene_runs_an_effect_that_it_does_not_name(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_scene *scene = make_scene(context);
    virga_nothing *nothing = virga_scene_nothing(scene);
    virga_nothing_settings settings = virga_default_nothing_settings();
    virga_nothing_stats stats;
    settings.weight = 5;
    REQUIRE(nothing && virga_nothing_set(nothing, &settings) == VIRGA_OK);
    run(f, context, scene);
    REQUIRE(virga_frame_completed(context, FRAMES) == VIRGA_OK);
    virga_nothing_stats_get(nothing, &stats);
    assert_int_equal(stats.frame_index, FRAMES);
    assert_int_equal(stats.sum, 5 * FRAMES * TICKS_A_FRAME);
    virga_scene_destroy(&scene);
    virga_context_destroy(&context);
}

static void its_setting_is_checked_by_its_table(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_scene *scene = make_scene(context);
    virga_nothing_settings settings = virga_default_nothing_settings();
    settings.weight = 101;
    assert_int_equal(virga_nothing_set(virga_scene_nothing(scene), &settings), VIRGA_DEGRADED);
    gpu_forget_log(f);
    settings.cookie++;
    assert_int_equal(virga_nothing_set(virga_scene_nothing(scene), &settings), VIRGA_ERROR_INVALID);
    gpu_forget_log(f);
    virga_scene_destroy(&scene);
    virga_context_destroy(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(a_scene_runs_an_effect_that_it_does_not_name),
        gpu_test(its_setting_is_checked_by_its_table),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("nothing", tests, NULL, NULL));
}
