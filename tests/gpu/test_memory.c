/* test_memory.c - what is taken is counted, used, and given back: by Virga's own pages, by a host's callbacks, and when
 * the device is still at work on what a host destroys. */
#include "gpu_fixture.h"
#include "small_scene.h"

/* A context with rain and a picture, attached. */
typedef struct stage {
    virga_context *context;
    virga_rain *rain;
    gpu_picture picture;
    virga_memory_stats empty; /* of the context alone */
} stage;

static void stage_open(gpu_fixture *f, const virga_context_def *def, stage *s)
{
    memset(s, 0, sizeof *s);
    REQUIRE(virga_context_create(def, &s->context) == VIRGA_OK);
    virga_memory_get(s->context, &s->empty);
    s->rain = gpu_rain(s->context);
    gpu_picture_open(f, s->context, &s->picture);
    REQUIRE(virga_rain_attach(s->rain, s->picture.target) == VIRGA_OK);
}

static void stage_close(gpu_fixture *f, stage *s)
{
    virga_rain_destroy(&s->rain);
    gpu_picture_close(f, &s->picture);
    virga_context_destroy(&s->context);
}

static void run_frame(gpu_fixture *f, stage *s)
{
    gpu_record(gpu_begin_frame(f, s->context), s->rain, &s->picture);
    gpu_submit(f);
}

static void check_empty(const stage *s)
{
    virga_memory_stats stats;
    virga_memory_get(s->context, &stats);
    assert_int_equal(stats.device_bytes, 0);
    assert_int_equal(stats.device_used, 0);
    assert_int_equal(stats.device_allocations, 0);
    assert_int_equal(stats.objects, s->empty.objects);
    assert_int_equal(stats.host_allocations, s->empty.host_allocations);
    assert_int_equal(stats.host_bytes, s->empty.host_bytes);
}

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

/* The estimate is what a host plans with: rain takes hardly more, and less only by frames that are not in flight. */
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
    assert_int_equal(watch.most_bytes, bytes);
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

/* Splashes take what there is room for: every buffer that a droplet has a share of, the widest too. */
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

/* ---- device memory from a host */

enum { MOST_BLOCKS = 64 };

typedef struct host_allocator {
    const gpu_fixture *f;
    virga_memory_block blocks[MOST_BLOCKS]; /* alive where host_handle is not NULL */
    uint32_t calls, live, fail_at;
    bool wrong; /* something was asked for or given back that should not be */
    bool recording;
} host_allocator;

/* Not at the start of its memory, as a host that suballocates would have it. */
static VkResult take(host_allocator *a, const VkMemoryRequirements *need, uint32_t type, bool mapped,
                     virga_memory_block *block)
{
    const VkDevice device = a->f->gpu.device.device;
    const VkDeviceSize offset = need->alignment * 3;
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .allocationSize = offset + need->size,
                                       .memoryTypeIndex = type};
    void *address = NULL;
    REQUIRE(vkAllocateMemory(device, &info, NULL, &block->memory) == VK_SUCCESS);
    if (mapped)
        REQUIRE(vkMapMemory(device, block->memory, 0, VK_WHOLE_SIZE, 0, &address) == VK_SUCCESS);
    block->offset = offset;
    block->mapped = mapped ? (char *)address + offset : NULL;
    return VK_SUCCESS;
}

