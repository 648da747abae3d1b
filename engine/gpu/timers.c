/* gpu/timers.c - labels and timestamps around passes. */
#include "gpu/timers.h"
#include "gpu/retire.h"

#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/record.h"

#include <string.h>

/* ---- query pools */

virga_result virga_timers_create(virga_context *context, uint32_t valid_bits)
{
    virga_result result = VIRGA_OK;
    virga_timers *timers = &context->timers;
    timers->enabled = valid_bits > 0;
    if (!timers->enabled)
        return VIRGA_OK;
    timers->timestamp_mask = valid_bits >= 64 ? UINT64_MAX : (UINT64_C(1) << valid_bits) - 1;
    timers->timestamp_ns = (double)context->properties.limits.timestampPeriod;
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = VIRGA_MAX_QUERIES};
    for (uint32_t i = 0; i < context->frames_in_flight; i++) {
        VK_TRY(context, CreateQueryPool(context->device, &info, NULL, &timers->slots[i].pool));
        context->objects++;
    }
error:
    return result;
}

void virga_timers_destroy(virga_context *context)
{
    for (uint32_t i = 0; i < VIRGA_MAX_FRAMES_IN_FLIGHT; i++)
        VIRGA_DESTROY(context, QueryPool, context->timers.slots[i].pool);
}

static virga_timer_slot *slot_of_frame(virga_context *context)
{
    return &context->timers.slots[context->ring_slot];
}

/* A pool can only be reset outside rendering, so every call that records outside rendering calls this. The first call
 * in a frame resets the pool; a frame without such a call has no timings. Another command buffer of the frame resets
 * what is not written yet, as the first one may be thrown away. */
void virga_timers_reset(virga_context *context, VkCommandBuffer cmd)
{
    virga_timer_slot *slot = slot_of_frame(context);
    const uint32_t first = slot->reset ? slot->count : 0;
    if (!context->timers.enabled || (slot->reset && slot->reset_in == cmd) || first == VIRGA_MAX_QUERIES)
        return;
    context->vk.CmdResetQueryPool(cmd, slot->pool, first, VIRGA_MAX_QUERIES - first);
    slot->reset = true;
    slot->reset_in = cmd;
    slot->frame_index = context->frame_index;
}

/* ---- passes */

static void label_begin(virga_context *context, VkCommandBuffer cmd, const char *name)
{
    if (!context->debug_names || !context->vk.CmdBeginDebugUtilsLabelEXT)
        return;
    const VkDebugUtilsLabelEXT label = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name};
    context->vk.CmdBeginDebugUtilsLabelEXT(cmd, &label);
}

static void label_end(virga_context *context, VkCommandBuffer cmd)
{
    if (context->debug_names && context->vk.CmdEndDebugUtilsLabelEXT)
        context->vk.CmdEndDebugUtilsLabelEXT(cmd);
}

/* Index of a pass in pass_times. Names are static, so comparing addresses finds nearly all of them. */
static uint32_t pass_index(virga_timers *timers, const char *name)
{
    for (uint32_t i = 0; i < timers->pass_count; i++)
        if (timers->pass_times[i].name == name || !strcmp(timers->pass_times[i].name, name))
            return i;
    if (timers->pass_count == VIRGA_MAX_PASSES)
        return VIRGA_MAX_PASSES;
    timers->pass_times[timers->pass_count].name = name;
    return timers->pass_count++;
}

void virga_timers_expect(virga_context *context, bool multiview)
{
    context->timers.multiview = multiview;
}

static virga_pass_scope write_begin(virga_context *context, VkCommandBuffer cmd, const char *name)
{
    virga_timer_slot *slot = slot_of_frame(context);
    if (!context->timers.enabled || context->timers.multiview || slot->count + 2 > VIRGA_MAX_QUERIES || !slot->reset)
        return (virga_pass_scope){0};
    const uint32_t pass = pass_index(&context->timers, name);
    if (pass == VIRGA_MAX_PASSES)
        return (virga_pass_scope){0};
    slot->names[slot->count / 2] = (uint8_t)pass;
    context->vk.CmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, slot->pool, slot->count);
    slot->count += 2;
    return (virga_pass_scope){slot->count - 1};
}

