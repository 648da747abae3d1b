/* picture_depth.h - the scene's depth in pictures of effects: attached where the host's own passes have it read, and
 * reversed. */
#ifndef VIRGA_TESTS_PICTURE_DEPTH_H
#define VIRGA_TESTS_PICTURE_DEPTH_H

#include "camera.h"
#include "effect_fixture.h"
#include "target.h"

/* A pass that draws the layer and tests it against the plate's depth, which stays as it is: what a target with
 * `depth_attached` is for. */
typedef struct tested_pass {
    VkRenderPass pass; /* null: there is none */
    VkFramebuffer framebuffer;
} tested_pass;

static inline void tested_pass_create(host_device *device, const host_target *picture, VkImageView layer,
                                      tested_pass *made)
{
    const VkAttachmentDescription attachments[2] = {{.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                     .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                     .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
                                                    {.format = VK_FORMAT_D32_SFLOAT,
                                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                                     .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                     .initialLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                                                     .finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 1,
                                          .pColorAttachments = &color,
                                          .pDepthStencilAttachment = &depth};
    const VkPipelineStageFlags draws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkSubpassDependency dependencies[2] = {
        {VK_SUBPASS_EXTERNAL, 0, VK_PIPELINE_STAGE_TRANSFER_BIT | draws, draws, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, 0},
        {0, VK_SUBPASS_EXTERNAL, draws, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         VK_ACCESS_TRANSFER_READ_BIT, 0}};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 2,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = dependencies};
    REQUIRE(vkCreateRenderPass(device->device, &info, NULL, &made->pass) == VK_SUCCESS);
    const VkImageView views[2] = {layer, picture->images[HOST_DEPTH].view};
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = made->pass,
                                                 .attachmentCount = 2,
                                                 .pAttachments = views,
                                                 .width = picture->width,
                                                 .height = picture->height,
                                                 .layers = 1};
    REQUIRE(vkCreateFramebuffer(device->device, &framebuffer, NULL, &made->framebuffer) == VK_SUCCESS);
}

static inline void tested_pass_destroy(host_device *device, tested_pass *made)
{
    vkDestroyFramebuffer(device->device, made->framebuffer, NULL);
    vkDestroyRenderPass(device->device, made->pass, NULL);
    *made = (tested_pass){0};
}

/* Clears the layer and leaves the depth; ended by vkCmdEndRenderPass. */
static inline void tested_pass_begin(const tested_pass *made, const host_target *picture, VkCommandBuffer cmd)
{
    const VkClearValue clears[2] = {{.color = {.float32 = {0}}}, {.depthStencil = {1, 0}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = made->pass,
                                         .framebuffer = made->framebuffer,
                                         .renderArea = {{0, 0}, {picture->width, picture->height}},
                                         .clearValueCount = 2,
                                         .pClearValues = clears};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
}

/* Nearer is greater: depth' = 1 - depth. */
static inline void picture_reverse_depth(virga_view *view)
{
    float *const projections[2] = {view->clip_from_view, view->open_clip_from_view};
    for (int i = 0; i < 2; i++) {
        projections[i][10] = -1 - projections[i][10];
        projections[i][14] = -projections[i][14];
    }
    view->reversed_depth = true;
}

/* Depth buffer value of a distance along the camera's axis. */
static inline float picture_stored_depth(const host_camera *camera, bool reversed, double distance_m)
{
    const double stored = -(double)camera->clip_from_view[10] + (double)camera->clip_from_view[14] / distance_m;
    return (float)(reversed ? 1 - stored : stored);
}

#endif