static VkResult allocator_alloc(void *user, const VkMemoryRequirements *need, uint32_t type, bool mapped,
                                virga_memory_block *block)
{
    host_allocator *a = user;
    const VkPhysicalDeviceMemoryProperties *memory = &a->f->gpu.device.memory;
    const VkDeviceSize alignment = need->alignment;
    a->wrong = a->wrong || a->recording || !need->size || !alignment || (alignment & (alignment - 1)) ||
               !(need->memoryTypeBits & (1u << type)) || type >= memory->memoryTypeCount ||
               (mapped && !(memory->memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT));
    if (++a->calls == a->fail_at)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    for (uint32_t i = 0; i < MOST_BLOCKS; i++)
        if (!a->blocks[i].host_handle) {
            const VkResult result = take(a, need, type, mapped, block);
            block->host_handle = &a->blocks[i];
            a->blocks[i] = *block;
            a->live++;
            return result;
        }
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

static void allocator_free(void *user, const virga_memory_block *block)
{
    host_allocator *a = user;
    virga_memory_block *kept = block->host_handle;
    const bool same = kept >= a->blocks && kept < a->blocks + MOST_BLOCKS && kept->memory == block->memory &&
                      kept->offset == block->offset && kept->mapped == block->mapped && kept->host_handle == kept;
    a->wrong = a->wrong || a->recording || !same;
    if (!same)
        return;
    vkFreeMemory(a->f->gpu.device.device, kept->memory, NULL);
    memset(kept, 0, sizeof *kept);
    a->live--;
}

static virga_context_def allocator_def(gpu_fixture *f, host_allocator *a)
{
    virga_context_def def = gpu_context_def(f);
    memset(a, 0, sizeof *a);
    a->f = f;
    def.device_memory = (virga_device_memory){a, allocator_alloc, allocator_free};
    return def;
}

static void device_memory_of_a_host_is_used_and_given_back(void **state)
{
    gpu_fixture *f = *state;
    host_allocator allocator;
    const virga_context_def def = allocator_def(f, &allocator);
    stage s;
    virga_memory_stats stats;
    stage_open(f, &def, &s);
    virga_memory_get(s.context, &stats);
    assert_int_equal(watch.made[WATCH_Memory], 0);
    assert_int_equal(allocator.live, watch.live[WATCH_Buffer] + watch.live[WATCH_Image]);
    assert_int_equal(stats.device_allocations, allocator.live);
    for (int i = 0; i < 5; i++)
        run_frame(f, &s);
    gpu_wait(f);
    REQUIRE(virga_frame_completed(s.context, f->gpu.device.completed) == VIRGA_OK);
    virga_rain_destroy(&s.rain);
    virga_target_destroy(&s.picture.target);
    check_empty(&s);
    assert_int_equal(allocator.live, 0);
    assert_false(allocator.wrong);
    stage_close(f, &s);
}

static void device_memory_that_a_host_refuses_is_an_error(void **state)
{
    gpu_fixture *f = *state;
    host_allocator allocator;
    const virga_context_def def = allocator_def(f, &allocator);
    const virga_rain_def rain_def = gpu_rain_def();
    virga_context *context = NULL;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    for (uint32_t number = 1;; number++) {
        virga_rain *rain = NULL;
        gpu_forget_log(f);
        allocator.calls = 0;
        allocator.fail_at = number;
        const virga_result result = virga_rain_create(context, &rain_def, &rain);
        if (allocator.calls < number) {
            assert_int_equal(result, VIRGA_OK);
            virga_rain_destroy(&rain);
            break;
        }
        assert_int_equal(result, VIRGA_ERROR_DEVICE_MEMORY);
        assert_null(rain);
        assert_int_equal(f->errors, 1);
        assert_int_equal(allocator.live, 0);
    }
    assert_false(allocator.wrong);
    virga_context_destroy(&context);
}

static void budget_holds_for_a_host_too(void **state)
{
    gpu_fixture *f = *state;
    host_allocator allocator;
    virga_context_def def = allocator_def(f, &allocator);
    const virga_rain_def rain_def = gpu_rain_def();
    virga_context *context = NULL;
    virga_rain *rain = NULL;
    def.memory_budget = 40000;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    assert_int_equal(virga_rain_create(context, &rain_def, &rain), VIRGA_ERROR_DEVICE_MEMORY);
    assert_int_equal(allocator.live, 0);
    virga_context_destroy(&context);
}

/* ---- where the host reads */

/* Most device memory is slow to read for the host; what is cached need not be coherent. */
static void lie_uncached_or_incoherent(VkPhysicalDeviceMemoryProperties *properties)
{
    const VkMemoryPropertyFlags visible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    properties->memoryTypeCount = 2;
    properties->memoryTypes[0].propertyFlags =
        visible | VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    properties->memoryTypes[1] =
        (VkMemoryType){visible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, properties->memoryTypes[0].heapIndex};
}

typedef struct two_types {
    VkDevice device;
    uint32_t asked[2];
} two_types;

/* Of the one type that there really is. */
static VkResult two_types_alloc(void *user, const VkMemoryRequirements *need, uint32_t type, bool mapped,
                                virga_memory_block *block)
{
    two_types *types = user;
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = need->size};
    types->asked[type]++;
    REQUIRE(vkAllocateMemory(types->device, &info, NULL, &block->memory) == VK_SUCCESS);
    if (mapped)
        REQUIRE(vkMapMemory(types->device, block->memory, 0, VK_WHOLE_SIZE, 0, &block->mapped) == VK_SUCCESS);
    return VK_SUCCESS;
}

static void two_types_free(void *user, const virga_memory_block *block)
{
    vkFreeMemory(((two_types *)user)->device, block->memory, NULL);
}

