/* test_context.c - contexts: made, refused, side by side, taken down, and lost with their device. */
#include "gpu_fixture.h"

static void context_is_made_and_says_so(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_memory_stats stats;
    virga_memory_get(context, &stats);
    assert_int_equal(f->lines[VIRGA_LOG_CREATED], 1);
    assert_int_equal(f->errors, 0);
    assert_int_equal(stats.objects, watch_sum(watch.live));
    assert_int_equal(stats.device_bytes, 0);
    virga_context_destroy(&context);
    assert_null(context);
    assert_int_equal(watch_sum(watch.live), 0);
}

static VkPhysicalDeviceType lie_type_name;

static void lie_type(VkPhysicalDeviceProperties *properties)
{
    properties->deviceType = lie_type_name;
}

/* Who forgets to choose a GPU wonders why it is slow. */
static void context_without_a_gpu_says_so(void **state)
{
    gpu_fixture *f = *state;
    const VkPhysicalDeviceType types[2] = {VK_PHYSICAL_DEVICE_TYPE_CPU, VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU};
    watch.lie_properties = lie_type;
    for (int i = 0; i < 2; i++) {
        lie_type_name = types[i];
        gpu_forget_log(f);
        virga_context *context = gpu_context(f);
        assert_int_equal(strstr(f->last, "software Vulkan without a GPU") != NULL, i == 0);
        virga_context_destroy(&context);
    }
}

static void destroy_accepts_null(void **state)
{
    (void)state;
    virga_context *context = NULL;
    virga_target *target = NULL;
    virga_rain *rain = NULL;
    virga_scene *scene = NULL;
    virga_context_destroy(NULL);
    virga_context_destroy(&context);
    virga_target_destroy(NULL);
    virga_target_destroy(&target);
    virga_rain_destroy(NULL);
    virga_rain_destroy(&rain);
    virga_scene_destroy(NULL);
    virga_scene_destroy(&scene);
}

static void destroy_sets_handles_to_null(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain *rain = gpu_rain(context);
    gpu_picture picture;
    gpu_picture_open(f, context, &picture);
    virga_scene *scene = NULL;
    virga_scene_def def = virga_default_scene_def();
    def.rain = gpu_rain_def();
    REQUIRE(virga_scene_create(context, &def, &scene) == VIRGA_OK);
    virga_scene_destroy(&scene);
    assert_null(scene);
    virga_rain_destroy(&rain);
    assert_null(rain);
    virga_target_destroy(&picture.target);
    assert_null(picture.target);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&context);
    assert_null(context);
}

static void two_contexts_live_side_by_side(void **state)
{
    gpu_fixture *f = *state;
    virga_context *first = gpu_context(f), *second = gpu_context(f);
    virga_rain *rain = gpu_rain(first), *other = gpu_rain(second);
    virga_rain_destroy(&rain);
    virga_context_destroy(&first);
    gpu_picture picture;
    gpu_picture_open(f, second, &picture);
    REQUIRE(virga_rain_attach(other, picture.target) == VIRGA_OK);
    gpu_record(gpu_begin_frame(f, second), other, &picture);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_destroy(&other);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&second);
}

static void wrong_context_arguments_are_refused(void **state)
{
    gpu_fixture *f = *state;
    const virga_context_def good = gpu_context_def(f);
    virga_context_def bad[8];
    for (int i = 0; i < 8; i++)
        bad[i] = good;
    bad[0].instance = VK_NULL_HANDLE;
    bad[1].physical_device = VK_NULL_HANDLE;
    bad[2].device = VK_NULL_HANDLE;
    bad[3].get_instance_proc_addr = NULL;
    bad[4].frames_in_flight = 0;
    bad[5].frames_in_flight = VIRGA_MAX_FRAMES_IN_FLIGHT + 1;
    bad[6].host_memory.alloc = (void *(*)(void *, size_t))(uintptr_t)8; /* without free */
    bad[7].device_memory.free = (void (*)(void *, const virga_memory_block *))(uintptr_t)8;
    for (int i = 0; i < 8; i++) {
        virga_context *context = (virga_context *)f;
        gpu_forget_log(f);
        assert_int_equal(virga_context_create(&bad[i], &context), VIRGA_ERROR_INVALID);
        assert_null(context);
        assert_one_error(f, VIRGA_LOG_ARGUMENT);
    }
    assert_int_equal(virga_context_create(&good, NULL), VIRGA_ERROR_INVALID);
    virga_context *context = (virga_context *)f;
    assert_int_equal(virga_context_create(NULL, &context), VIRGA_ERROR_INVALID);
    assert_null(context);
}

/* ---- a device that is lost */

static void lost_device_is_sticky_and_said_once(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain *rain = gpu_rain(context), *other = NULL;
    virga_target *target = NULL;
    const virga_rain_def def = gpu_rain_def();
    virga_target_def target_def = virga_default_target_def();
    const VkCommandBuffer cmd = gpu_begin_frame(f, context);
    const virga_rain_step_info step = {.dt_s = 0.02};
    const double camera[3] = {0, 0, 0};
    const virga_view view = virga_default_view();
    size_t size = 0;
    gpu_forget_log(f);
    watch_fail(1, VK_ERROR_DEVICE_LOST);
    assert_int_equal(virga_rain_create(context, &def, &other), VIRGA_ERROR_DEVICE_LOST);
    assert_null(other);
    watch_fail(0, VK_SUCCESS);
    assert_int_equal(virga_rain_create(context, &def, &other), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_target_create(context, &target_def, &target), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_rain_draw_occlusion(rain, cmd, camera, NULL, 0), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_rain_step(rain, cmd, &step), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_rain_prepare(rain, cmd, &view, 0), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_frame_begin(context, 100, 99), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_frame_completed(context, 1), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_pipeline_cache_get(context, &size, NULL), VIRGA_ERROR_DEVICE_LOST);
    assert_one_error(f, VIRGA_LOG_DEVICE_LOST);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(context_is_made_and_says_so),
        gpu_test(context_without_a_gpu_says_so),
        gpu_test(destroy_accepts_null),
        gpu_test(destroy_sets_handles_to_null),
        gpu_test(two_contexts_live_side_by_side),
        gpu_test(wrong_context_arguments_are_refused),
        gpu_test(lost_device_is_sticky_and_said_once),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
