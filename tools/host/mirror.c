/* mirror.c - images and render pass of what water mirrors. */
#include "mirror.h"

#include "pipeline.h"

#include <string.h>

#define DEPTH_STAGES (VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT)

static bool create_images(host_device *device, host_mirror *mirror, char *error, size_t error_size)
{
    host_image_def def = {
        .format = VK_FORMAT_R16G16B16A16_SFLOAT,
        .extent = {mirror->width, mirror->height, 1},
        .levels = host_mirror_level_count(mirror->width, mirror->height),
        .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
        .name = "mirror",
    };
    if (!host_image_create(device, &def, &mirror->color, error, error_size))
        return false;
    def.format = VK_FORMAT_D32_SFLOAT;
    def.levels = 1;
    def.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    def.name = "mirror depth";
    return host_image_create(device, &def, &mirror->depth, error, error_size);
}

static VkAttachmentDescription cleared(VkFormat format, VkAttachmentStoreOp store, VkImageLayout final)
{
    return (VkAttachmentDescription){
        .format = format,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
        .storeOp = store,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .finalLayout = final,
    };
}

static bool create_pass(host_device *device, host_mirror *mirror, char *error, size_t error_size)
{
    const VkAttachmentDescription attachments[] = {
        cleared(mirror->color.format, VK_ATTACHMENT_STORE_OP_STORE, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
        cleared(mirror->depth.format, VK_ATTACHMENT_STORE_OP_DONT_CARE,
                VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL),
    };
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {
        .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
        .colorAttachmentCount = 1,
        .pColorAttachments = &color,
        .pDepthStencilAttachment = &depth,
    };
    const VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const VkSubpassDependency dependencies[] = {
        {
            /* After the plate of the frame before has read it. */
            .srcSubpass = VK_SUBPASS_EXTERNAL,
            .srcStageMask =
                VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | DEPTH_STAGES,
            .dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | DEPTH_STAGES,
            .srcAccessMask = writes,
            .dstAccessMask = writes | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
        },
        {
            .dstSubpass = VK_SUBPASS_EXTERNAL,
            .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
            .dstStageMask = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
            .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
            .dstAccessMask = VK_ACCESS_SHADER_READ_BIT,
        },
    };
    const VkRenderPassCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = 2,
        .pAttachments = attachments,
        .subpassCount = 1,
        .pSubpasses = &subpass,
        .dependencyCount = 2,
        .pDependencies = dependencies,
    };
    HOST_TRY(vkCreateRenderPass(device->device, &info, NULL, &mirror->pass));
    return true;
}

static bool create_framebuffer(host_device *device, host_mirror *mirror, char *error, size_t error_size)
{
    const VkImageView views[] = {mirror->levels.views[0], mirror->depth.view};
    const VkFramebufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
        .renderPass = mirror->pass,
        .attachmentCount = 2,
        .pAttachments = views,
        .width = mirror->width,
        .height = mirror->height,
        .layers = 1,
    };
    HOST_TRY(vkCreateFramebuffer(device->device, &info, NULL, &mirror->framebuffer));
    return true;
}

bool host_mirror_create(host_device *device, uint32_t width, uint32_t height, host_mirror *mirror, char *error,
                        size_t error_size)
{
    memset(mirror, 0, sizeof *mirror);
    mirror->width = width;
    mirror->height = height;
    if (create_images(device, mirror, error, error_size) && create_pass(device, mirror, error, error_size) &&
        host_mirror_levels_create(device, &mirror->color, &mirror->levels, error, error_size) &&
        create_framebuffer(device, mirror, error, error_size))
        return true;
    host_mirror_destroy(device, mirror);
    return false;
}

void host_mirror_destroy(host_device *device, host_mirror *mirror)
{
    vkDestroyFramebuffer(device->device, mirror->framebuffer, NULL);
    vkDestroyRenderPass(device->device, mirror->pass, NULL);
    host_mirror_levels_destroy(device, &mirror->levels);
    host_image_destroy(device, &mirror->depth);
    host_image_destroy(device, &mirror->color);
    memset(mirror, 0, sizeof *mirror);
}

void host_mirror_begin(const host_mirror *mirror, VkCommandBuffer cmd)
{
    VkClearValue clears[2];
    memset(clears, 0, sizeof clears);
    clears[1].depthStencil.depth = 1.0f;
    const VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = mirror->pass,
        .framebuffer = mirror->framebuffer,
        .renderArea = {{0, 0}, {mirror->width, mirror->height}},
        .clearValueCount = 2,
        .pClearValues = clears,
    };
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    host_set_area(cmd, mirror->width, mirror->height);
}

void host_mirror_end(const host_mirror *mirror, VkCommandBuffer cmd)
{
    vkCmdEndRenderPass(cmd);
    host_mirror_levels_record(&mirror->levels, cmd, &mirror->color);
}
