/* test_pipeline_cache.c - the blob comes out and goes in again; what is not such a blob never reaches the driver. */
#include "gpu_fixture.h"

typedef struct blob {
    unsigned char *bytes;
    size_t size;
} blob;

static blob read_blob(virga_context *context)
{
    blob b = {NULL, 0};
    assert_int_equal(virga_pipeline_cache_get(context, &b.size, NULL), VIRGA_OK);
    b.bytes = malloc(b.size + 1);
    b.bytes[b.size] = 0x5a; /* must not be written to */
    assert_int_equal(virga_pipeline_cache_get(context, &b.size, b.bytes), VIRGA_OK);
    assert_int_equal(b.bytes[b.size], 0x5a);
    return b;
}

/* The blob of a context that has built all of rain's pipelines. */
static blob used_blob(gpu_fixture *f)
{
    virga_context *context = gpu_context_in_mode(f, VIRGA_PIPELINES_IMMEDIATE);
    virga_rain *rain = gpu_rain(context);
    const blob b = read_blob(context);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
    return b;
}

/* A context from a blob, which is overwritten once the call has returned. Tells how many bytes reached the driver. */
static size_t bytes_accepted(gpu_fixture *f, const void *bytes, size_t size, virga_context **context)
{
    virga_context_def def = gpu_context_def(f);
    unsigned char *copy = malloc(size + 1);
    memcpy(copy, bytes, size);
    def.pipeline_cache = copy;
    def.pipeline_cache_size = size;
    gpu_forget_log(f);
    watch.cache_size = SIZE_MAX;
    REQUIRE(virga_context_create(&def, context) == VIRGA_OK);
    memset(copy, 0xee, size);
    free(copy);
    return watch.cache_size;
}

static void blob_comes_out_and_goes_in(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = NULL;
    const blob b = used_blob(f);
    const size_t accepted = bytes_accepted(f, b.bytes, b.size, &context);
    assert_true(accepted >= sizeof(VkPipelineCacheHeaderVersionOne));
    assert_true(accepted <= b.size);
    assert_int_equal(f->lines[VIRGA_LOG_PIPELINE_CACHE], 0);
    virga_rain *rain = gpu_rain(context);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
    free(b.bytes);
}

static void blob_goes_through_two_contexts(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = NULL;
    const blob first = used_blob(f);
    bytes_accepted(f, first.bytes, first.size, &context);
    const blob second = read_blob(context);
    virga_context_destroy(&context);
    assert_true(bytes_accepted(f, second.bytes, second.size, &context) > 0);
    virga_context_destroy(&context);
    free(first.bytes);
    free(second.bytes);
}

/* Ignored: nothing of it reaches the driver, one line says so, and the context is as good as any. */
static void check_ignored(gpu_fixture *f, const void *bytes, size_t size, const char *what, size_t which)
{
    virga_context *context = NULL;
    const size_t accepted = bytes_accepted(f, bytes, size, &context);
    virga_context_destroy(&context);
    if (accepted != 0)
        fail_msg("%s (%zu): %zu bytes reached the driver", what, which, accepted);
    if (f->lines[VIRGA_LOG_PIPELINE_CACHE] != 1 || f->errors)
        fail_msg("%s (%zu): %u lines about the cache, %u errors", what, which, f->lines[VIRGA_LOG_PIPELINE_CACHE],
                 f->errors);
}

static void truncated_blob_is_ignored(void **state)
{
    const blob b = used_blob(*state);
    const size_t step = b.size / 256 + 1;
    for (size_t size = 1; size < b.size; size += size < 128 ? 1 : step)
        check_ignored(*state, b.bytes, size, "cut to bytes", size);
    check_ignored(*state, b.bytes, b.size - 1, "cut to bytes", b.size - 1);
    free(b.bytes);
}

static void longer_blob_is_ignored(void **state)
{
    const blob b = used_blob(*state);
    check_ignored(*state, b.bytes, b.size + 1, "with a byte too many", b.size + 1);
    free(b.bytes);
}

