/* layered_pass.h - a render pass of a test's own, with a color of any format over one or more layers, and its readback.
 * With a view mask, each of the mask's views is drawn into its own layer. */
#ifndef VIRGA_TESTS_LAYERED_PASS_H
#define VIRGA_TESTS_LAYERED_PASS_H

#include "../host/effect_fixture.h"

typedef struct layered_pass {
    fixture *gpu;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    host_image color;
    host_buffer pixels; /* of all layers, one after the other */
    uint32_t width, height, layers, view_mask;
} layered_pass;

static inline void layered_pass_describe(layered_pass *p, VkFormat format)
{
    const VkAttachmentDescription attachment = {.format = format,
                                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                                .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkPipelineStageFlags draws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkSubpassDependency dependencies[2] = {
        {VK_SUBPASS_EXTERNAL, 0, VK_PIPELINE_STAGE_TRANSFER_BIT | draws, draws, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, 0},
        {0, VK_SUBPASS_EXTERNAL, draws, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         VK_ACCESS_TRANSFER_READ_BIT, 0}};
    const VkRenderPassMultiviewCreateInfo views = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_MULTIVIEW_CREATE_INFO, .subpassCount = 1, .pViewMasks = &p->view_mask};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .pNext = p->view_mask ? &views : NULL,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = dependencies};
    REQUIRE(vkCreateRenderPass(p->gpu->device.device, &info, NULL, &p->pass) == VK_SUCCESS);
}

static inline void layered_pass_open(layered_pass *p, fixture *gpu, VkFormat format, uint32_t texel_bytes,
                                     uint32_t width, uint32_t height, uint32_t layers, uint32_t view_mask)
{
    *p = (layered_pass){.gpu = gpu, .width = width, .height = height, .layers = layers, .view_mask = view_mask};
    const host_image_def def = {.format = format,
                                .extent = {width, height, 1},
                                .layers = layers,
                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                .name = "a test's picture"};
    REQUIRE(host_image_create(&gpu->device, &def, &p->color, gpu->error, sizeof gpu->error));
    REQUIRE(host_buffer_create(&gpu->device, (VkDeviceSize)texel_bytes * width * height * layers,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "pixels", &p->pixels, gpu->error,
                               sizeof gpu->error));
    layered_pass_describe(p, format);
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = p->pass,
                                                 .attachmentCount = 1,
                                                 .pAttachments = &p->color.view,
                                                 .width = width,
                                                 .height = height,
                                                 .layers = 1};
    REQUIRE(vkCreateFramebuffer(gpu->device.device, &framebuffer, NULL, &p->framebuffer) == VK_SUCCESS);
}

static inline void layered_pass_close(layered_pass *p)
{
    vkDestroyFramebuffer(p->gpu->device.device, p->framebuffer, NULL);
    vkDestroyRenderPass(p->gpu->device.device, p->pass, NULL);
    host_image_destroy(&p->gpu->device, &p->color);
    host_buffer_destroy(&p->gpu->device, &p->pixels);
}

/* All channels of the picture begin as `value`. */
static inline void layered_pass_begin(const layered_pass *p, VkCommandBuffer cmd, float value)
{
    const VkClearValue clear = {.color = {.float32 = {value, value, value, value}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = p->pass,
                                         .framebuffer = p->framebuffer,
                                         .renderArea = {{0, 0}, {p->width, p->height}},
                                         .clearValueCount = 1,
                                         .pClearValues = &clear};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
}

/* Ends the pass and copies the picture out. */
static inline void layered_pass_end(const layered_pass *p, VkCommandBuffer cmd)
{
    const VkBufferImageCopy picture = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, p->layers},
                                       .imageExtent = {p->width, p->height, 1}};
    vkCmdEndRenderPass(cmd);
    vkCmdCopyImageToBuffer(cmd, p->color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, p->pixels.buffer, 1, &picture);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
}

/* Once the device has completed it. */
static inline const void *layered_pass_pixels(const layered_pass *p)
{
    host_buffer_invalidate(&p->gpu->device, &p->pixels);
    return p->pixels.mapped;
}

#endif
