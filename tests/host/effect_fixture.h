/* effect_fixture.h - the common part of the fixtures of rain, ground, splash and glass: a context on a device with
 * validation, frames that are waited for, read-back, and a check that all objects are destroyed.
 *
 * All cases of a program share one device, and pipelines are cached between cases (kept_pipelines.h). The program's
 * main ends with effect_fixture_close. */
#ifndef VIRGA_TESTS_EFFECT_FIXTURE_H
#define VIRGA_TESTS_EFFECT_FIXTURE_H

#include <malloc.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "kept_pipelines.h"
#include "plate_fixture.h"

#include <virga/virga.h>

#define REQUIRE(condition)                      \
    do {                                        \
        if (!(condition))                       \
            fail_msg("not so: %s", #condition); \
    } while (0)

/* Prints errors to stderr. For fixtures that do not store log lines. */
static inline void effect_fixture_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user;
    if (level == VIRGA_LOG_ERROR)
        fprintf(stderr, "%s: %s\n", virga_log_name(id), text);
}

/* The device of all cases. A case works with a copy of it and returns it. A case with two fixtures at a time gets a
 * separate device for the second. */
static struct effect_device {
    fixture fixture;
    bool there, lent;
    uint32_t messages; /* of validation, before the current case */
} effect_device;

/* Catches programs that create a device and do not destroy it: validation reports leaks only when it is destroyed. */
static inline void effect_device_expect_closed(void)
{
    if (!effect_device.there)
        return;
    fprintf(stderr, "the device was never destroyed: effect_fixture_close is missing\n");
    _exit(1);
}

/* Exits with 77 if there is no device. */
static inline void effect_device_lend(fixture *gpu)
{
    fixture *made = effect_device.lent ? gpu : &effect_device.fixture;
    if ((made == gpu || !effect_device.there) && !fixture_begin(made)) {
        printf("skipped: %s\n", made->error);
        exit(77);
    }
    if (made == gpu)
        return;
    if (!effect_device.there)
        atexit(effect_device_expect_closed);
    effect_device.there = effect_device.lent = true;
    *gpu = effect_device.fixture;
    gpu->device.warn_user = gpu;
    gpu->device.frame = gpu->device.completed = 0; /* frames count from 1 in each case; none is in flight */
    for (int i = 0; i < HOST_FRAMES; i++)
        gpu->device.frames[i].index = 0;
}

static inline bool effect_device_is_shared(const fixture *gpu)
{
    return gpu->device.instance == &effect_device.fixture.instance;
}

/* Returns the number of validation messages in this case plus the number of its live objects. */
static inline uint32_t effect_device_give_back(fixture *gpu)
{
    if (!effect_device_is_shared(gpu))
        return fixture_end(gpu);
    uint32_t live = gpu->device.live + (host_wait(&gpu->device, gpu->error, sizeof gpu->error) ? 0 : 1);
    const host_instance *instance = &effect_device.fixture.instance;
    const uint32_t messages = instance->messages - effect_device.messages;
    if (messages)
        fprintf(stderr, "validation: %s\n", instance->first_message);
    gpu->device.live = 0;
    effect_device.fixture.device = gpu->device;
    effect_device.messages = instance->messages;
    effect_device.lent = false;
    return live + messages;
}

/* Destroys the device; validation then reports leaked objects. */
static inline void effect_device_destroy(void)
{
    if (!effect_device.there)
        return;
    kept_forget();
    effect_device.there = false;
    fixture_end(&effect_device.fixture);
}

/* The number of threads of software Vulkan from the next case on. "0": it runs in the thread of the test. A device
 * reads the number when it is created, so another number needs another device. With threads, freed memory is not
 * overwritten: the driver's threads may wait for ever then (see tests/images/same_bytes.sh). */
static inline void effect_device_set_threads(const char *threads)
{
    const char *current = getenv("LP_NUM_THREADS");
    if (current && !strcmp(current, threads))
        return;
    setenv("LP_NUM_THREADS", threads, 1);
    const char *perturb = strcmp(threads, "0") ? "0" : getenv("MALLOC_PERTURB_");
    mallopt(M_PERTURB, perturb ? atoi(perturb) : 0);
    effect_device_destroy();
    effect_device.messages = 0;
}

