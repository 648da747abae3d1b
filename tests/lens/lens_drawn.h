/* lens_drawn.h - a target that a lens draws into, which is read back. */
#ifndef VIRGA_TESTS_LENS_DRAWN_H
#define VIRGA_TESTS_LENS_DRAWN_H

#include "lens_fixture.h"

#define LENS_WHOLE UINT32_MAX /* not a part: the picture */

typedef struct lens_drawn {
    host_image image;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    virga_target *target;
} lens_drawn;

static inline void lens_create_drawn(lens_fixture *f, lens_drawn *made)
{
    const VkDevice device = f->gpu.device.device;
    const host_image_def def = {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                .extent = {f->scene.width, f->scene.height, 1},
                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                .name = "drawn"};
    REQUIRE(host_image_create(&f->gpu.device, &def, &made->image, f->gpu.error, sizeof f->gpu.error));
    const VkAttachmentDescription attachment = {.format = def.format,
                                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                                .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkSubpassDependency to_copy = {0,
                                         VK_SUBPASS_EXTERNAL,
                                         VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                         VK_PIPELINE_STAGE_TRANSFER_BIT,
                                         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                         VK_ACCESS_TRANSFER_READ_BIT,
                                         0};
    const VkRenderPassCreateInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 1,
                                         .pDependencies = &to_copy};
    REQUIRE(vkCreateRenderPass(device, &pass, NULL, &made->pass) == VK_SUCCESS);
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = made->pass,
                                                 .attachmentCount = 1,
                                                 .pAttachments = &made->image.view,
                                                 .width = f->scene.width,
                                                 .height = f->scene.height,
                                                 .layers = 1};
    REQUIRE(vkCreateFramebuffer(device, &framebuffer, NULL, &made->framebuffer) == VK_SUCCESS);
    virga_target_def target = virga_default_target_def();
    target.render_pass = made->pass;
    target.depth_attached = false;
    target.reversed_depth = true;
    REQUIRE(virga_target_create(f->context, &target, &made->target) == VIRGA_OK);
    REQUIRE(virga_lens_attach(f->lens, made->target) == VIRGA_OK);
}

static inline void lens_destroy_drawn(lens_fixture *f, lens_drawn *made)
{
    virga_target_destroy(&made->target);
    vkDestroyFramebuffer(f->gpu.device.device, made->framebuffer, NULL);
    vkDestroyRenderPass(f->gpu.device.device, made->pass, NULL);
    host_image_destroy(&f->gpu.device, &made->image);
}

/* Draws the picture or a part of it into the target, and reads the target back into the result. */
static inline virga_result lens_draw_and_read(lens_fixture *f, const lens_drawn *made, VkCommandBuffer cmd,
                                              uint32_t part)
{
    const VkClearValue clear = {.color = {.float32 = {9, 9, 9, 9}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = made->pass,
                                         .framebuffer = made->framebuffer,
                                         .renderArea = {{0, 0}, {f->scene.width, f->scene.height}},
                                         .clearValueCount = 1,
                                         .pClearValues = &clear};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const virga_result result = part == LENS_WHOLE ? virga_lens_draw(f->lens, cmd, made->target)
                                                   : virga_lens_draw_part(f->lens, cmd, made->target, part);
    vkCmdEndRenderPass(cmd);
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {f->scene.width, f->scene.height, 1}};
    vkCmdCopyImageToBuffer(cmd, made->image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, f->download.buffer, 1, &copy);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
    effect_fixture_complete(&f->gpu, f->context);
    host_buffer_invalidate(&f->gpu.device, &f->download);
    return result;
}

#endif
