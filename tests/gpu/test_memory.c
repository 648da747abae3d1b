/* test_memory.c - what is taken is counted, used, and given back, also when the device is still at work on what a host
 * destroys. */
#include "small_scene.h"
#include "small_stage.h"

/* ---- what the counters say */

static void counters_say_what_is_alive(void **state)
{
    gpu_fixture *f = *state;
    const virga_context_def def = gpu_context_def(f);
    stage s;
    stage_open(f, &def, &s);
    for (int i = 0; i < 4; i++) {
        virga_memory_stats stats;
        virga_memory_get(s.context, &stats);
        assert_int_equal(stats.objects, watch_sum(watch.live));
        assert_int_equal(stats.device_bytes, watch.bytes);
        assert_int_equal(stats.device_allocations, watch.live[WATCH_Memory]);
        assert_true(stats.device_used > 0 && stats.device_used <= stats.device_bytes);
        run_frame(f, &s);
    }
    gpu_wait(f);
    stage_close(f, &s);
}

/* Without another frame: a host that ends has none. */
static void counters_are_zero_after_the_last_destroy(void **state)
{
    gpu_fixture *f = *state;
    const virga_context_def def = gpu_context_def(f);
    stage s;
    stage_open(f, &def, &s);
    run_frame(f, &s);
    run_frame(f, &s);
    gpu_wait(f);
    REQUIRE(virga_frame_completed(s.context, f->gpu.device.completed) == VIRGA_OK);
    virga_rain_destroy(&s.rain);
    virga_target_destroy(&s.picture.target);
    check_empty(&s);
    stage_close(f, &s);
}

static void memory_get_accepts_null(void **state)
{
    (void)state;
    const virga_memory_stats zero = {0};
    virga_memory_stats stats;
    memset(&stats, 255, sizeof stats);
    virga_memory_get(NULL, &stats);
    assert_memory_equal(&stats, &zero, sizeof zero);
    virga_memory_get(NULL, NULL);
}

/* The estimate is what a host plans with. Rain allocates hardly more, and less only by frames that are not in
 * flight. */
static void estimate_is_what_rain_takes(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain_def def = virga_default_rain_def();
    virga_rain *rain = NULL;
    virga_memory_stats stats;
    const double estimate = (double)virga_rain_estimate(&def);
    REQUIRE(virga_rain_create(context, &def, &rain) == VIRGA_OK);
    virga_memory_get(context, &stats);
    const double used = (double)stats.device_used;
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
    if (used > estimate * 1.02 || used < estimate * 0.6)
        fail_msg("%.0f bytes are used, and the estimate is %.0f", used, estimate);
}

/* ---- Virga's own pages */

/* Without the fixture's budget, which makes pages small. */
static virga_context *roomy_context(gpu_fixture *f)
{
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    def.memory_budget = 0;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    return context;
}

static void few_blocks_hold_many_buffers(void **state)
{
    gpu_fixture *f = *state;
    const virga_context_def def = gpu_context_def(f);
    stage s;
    stage_open(f, &def, &s);
    const uint32_t resources = watch.made[WATCH_Buffer] + watch.made[WATCH_Image];
    assert_true(resources >= 18);
    assert_in_range(watch.made[WATCH_Memory], 1, 3); /* buffers, images, and where the device has it, mapped memory */
    stage_close(f, &s);
}

