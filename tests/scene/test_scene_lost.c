/* test_scene_lost.c - frames whose command buffer the host throws away: rain, ground, splashes and panes are complete
 * again, and no water is counted that no frame moved. */
#include "../gpu/gpu_fixture.h"
#include "../gpu/small_state.h"
#include "host_parts.h"

enum { FRAMES = 24 };

typedef struct lost_run {
    gpu_fixture *f;
    virga_context *context;
    virga_scene *scene;
    gpu_picture picture;
    host_buffer vertices, indices;
    small_state state;
    bool tell, wait, walk; /* what the host does */
    bool unbalanced;       /* water that fell on ground without heights is not followed */
} lost_run;

static void open_run(lost_run *run, gpu_fixture *f)
{
    virga_glass_def panes[SMALL_PANES];
    const virga_scene_def def = small_scene_def(panes);
    run->f = f;
    run->context = gpu_context(f);
    gpu_picture_open(f, run->context, &run->picture);
    REQUIRE(virga_scene_create(run->context, &def, &run->scene) == VIRGA_OK);
    REQUIRE(small_shapes_set(run->scene) == VIRGA_OK && small_weather_set(run->scene) == VIRGA_OK);
    REQUIRE(virga_scene_attach(run->scene, run->picture.target) == VIRGA_OK);
    host_parts_square(&f->gpu, &run->vertices, &run->indices);
    REQUIRE(small_state_open(&run->state, &f->gpu.device, run->scene, f->gpu.error, sizeof f->gpu.error));
    gpu_forget_log(f);
}

static void close_run(lost_run *run)
{
    small_state_close(&run->state, &run->f->gpu.device);
    host_buffer_destroy(&run->f->gpu.device, &run->vertices);
    host_buffer_destroy(&run->f->gpu.device, &run->indices);
    virga_scene_destroy(&run->scene);
    gpu_picture_close(run->f, &run->picture);
    virga_context_destroy(&run->context);
}

static void record(lost_run *run, VkCommandBuffer cmd, uint32_t number)
{
    const virga_occluder square = small_occluder(run->vertices.buffer, run->indices.buffer);
    virga_scene_pane panes[SMALL_PANES];
    virga_view view = gpu_view(&run->picture);
    const double ahead = run->walk ? 0.7 * number : 0; /* the ground's window follows */
    const virga_scene_frame frame = {.dt_s = 1.0 / 60,
                                     .camera_m = {0, 1.7, -ahead},
                                     .ripple_center_m = {0, 0, -ahead},
                                     .occluders = &square,
                                     .occluder_count = 1,
                                     .view = &view,
                                     .panes = panes};
    small_panes_lay(panes);
    view.position_m[1] = view.open_position_m[1] = 1.7;
    view.position_m[2] = view.open_position_m[2] = -ahead;
    assert_int_equal(virga_scene_record(run->scene, cmd, &frame), VIRGA_OK);
    host_target_begin_layer(&run->picture.images, cmd);
    assert_int_equal(virga_scene_draw(run->scene, cmd, run->picture.target), VIRGA_OK);
    host_target_end_layer(&run->picture.images, cmd);
    small_state_record(&run->state, cmd, run->scene);
}

/* `lost` has a bit for each frame that is thrown away. */
static void play(lost_run *run, uint32_t lost)
{
    for (uint32_t number = 1; number <= FRAMES; number++) {
        VkCommandBuffer cmd = gpu_begin_frame(run->f, run->context);
        record(run, cmd, number);
        if (lost & 1u << number)
            host_parts_throw_away(&run->f->gpu.device, run->context, cmd, run->tell);
        gpu_submit(run->f);
        if (run->wait)
            gpu_wait(run->f);
    }
    gpu_wait(run->f);
    assert_int_equal(virga_frame_completed(run->context, run->f->gpu.device.completed), VIRGA_OK);
}

