/* test_host_memory.c - memory by a host's callbacks: asked for with sense, given back, never while recording. */
#include "small_stage.h"

enum { MAX_BLOCKS = 64 };

typedef struct host_allocator {
    const gpu_fixture *f;
    virga_memory_block blocks[MAX_BLOCKS]; /* alive where host_handle is not NULL */
    uint32_t calls, live, fail_at;
    bool wrong; /* something was asked for or given back that should not be */
    bool recording;
} host_allocator;

/* Not at the start of its memory, as a host that suballocates would have it. */
static VkResult allocate(host_allocator *a, const VkMemoryRequirements *need, uint32_t type, bool mapped,
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
    for (uint32_t i = 0; i < MAX_BLOCKS; i++)
        if (!a->blocks[i].host_handle) {
            const VkResult result = allocate(a, need, type, mapped, block);
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
    const bool same = kept >= a->blocks && kept < a->blocks + MAX_BLOCKS && kept->memory == block->memory &&
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
    assert_int_equal(types.asked[1], 2); /* statistics and marks are read back; all others lie in the first type */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(device_memory_of_a_host_is_used_and_given_back),
        gpu_test(device_memory_that_a_host_refuses_is_an_error),
        gpu_test(budget_holds_for_a_host_too),
        gpu_test(what_the_host_reads_is_cached_even_where_it_is_not_coherent),
        gpu_test(host_memory_of_a_host_is_used_and_given_back),
        gpu_test(recording_allocates_and_creates_nothing),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
