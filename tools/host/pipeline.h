/* pipeline.h - pipelines for triangles with one sample. Viewport and scissor are dynamic. */
#ifndef VIRGA_HOST_PIPELINE_H
#define VIRGA_HOST_PIPELINE_H

#include "device.h"

/* A shader as the build embeds it. */
typedef struct host_code {
    const uint32_t *spirv;
    size_t size; /* bytes; 0: no shader */
} host_code;

#define HOST_CODE(name) ((host_code){name##_spv, sizeof name##_spv})

typedef struct host_graphics_def {
    host_code vertex, fragment; /* without a fragment shader only depth is written */
    VkPipelineLayout layout;
    VkRenderPass pass;        /* its first subpass */
    uint32_t attribute_count; /* of host_vertex: position at location 0, uv at 2, normal at 1. 0: no vertex buffer */
    VkCullModeFlags cull;
    VkFrontFace front;
    bool depth_test, depth_write;
    VkCompareOp compare; /* (depth_test) */
    const VkPipelineColorBlendAttachmentState *colors;
    uint32_t color_count;
    bool blend_constants; /* dynamic */
} host_graphics_def;

/* Overwrite; blend with premultiplied alpha. */
extern const VkPipelineColorBlendAttachmentState host_blend_replace, host_blend_over;

bool host_graphics_create(host_device *device, const host_graphics_def *def, VkPipeline *pipeline, char *error,
                          size_t error_size);

/* A shader that makes one triangle over a whole picture, at the far end, from three vertices. */
host_code host_fullscreen_vertex(void);

/* Triangles without a vertex buffer, into one color attachment, without depth, blending or culling. */
bool host_fullscreen_create(host_device *device, host_code vertex, host_code fragment, VkPipelineLayout layout,
                            VkRenderPass pass, VkPipeline *pipeline, char *error, size_t error_size);

bool host_compute_create(host_device *device, host_code code, VkPipelineLayout layout, VkPipeline *pipeline,
                         char *error, size_t error_size);

/* Sets viewport and scissor to a whole attachment, in texels. */
void host_set_area(VkCommandBuffer cmd, uint32_t width, uint32_t height);

#endif
