/* test_failures.c - every call that can fail is failed once, in every create: the result says what went wrong, nothing
 * half-built stays alive, and the context goes on. */
#include "gpu_fixture.h"
#include "small_scene.h"

/* What is being built, on a context that is there or not. */
typedef struct build {
    gpu_fixture *f;
    virga_context *context;
    virga_scene *scene;
    virga_target *target;
    gpu_picture *picture;
    virga_host_memory host_memory;
    uint32_t stride; /* of the calls or blocks that fail; 0 and 1: each of them */
} build;

/* A scene makes its effects with the same code that makes them alone, where each call fails. What a scene adds is to
 * destroy the effects before the one that failed: for that it is enough that some calls of each effect fail. */
enum { SCENE_STRIDE = 7 };

static uint32_t next_number(const build *b, uint32_t number)
{
    return number + (b->stride ? b->stride : 1);
}

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

static virga_result build_target(build *b)
{
    virga_target_def def = virga_default_target_def();
    virga_target *target = NULL;
    host_target_describe_layer(&b->picture->images, &def);
    const virga_result result = virga_target_create(b->context, &def, &target);
    assert_int_equal(target != NULL, result == VIRGA_OK);
    virga_target_destroy(&target);
    return result;
}

/* An effect alone: made, looked at, destroyed. */
#define BUILD(effect)                                                                 \
    static virga_result build_##effect(build *b)                                      \
    {                                                                                 \
        const virga_##effect##_def def = small_##effect##_def();                      \
        virga_##effect *made = NULL;                                                  \
        const virga_result result = virga_##effect##_create(b->context, &def, &made); \
        assert_int_equal(made != NULL, result == VIRGA_OK);                           \
        virga_##effect##_destroy(&made);                                              \
        return result;                                                                \
    }
BUILD(rain)
BUILD(ground)
BUILD(splash)
BUILD(glass)
#undef BUILD

static virga_result build_scene(build *b)
{
    virga_glass_def panes[SMALL_PANES];
    virga_scene_def def = small_scene_def(panes);
    virga_scene *scene = NULL;
    def.pane_count = 1;
    const virga_result result = virga_scene_create(b->context, &def, &scene);
    assert_int_equal(scene != NULL, result == VIRGA_OK);
    virga_scene_destroy(&scene);
    return result;
}

/* Attached again until it succeeds: a failed attach must leave the target's slot free. */
static virga_result build_rain_attach(build *b)
{
    return virga_rain_attach(virga_scene_rain(b->scene), b->target);
}

static virga_result build_splash_attach(build *b)
{
    return virga_splash_attach(virga_scene_splash(b->scene), b->target);
}

static virga_result build_glass_attach(build *b)
{
    return virga_glass_attach(virga_scene_glass(b->scene, 0), b->target);
}

/* Setting a shape makes buffers, and replaces the shape before. */
static virga_result build_flat_shape(build *b)
{
    return small_shape_set(virga_scene_glass(b->scene, 0), 0);
}

static virga_result build_windshield(build *b)
{
    return small_shape_set(virga_scene_glass(b->scene, 0), 1);
}

static virga_result build_shape_of_mesh(build *b)
{
    return small_shape_set(virga_scene_glass(b->scene, 0), 2);
}

