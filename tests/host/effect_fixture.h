/* effect_fixture.h - what the fixtures of rain, ground, splash and glass have in common: a context on a device with
 * validation on, frames that are waited for, reading back, and a check that nothing is left.
 *
 * All cases of a program have one device, and pipelines are kept from case to case (kept_pipelines.h). Its main ends
 * with effect_fixture_close. */
#ifndef VIRGA_TESTS_EFFECT_FIXTURE_H
#define VIRGA_TESTS_EFFECT_FIXTURE_H

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

/* Errors on stderr; for fixtures that keep nothing of what the library says. */
static inline void effect_fixture_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user;
    if (level == VIRGA_LOG_ERROR)
        fprintf(stderr, "%s: %s\n", virga_log_name(id), text);
}

/* The device of all cases. A case works with a copy of it, which it gives back; one that has two fixtures at a time
 * gets a device of its own for the second. */
static struct effect_device {
    fixture fixture;
    bool there, lent;
    uint32_t messages; /* of validation, up to the case before */
} effect_device;

/* A program that makes a device and forgets to destroy it would not see what validation says then. */
static inline void effect_device_expect_closed(void)
{
    if (!effect_device.there)
        return;
    fprintf(stderr, "the device was never destroyed: effect_fixture_close is missing\n");
    _exit(1);
}

/* Exits with 77 where there is no device. */
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
    gpu->device.frame = gpu->device.completed = 0; /* frames count from 1 in each case; none is under way */
    for (int i = 0; i < HOST_FRAMES; i++)
        gpu->device.frames[i].index = 0;
}

static inline bool effect_device_is_shared(const fixture *gpu)
{
    return gpu->device.instance == &effect_device.fixture.instance;
}

/* Returns what validation has said in this case plus what is still alive of it. */
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

/* Destroys the device, of which validation then says what objects are left. What main returns, of the number of cases
 * that failed. */
static inline int effect_fixture_close(int failed)
{
    if (effect_device.there) {
        kept_forget();
        effect_device.there = false;
        fixture_end(&effect_device.fixture);
    }
    return fixture_result(failed);
}

/* Device and context. Exits with 77 where there is no device. Without timings, unless a test is of those: their
 * barriers around each pass would hide those that are missing. */
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
    def.timings = timings;
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

/* And tells the library, so that statistics are there at once. */
static inline void effect_fixture_complete(fixture *gpu, virga_context *context)
{
    effect_fixture_submit(gpu);
    REQUIRE(virga_frame_completed(context, gpu->device.completed) == VIRGA_OK);
}

/* What passes and copies have written may be copied. */
static inline void effect_fixture_transfers(VkCommandBuffer cmd)
{
    const VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                                     .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT};
    const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    vkCmdPipelineBarrier(cmd, stages, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &barrier, 0, NULL, 0, NULL);
}

/* Copies a whole buffer behind what `to` holds already, and says where it will be. */
static inline const void *effect_fixture_copy(VkCommandBuffer cmd, VkBuffer from, VkDeviceSize size,
                                              const host_buffer *to, VkDeviceSize *offset)
{
    const VkBufferCopy copy = {0, *offset, size};
    const char *there = (const char *)to->mapped + *offset;
    vkCmdCopyBuffer(cmd, from, to->buffer, 1, &copy);
    *offset += size;
    return there;
}

/* After effects and context are destroyed. Returns what validation said plus what is still alive: 0 is right. */
static inline uint32_t effect_fixture_end(fixture *gpu, host_buffer *const *buffers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (buffers[i]->buffer)
            host_buffer_destroy(&gpu->device, buffers[i]);
    return effect_device_give_back(gpu);
}

#endif
