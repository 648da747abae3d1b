/* passes.c - see passes.h. */
#include "passes.h"

#include "pipeline.h"

#include <string.h>

VkAttachmentDescription host_attachment(VkFormat format, VkImageLayout after)
{
    return (VkAttachmentDescription){
        .format = format,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .finalLayout = after,
    };
}

/* Fills a dependency between two subpasses and returns 1; returns 0 if it has no stages. */
static uint32_t add_dependency(uint32_t from, uint32_t to, const host_order *order, VkSubpassDependency *dependency)
{
    *dependency =
        (VkSubpassDependency){from, to, order->from_stage, order->to_stage, order->from_access, order->to_access, 0};
    return order->from_stage != 0;
}

bool host_pass_create(host_device *device, const host_pass_def *def, VkRenderPass *pass, char *error, size_t error_size)
{
    VkAttachmentReference colors[HOST_PASS_COLORS];
    VkSubpassDependency dependencies[2];
    for (uint32_t i = 0; i < def->color_count; i++)
        colors[i] = (VkAttachmentReference){i, def->general ? VK_IMAGE_LAYOUT_GENERAL
                                                            : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth = {def->color_count, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {
        .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
        .colorAttachmentCount = def->color_count,
        .pColorAttachments = colors,
        .pDepthStencilAttachment = def->depth ? &depth : NULL,
    };
    uint32_t count = add_dependency(VK_SUBPASS_EXTERNAL, 0, &def->before, &dependencies[0]);
    count += add_dependency(0, VK_SUBPASS_EXTERNAL, &def->after, &dependencies[count]);
    const VkRenderPassCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = def->color_count + def->depth,
        .pAttachments = def->attachments,
        .subpassCount = 1,
        .pSubpasses = &subpass,
        .dependencyCount = count,
        .pDependencies = dependencies,
    };
    HOST_TRY(vkCreateRenderPass(device->device, &info, NULL, pass));
    return true;
}

bool host_framebuffer_create(host_device *device, VkRenderPass pass, const VkImageView *views, uint32_t count,
                             uint32_t width, uint32_t height, VkFramebuffer *framebuffer, char *error,
                             size_t error_size)
{
    const VkFramebufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
        .renderPass = pass,
        .attachmentCount = count,
        .pAttachments = views,
        .width = width,
        .height = height,
        .layers = 1,
    };
    HOST_TRY(vkCreateFramebuffer(device->device, &info, NULL, framebuffer));
    return true;
}

bool host_slice_create(host_device *device, VkRenderPass pass, const host_image *image, uint32_t level, uint32_t layer,
                       host_slice *slice, char *error, size_t error_size)
{
    const uint32_t width = host_level_size(image->extent.width, level);
    const uint32_t height = host_level_size(image->extent.height, level);
    return host_view_create(device, image->image, image->format, level, layer, &slice->view, error, error_size) &&
           host_framebuffer_create(device, pass, &slice->view, 1, width, height, &slice->framebuffer, error,
                                   error_size);
}

void host_slice_destroy(const host_device *device, const host_slice *slice)
{
    vkDestroyFramebuffer(device->device, slice->framebuffer, NULL);
    vkDestroyImageView(device->device, slice->view, NULL);
}

void host_pass_begin(VkCommandBuffer cmd, VkRenderPass pass, VkFramebuffer framebuffer, uint32_t width, uint32_t height,
                     uint32_t color_count)
{
    VkClearValue clears[HOST_PASS_COLORS + 1];
    memset(clears, 0, sizeof clears);
    clears[color_count].depthStencil.depth = 1.0f;
    const VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = pass,
        .framebuffer = framebuffer,
        .renderArea = {{0, 0}, {width, height}},
        .clearValueCount = color_count + 1,
        .pClearValues = clears,
    };
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    host_set_area(cmd, width, height);
}
