/* gpu/offscreen.h - images of an effect's own that it draws into: a render pass, and a framebuffer for each layer.
 * Internal. */
#ifndef VIRGA_GPU_OFFSCREEN_H
#define VIRGA_GPU_OFFSCREEN_H

#include "gpu/resources.h"

#define VIRGA_OFFSCREEN_MAX_COLORS 4
#define VIRGA_OFFSCREEN_MAX_LAYERS 32

typedef struct virga_offscreen_def {
    const char *name;
    VkExtent2D extent;
    uint32_t layers;
    VkFormat colors[VIRGA_OFFSCREEN_MAX_COLORS]; /* of as many images as are not VK_FORMAT_UNDEFINED */
    VkFormat depth;                              /* VK_FORMAT_UNDEFINED: no depth */
    bool reversed_depth;                         /* greater depth is nearer */
    VkImageUsageFlags color_usage, depth_usage;  /* besides drawing and sampling */
    VkImageLayout layout;                        /* after a draw */
    VkPipelineStageFlags readers;                /* the stages that read the images */
} virga_offscreen_def;

typedef struct virga_offscreen {
    virga_resource resource; /* first */
    virga_image_2d *colors[VIRGA_OFFSCREEN_MAX_COLORS], *depth;
    uint32_t color_count;
    VkExtent2D extent;
    bool reversed_depth;
    VkRenderPass pass;  /* clears first */
    VkRenderPass again; /* keeps what is there; compatible */
    VkFramebuffer framebuffers[VIRGA_OFFSCREEN_MAX_LAYERS];
} virga_offscreen;

virga_result virga_offscreen_create(virga_context *context, const virga_offscreen_def *def,
                                    virga_offscreen **offscreen);
void virga_offscreen_retire(virga_context *context, virga_offscreen **offscreen); /* *offscreen may be NULL */

/* Begins a draw into a layer, cleared: colors to 0, depth to far. Waits for the readers of the last draw. The
 * viewport is the whole layer. */
void virga_offscreen_begin(virga_context *context, VkCommandBuffer cmd, const virga_offscreen *offscreen,
                           uint32_t layer);

/* The same, but the images keep what an earlier draw into the layer has left there. */
void virga_offscreen_resume(virga_context *context, VkCommandBuffer cmd, const virga_offscreen *offscreen,
                            uint32_t layer);

/* Ends it. Readers wait for the draw. */
void virga_offscreen_end(virga_context *context, VkCommandBuffer cmd);

#endif
