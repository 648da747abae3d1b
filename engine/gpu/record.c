/* gpu/record.c - barriers and compute passes for all effects. */
#include "gpu/record.h"

#include "gpu/builds.h"
#include "gpu/context.h"
#include "gpu/pipelines.h"

#include <math.h>

void virga_barrier(virga_context *context, VkCommandBuffer cmd, VkPipelineStageFlags from, VkAccessFlags wrote,
                   VkPipelineStageFlags to, VkAccessFlags reads)
{
    const VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = wrote, .dstAccessMask = reads};
    context->vk.CmdPipelineBarrier(cmd, from, to, 0, 1, &barrier, 0, NULL, 0, NULL);
}

/* In the order of the bits of virga_users. */
static const struct {
    VkPipelineStageFlags stages;
    VkAccessFlags reads, writes;
} users[] = {
    {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT, VK_ACCESS_SHADER_WRITE_BIT},
    {VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, VK_ACCESS_INDIRECT_COMMAND_READ_BIT, 0},
    {VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT, VK_ACCESS_TRANSFER_WRITE_BIT},
    {VK_PIPELINE_STAGE_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT,
     VK_ACCESS_INDEX_READ_BIT | VK_ACCESS_SHADER_READ_BIT, 0},
    {VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT, 0},
};

void virga_wait(virga_context *context, VkCommandBuffer cmd, uint32_t before, uint32_t after)
{
    VkPipelineStageFlags from = 0, to = 0;
    VkAccessFlags wrote = 0, use = 0;
    for (uint32_t i = 0; i < sizeof users / sizeof users[0]; i++) {
        if (before & 1u << i) {
            from |= users[i].stages;
            wrote |= users[i].writes;
        }
        if (after & 1u << i) {
            to |= users[i].stages;
            use |= users[i].reads | users[i].writes;
        }
    }
    virga_barrier(context, cmd, from, wrote, to, use);
}

void virga_compute_barrier(virga_context *context, VkCommandBuffer cmd)
{
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_PASSES);
}

void virga_indirect_barrier(virga_context *context, VkCommandBuffer cmd)
{
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_PASSES | VIRGA_ARGUMENTS);
}

void virga_bind(virga_context *context, VkCommandBuffer cmd, VkPipelineBindPoint point, const virga_bindings *bindings,
                VkDescriptorSet set, uint32_t offset_count, const uint32_t *offsets)
{
    context->vk.CmdBindDescriptorSets(cmd, point, bindings->layout, 0, 1, &set, offset_count, offsets);
}

bool virga_bind_pipeline(virga_context *context, VkCommandBuffer cmd, VkPipelineBindPoint point,
                         const virga_pipeline *pipeline)
{
    const VkPipeline handle = virga_build_on_use(context, pipeline);
    if (handle)
        context->vk.CmdBindPipeline(cmd, point, handle);
    return handle;
}

void virga_dispatch(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t groups)
{
    virga_dispatch_2d(context, cmd, pipeline, groups, 1);
}

void virga_dispatch_2d(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t columns,
                       uint32_t rows)
{
    if (virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline))
        context->vk.CmdDispatch(cmd, columns, rows, 1);
}

void virga_dispatch_indirect(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                             VkBuffer arguments, VkDeviceSize offset)
{
    if (virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline))
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
    if (context->for_software) {
        virga_dispatch(context, cmd, scan, 1);
        virga_compute_barrier(context, cmd);
    }
    virga_dispatch_and_barrier(context, cmd, list, (groups + 31) / 32);
}

void virga_draw_indexed_indirect(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                                 VkBuffer arguments, VkDeviceSize offset)
{
    if (virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline))
        context->vk.CmdDrawIndexedIndirect(cmd, arguments, offset, 1, sizeof(VkDrawIndexedIndirectCommand));
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

void virga_fill_sampled(virga_context *context, VkCommandBuffer cmd, VkImage image, VkBuffer from, VkExtent2D extent,
                        uint32_t layers)
{
    const virga_image_state before = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0};
    const virga_image_state filled = {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                      VK_ACCESS_TRANSFER_WRITE_BIT};
    const virga_image_state ready = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                     VK_ACCESS_SHADER_READ_BIT};
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, layers},
                                    .imageExtent = {extent.width, extent.height, 1}};
    virga_image_barrier(context, cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, before, filled);
    context->vk.CmdCopyBufferToImage(cmd, from, image, filled.layout, 1, &copy);
    virga_image_barrier(context, cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, filled, ready);
}

void virga_set_draw_area(virga_context *context, VkCommandBuffer cmd, const float viewport[4])
{
    const VkViewport area = {viewport[0], viewport[1], viewport[2], viewport[3], 0, 1};
    const VkRect2D scissor = {{viewport[0] > 0 ? (int32_t)viewport[0] : 0, viewport[1] > 0 ? (int32_t)viewport[1] : 0},
                              {(uint32_t)ceilf(viewport[2]), (uint32_t)ceilf(viewport[3])}};
    context->vk.CmdSetViewport(cmd, 0, 1, &area);
    context->vk.CmdSetScissor(cmd, 0, 1, &scissor);
}
