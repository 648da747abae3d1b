/* temporal_picture.h - a pass with motion vectors and a reactive mask in the formats that engines use, and read-back.
 * The motion is cleared to a value that no draw writes, so that a test sees where it was left. */
#ifndef VIRGA_TESTS_TEMPORAL_PICTURE_H
#define VIRGA_TESTS_TEMPORAL_PICTURE_H

#include <math.h>
#include <stdlib.h>

#include "host.h"

#include <virga/vulkan.h>

#define NO_MOTION 30000.0f /* clear value of the motion attachment */
#define OTHER_ID  77u      /* clear value of the other attachment */

enum { PICTURE_COLOR, PICTURE_OTHER, PICTURE_MOTION, PICTURE_REACTIVE, PICTURE_IMAGES };

typedef struct temporal_picture {
    uint32_t width, height;
    host_image images[PICTURE_IMAGES];
    host_buffer reads[PICTURE_IMAGES];
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    float *color, *motion, *reactive; /* of the newest frame: RGBA premultiplied, x and y, one */
} temporal_picture;

static const struct {
    VkFormat format;
    uint32_t bytes;
} picture_formats[PICTURE_IMAGES] = {
    [PICTURE_COLOR] = {VK_FORMAT_R32G32B32A32_SFLOAT, 16},
    [PICTURE_OTHER] = {VK_FORMAT_R32_UINT, 4}, /* an attachment of the host, which draws do not change */
    [PICTURE_MOTION] = {VK_FORMAT_R16G16_SFLOAT, 4},
    [PICTURE_REACTIVE] = {VK_FORMAT_R8_UNORM, 1},
};

#define PICTURE_REQUIRE(condition)              \
    do {                                        \
        if (!(condition))                       \
            fail_msg("not so: %s", #condition); \
    } while (0)

static inline void picture_pass(host_device *device, temporal_picture *p)
{
    VkAttachmentDescription attachments[PICTURE_IMAGES];
    VkAttachmentReference references[PICTURE_IMAGES];
    for (uint32_t i = 0; i < PICTURE_IMAGES; i++) {
        attachments[i] = (VkAttachmentDescription){.format = picture_formats[i].format,
                                                   .samples = VK_SAMPLE_COUNT_1_BIT,
                                                   .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                   .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                   .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
        references[i] = (VkAttachmentReference){i, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    }
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = PICTURE_IMAGES,
                                          .pColorAttachments = references};
    const VkPipelineStageFlags drawn = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkAccessFlags access = VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    const VkSubpassDependency dependencies[2] = {{VK_SUBPASS_EXTERNAL, 0, VK_PIPELINE_STAGE_TRANSFER_BIT | drawn, drawn,
                                                  VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, access, 0},
                                                 {0, VK_SUBPASS_EXTERNAL, drawn, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                                  VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT,
                                                  0}};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = PICTURE_IMAGES,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = dependencies};
    PICTURE_REQUIRE(vkCreateRenderPass(device->device, &info, NULL, &p->pass) == VK_SUCCESS);
}

static inline void picture_open(host_device *device, uint32_t width, uint32_t height, temporal_picture *p)
{
    char error[256];
    VkImageView views[PICTURE_IMAGES];
    *p = (temporal_picture){.width = width, .height = height};
    for (uint32_t i = 0; i < PICTURE_IMAGES; i++) {
        const host_image_def def = {.format = picture_formats[i].format,
                                    .extent = {width, height, 1},
                                    .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                    .name = "temporal"};
        PICTURE_REQUIRE(host_image_create(device, &def, &p->images[i], error, sizeof error));
        PICTURE_REQUIRE(host_buffer_create(device, (VkDeviceSize)width * height * picture_formats[i].bytes,
                                           VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "temporal",
                                           &p->reads[i], error, sizeof error));
        views[i] = p->images[i].view;
    }
    picture_pass(device, p);
    const VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                          .renderPass = p->pass,
                                          .attachmentCount = PICTURE_IMAGES,
                                          .pAttachments = views,
                                          .width = width,
                                          .height = height,
                                          .layers = 1};
    PICTURE_REQUIRE(vkCreateFramebuffer(device->device, &info, NULL, &p->framebuffer) == VK_SUCCESS);
    p->color = malloc((size_t)width * height * 4 * sizeof(float));
    p->motion = malloc((size_t)width * height * 2 * sizeof(float));
    p->reactive = malloc((size_t)width * height * sizeof(float));
}