static void check_rain_everywhere(lost_run *run)
{
    virga_rain_stats rain;
    virga_splash_stats splashes;
    virga_glass_stats pane;
    virga_ground_stats ground;
    virga_rain_stats_get(virga_scene_rain(run->scene), &rain);
    virga_splash_stats_get(virga_scene_splash(run->scene), &splashes);
    virga_glass_stats_get(virga_scene_glass(run->scene, 0), &pane);
    virga_ground_stats_get(virga_scene_ground(run->scene), &ground);
    assert_int_equal(rain.frame_index, run->f->gpu.device.frame);
    assert_true(rain.streaks > 0);
    assert_true(splashes.splashes_alive > 0);
    assert_true(pane.drops > 0);
    assert_true(ground.puddles_nl > 0);
    if (!run->unbalanced && !small_state_check(&run->state, &run->f->gpu.device, run->scene))
        fail_msg("%s", run->state.wrong);
}

static void check(void **state, lost_run host, uint32_t lost)
{
    lost_run run = host;
    open_run(&run, *state);
    play(&run, lost);
    assert_int_equal(virga_frames_lost(run.context), __builtin_popcount(lost));
    assert_int_equal(run.f->lines[VIRGA_LOG_FRAME_LOST], run.tell || !lost ? 0 : 1);
    check_rain_everywhere(&run);
    close_run(&run);
}

#define FIRST  (1u << 1)
#define MIDDLE (1u << 9 | 1u << 14)

static void a_first_frame_that_is_told(void **state)
{
    check(state, (lost_run){.tell = true}, FIRST);
}

static void a_first_frame_that_is_found_lost(void **state)
{
    check(state, (lost_run){.wait = true}, FIRST);
}

static void a_first_frame_that_is_found_lost_with_others_in_flight(void **state)
{
    check(state, (lost_run){.unbalanced = true}, FIRST);
}

static void a_middle_frame_that_is_told(void **state)
{
    check(state, (lost_run){.tell = true}, MIDDLE);
}

static void a_middle_frame_that_is_found_lost_with_others_in_flight(void **state)
{
    check(state, (lost_run){0}, MIDDLE);
}

static void frames_in_which_the_window_moves(void **state)
{
    check(state, (lost_run){.tell = true, .walk = true}, FIRST | 0x49248);
    check(state, (lost_run){.wait = true, .walk = true}, FIRST | 0x49248);
}

static void no_frame_at_all(void **state)
{
    check(state, (lost_run){.walk = true}, 0);
}

static void dropped_frames_are_begun_and_not_completed(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    assert_int_equal(virga_frame_dropped(NULL, 1), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_frame_begin(context, 3, 1), VIRGA_OK);
    const uint64_t wrong[] = {0, 1, 4};
    for (int i = 0; i < 3; i++) {
        gpu_forget_log(f);
        assert_int_equal(virga_frame_dropped(context, wrong[i]), VIRGA_ERROR_INVALID);
        assert_one_error(f, VIRGA_LOG_FRAME_ORDER);
    }
    assert_int_equal(virga_frame_dropped(context, 3), VIRGA_OK);
    assert_int_equal(virga_frames_lost(context), 0); /* nothing was recorded in it */
    virga_context_destroy(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(no_frame_at_all),
        gpu_kept_test(a_first_frame_that_is_told),
        gpu_kept_test(a_first_frame_that_is_found_lost),
        gpu_kept_test(a_first_frame_that_is_found_lost_with_others_in_flight),
        gpu_kept_test(a_middle_frame_that_is_told),
        gpu_kept_test(a_middle_frame_that_is_found_lost_with_others_in_flight),
        gpu_kept_test(frames_in_which_the_window_moves),
        gpu_kept_test(dropped_frames_are_begun_and_not_completed),
    };
    if (getenv("ONLY"))
        cmocka_set_test_filter(getenv("ONLY"));
    return effect_fixture_close(cmocka_run_group_tests_name("lost frames", tests, NULL, NULL));
}
