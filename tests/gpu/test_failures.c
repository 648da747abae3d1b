/* test_failures.c - every call that can fail is failed once, in every create: the result says what went wrong, nothing
 * half-built stays alive, and the context goes on. */
#include "gpu_fixture.h"

/* What is being built, on a context that is there or not. */
typedef struct build {
    gpu_fixture *f;
    virga_context *context;
    virga_rain *rain;
    gpu_picture *picture;
    virga_host_memory host_memory;
} build;

typedef virga_result (*build_fn)(build *b);

static virga_result build_context(build *b)
{
    virga_context_def def = gpu_context_def(b->f);
    virga_context *context = NULL;
    def.host_memory = b->host_memory;
    const virga_result result = virga_context_create(&def, &context);
    assert_int_equal(context != NULL, result == VIRGA_OK);
    virga_context_destroy(&context);
    return result;
}

static virga_result build_rain(build *b)
{
    const virga_rain_def def = gpu_rain_def();
    virga_rain *rain = NULL;
    const virga_result result = virga_rain_create(b->context, &def, &rain);
    assert_int_equal(rain != NULL, result == VIRGA_OK);
    virga_rain_destroy(&rain);
    return result;
}

static virga_result build_scene(build *b)
{
    virga_scene_def def = virga_default_scene_def();
    virga_scene *scene = NULL;
    def.rain = gpu_rain_def();
    const virga_result result = virga_scene_create(b->context, &def, &scene);
    assert_int_equal(scene != NULL, result == VIRGA_OK);
    virga_scene_destroy(&scene);
    return result;
}

/* Attached again until it is: a failed attach must leave the place free. */
static virga_result build_attach(build *b)
{
    return virga_rain_attach(b->rain, b->picture->target);
}

static bool same_stats(const virga_memory_stats *a, const virga_memory_stats *b)
{
    return a->device_bytes == b->device_bytes && a->device_used == b->device_used &&
           a->device_allocations == b->device_allocations && a->objects == b->objects &&
           a->host_bytes == b->host_bytes && a->host_allocations == b->host_allocations;
}

/* After a failure at call `number`: counts are where they were. */
static void check_nothing_left(const build *b, const virga_memory_stats *before, uint32_t alive_before, uint32_t number,
                               const char *call)
{
    virga_memory_stats after;
    virga_memory_get(b->context, &after);
    if (watch_sum(watch.live) != alive_before)
        fail_msg("call %u, %s, failed: alive are %s", number, call, watch_alive());
    if (!same_stats(&after, before))
        fail_msg("call %u, %s, failed: %u objects, %u host blocks, %u device blocks are counted, before it %u, %u, %u",
                 number, call, after.objects, after.host_allocations, after.device_allocations, before->objects,
                 before->host_allocations, before->device_allocations);
}

/* Fails each call once until none is left to fail; returns how many there were. */
static uint32_t fail_each_call(build *b, build_fn build_it, VkResult failure, virga_result expected)
{
    virga_memory_stats before;
    virga_memory_get(b->context, &before);
    const uint32_t alive = watch_sum(watch.live);
    for (uint32_t number = 1;; number++) {
        gpu_forget_log(b->f);
        watch_fail(number, failure);
        const virga_result result = build_it(b);
        const bool failed = watch.failed;
        watch_fail(0, VK_SUCCESS);
        if (!failed) {
            assert_int_equal(result, VIRGA_OK);
            return number - 1;
        }
        if (result != expected)
            fail_msg("call %u, %s, failed: the result is %s, expected %s", number, watch.failed_call,
                     virga_result_name(result), virga_result_name(expected));
        assert_one_error(b->f, VIRGA_LOG_VULKAN_CALL);
        check_nothing_left(b, &before, alive, number, watch.failed_call);
    }
}

static void context_survives_every_failure(void **state)
{
    build b = {.f = *state};
    const uint32_t calls = fail_each_call(&b, build_context, VK_ERROR_OUT_OF_DEVICE_MEMORY, VIRGA_ERROR_DEVICE_MEMORY);
    assert_int_equal(calls, 6); /* the pipeline cache, three query pools and two samplers */
    fail_each_call(&b, build_context, VK_ERROR_OUT_OF_HOST_MEMORY, VIRGA_ERROR_HOST_MEMORY);
    fail_each_call(&b, build_context, VK_ERROR_TOO_MANY_OBJECTS, VIRGA_ERROR_VULKAN);
}

static void rain_survives_every_failure(void **state)
{
    build b = {.f = *state, .context = gpu_context(*state)};
    const uint32_t calls = fail_each_call(&b, build_rain, VK_ERROR_OUT_OF_DEVICE_MEMORY, VIRGA_ERROR_DEVICE_MEMORY);
    assert_true(calls > 50);
    virga_context_destroy(&b.context);
}