static inline void picture_close(host_device *device, temporal_picture *p)
{
    vkDestroyFramebuffer(device->device, p->framebuffer, NULL);
    vkDestroyRenderPass(device->device, p->pass, NULL);
    for (uint32_t i = 0; i < PICTURE_IMAGES; i++) {
        host_image_destroy(device, &p->images[i]);
        host_buffer_destroy(device, &p->reads[i]);
    }
    free(p->color);
    free(p->motion);
    free(p->reactive);
}

/* Formats are given though a render pass does without: so they are checked. */
static inline virga_target_def picture_target(const temporal_picture *p)
{
    virga_target_def def = virga_default_target_def();
    def.kind = VIRGA_TARGET_RENDER_PASS;
    def.render_pass = p->pass;
    def.color_count = PICTURE_IMAGES;
    def.motion_attachment = PICTURE_MOTION;
    def.reactive_attachment = PICTURE_REACTIVE;
    def.depth_attached = false;
    for (uint32_t i = 0; i < PICTURE_IMAGES; i++)
        def.color_formats[i] = picture_formats[i].format;
    return def;
}

static inline void picture_begin(const temporal_picture *p, VkCommandBuffer cmd)
{
    const VkClearValue clears[PICTURE_IMAGES] = {
        [PICTURE_OTHER] = {.color = {.uint32 = {OTHER_ID}}},
        [PICTURE_MOTION] = {.color = {.float32 = {NO_MOTION, NO_MOTION}}},
    };
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = p->pass,
                                         .framebuffer = p->framebuffer,
                                         .renderArea = {{0, 0}, {p->width, p->height}},
                                         .clearValueCount = PICTURE_IMAGES,
                                         .pClearValues = clears};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
}

static inline void picture_end(const temporal_picture *p, VkCommandBuffer cmd)
{
    vkCmdEndRenderPass(cmd);
    for (uint32_t i = 0; i < PICTURE_IMAGES; i++) {
        const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                        .imageExtent = {p->width, p->height, 1}};
        vkCmdCopyImageToBuffer(cmd, p->images[i].image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, p->reads[i].buffer, 1,
                               &copy);
    }
    const VkMemoryBarrier read = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                  .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                  .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &read, 0, NULL, 0,
                         NULL);
}

static inline float picture_half(uint32_t bits)
{
    const int exponent = (int)(bits >> 10 & 31), mantissa = (int)(bits & 1023);
    const double size = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return (float)(bits & 0x8000 ? -size : size);
}

/* Call it after the device has completed the frame. */
static inline void picture_read(const host_device *device, temporal_picture *p)
{
    const size_t pixels = (size_t)p->width * p->height;
    for (uint32_t i = 0; i < PICTURE_IMAGES; i++)
        host_buffer_invalidate(device, &p->reads[i]);
    const uint32_t *motion = p->reads[PICTURE_MOTION].mapped, *other = p->reads[PICTURE_OTHER].mapped;
    const uint8_t *reactive = p->reads[PICTURE_REACTIVE].mapped;
    memcpy(p->color, p->reads[PICTURE_COLOR].mapped, pixels * 16);
    for (size_t i = 0; i < pixels; i++) {
        p->motion[2 * i] = picture_half(motion[i]);
        p->motion[2 * i + 1] = picture_half(motion[i] >> 16);
        p->reactive[i] = (float)reactive[i] / 255;
        PICTURE_REQUIRE(other[i] == OTHER_ID);
    }
}

static inline bool picture_has_motion(const temporal_picture *p, size_t pixel)
{
    return p->motion[2 * pixel] < 0.5f * NO_MOTION;
}

#endif