/* Returns the exit code of main, from the number of failed cases. */
static inline int effect_fixture_close(int failed)
{
    effect_device_destroy();
    return fixture_result(failed);
}

/* Ends the test as skipped. What it has created is not destroyed, so nothing may look for leaks. */
static inline void effect_fixture_skip(const char *reason)
{
    printf("skipped: %s\n", reason);
    fflush(stdout);
    _exit(77);
}

/* Variants of passes of the contexts that are opened from now on. By default as VIRGA_TEST_VARIANTS says. */
static virga_pass_variants effect_fixture_variants;

static inline virga_pass_variants effect_fixture_wanted_variants(void)
{
    const char *wanted = getenv("VIRGA_TEST_VARIANTS");
    return effect_fixture_variants ? effect_fixture_variants
           : !wanted               ? VIRGA_VARIANTS_OF_DEVICE
           : strcmp(wanted, "gpu") ? VIRGA_VARIANTS_SOFTWARE
                                   : VIRGA_VARIANTS_GPU;
}

/* Device and context. Exits with 77 if there is no device. Timings are off, except in tests of timings: their barriers
 * around each pass would hide missing ones. */
static inline virga_context *effect_fixture_open(fixture *gpu, bool timings, virga_log_fn log, void *user)
{
    effect_device_lend(gpu);
    virga_context_def def = virga_default_context_def();
    def.instance = gpu->instance.instance;
    def.physical_device = gpu->device.physical;
    def.device = gpu->device.device;
    def.queue_family = gpu->device.queue_family;
    def.get_instance_proc_addr = effect_device_is_shared(gpu) ? kept_get_instance_proc_addr : vkGetInstanceProcAddr;
    def.wide_lines = gpu->device.wide_lines;
    def.log = log;
    def.log_user = user;
    def.log_repeats = true;
    def.timings = timings;
    def.variants = effect_fixture_wanted_variants();
    def.pipeline_build_mode = VIRGA_PIPELINES_ON_USE; /* most tests use few */
    virga_context *context = NULL;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    return context;
}

static inline VkCommandBuffer effect_fixture_begin(fixture *gpu, virga_context *context)
{
    VkCommandBuffer cmd;
    REQUIRE(host_begin_frame(&gpu->device, &cmd, gpu->error, sizeof gpu->error));
    REQUIRE(virga_frame_begin(context, gpu->device.frame, gpu->device.completed) == VIRGA_OK);
    return cmd;
}

/* Submits the frame and waits for it. */
static inline void effect_fixture_submit(fixture *gpu)
{
    REQUIRE(host_submit(&gpu->device, gpu->error, sizeof gpu->error));
    REQUIRE(host_wait(&gpu->device, gpu->error, sizeof gpu->error));
}

/* The same, and reports it to the library, so that statistics are available at once. */
static inline void effect_fixture_complete(fixture *gpu, virga_context *context)
{
    effect_fixture_submit(gpu);
    REQUIRE(virga_frame_completed(context, gpu->device.completed) == VIRGA_OK);
}

/* Makes what passes and copies have written available to copies. */
static inline void effect_fixture_transfers(VkCommandBuffer cmd)
{
    const VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                                     .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT};
    const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    vkCmdPipelineBarrier(cmd, stages, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &barrier, 0, NULL, 0, NULL);
}

/* Appends a whole buffer to `to` and returns its offset there. */
static inline const void *effect_fixture_copy(VkCommandBuffer cmd, VkBuffer from, VkDeviceSize size,
                                              const host_buffer *to, VkDeviceSize *offset)
{
    const VkBufferCopy copy = {0, *offset, size};
    const char *there = (const char *)to->mapped + *offset;
    vkCmdCopyBuffer(cmd, from, to->buffer, 1, &copy);
    *offset += size;
    return there;
}

/* Call it after effects and context are destroyed. Returns the number of validation messages plus the number of live
 * objects: 0 if all is correct. */
static inline uint32_t effect_fixture_end(fixture *gpu, host_buffer *const *buffers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (buffers[i]->buffer)
            host_buffer_destroy(&gpu->device, buffers[i]);
    return effect_device_give_back(gpu);
}

#endif