static void scene_survives_a_failure(void **state)
{
    build b = {.f = *state, .context = gpu_context(*state)};
    watch_fail(1, VK_ERROR_OUT_OF_DEVICE_MEMORY);
    assert_int_equal(build_scene(&b), VIRGA_ERROR_DEVICE_MEMORY);
    watch_fail(0, VK_SUCCESS);
    virga_context_destroy(&b.context);
    assert_int_equal(b.f->lines[VIRGA_LOG_LIVE_OBJECTS], 0);
}

static void attach_survives_every_failure(void **state)
{
    build b = {.f = *state, .context = gpu_context(*state)};
    gpu_picture picture;
    gpu_picture_open(b.f, b.context, &picture);
    b.picture = &picture;
    b.rain = gpu_rain(b.context);
    const uint32_t calls = fail_each_call(&b, build_attach, VK_ERROR_OUT_OF_DEVICE_MEMORY, VIRGA_ERROR_DEVICE_MEMORY);
    assert_int_equal(calls, 15); /* five pipelines of two shaders */
    gpu_record(gpu_begin_frame(b.f, b.context), b.rain, &picture);
    gpu_submit(b.f);
    gpu_wait(b.f);
    virga_rain_destroy(&b.rain);
    gpu_picture_close(b.f, &picture);
    virga_context_destroy(&b.context);
}

/* ---- host memory that runs out */

typedef struct small_heap {
    uint32_t calls, fail_at, live;
} small_heap;

static void *small_alloc(void *user, size_t size)
{
    small_heap *heap = user;
    if (++heap->calls == heap->fail_at)
        return NULL;
    void *block = aligned_alloc(16, (size + 15) / 16 * 16);
    heap->live += block != NULL;
    return block;
}

static void small_free(void *user, void *pointer)
{
    small_heap *heap = user;
    assert_non_null(pointer);
    heap->live--;
    free(pointer);
}

/* As fail_each_call, for the host's allocator. */
static uint32_t fail_each_block(build *b, build_fn build_it, small_heap *heap)
{
    virga_memory_stats before;
    virga_memory_get(b->context, &before);
    const uint32_t alive = watch_sum(watch.live), blocks = heap->live;
    for (uint32_t number = 1;; number++) {
        gpu_forget_log(b->f);
        heap->calls = 0;
        heap->fail_at = number;
        const virga_result result = build_it(b);
        const bool failed = heap->calls >= number;
        heap->fail_at = 0;
        if (!failed) {
            assert_int_equal(result, VIRGA_OK);
            return number - 1;
        }
        if (result != VIRGA_ERROR_HOST_MEMORY)
            fail_msg("block %u was refused: the result is %s", number, virga_result_name(result));
        assert_one_error(b->f, VIRGA_LOG_HOST_MEMORY);
        check_nothing_left(b, &before, alive, number, "alloc");
        assert_int_equal(heap->live, blocks);
    }
}

static void every_block_of_host_memory_may_be_refused(void **state)
{
    small_heap heap = {0};
    build b = {.f = *state, .host_memory = {&heap, small_alloc, small_free}};
    assert_int_equal(fail_each_block(&b, build_context, &heap), 1);
    assert_int_equal(heap.live, 0);
    virga_context_def def = gpu_context_def(b.f);
    def.host_memory = b.host_memory;
    REQUIRE(virga_context_create(&def, &b.context) == VIRGA_OK);
    assert_true(fail_each_block(&b, build_rain, &heap) > 20);
    assert_true(fail_each_block(&b, build_scene, &heap) > 20);
    virga_context_destroy(&b.context);
    assert_int_equal(heap.live, 0);
}

static void settings_stay_where_a_table_finds_no_memory(void **state)
{
    gpu_fixture *f = *state;
    small_heap heap = {0};
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    const double diameters[2] = {0.001, 0.002}, numbers[2] = {1, 1};
    def.host_memory = (virga_host_memory){&heap, small_alloc, small_free};
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    virga_rain *rain = gpu_rain(context);
    const uint32_t blocks = heap.live;
    for (uint32_t number = 1; number <= 2; number++) {
        virga_rain_settings settings = virga_default_rain_settings();
        settings.rate_mm_h = 42;
        settings.sizes = (virga_sizes){VIRGA_SIZES_TABLE, diameters, numbers, 2};
        heap.calls = 0;
        heap.fail_at = number;
        assert_int_equal(virga_rain_set(rain, &settings), VIRGA_ERROR_HOST_MEMORY);
        virga_rain_get(rain, &settings);
        assert_int_equal((int)settings.rate_mm_h, 10);
        assert_int_equal(settings.sizes.kind, VIRGA_SIZES_MARSHALL_PALMER);
        assert_int_equal(heap.live, blocks);
    }
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
    assert_int_equal(heap.live, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(context_survives_every_failure),
        gpu_test(rain_survives_every_failure),
        gpu_test(scene_survives_a_failure),
        gpu_test(attach_survives_every_failure),
        gpu_test(every_block_of_host_memory_may_be_refused),
        gpu_test(settings_stay_where_a_table_finds_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
