/* test_frames.c - frames in their order, and the passes that are timed in them. */
#include "gpu_fixture.h"

static void step_before_the_first_frame_is_refused(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain *rain = gpu_rain(context);
    VkCommandBuffer cmd;
    REQUIRE(host_begin_frame(&f->gpu.device, &cmd, f->gpu.error, sizeof f->gpu.error));
    const virga_rain_step_info step = {.dt_s = 0.02};
    gpu_forget_log(f);
    assert_int_equal(virga_rain_step(rain, cmd, &step), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_FRAME_ORDER);
    assert_true(virga_rain_time(rain) == 0);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

/* Recording occlusion too needs a frame: its timers, and its part of the rings. */
static void occlusion_before_the_first_frame_is_refused(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain *rain = gpu_rain(context);
    const double camera[3] = {0, 0, 0};
    VkCommandBuffer cmd;
    REQUIRE(host_begin_frame(&f->gpu.device, &cmd, f->gpu.error, sizeof f->gpu.error));
    gpu_forget_log(f);
    assert_int_equal(virga_rain_draw_occlusion(rain, cmd, camera, NULL, 0), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_FRAME_ORDER);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

/* begin refuses, says so once, and goes on as if it had not been called. */
static void check_refused_frame(gpu_fixture *f, virga_context *context, uint64_t frame, uint64_t completed)
{
    gpu_forget_log(f);
    if (virga_frame_begin(context, frame, completed) != VIRGA_ERROR_INVALID)
        fail_msg("frame %d with %d completed was taken", (int)frame, (int)completed);
    assert_one_error(f, VIRGA_LOG_FRAME_ORDER);
}

static void frames_rise_and_completed_stays_behind(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    check_refused_frame(f, context, 0, 0); /* indices start at 1 */
    check_refused_frame(f, context, 1, 1); /* complete before it was recorded */
    check_refused_frame(f, context, 1, 2);
    check_refused_frame(f, context, 4, 0); /* four frames in flight, of three */
    assert_int_equal(virga_frame_begin(context, 3, 0), VIRGA_OK);
    check_refused_frame(f, context, 3, 0); /* the same again */
    check_refused_frame(f, context, 2, 0); /* backwards */
    check_refused_frame(f, context, 4, 4);
    check_refused_frame(f, context, UINT64_MAX, 0);
    assert_int_equal(virga_frame_begin(context, 5, 3), VIRGA_OK);
    check_refused_frame(f, context, 6, 2);                           /* what was complete stays so */
    assert_int_equal(virga_frame_begin(context, 100, 97), VIRGA_OK); /* by any amount */
    assert_int_equal(virga_frame_begin(NULL, 1, 0), VIRGA_ERROR_INVALID);
    virga_context_destroy(&context);
}

/* A frame that was never begun cannot have completed, whatever comes after it. */
static void completed_does_not_pass_the_newest_frame(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    const uint64_t wrong[] = {3, 1, UINT64_MAX};
    assert_int_equal(virga_frame_completed(context, 0), VIRGA_OK);
    assert_int_equal(virga_frame_begin(context, 2, 0), VIRGA_OK);
    assert_int_equal(virga_frame_completed(context, 2), VIRGA_OK);
    for (int i = 0; i < 3; i++) {
        gpu_forget_log(f);
        assert_int_equal(virga_frame_completed(context, wrong[i]), VIRGA_ERROR_INVALID);
        assert_one_error(f, VIRGA_LOG_FRAME_ORDER);
    }
    assert_int_equal(virga_frame_completed(NULL, 1), VIRGA_ERROR_INVALID);
    virga_context_destroy(&context);
}

/* ---- rain that nobody sees */

static virga_rain *rain_of_views(virga_context *context, uint32_t views)
{
    virga_rain_def def = gpu_rain_def();
    virga_rain_settings settings = virga_default_rain_settings();
    virga_rain *rain = NULL;
    def.max_views = views;
    settings.rate_mm_h = 100;
    REQUIRE(virga_rain_create(context, &def, &rain) == VIRGA_OK);
    REQUIRE(virga_rain_set(rain, &settings) == VIRGA_OK);
    return rain;
}

/* Seconds of rain, with views whose cameras are that far from the drops. Every `pause`-th frame has views. Returns the
 * number of lines about it. */
static uint32_t lines_of_unseen_rain(gpu_fixture *f, uint32_t views, const double *away_m, int pause)
{
    virga_context *context = gpu_context(f);
    virga_rain *rain = rain_of_views(context, views);
    gpu_picture picture;
    gpu_picture_open(f, context, &picture);
    gpu_forget_log(f);
    for (int frame = 0; frame < 40; frame++) {
        const virga_rain_step_info step = {.dt_s = 0.25};
        const VkCommandBuffer cmd = gpu_begin_frame(f, context);
        assert_int_equal(virga_rain_step(rain, cmd, &step), VIRGA_OK);
        for (uint32_t i = 0; i < views && frame % pause == 0; i++) {
            virga_view view = gpu_view(&picture);
            view.position_m[0] = view.open_position_m[0] = away_m[i];
            assert_int_equal(virga_rain_prepare(rain, cmd, &view, virga_rain_time(rain)), VIRGA_OK);
        }
        gpu_submit(f);
    }
    gpu_wait(f);
    REQUIRE(virga_frame_completed(context, f->gpu.device.completed) == VIRGA_OK);
    const uint32_t lines = f->lines[VIRGA_LOG_NOT_DRAWN];
    virga_rain_destroy(&rain);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&context);
    return lines;
}

/* A camera in other units than the rain's, and one of two halves of a screen. */
static void rain_that_nobody_sees_is_told_once(void **state)
{
    static const double here[2] = {0, 0}, away[2] = {1000, 1000}, one_away[2] = {1000, 0}, other_away[2] = {0, 1000};
    gpu_fixture *f = *state;
    assert_int_equal(lines_of_unseen_rain(f, 1, here, 1), 0);
    assert_int_equal(lines_of_unseen_rain(f, 1, away, 1), 1);
    assert_int_equal(lines_of_unseen_rain(f, 2, here, 1), 0);
    assert_int_equal(lines_of_unseen_rain(f, 2, away, 1), 1);
    assert_int_equal(lines_of_unseen_rain(f, 2, one_away, 1), 1);
    assert_int_equal(lines_of_unseen_rain(f, 2, other_away, 1), 1);
}

/* Two looks at nothing, 5 s apart, are no seconds of rain. */
static void time_without_views_is_not_time_unseen(void **state)
{
    static const double away[1] = {1000};
    assert_int_equal(lines_of_unseen_rain(*state, 1, away, 20), 0);
}

/* ---- timings */

static VkPhysicalDeviceType lie_type_name;

static void lie_type(VkPhysicalDeviceProperties *properties)
{
    properties->deviceType = lie_type_name;
}

/* Barriers at which everything waits for everything in a frame of rain on such a device, and passes that were timed. */
static uint32_t full_barriers(gpu_fixture *f, VkPhysicalDeviceType type, bool timings, uint32_t *timed)
{
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    def.timings = timings;
    lie_type_name = type;
    watch.lie_properties = lie_type;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    watch.lie_properties = NULL;
    virga_rain *rain = gpu_rain(context);
    gpu_picture picture;
    gpu_picture_open(f, context, &picture);
    REQUIRE(virga_rain_attach(rain, picture.target) == VIRGA_OK);
    watch.full_barriers = 0;
    gpu_record(gpu_begin_frame(f, context), rain, &picture);
    const uint32_t found = watch.full_barriers;
    gpu_submit(f);
    gpu_wait(f);
    REQUIRE(virga_frame_completed(context, f->gpu.device.completed) == VIRGA_OK);
    *timed = virga_timings_get(context, NULL, 0);
    virga_rain_destroy(&rain);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&context);
    return found;
}

/* A GPU would drain at each, also where timings are on by default. A processor draws after its timestamps, so draws are
 * timed on GPUs alone. */
static void passes_are_timed_one_by_one_on_processors_alone(void **state)
{
    gpu_fixture *f = *state;
    uint32_t on_processor = 0, on_gpu = 0, none = 0;
    assert_true(full_barriers(f, VK_PHYSICAL_DEVICE_TYPE_CPU, true, &on_processor) > 0);
    assert_int_equal(full_barriers(f, VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, true, &on_gpu), 0);
    assert_int_equal(full_barriers(f, VK_PHYSICAL_DEVICE_TYPE_CPU, false, &none), 0);
    assert_true(on_processor > 0);
    assert_true(on_gpu > on_processor);
    assert_int_equal(none, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(step_before_the_first_frame_is_refused),
        gpu_kept_test(occlusion_before_the_first_frame_is_refused),
        gpu_kept_test(frames_rise_and_completed_stays_behind),
        gpu_kept_test(completed_does_not_pass_the_newest_frame),
        gpu_kept_test(rain_that_nobody_sees_is_told_once),
        gpu_kept_test(time_without_views_is_not_time_unseen),
        gpu_kept_test(passes_are_timed_one_by_one_on_processors_alone),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
