/* gpu/record.c - compute passes, and what surrounds a pass: labels, timestamps, barriers, the area of a draw. */
#include "gpu/context.h"

#include <math.h>
#include <string.h>

void virga_barrier(virga_context *context, VkCommandBuffer cmd, VkPipelineStageFlags from, VkAccessFlags wrote,
                   VkPipelineStageFlags to, VkAccessFlags reads)
{
    const VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = wrote, .dstAccessMask = reads};
    context->vk.CmdPipelineBarrier(cmd, from, to, 0, 1, &barrier, 0, NULL, 0, NULL);
}

void virga_compute_barrier(virga_context *context, VkCommandBuffer cmd)
{
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, READ_WRITE);
}

void virga_indirect_barrier(virga_context *context, VkCommandBuffer cmd)
{
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                  READ_WRITE | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
}

void virga_dispatch(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t groups)
{
    virga_dispatch_2d(context, cmd, pipeline, groups, 1);
}

void virga_dispatch_2d(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t columns,
                       uint32_t rows)
{
    context->vk.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline->pipeline);
    context->vk.CmdDispatch(cmd, columns, rows, 1);
}

void virga_dispatch_indirect(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                             VkBuffer arguments, VkDeviceSize offset)
{
    context->vk.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline->pipeline);
    context->vk.CmdDispatchIndirect(cmd, arguments, offset);
}

void virga_dispatch_and_barrier(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                                uint32_t groups)
{
    virga_dispatch(context, cmd, pipeline, groups);
    virga_indirect_barrier(context, cmd);
}

void virga_dispatch_indirect_and_barrier(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                                         VkBuffer arguments, VkDeviceSize offset)
{
    virga_dispatch_indirect(context, cmd, pipeline, arguments, offset);
    virga_indirect_barrier(context, cmd);
}

void virga_record_list(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *find,
                       const virga_pipeline *scan, const virga_pipeline *list, uint32_t groups)
{
    virga_dispatch(context, cmd, find, groups);
    virga_compute_barrier(context, cmd);
    virga_dispatch(context, cmd, scan, 1);
    virga_compute_barrier(context, cmd);
    virga_dispatch_and_barrier(context, cmd, list, (groups + 31) / 32);
}

void virga_image_barrier(virga_context *context, VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect,
                         virga_image_state before, virga_image_state after)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = before.access,
        .dstAccessMask = after.access,
        .oldLayout = before.layout,
        .newLayout = after.layout,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}};
    const VkPipelineStageFlags from = before.stage ? before.stage : VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT;
    context->vk.CmdPipelineBarrier(cmd, from, after.stage, 0, 0, NULL, 0, NULL, 1, &barrier);
}

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

/* Index of a pass's name among the times; names are static, so their addresses tell them apart. */
static uint32_t pass_index(virga_context *context, const char *name)
{
    for (uint32_t i = 0; i < context->pass_count; i++)
        if (context->pass_times[i].name == name || !strcmp(context->pass_times[i].name, name))
            return i;
    if (context->pass_count == VIRGA_MAX_PASSES)
        return VIRGA_MAX_PASSES;
    context->pass_times[context->pass_count].name = name;
    return context->pass_count++;
}

virga_pass_scope virga_draw_begin(virga_context *context, VkCommandBuffer cmd, const char *name)
{
    label_begin(context, cmd, name);
    virga_timer_slot *slot = &context->timers[context->ring_slot];
    if (!context->timings || slot->count + 2 > VIRGA_MAX_QUERIES || !slot->reset)
        return (virga_pass_scope){0};
    const uint32_t pass = pass_index(context, name);
    if (pass == VIRGA_MAX_PASSES)
        return (virga_pass_scope){0};
    slot->names[slot->count / 2] = (uint8_t)pass;
    context->vk.CmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, slot->pool, slot->count);
    slot->count += 2;
    return (virga_pass_scope){slot->count - 1};
}

static void wait_for_all(virga_context *context, VkCommandBuffer cmd)
{
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    virga_barrier(context, cmd, all, 0, all, 0);
}

/* On software Vulkan a timestamp between two barriers: without them it is taken before the work in front is done, and
 * passes wait for each other there anyway. A GPU would drain at each, the host's own work with it. */
virga_pass_scope virga_pass_begin(virga_context *context, VkCommandBuffer cmd, const char *name)
{
    const bool alone = context->timings && context->software;
    if (alone)
        wait_for_all(context, cmd);
    const virga_pass_scope scope = virga_draw_begin(context, cmd, name);
    if (alone)
        wait_for_all(context, cmd);
    return scope;
}

void virga_draw_area(virga_context *context, VkCommandBuffer cmd, const float viewport[4])
{
    const VkViewport area = {viewport[0], viewport[1], viewport[2], viewport[3], 0, 1};
    const VkRect2D scissor = {{viewport[0] > 0 ? (int32_t)viewport[0] : 0, viewport[1] > 0 ? (int32_t)viewport[1] : 0},
                              {(uint32_t)ceilf(viewport[2]), (uint32_t)ceilf(viewport[3])}};
    context->vk.CmdSetViewport(cmd, 0, 1, &area);
    context->vk.CmdSetScissor(cmd, 0, 1, &scissor);
}

void virga_pass_end(virga_context *context, VkCommandBuffer cmd, virga_pass_scope scope)
{
    if (scope.query)
        context->vk.CmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                                      context->timers[context->ring_slot].pool, scope.query);
    label_end(context, cmd);
}

/* A pool can only be reset outside rendering, so every call that records outside rendering makes sure of it; a
 * frame's first such call does it, and a frame without one has no timings. */
void virga_timers_reset(virga_context *context, VkCommandBuffer cmd)
{
    virga_timer_slot *slot = &context->timers[context->ring_slot];
    if (!context->timings || slot->reset)
        return;
    context->vk.CmdResetQueryPool(cmd, slot->pool, 0, VIRGA_MAX_QUERIES);
    slot->reset = true;
    slot->frame_index = context->frame_index;
}

virga_result virga_timers_collect(virga_context *context, virga_timer_slot *slot)
{
    uint64_t ticks[VIRGA_MAX_QUERIES];
    if (!slot->count)
        return VIRGA_OK;
    const VkResult got = context->vk.GetQueryPoolResults(context->device, slot->pool, 0, slot->count, sizeof ticks,
                                                         ticks, sizeof ticks[0], VK_QUERY_RESULT_64_BIT);
    if (got < 0)
        return virga_vulkan_failed(context, got, "vkGetQueryPoolResults") == VIRGA_ERROR_DEVICE_LOST
                   ? VIRGA_ERROR_DEVICE_LOST
                   : VIRGA_DEGRADED;
    if (got != VK_SUCCESS)
        return VIRGA_OK; /* not there: the host recorded into a command buffer that it never submitted */
    for (uint32_t i = 0; i < slot->count / 2; i++) {
        virga_pass_time *time = &context->pass_times[slot->names[i]];
        if (time->frame_index != slot->frame_index)
            time->milliseconds = 0;
        time->frame_index = slot->frame_index;
        const uint64_t passed = (ticks[2 * i + 1] - ticks[2 * i]) & context->timestamp_mask;
        time->milliseconds += (double)passed * context->timestamp_ns * 1e-6;
    }
    return VIRGA_OK;
}

uint32_t virga_timings_get(const virga_context *context, virga_pass_time *times, uint32_t capacity)
{
    if (!context)
        return 0;
    for (uint32_t i = 0; i < context->pass_count && i < capacity && times; i++)
        times[i] = context->pass_times[i];
    return context->pass_count;
}