static void blob_with_a_flipped_bit_is_ignored(void **state)
{
    const blob b = used_blob(*state);
    const size_t step = b.size / 256 + 1;
    for (size_t at = 0; at < b.size; at += at < 64 ? 1 : step) {
        b.bytes[at] ^= (unsigned char)(1u << at % 8);
        check_ignored(*state, b.bytes, b.size, "a bit flipped at byte", at);
        b.bytes[at] ^= (unsigned char)(1u << at % 8);
    }
    free(b.bytes);
}

static void noise_is_ignored(void **state)
{
    unsigned char noise[333];
    for (size_t i = 0; i < sizeof noise; i++)
        noise[i] = (unsigned char)(i * 167 + 13);
    check_ignored(*state, noise, sizeof noise, "noise", sizeof noise);
    memset(noise, 0, sizeof noise);
    check_ignored(*state, noise, sizeof noise, "zeros", sizeof noise);
    memset(noise, 255, sizeof noise);
    check_ignored(*state, noise, sizeof noise, "ones", sizeof noise);
}

/* Whole, but written on another machine: each of what tells devices and drivers apart. */
static int foreign; /* which of them is changed */

static void lie_foreign(VkPhysicalDeviceProperties *properties)
{
    if (foreign == 0)
        properties->vendorID++;
    else if (foreign == 1)
        properties->deviceID++;
    else
        properties->pipelineCacheUUID[foreign - 2] ^= 1;
}

static void blob_of_another_device_is_ignored(void **state)
{
    const blob b = used_blob(*state);
    watch.lie_properties = lie_foreign;
    for (foreign = 0; foreign < 2 + (int)VK_UUID_SIZE; foreign++)
        check_ignored(*state, b.bytes, b.size, "foreign in", (size_t)foreign);
    free(b.bytes);
}

static void no_blob_is_no_remark(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context_in_mode(f, VIRGA_PIPELINES_IMMEDIATE);
    assert_int_equal(f->lines[VIRGA_LOG_PIPELINE_CACHE], 0);
    assert_int_equal(watch.cache_size, 0);
    virga_context_destroy(&context);
    virga_context_def def = gpu_context_def(f);
    def.pipeline_cache_size = 100; /* of nothing */
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    assert_int_equal(watch.cache_size, 0);
    virga_context_destroy(&context);
}

static void too_little_room_is_refused(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context_in_mode(f, VIRGA_PIPELINES_IMMEDIATE);
    size_t whole = 0;
    REQUIRE(virga_pipeline_cache_get(context, &whole, NULL) == VIRGA_OK);
    unsigned char *room = malloc(whole);
    const size_t sizes[] = {0, 1, whole / 2, whole - 1};
    for (int i = 0; i < 4; i++) {
        size_t size = sizes[i];
        memset(room, 0x5a, whole);
        gpu_forget_log(f);
        assert_int_equal(virga_pipeline_cache_get(context, &size, room), VIRGA_ERROR_INVALID);
        assert_one_error(f, VIRGA_LOG_ARGUMENT);
        for (size_t at = 0; at < whole; at++)
            assert_int_equal(room[at], 0x5a);
    }
    assert_int_equal(virga_pipeline_cache_get(context, NULL, room), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_pipeline_cache_get(NULL, &whole, room), VIRGA_ERROR_INVALID);
    free(room);
    virga_context_destroy(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(blob_comes_out_and_goes_in),         gpu_test(blob_goes_through_two_contexts),
        gpu_test(truncated_blob_is_ignored),          gpu_test(longer_blob_is_ignored),
        gpu_test(blob_with_a_flipped_bit_is_ignored), gpu_test(noise_is_ignored),
        gpu_test(blob_of_another_device_is_ignored),  gpu_test(no_blob_is_no_remark),
        gpu_test(too_little_room_is_refused),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