static void what_the_host_reads_is_cached_even_where_it_is_not_coherent(void **state)
{
    gpu_fixture *f = *state;
    two_types types = {.device = f->gpu.device.device};
    virga_context_def def = gpu_context_def(f);
    def.device_memory = (virga_device_memory){&types, two_types_alloc, two_types_free};
    watch.lie_memory = lie_uncached_or_incoherent;
    watch.lie_types = 3;
    stage s;
    stage_open(f, &def, &s);
    assert_int_equal(types.asked[1], 1); /* the one buffer that is read back; all others lie in the first type */
    assert_true(types.asked[0] > 10);
    for (int i = 0; i < 3; i++)
        run_frame(f, &s);
    gpu_wait(f);
    virga_rain_stats stats;
    virga_rain_stats_get(s.rain, &stats);
    assert_true(stats.frame_index > 0 && stats.slots > 0);
    stage_close(f, &s);
}

/* ---- recording */

typedef struct host_heap {
    uint32_t live, calls;
    bool recording, wrong;
} host_heap;

static void *heap_alloc(void *user, size_t size)
{
    host_heap *heap = user;
    void *block = aligned_alloc(16, (size + 15) / 16 * 16);
    heap->wrong = heap->wrong || heap->recording || !size;
    heap->calls++;
    heap->live += block != NULL;
    if (block)
        memset(block, 0xa5, size); /* what a host hands out is not clear */
    return block;
}

static void heap_free(void *user, void *pointer)
{
    host_heap *heap = user;
    heap->wrong = heap->wrong || heap->recording || !pointer;
    heap->live--;
    free(pointer);
}

static void host_memory_of_a_host_is_used_and_given_back(void **state)
{
    gpu_fixture *f = *state;
    host_heap heap = {0};
    virga_context_def def = gpu_context_def(f);
    virga_memory_stats stats;
    stage s;
    def.host_memory = (virga_host_memory){&heap, heap_alloc, heap_free};
    stage_open(f, &def, &s);
    virga_memory_get(s.context, &stats);
    assert_true(heap.calls > 20);
    assert_int_equal(stats.host_allocations, heap.live);
    run_frame(f, &s);
    gpu_wait(f);
    stage_close(f, &s);
    assert_int_equal(heap.live, 0);
    assert_false(heap.wrong);
}

/* Not in the first frame either, which uploads what never changes, nor when the host passes settings between frames. */
static void recording_allocates_and_creates_nothing(void **state)
{
    gpu_fixture *f = *state;
    host_heap heap = {0};
    host_allocator allocator;
    virga_context_def def = allocator_def(f, &allocator);
    stage s;
    def.host_memory = (virga_host_memory){&heap, heap_alloc, heap_free};
    stage_open(f, &def, &s);
    for (int i = 0; i < 5; i++) {
        const VkCommandBuffer cmd = gpu_begin_frame(f, s.context);
        const uint32_t made = watch_sum(watch.made), destroyed = watch_sum(watch.destroyed), calls = heap.calls;
        heap.recording = allocator.recording = true;
        gpu_record(cmd, s.rain, &s.picture);
        heap.recording = allocator.recording = false;
        assert_int_equal(watch_sum(watch.made), made);
        assert_int_equal(watch_sum(watch.destroyed), destroyed);
        assert_int_equal(heap.calls, calls);
        gpu_submit(f);
    }
    gpu_wait(f);
    assert_false(heap.wrong || allocator.wrong);
    stage_close(f, &s);
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
    const uint32_t messages = f->gpu.instance.messages;

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

/* A context that ends takes with it what still waits. */
static void context_takes_the_waiting_with_it(void **state)
{
    gpu_fixture *f = *state;
    const virga_context_def def = gpu_context_def(f);
    stage s;
    stage_open(f, &def, &s);
    run_frame(f, &s);
    gpu_wait(f);
    virga_rain_destroy(&s.rain); /* the context has not been told that the frame is complete */
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
        gpu_test(device_memory_of_a_host_is_used_and_given_back),
        gpu_test(device_memory_that_a_host_refuses_is_an_error),
        gpu_test(budget_holds_for_a_host_too),
        gpu_test(what_the_host_reads_is_cached_even_where_it_is_not_coherent),
        gpu_test(host_memory_of_a_host_is_used_and_given_back),
        gpu_test(recording_allocates_and_creates_nothing),
        gpu_test(rain_destroyed_under_a_frame_lives_until_it_has_completed),
        gpu_test(rain_waits_for_the_frames_before_it_alone),
        gpu_test(context_takes_the_waiting_with_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
