/* passes.h - render passes with one subpass and one sample, and their framebuffers. */
#ifndef VIRGA_HOST_PASSES_H
#define VIRGA_HOST_PASSES_H

#include "memory.h"

/* A dependency: the first stage completes before the second begins. */
typedef struct host_order {
    VkPipelineStageFlags from_stage;
    VkAccessFlags from_access;
    VkPipelineStageFlags to_stage;
    VkAccessFlags to_access;
} host_order;

typedef struct host_pass_def {
    const VkAttachmentDescription *attachments; /* colors, then depth */
    uint32_t color_count;                       /* at most HOST_PASS_COLORS */
    bool depth;
    bool general;             /* colors stay in the layout GENERAL */
    host_order before, after; /* dependencies on commands outside the pass; all zero: none */
} host_pass_def;

#define HOST_PASS_COLORS 8

#define HOST_DEPTH_STAGES (VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT)
#define HOST_DRAW_WRITES  (VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT)
#define HOST_DRAW_READS   (VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT)

/* An attachment that is cleared, drawn and stored, and ends in the layout `after`. */
VkAttachmentDescription host_attachment(VkFormat format, VkImageLayout after);

bool host_pass_create(host_device *device, const host_pass_def *def, VkRenderPass *pass, char *error,
                      size_t error_size);

bool host_framebuffer_create(host_device *device, VkRenderPass pass, const VkImageView *views, uint32_t count,
                             uint32_t width, uint32_t height, VkFramebuffer *framebuffer, char *error,
                             size_t error_size);

/* One level of one layer of an image, to draw into. */
typedef struct host_slice {
    VkImageView view;
    VkFramebuffer framebuffer;
} host_slice;

bool host_slice_create(host_device *device, VkRenderPass pass, const host_image *image, uint32_t level, uint32_t layer,
                       host_slice *slice, char *error, size_t error_size);
void host_slice_destroy(const host_device *device, const host_slice *slice);

/* Begins a pass on a whole framebuffer, and sets viewport and scissor. Clears colors to 0 and depth to 1. */
void host_pass_begin(VkCommandBuffer cmd, VkRenderPass pass, VkFramebuffer framebuffer, uint32_t width, uint32_t height,
                     uint32_t color_count);

#endif