static void open_scene(build *b)
{
    virga_glass_def panes[SMALL_PANES];
    const virga_scene_def def = small_scene_def(panes);
    REQUIRE(virga_scene_create(b->context, &def, &b->scene) == VIRGA_OK);
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

/* Fails each call once until none is left to fail. Returns how many there were; with a stride, up to
 * stride - 1 more. */
static uint32_t fail_each_call(build *b, build_fn build_it, VkResult failure, virga_result expected)
{
    virga_memory_stats before;
    virga_memory_get(b->context, &before);
    const uint32_t alive = watch_sum(watch.live);
    for (uint32_t number = 1;; number = next_number(b, number)) {
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

/* In each of the three ways in which Vulkan says that it can not. */
static void fail_in_each_way(build *b, build_fn build_it, uint32_t min_calls)
{
    const uint32_t calls = fail_each_call(b, build_it, VK_ERROR_OUT_OF_DEVICE_MEMORY, VIRGA_ERROR_DEVICE_MEMORY);
    if (calls < min_calls)
        fail_msg("%u calls that can fail, expected at least %u", calls, min_calls);
    fail_each_call(b, build_it, VK_ERROR_OUT_OF_HOST_MEMORY, VIRGA_ERROR_HOST_MEMORY);
    fail_each_call(b, build_it, VK_ERROR_TOO_MANY_OBJECTS, VIRGA_ERROR_VULKAN);
}

static void context_survives_every_failure(void **state)
{
    build b = {.f = *state};
    fail_in_each_way(&b, build_context, 6); /* the pipeline cache, three query pools and two samplers */
}

/* Every call of one create: buffers, views, memory, mapping, binding, layouts, pools, sets, modules and pipelines. */
static void create_survives_every_failure(gpu_fixture *f, build_fn build_it, uint32_t stride)
{
    watch.keep_pipelines = true;
    build b = {.f = f, .context = gpu_context_in_mode(f, VIRGA_PIPELINES_IMMEDIATE), .stride = stride};
    const uint32_t calls = fail_each_call(&b, build_it, VK_ERROR_OUT_OF_DEVICE_MEMORY, VIRGA_ERROR_DEVICE_MEMORY);
    assert_true(calls > 50);
    virga_context_destroy(&b.context);
    assert_int_equal(b.f->lines[VIRGA_LOG_LIVE_OBJECTS], 0);
}

static void rain_survives_every_failure(void **state)
{
    create_survives_every_failure(*state, build_rain, 1);
}

static void ground_survives_every_failure(void **state)
{
    create_survives_every_failure(*state, build_ground, 1);
}

static void splash_survives_every_failure(void **state)
{
    create_survives_every_failure(*state, build_splash, 1);
}

static void pane_survives_every_failure(void **state)
{
    create_survives_every_failure(*state, build_glass, 1);
}

/* What was made before the effect that failed goes too. */
static void scene_survives_failures_of_each_effect(void **state)
{
    create_survives_every_failure(*state, build_scene, SCENE_STRIDE);
}

static void shapes_survive_every_failure(void **state)
{
    static const build_fn shapes[] = {build_flat_shape, build_windshield, build_shape_of_mesh};
    watch.keep_pipelines = true;
    build b = {.f = *state, .context = gpu_context_in_mode(*state, VIRGA_PIPELINES_IMMEDIATE)};
    open_scene(&b);
    for (int i = 0; i < 3; i++)
        fail_in_each_way(&b, shapes[i], 2);
    virga_scene_destroy(&b.scene);
    virga_context_destroy(&b.context);
}

/* Of a render pass, or of dynamic rendering. */
static void open_target(build *b, bool dynamic)
{
    virga_target_def def = virga_default_target_def();
    host_target_describe_layer(&b->picture->images, &def);
    if (dynamic) {
        def.kind = VIRGA_TARGET_DYNAMIC;
        def.color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT;
        def.depth_attached = false;
        def.depth_format = VK_FORMAT_UNDEFINED;
    }
    REQUIRE(virga_target_create(b->context, &def, &b->target) == VIRGA_OK);
}

static void draw_frame(build *b)
{
    virga_scene_pane panes[SMALL_PANES];
    const virga_view view = gpu_view(b->picture);
    const virga_scene_frame frame = {.dt_s = 0.05, .view = &view, .panes = panes};
    small_panes_lay(panes);
    VkCommandBuffer cmd = gpu_begin_frame(b->f, b->context);
    REQUIRE(virga_scene_record(b->scene, cmd, &frame) == VIRGA_OK);
    host_target_begin_layer(&b->picture->images, cmd);
    REQUIRE(virga_rain_draw(virga_scene_rain(b->scene), cmd, b->target) == VIRGA_OK);
    REQUIRE(virga_splash_draw(virga_scene_splash(b->scene), cmd, b->target) == VIRGA_OK);
    REQUIRE(virga_glass_draw(virga_scene_glass(b->scene, 0), cmd, b->target) == VIRGA_OK);
    host_target_end_layer(&b->picture->images, cmd);
    gpu_submit(b->f);
    gpu_wait(b->f);
}

/* And what was attached in the end draws. */
static void attach_survives_every_failure(void **state)
{
    static const build_fn attaches[] = {build_rain_attach, build_splash_attach, build_glass_attach};
    static const uint32_t pipelines[] = {5, 10, 12};
    watch.keep_pipelines = true;
    build b = {.f = *state};
    virga_context_def def = gpu_context_def(b.f);
    def.debug_names = false; /* pipelines for dynamic rendering are made up, see watch.h */
    REQUIRE(virga_context_create(&def, &b.context) == VIRGA_OK);
    gpu_picture picture;
    gpu_picture_open(b.f, b.context, &picture);
    b.picture = &picture;
    open_scene(&b);
    for (int dynamic = 1; dynamic >= 0; dynamic--) {
        virga_target_destroy(&b.target);
        open_target(&b, dynamic);
        for (int i = 0; i < 3; i++) {
            const uint32_t calls =
                fail_each_call(&b, attaches[i], VK_ERROR_OUT_OF_DEVICE_MEMORY, VIRGA_ERROR_DEVICE_MEMORY);
            assert_true(calls >= 3 * pipelines[i]); /* a pipeline and its two shaders */
        }
    }
    draw_frame(&b);
    virga_scene_destroy(&b.scene);
    virga_target_destroy(&b.target);
    gpu_picture_close(b.f, &picture);
    virga_context_destroy(&b.context);
}

/* ---- host memory that runs out */

/* The host's callbacks, for its own memory or the device's: the block of the number fail_at is refused. */
typedef struct small_heap {
    gpu_fixture *f; /* device memory is its device's */
    uint32_t calls, fail_at, live;
} small_heap;

/* What the library makes of a refused block. */
typedef struct refusal {
    virga_result result;
    virga_log_id line;
    const char *callback;
} refusal;

static const refusal of_host_memory = {VIRGA_ERROR_HOST_MEMORY, VIRGA_LOG_HOST_MEMORY, "alloc"};
static const refusal of_device_memory = {VIRGA_ERROR_DEVICE_MEMORY, VIRGA_LOG_VULKAN_CALL,
                                         "the host's device memory callback"};

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

/* As fail_each_call, for the host's callbacks. */
static uint32_t fail_each_block(build *b, build_fn build_it, small_heap *heap, const refusal *expected)
{
    virga_memory_stats before;
    virga_memory_get(b->context, &before);
    const uint32_t alive = watch_sum(watch.live), blocks = heap->live;
    for (uint32_t number = 1;; number = next_number(b, number)) {
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
        if (result != expected->result)
            fail_msg("block %u was refused: the result is %s", number, virga_result_name(result));
        assert_one_error(b->f, expected->line);
        check_nothing_left(b, &before, alive, number, expected->callback);
        assert_int_equal(heap->live, blocks);
    }
}

/* Every block of each effect, and some of each effect in a scene. */
static void fail_blocks_of_creates(build *b, small_heap *heap, const refusal *expected, uint32_t min)
{
    static const build_fn effects[] = {build_rain, build_ground, build_splash, build_glass};
    for (size_t i = 0; i < sizeof effects / sizeof effects[0]; i++)
        assert_true(fail_each_block(b, effects[i], heap, expected) > min);
    b->stride = SCENE_STRIDE;
    assert_true(fail_each_block(b, build_scene, heap, expected) > min);
    b->stride = 1;
}

static virga_context *open_on_heap(build *b, small_heap *heap)
{
    virga_context_def def = gpu_context_def(b->f);
    b->host_memory = (virga_host_memory){heap, small_alloc, small_free};
    def.host_memory = b->host_memory;
    REQUIRE(virga_context_create(&def, &b->context) == VIRGA_OK);
    return b->context;
}

static void every_block_of_host_memory_may_be_refused(void **state)
{
    small_heap heap = {0};
    build b = {.f = *state, .host_memory = {&heap, small_alloc, small_free}};
    watch.keep_pipelines = true;
    assert_int_equal(fail_each_block(&b, build_context, &heap, &of_host_memory), 1);
    assert_int_equal(heap.live, 0);
    open_on_heap(&b, &heap);
    fail_blocks_of_creates(&b, &heap, &of_host_memory, 20);
    virga_context_destroy(&b.context);
    assert_int_equal(heap.live, 0);
}

static void every_block_of_an_attach_or_a_shape_may_be_refused(void **state)
{
    static const build_fn builds[] = {build_target,     build_rain_attach, build_splash_attach, build_glass_attach,
                                      build_flat_shape, build_windshield,  build_shape_of_mesh};
    static const uint32_t min[] = {1, 5, 10, 12, 2, 2, 2};
    small_heap heap = {0};
    gpu_picture picture;
    build b = {.f = *state, .picture = &picture};
    watch.keep_pipelines = true;
    open_on_heap(&b, &heap);
    gpu_picture_open(b.f, b.context, &picture);
    open_scene(&b);
    open_target(&b, false);
    for (size_t i = 0; i < sizeof builds / sizeof builds[0]; i++)
        assert_true(fail_each_block(&b, builds[i], &heap, &of_host_memory) >= min[i]);
    virga_scene_destroy(&b.scene);
    virga_target_destroy(&b.target);
    gpu_picture_close(b.f, &picture);
    virga_context_destroy(&b.context);
    assert_int_equal(heap.live, 0);
}

/* ---- device memory through the host's callbacks */

static VkResult small_device_alloc(void *user, const VkMemoryRequirements *need, uint32_t type, bool mapped,
                                   virga_memory_block *block)
{
    small_heap *heap = user;
    const VkDevice device = heap->f->gpu.device.device;
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = need->size, .memoryTypeIndex = type};
    if (++heap->calls == heap->fail_at)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    *block = (virga_memory_block){0};
    REQUIRE(vkAllocateMemory(device, &info, NULL, &block->memory) == VK_SUCCESS);
    if (mapped)
        REQUIRE(vkMapMemory(device, block->memory, 0, VK_WHOLE_SIZE, 0, &block->mapped) == VK_SUCCESS);
    heap->live++;
    return VK_SUCCESS;
}

static void small_device_free(void *user, const virga_memory_block *block)
{
    small_heap *heap = user;
    vkFreeMemory(heap->f->gpu.device.device, block->memory, NULL);
    heap->live--;
}

static void every_block_of_device_memory_may_be_refused(void **state)
{
    small_heap heap = {.f = *state};
    build b = {.f = *state};
    virga_context_def def = gpu_context_def(b.f);
    watch.keep_pipelines = true;
    def.device_memory = (virga_device_memory){&heap, small_device_alloc, small_device_free};
    REQUIRE(virga_context_create(&def, &b.context) == VIRGA_OK);
    fail_blocks_of_creates(&b, &heap, &of_device_memory, 10);
    virga_context_destroy(&b.context);
    assert_int_equal(heap.live, 0);
}

/* ---- sets */

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
        gpu_test(ground_survives_every_failure),
        gpu_test(splash_survives_every_failure),
        gpu_test(pane_survives_every_failure),
        gpu_test(scene_survives_failures_of_each_effect),
        gpu_test(shapes_survive_every_failure),
        gpu_test(attach_survives_every_failure),
        gpu_test(every_block_of_host_memory_may_be_refused),
        gpu_test(every_block_of_an_attach_or_a_shape_may_be_refused),
        gpu_test(every_block_of_device_memory_may_be_refused),
        gpu_test(settings_stay_where_a_table_finds_no_memory),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