/* Software Vulkan rasterises when the host's rendering ends, long after it has written the timestamps in it: a draw
 * would have no time, and the next pass the draw's. */
virga_pass_scope virga_draw_begin(virga_context *context, VkCommandBuffer cmd, const char *name)
{
    label_begin(context, cmd, name);
    return context->software ? (virga_pass_scope){0} : write_begin(context, cmd, name);
}

static void wait_for_all(virga_context *context, VkCommandBuffer cmd)
{
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    virga_barrier(context, cmd, all, 0, all, 0);
}

/* On software Vulkan a timestamp has a barrier on both sides. Without them it is written before the earlier work is
 * done. Passes wait for each other there anyway. On a GPU such barriers would also wait for the host's own work. */
virga_pass_scope virga_pass_begin(virga_context *context, VkCommandBuffer cmd, const char *name)
{
    const bool alone = context->timers.enabled && context->software;
    context->timers.multiview = false;
    if (alone)
        wait_for_all(context, cmd);
    label_begin(context, cmd, name);
    const virga_pass_scope scope = write_begin(context, cmd, name);
    if (alone)
        wait_for_all(context, cmd);
    return scope;
}

void virga_pass_end(virga_context *context, VkCommandBuffer cmd, virga_pass_scope scope)
{
    if (scope.query)
        context->vk.CmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, slot_of_frame(context)->pool,
                                      scope.query);
    label_end(context, cmd);
}

/* ---- times */

static virga_result read_times(virga_context *context, const virga_timer_slot *slot)
{
    const virga_timers *timers = &context->timers;
    uint64_t ticks[VIRGA_MAX_QUERIES];
    /* Queries that were never reset must not be read. */
    const bool lost = context->lost_of_slot[slot->frame_index % context->frames_in_flight] == slot->frame_index;
    if (!slot->count || lost)
        return VIRGA_OK;
    const VkResult got = context->vk.GetQueryPoolResults(context->device, slot->pool, 0, slot->count, sizeof ticks,
                                                         ticks, sizeof ticks[0], VK_QUERY_RESULT_64_BIT);
    if (got < 0)
        return virga_vulkan_failed(context, got, "vkGetQueryPoolResults") == VIRGA_ERROR_DEVICE_LOST
                   ? VIRGA_ERROR_DEVICE_LOST
                   : VIRGA_DEGRADED;
    if (got != VK_SUCCESS)
        return VIRGA_OK; /* not available: the host never submitted this command buffer */
    for (uint32_t i = 0; i < slot->count / 2; i++) {
        virga_pass_time *time = &context->timers.pass_times[slot->names[i]];
        if (time->frame_index != slot->frame_index)
            time->milliseconds = 0;
        time->frame_index = slot->frame_index;
        const uint64_t passed = (ticks[2 * i + 1] - ticks[2 * i]) & timers->timestamp_mask;
        time->milliseconds += (double)passed * timers->timestamp_ns * 1e-6;
    }
    return VIRGA_OK;
}

/* Reads the times of a slot, and clears it. */
static virga_result collect_slot(virga_context *context, virga_timer_slot *slot)
{
    const virga_result result = read_times(context, slot);
    slot->count = 0;
    slot->reset = false;
    return result;
}

virga_result virga_timers_begin_frame(virga_context *context)
{
    return collect_slot(context, slot_of_frame(context));
}

virga_result virga_timers_collect(virga_context *context)
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < context->frames_in_flight && result >= 0; i++) {
        virga_timer_slot *slot = &context->timers.slots[i];
        if (!slot->count || slot->frame_index > context->completed_index)
            continue;
        const virga_result collected = collect_slot(context, slot);
        result = collected ? collected : result;
    }
    return result;
}

void virga_timers_drop(virga_context *context, uint64_t frame_index)
{
    virga_timer_slot *slot = &context->timers.slots[frame_index % context->frames_in_flight];
    if (slot->frame_index != frame_index)
        return;
    slot->count = 0;
    slot->reset = false;
}

uint32_t virga_timings_get(const virga_context *context, virga_pass_time *times, uint32_t capacity)
{
    if (!context)
        return 0;
    const virga_timers *timers = &context->timers;
    for (uint32_t i = 0; i < timers->pass_count && i < capacity && times; i++)
        times[i] = timers->pass_times[i];
    return timers->pass_count;
}