/* As many drops as by default: blocks may be as many as the bytes ask for, and a few. */
static void few_blocks_hold_default_rain(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = roomy_context(f);
    const virga_rain_def def = virga_default_rain_def();
    virga_rain *rain = NULL;
    REQUIRE(virga_rain_create(context, &def, &rain) == VIRGA_OK);
    assert_in_range(watch.made[WATCH_Memory], 1, (watch.bytes >> 25) + 3);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

/* Memory that was given back is taken again: making and destroying does not pile up. */
static void memory_is_used_again(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = roomy_context(f);
    virga_rain *kept = gpu_rain(context);
    const VkDeviceSize bytes = watch.bytes;
    for (int i = 0; i < 12; i++) {
        virga_rain *rain = gpu_rain(context);
        virga_rain_destroy(&rain);
    }
    assert_int_equal(watch.bytes, bytes);
    assert_int_equal(watch.max_bytes, bytes);
    virga_rain_destroy(&kept);
    virga_context_destroy(&context);
}

/* ---- what a device sets a limit to */

static void lie_small_storage(VkPhysicalDeviceProperties *properties)
{
    properties->limits.maxStorageBufferRange = 20000;
}

static void lie_small_images(VkPhysicalDeviceProperties *properties)
{
    properties->limits.maxImageDimension2D = 32;
}

static void lie_few_layers(VkPhysicalDeviceProperties *properties)
{
    properties->limits.maxImageArrayLayers = 1;
}

/* A device promises 128 MiB to a storage buffer and 4096 texels to a side; definitions may ask for more. */
static void what_is_too_large_for_the_device_is_refused(void **state)
{
    gpu_fixture *f = *state;
    void (*const lies[])(VkPhysicalDeviceProperties *) = {lie_small_storage, lie_small_images, lie_few_layers};
    const virga_rain_def def = gpu_rain_def();
    for (int i = 0; i < 3; i++) {
        watch.lie_properties = lies[i];
        virga_context *context = gpu_context(f);
        virga_rain *rain = NULL;
        gpu_forget_log(f);
        assert_int_equal(virga_rain_create(context, &def, &rain), VIRGA_ERROR_UNSUPPORTED);
        assert_null(rain);
        assert_one_error(f, VIRGA_LOG_FEATURE_MISSING);
        virga_context_destroy(&context);
    }
}

static void lie_half_a_mib(VkPhysicalDeviceProperties *properties)
{
    properties->limits.maxStorageBufferRange = 1u << 19;
}

/* Splashes shrink to what a storage buffer can hold: in every buffer with a row per droplet, also the widest. */
static void splashes_fit_what_storage_buffers_hold(void **state)
{
    gpu_fixture *f = *state;
    watch.lie_properties = lie_half_a_mib;
    virga_context *context = gpu_context(f);
    virga_splash_def def = small_splash_def();
    virga_splash *splash = NULL;
    def.max_droplets = 1u << 20;
    gpu_forget_log(f);
    assert_int_equal(virga_splash_create(context, &def, &splash), VIRGA_DEGRADED);
    assert_int_equal(f->lines[VIRGA_LOG_CLAMPED], 1);
    virga_splash_destroy(&splash);
    virga_context_destroy(&context);
}

/* ---- destroying what the device is at work on */

/* Validation, too, complains of anything that is destroyed under a frame. */
static void rain_destroyed_under_a_frame_lives_until_it_has_completed(void **state)
{
    gpu_fixture *f = *state;
    const virga_context_def def = gpu_context_def(f);
    stage s;
    stage_open(f, &def, &s);
    run_frame(f, &s); /* 1 */
    uint32_t before[WATCH_KINDS];
    memcpy(before, watch.live, sizeof before);
    virga_rain_destroy(&s.rain);
    assert_null(s.rain);
    char text[256] = "";
    for (int i = 0; i < WATCH_KINDS; i++)
        if (watch.live[i] != before[i])
            snprintf(text + strlen(text), sizeof text - strlen(text), " %u %s", before[i] - watch.live[i],
                     watch_names[i]);
    const uint32_t messages = f->gpu.device.instance->messages;

    REQUIRE(virga_frame_begin(s.context, 2, 0) == VIRGA_OK);
    const uint32_t under_the_next = watch_sum(watch.live);
    gpu_wait(f);
    REQUIRE(virga_frame_begin(s.context, 3, 1) == VIRGA_OK);
    virga_target_destroy(&s.picture.target);
    if (text[0])
        fail_msg("destroyed while the frame was running:%s (and validation says %u times so)", text, messages);
    assert_int_equal(under_the_next, watch_sum(before));
    check_empty(&s);
    stage_close(f, &s);
}

/* A frame that was begun after the rain was destroyed does not keep it. */
static void rain_waits_for_the_frames_before_it_alone(void **state)
{
    gpu_fixture *f = *state;
    const virga_context_def def = gpu_context_def(f);
    stage s;
    stage_open(f, &def, &s);
    run_frame(f, &s); /* 1 */
    run_frame(f, &s); /* 2 */
    virga_rain_destroy(&s.rain);
    gpu_wait(f);
    virga_memory_stats stats;
    REQUIRE(virga_frame_begin(s.context, 3, 1) == VIRGA_OK);
    virga_memory_get(s.context, &stats);
    assert_true(stats.device_used > 0);
    REQUIRE(virga_frame_begin(s.context, 4, 2) == VIRGA_OK);
    virga_target_destroy(&s.picture.target);
    check_empty(&s);
    stage_close(f, &s);
}

/* Destroying a context also destroys what waits for its frames. */
static void context_takes_the_waiting_with_it(void **state)
{
    gpu_fixture *f = *state;
    const virga_context_def def = gpu_context_def(f);
    stage s;
    stage_open(f, &def, &s);
    run_frame(f, &s);
    gpu_wait(f);
    virga_rain_destroy(&s.rain); /* the context does not know yet that the frame has completed */
    gpu_picture_close(f, &s.picture);
    virga_context_destroy(&s.context);
    assert_int_equal(watch_sum(watch.live), 0);
    assert_int_equal(f->lines[VIRGA_LOG_LIVE_OBJECTS], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(counters_say_what_is_alive),
        gpu_test(counters_are_zero_after_the_last_destroy),
        gpu_test(memory_get_accepts_null),
        gpu_test(estimate_is_what_rain_takes),
        gpu_test(few_blocks_hold_many_buffers),
        gpu_test(few_blocks_hold_default_rain),
        gpu_test(memory_is_used_again),
        gpu_test(what_is_too_large_for_the_device_is_refused),
        gpu_test(splashes_fit_what_storage_buffers_hold),
        gpu_test(rain_destroyed_under_a_frame_lives_until_it_has_completed),
        gpu_test(rain_waits_for_the_frames_before_it_alone),
        gpu_test(context_takes_the_waiting_with_it),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
