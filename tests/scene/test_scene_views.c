/* test_scene_views.c - several views in one frame: each is drawn as it is alone, in any order and in one pass; what is
 * no view of this frame is refused. */
#include "views_fixture.h"

static float alone[VIEWS][PIXELS * 4];

static const float *finish(views_run *run, VkCommandBuffer cmd)
{
    host_target_copy_out(&run->images, cmd, 1u << HOST_LAYER);
    gpu_submit(run->f);
    gpu_wait(run->f);
    return host_target_floats(&run->f->gpu.device, &run->images, HOST_LAYER);
}

/* A frame in which time stands still. Draws `count` of its views in the given order, in one pass. */
static const float *draw(views_run *run, uint32_t first, uint32_t count, const uint32_t *order)
{
    VkCommandBuffer cmd = gpu_begin_frame(run->f, run->context);
    assert_int_equal(record(run, cmd, 0, first, count), VIRGA_OK);
    host_target_begin_layer(&run->images, cmd);
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(virga_scene_draw_view(run->scene, cmd, run->target, order[i]), VIRGA_OK);
    host_target_end_layer(&run->images, cmd);
    return finish(run, cmd);
}

static void draw_each_alone(views_run *run)
{
    static const uint32_t only[1] = {0};
    play(run);
    for (uint32_t i = 0; i < VIEWS; i++)
        memcpy(alone[i], draw(run, i, 1, only), sizeof alone[i]);
}

static double sum_of_view(const float *picture, uint32_t view)
{
    double sum = 0;
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++)
            sum += (double)picture[4 * (y * SIDE * VIEWS + view * SIDE + x) + 3];
    return sum;
}

/* Each third of the picture is what it is in the picture of that view alone. */
static void assert_as_alone(const float *picture)
{
    for (uint32_t view = 0; view < VIEWS; view++) {
        assert_true(sum_of_view(picture, view) > 20);
        for (uint32_t y = 0; y < SIDE; y++) {
            const size_t at = 4 * (y * SIDE * VIEWS + view * SIDE);
            assert_memory_equal(&picture[at], &alone[view][at], SIDE * 4 * sizeof(float));
        }
    }
    for (uint32_t y = 0; y < SIDE; y++) /* and they differ */
        if (memcmp(&picture[4 * y * SIDE * VIEWS], &picture[4 * (y * SIDE * VIEWS + SIDE)], SIDE * 4 * sizeof(float)))
            return;
    fail_msg("two views show the same");
}

static void views_in_one_pass_are_as_each_alone(void **state)
{
    static const uint32_t forward[VIEWS] = {0, 1, 2}, backward[VIEWS] = {2, 1, 0};
    static views_run run;
    open_run(&run, *state, VIEWS);
    draw_each_alone(&run);
    assert_as_alone(draw(&run, 0, VIEWS, forward));
    assert_as_alone(draw(&run, 0, VIEWS, backward));
    assert_int_equal(run.f->errors, 0);
    assert_int_equal(run.f->lines[VIRGA_LOG_NOT_DRAWN], 0);
    close_run(&run);
}

/* A frame is thrown away after its views were prepared. The next one shows all of them. */
static void views_after_a_lost_frame_are_whole(void **state)
{
    static const uint32_t forward[VIEWS] = {0, 1, 2};
    static views_run run;
    open_run(&run, *state, VIEWS);
    draw_each_alone(&run);
    VkCommandBuffer cmd = gpu_begin_frame(run.f, run.context);
    assert_int_equal(record(&run, cmd, 0, 0, VIEWS), VIRGA_OK);
    host_parts_throw_away(&run.f->gpu.device, run.context, cmd, true);
    assert_int_equal(virga_scene_draw_view(run.scene, cmd, run.target, 0), VIRGA_ERROR_INVALID);
    gpu_submit(run.f);
    assert_as_alone(draw(&run, 0, VIEWS, forward));
    close_run(&run);
}

static void statistics_are_by_view(void **state)
{
    static const uint32_t forward[VIEWS] = {0, 1, 2}, only[1] = {0};
    static views_run run;
    uint32_t streaks[VIEWS], sprites[VIEWS], balls[VIEWS];
    virga_rain_stats rain;
    virga_splash_stats splash;
    virga_glass_stats glass;
    open_run(&run, *state, VIEWS);
    play(&run);
    for (uint32_t i = 0; i <= VIEWS; i++) {
        draw(&run, i % VIEWS, i < VIEWS ? 1 : VIEWS, i < VIEWS ? only : forward);
        assert_int_equal(virga_frame_completed(run.context, run.f->gpu.device.completed), VIRGA_OK);
        virga_rain_stats_get(virga_scene_rain(run.scene), &rain);
        virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
        virga_glass_stats_get(virga_scene_glass(run.scene, 0), &glass);
        if (i == VIEWS)
            break;
        assert_int_equal(rain.views, 1);
        streaks[i] = rain.streaks;
        sprites[i] = splash.sprites;
        balls[i] = glass.balls;
    }
    assert_int_equal(rain.views, VIEWS);
    assert_int_equal(splash.views, VIEWS);
    assert_int_equal(glass.views, VIEWS);
    assert_int_equal(rain.streaks, streaks[VIEWS - 1]);
    assert_true(streaks[0] > 10 && sprites[0] > 0);
    assert_memory_equal(rain.view_streaks, streaks, sizeof streaks);
    assert_memory_equal(splash.view_sprites, sprites, sizeof sprites);
    assert_memory_equal(glass.view_balls, balls, sizeof balls);
    close_run(&run);
}

