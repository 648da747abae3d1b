/* mirror_levels.c - draws each mip level from the one before. */
#include "mirror_levels.h"

#include "pipeline.h"

#include <string.h>

#include "mirror_level_frag.spv.h"
#include "mirror_level_vert.spv.h"

#define MIN_SIDE 2

uint32_t host_mirror_level_count(uint32_t width, uint32_t height)
{
    const uint32_t shorter = width < height ? width : height;
    uint32_t count = 1;
    while (count < HOST_MIRROR_LEVELS && host_level_size(shorter, count) >= MIN_SIDE)
        count++;
    return count;
}

/* ---- create ------------------------------------------------------------------------------------------------- */

static bool create_pass(host_device *device, host_mirror_levels *levels, VkFormat format, char *error,
                        size_t error_size)
{
    VkAttachmentDescription attachment = host_attachment(format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    const VkPipelineStageFlags draws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkPipelineStageFlags reads = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    const VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    const host_pass_def def = {
        .attachments = &attachment,
        .color_count = 1,
        /* After the previous level is drawn, and after the previous frame has sampled this one. */
        .before = {draws | reads, writes, draws | reads, writes | VK_ACCESS_SHADER_READ_BIT},
        .after = {draws, writes, reads, VK_ACCESS_SHADER_READ_BIT},
    };
    return host_pass_create(device, &def, &levels->pass, error, error_size);
}

static bool create_slices(host_device *device, host_mirror_levels *levels, const host_image *color, char *error,
                          size_t error_size)
{
    for (uint32_t i = 0; i < levels->count; i++)
        if (!host_slice_create(device, levels->pass, color, i, 0, &levels->slices[i], error, error_size))
            return false;
    return true;
}

static bool create_sets(host_device *device, host_mirror_levels *levels, char *error, size_t error_size)
{
    static const VkDescriptorType type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const host_bindings_def def = {.shape = {&type, 1, VK_SHADER_STAGE_FRAGMENT_BIT}, .set_count = levels->count};
    if (!host_sampler_create(device, HOST_SAMPLE_LINEAR, &levels->sampler, error, error_size) ||
        !host_bindings_create(device, &def, &levels->bindings, error, error_size))
        return false;
    for (uint32_t i = 1; i < levels->count; i++)
        host_set_write_image(device, levels->bindings.sets[i], 0, levels->sampler, levels->slices[i - 1].view,
                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    return true;
}

bool host_mirror_levels_create(host_device *device, const host_image *color, host_mirror_levels *levels, char *error,
                               size_t error_size)
{
    memset(levels, 0, sizeof *levels);
    levels->count = color->levels;
    if (create_pass(device, levels, color->format, error, error_size) &&
        create_slices(device, levels, color, error, error_size) && create_sets(device, levels, error, error_size) &&
        host_fullscreen_create(device, HOST_CODE(mirror_level_vert), HOST_CODE(mirror_level_frag),
                               levels->bindings.layout, levels->pass, &levels->pipeline, error, error_size))
        return true;
    host_mirror_levels_destroy(device, levels);
    return false;
}

void host_mirror_levels_destroy(host_device *device, host_mirror_levels *levels)
{
    vkDestroyPipeline(device->device, levels->pipeline, NULL);
    host_bindings_destroy(device, &levels->bindings);
    vkDestroySampler(device->device, levels->sampler, NULL);
    for (uint32_t i = 0; i < levels->count; i++)
        host_slice_destroy(device, &levels->slices[i]);
    vkDestroyRenderPass(device->device, levels->pass, NULL);
    memset(levels, 0, sizeof *levels);
}

/* ---- recording ---------------------------------------------------------------------------------------------- */

void host_mirror_levels_record(const host_mirror_levels *levels, VkCommandBuffer cmd, const host_image *color)
{
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, levels->pipeline);
    for (uint32_t i = 1; i < levels->count; i++) {
        const uint32_t width = host_level_size(color->extent.width, i),
                       height = host_level_size(color->extent.height, i);
        host_pass_begin(cmd, levels->pass, levels->slices[i].framebuffer, width, height, 1);
        vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, levels->bindings.layout, 0, 1,
                                &levels->bindings.sets[i], 0, NULL);
        vkCmdDraw(cmd, 3, 1, 0, 0);
        vkCmdEndRenderPass(cmd);
    }
}
