/* pipeline.c - see pipeline.h. */
#include "pipeline.h"

#include "mesh.h"

#include <stddef.h>

#include "fullscreen_vert.spv.h"

#define ALL_CHANNELS \
    (VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT)

const VkPipelineColorBlendAttachmentState host_blend_replace = {.colorWriteMask = ALL_CHANNELS};

const VkPipelineColorBlendAttachmentState host_blend_over = {.blendEnable = VK_TRUE,
                                                             .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
                                                             .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                                                             .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                                                             .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                                                             .colorWriteMask = ALL_CHANNELS};

static const VkVertexInputBindingDescription vertices = {0, sizeof(host_vertex), VK_VERTEX_INPUT_RATE_VERTEX};
static const VkVertexInputAttributeDescription attributes[] = {
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(host_vertex, position)},
    {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(host_vertex, uv)},
    {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(host_vertex, normal)},
};

/* A stage with its own module, which the caller destroys. Without code there is no module. */
static bool make_stage(host_device *device, host_code code, VkShaderStageFlagBits which,
                       VkPipelineShaderStageCreateInfo *stage, char *error, size_t error_size)
{
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = code.size, .pCode = code.spirv};
    *stage = (VkPipelineShaderStageCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, .stage = which, .pName = "main"};
    if (code.size)
        HOST_TRY(vkCreateShaderModule(device->device, &info, NULL, &stage->module));
    return true;
}

static VkResult create(host_device *device, const host_graphics_def *def, const VkPipelineShaderStageCreateInfo *stages,
                       VkPipeline *pipeline)
{
    static const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                            VK_DYNAMIC_STATE_BLEND_CONSTANTS};
    const VkPipelineVertexInputStateCreateInfo input = {.sType =
                                                            VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
                                                        .vertexBindingDescriptionCount = def->attribute_count ? 1 : 0,
                                                        .pVertexBindingDescriptions = &vertices,
                                                        .vertexAttributeDescriptionCount = def->attribute_count,
                                                        .pVertexAttributeDescriptions = attributes};
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
    const VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .cullMode = def->cull,
        .frontFace = def->front,
        .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples = {.sType =
                                                              VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                          .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth = {.sType =
                                                             VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                                                         .depthTestEnable = def->depth_test,
                                                         .depthWriteEnable = def->depth_write,
                                                         .depthCompareOp = def->compare};
    const VkPipelineColorBlendStateCreateInfo blend = {.sType =
                                                           VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                       .attachmentCount = def->color_count,
                                                       .pAttachments = def->colors};
    const VkPipelineDynamicStateCreateInfo dynamic = {.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                      .dynamicStateCount = def->blend_constants ? 3 : 2,
                                                      .pDynamicStates = states};
    const VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                               .stageCount = def->fragment.size ? 2 : 1,
                                               .pStages = stages,
                                               .pVertexInputState = &input,
                                               .pInputAssemblyState = &assembly,
                                               .pViewportState = &viewport,
                                               .pRasterizationState = &raster,
                                               .pMultisampleState = &samples,
                                               .pDepthStencilState = &depth,
                                               .pColorBlendState = &blend,
                                               .pDynamicState = &dynamic,
                                               .layout = def->layout,
                                               .renderPass = def->pass};
    return vkCreateGraphicsPipelines(device->device, VK_NULL_HANDLE, 1, &info, NULL, pipeline);
}

bool host_graphics_create(host_device *device, const host_graphics_def *def, VkPipeline *pipeline, char *error,
                          size_t error_size)
{
    VkPipelineShaderStageCreateInfo stages[2] = {{.module = VK_NULL_HANDLE}};
    bool good = make_stage(device, def->vertex, VK_SHADER_STAGE_VERTEX_BIT, &stages[0], error, error_size) &&
                make_stage(device, def->fragment, VK_SHADER_STAGE_FRAGMENT_BIT, &stages[1], error, error_size);
    const VkResult made = good ? create(device, def, stages, pipeline) : VK_SUCCESS;
    for (int i = 0; i < 2; i++)
        vkDestroyShaderModule(device->device, stages[i].module, NULL);
    HOST_TRY(made);
    return good;
}

host_code host_fullscreen_vertex(void)
{
    return HOST_CODE(fullscreen_vert);
}

bool host_fullscreen_create(host_device *device, host_code vertex, host_code fragment, VkPipelineLayout layout,
                            VkRenderPass pass, VkPipeline *pipeline, char *error, size_t error_size)
{
    const host_graphics_def def = {.vertex = vertex,
                                   .fragment = fragment,
                                   .layout = layout,
                                   .pass = pass,
                                   .colors = &host_blend_replace,
                                   .color_count = 1};
    return host_graphics_create(device, &def, pipeline, error, error_size);
}

bool host_compute_create(host_device *device, host_code code, VkPipelineLayout layout, VkPipeline *pipeline,
                         char *error, size_t error_size)
{
    VkComputePipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO, .layout = layout};
    if (!make_stage(device, code, VK_SHADER_STAGE_COMPUTE_BIT, &info.stage, error, error_size))
        return false;
    const VkResult made = vkCreateComputePipelines(device->device, VK_NULL_HANDLE, 1, &info, NULL, pipeline);
    vkDestroyShaderModule(device->device, info.stage.module, NULL);
    HOST_TRY(made);
    return true;
}

void host_set_area(VkCommandBuffer cmd, uint32_t width, uint32_t height)
{
    const VkViewport viewport = {0, 0, (float)width, (float)height, 0, 1};
    const VkRect2D scissor = {{0, 0}, {width, height}};
    vkCmdSetViewport(cmd, 0, 1, &viewport);
    vkCmdSetScissor(cmd, 0, 1, &scissor);
}