/* ---- what is no view */

static virga_prepared prepare_rain(views_run *run, VkCommandBuffer cmd, uint32_t view)
{
    virga_rain *rain = virga_scene_rain(run->scene);
    virga_prepared prepared = 0;
    assert_int_equal(virga_rain_prepare_view(rain, cmd, &run->views[view], virga_rain_time(rain), &prepared), VIRGA_OK);
    assert_true(prepared != 0);
    return prepared;
}

static void refused(views_run *run, VkCommandBuffer cmd, virga_prepared prepared, const char *why)
{
    gpu_forget_log(run->f);
    assert_int_equal(virga_rain_draw_view(virga_scene_rain(run->scene), cmd, run->target, prepared),
                     VIRGA_ERROR_INVALID);
    assert_one_error(run->f, VIRGA_LOG_ARGUMENT);
    if (!strstr(run->f->last, why))
        fail_msg("expected '%s' in: %s", why, run->f->last);
}

static void what_is_no_view_of_this_frame_is_refused(void **state)
{
    static views_run run;
    open_run(&run, *state, 2);
    play(&run);
    VkCommandBuffer cmd = gpu_begin_frame(run.f, run.context);
    const virga_prepared old = prepare_rain(&run, cmd, 0);
    gpu_submit(run.f);
    cmd = gpu_begin_frame(run.f, run.context);
    virga_prepared other = 0;
    virga_rain *rain = virga_scene_rain(run.scene);
    virga_splash *splash = virga_scene_splash(run.scene);
    assert_int_equal(virga_splash_prepare_view(splash, cmd, &run.views[0], virga_splash_time(splash), &other),
                     VIRGA_OK);
    const virga_prepared first = prepare_rain(&run, cmd, 0);
    prepare_rain(&run, cmd, 1);
    gpu_forget_log(run.f);
    const virga_prepared third = prepare_rain(&run, cmd, 2); /* there is room for two */
    assert_int_equal(run.f->lines[VIRGA_LOG_NOT_DRAWN], 1);
    host_target_begin_layer(&run.images, cmd);
    refused(&run, cmd, old, "another frame");
    refused(&run, cmd, other, "another effect");
    refused(&run, cmd, first, "max_views");
    assert_int_equal(virga_rain_draw_view(rain, cmd, run.target, third), VIRGA_OK);
    assert_int_equal(virga_rain_draw(rain, cmd, run.target), VIRGA_OK);
    assert_int_equal(virga_rain_draw_view(rain, cmd, run.target, 0), VIRGA_NOT_READY);
    host_target_end_layer(&run.images, cmd);
    gpu_submit(run.f);
    gpu_wait(run.f);
    close_run(&run);
}

static void a_scene_says_how_many_views_it_has(void **state)
{
    static views_run run;
    virga_glass_def panes[SMALL_PANES];
    virga_scene_def def = define(VIRGA_MAX_VIEWS + 1, panes);
    virga_scene *none;
    open_run(&run, *state, 2);
    assert_int_equal(virga_scene_create(run.context, &def, &none), VIRGA_ERROR_INVALID);
    assert_one_error(run.f, VIRGA_LOG_ARGUMENT);
    VkCommandBuffer cmd = gpu_begin_frame(run.f, run.context);
    gpu_forget_log(run.f);
    assert_int_equal(record(&run, cmd, 1.0 / 60, 0, 3), VIRGA_ERROR_INVALID);
    assert_one_error(run.f, VIRGA_LOG_ARGUMENT);
    assert_int_equal(record(&run, cmd, 1.0 / 60, 0, 2), VIRGA_OK);
    host_target_begin_layer(&run.images, cmd);
    gpu_forget_log(run.f);
    assert_int_equal(virga_scene_draw(run.scene, cmd, run.target), VIRGA_ERROR_INVALID);
    assert_one_error(run.f, VIRGA_LOG_ARGUMENT);
    gpu_forget_log(run.f);
    assert_int_equal(virga_scene_draw_view(run.scene, cmd, run.target, 2), VIRGA_ERROR_INVALID);
    assert_one_error(run.f, VIRGA_LOG_ARGUMENT);
    assert_int_equal(virga_scene_draw_view(run.scene, cmd, run.target, 1), VIRGA_OK);
    host_target_end_layer(&run.images, cmd);
    gpu_submit(run.f);
    gpu_wait(run.f);
    close_run(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(views_in_one_pass_are_as_each_alone),
        gpu_kept_test(views_after_a_lost_frame_are_whole),
        gpu_kept_test(statistics_are_by_view),
        gpu_kept_test(what_is_no_view_of_this_frame_is_refused),
        gpu_kept_test(a_scene_says_how_many_views_it_has),
    };
    if (getenv("ONLY"))
        cmocka_set_test_filter(getenv("ONLY"));
    return effect_fixture_close(cmocka_run_group_tests_name("views", tests, NULL, NULL));
}
