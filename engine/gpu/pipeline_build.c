/* gpu/pipeline_build.c - builds one pipeline on the device. */
#include "gpu/pipeline_build.h"

#include "gpu/context.h"
#include "gpu/layouts.h"

#include <string.h>

/* Specialisation constants; a shader may omit some. */
typedef struct constants {
    uint32_t own;         /* constant 0: of the compute shader, or of both shaders of a draw */
    VkBool32 small_views; /* constant 1: see shaders/gpu/texels.glsl */
    VkBool32 encoded;     /* constants 2 and 3: see shaders/gpu/encode.glsl */
    float blend_background;
    VkBool32 for_gpu;    /* constant 4: see shaders/gpu/variants.glsl */
    uint32_t scan_lanes; /* constant 5: see shaders/gpu/long_scan.glsl */
} constants;

static const VkSpecializationMapEntry constant_entries[] = {
    {0, offsetof(constants, own), sizeof((constants *)0)->own},
    {1, offsetof(constants, small_views), sizeof((constants *)0)->small_views},
    {2, offsetof(constants, encoded), sizeof((constants *)0)->encoded},
    {3, offsetof(constants, blend_background), sizeof((constants *)0)->blend_background},
    {4, offsetof(constants, for_gpu), sizeof((constants *)0)->for_gpu},
    {5, offsetof(constants, scan_lanes), sizeof((constants *)0)->scan_lanes}}; /* last: see specialize */

/* Software Vulkan keeps the sizes of workgroups that its shaders declare. */
static VkSpecializationInfo specialize(const constants *values)
{
    const uint32_t count = sizeof constant_entries / sizeof constant_entries[0];
    return (VkSpecializationInfo){values->for_gpu ? count : count - 1, constant_entries, sizeof *values, values};
}

/* Invocations of a workgroup that scans a long list on a GPU. With more, some have too few registers for each. */
static uint32_t scan_lanes(const virga_context *context)
{
    const VkPhysicalDeviceLimits *limits = &context->properties.limits; /* at least 256, see device_check.c */
    return limits->maxComputeWorkGroupInvocations >= 512 && limits->maxComputeWorkGroupSize[0] >= 512 ? 512 : 256;
}

static VkResult module_create(const virga_context *context, const virga_spirv *shader, VkShaderModule *module,
                              const char **call)
{
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = shader->size, .pCode = shader->code};
    *call = "vkCreateShaderModule";
    return context->vk.CreateShaderModule(context->device, &info, NULL, module);
}

static void module_destroy(const virga_context *context, VkShaderModule module)
{
    if (module)
        context->vk.DestroyShaderModule(context->device, module, NULL);
}

VkResult virga_compute_build(const virga_context *context, const virga_compute_def *def, VkPipeline *pipeline,
                             const char **call)
{
    const constants values = {.own = def->constant,
                              .small_views = context->small_views,
                              .for_gpu = !context->for_software,
                              .scan_lanes = scan_lanes(context)};
    const VkSpecializationInfo specialization = specialize(&values);
    VkShaderModule module = VK_NULL_HANDLE;
    VkResult result = module_create(context, def->shader, &module, call);
    if (result == VK_SUCCESS) {
        const VkComputePipelineCreateInfo info = {
            .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
            .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                      .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                      .module = module,
                      .pName = "main",
                      .pSpecializationInfo = &specialization},
            .layout = def->layout->layout};
        *call = "vkCreateComputePipelines";
        result = context->vk.CreateComputePipelines(context->device, context->pipeline_cache, 1, &info, NULL, pipeline);
    }
    module_destroy(context, module);
    return result;
}

/* Everything about a graphics pipeline except its shaders. The structs point to each other, so they are on the
 * caller's stack. */
typedef struct graphics_state {
    VkVertexInputBindingDescription binding;
    VkVertexInputAttributeDescription attribute;
    VkPipelineVertexInputStateCreateInfo input;
    VkPipelineInputAssemblyStateCreateInfo assembly;
    VkPipelineViewportStateCreateInfo viewport;
    VkPipelineRasterizationStateCreateInfo raster;
    VkPipelineMultisampleStateCreateInfo multisample;
    VkPipelineDepthStencilStateCreateInfo depth;
    VkPipelineColorBlendAttachmentState attachments[VIRGA_MAX_ATTACHMENTS];
    VkPipelineColorBlendStateCreateInfo blend;
    VkDynamicState dynamics[3];
    VkPipelineDynamicStateCreateInfo dynamic;
    VkPipelineRenderingCreateInfo rendering;
} graphics_state;

static void describe_blend(const virga_graphics_def *def, graphics_state *state)
{
    memset(state->attachments, 0, sizeof state->attachments);
    state->attachments[0] = (VkPipelineColorBlendAttachmentState){
        .blendEnable = def->blend_premultiplied || def->blend_add,
        .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstColorBlendFactor = def->blend_add ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
        .colorBlendOp = VK_BLEND_OP_ADD,
        .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstAlphaBlendFactor = def->blend_add ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
        .alphaBlendOp = VK_BLEND_OP_ADD,
        .colorWriteMask =
            VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT};
    for (uint32_t i = 1; i < def->color_count && def->add_all; i++)
        state->attachments[i] = state->attachments[0];
    if (def->no_color)
        memset(state->attachments, 0, sizeof state->attachments);
    /* A motion vector replaces the old one where its alpha is 1, and does not where it is 0. Masks are blended over
     * each other. */
    if (def->motion_attachment)
        state->attachments[def->motion_attachment] = (VkPipelineColorBlendAttachmentState){
            .blendEnable = VK_TRUE,
            .srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA,
            .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
            .colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT};
    if (def->reactive_attachment)
        state->attachments[def->reactive_attachment] =
            (VkPipelineColorBlendAttachmentState){.blendEnable = VK_TRUE,
                                                  .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
                                                  .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                                                  .colorWriteMask = VK_COLOR_COMPONENT_R_BIT};
    /* The other attachments have a write mask of zero, which needs the feature independentBlend. */
    state->blend =
        (VkPipelineColorBlendStateCreateInfo){.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                              .attachmentCount = def->color_count,
                                              .pAttachments = state->attachments};
}

static void describe_input(const virga_graphics_def *def, graphics_state *state)
{
    state->binding = (VkVertexInputBindingDescription){0, def->vertex_stride, VK_VERTEX_INPUT_RATE_VERTEX};
    state->attribute = (VkVertexInputAttributeDescription){0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0};
    const uint32_t used = def->vertex_stride ? 1 : 0;
    state->input =
        (VkPipelineVertexInputStateCreateInfo){.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
                                               .vertexBindingDescriptionCount = used,
                                               .pVertexBindingDescriptions = &state->binding,
                                               .vertexAttributeDescriptionCount = used,
                                               .pVertexAttributeDescriptions = &state->attribute};
    state->assembly = (VkPipelineInputAssemblyStateCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = def->lines ? VK_PRIMITIVE_TOPOLOGY_LINE_LIST : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
}

static void describe_raster(const virga_graphics_def *def, graphics_state *state)
{
    state->viewport = (VkPipelineViewportStateCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
    state->raster = (VkPipelineRasterizationStateCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .polygonMode = VK_POLYGON_MODE_FILL,
        .cullMode = (VkCullModeFlags)(def->cull_back ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE),
        .lineWidth = 1};
    state->multisample = (VkPipelineMultisampleStateCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = def->samples ? def->samples : VK_SAMPLE_COUNT_1_BIT};
    state->depth = (VkPipelineDepthStencilStateCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = def->depth_test,
        .depthWriteEnable = def->depth_write,
        .depthCompareOp = def->reversed_depth ? VK_COMPARE_OP_GREATER_OR_EQUAL : VK_COMPARE_OP_LESS_OR_EQUAL};
    state->dynamics[0] = VK_DYNAMIC_STATE_VIEWPORT;
    state->dynamics[1] = VK_DYNAMIC_STATE_SCISSOR;
    state->dynamics[2] = VK_DYNAMIC_STATE_LINE_WIDTH;
    state->dynamic = (VkPipelineDynamicStateCreateInfo){.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                        .dynamicStateCount = def->lines ? 3 : 2,
                                                        .pDynamicStates = state->dynamics};
}

/* The formats for dynamic rendering, if there is no render pass. */
static void describe_rendering(const virga_graphics_def *def, graphics_state *state)
{
    state->rendering = (VkPipelineRenderingCreateInfo){.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                       .viewMask = def->view_mask,
                                                       .colorAttachmentCount = def->color_count,
                                                       .pColorAttachmentFormats = def->color_formats,
                                                       .depthAttachmentFormat = def->depth_format,
                                                       .stencilAttachmentFormat = def->stencil_format};
}

static VkGraphicsPipelineCreateInfo describe(const virga_graphics_def *def, graphics_state *state,
                                             const VkPipelineShaderStageCreateInfo stages[2])
{
    describe_input(def, state);
    describe_raster(def, state);
    describe_blend(def, state);
    describe_rendering(def, state);
    return (VkGraphicsPipelineCreateInfo){.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .pNext = def->render_pass ? NULL : &state->rendering,
                                          .stageCount = 2,
                                          .pStages = stages,
                                          .pVertexInputState = &state->input,
                                          .pInputAssemblyState = &state->assembly,
                                          .pViewportState = &state->viewport,
                                          .pRasterizationState = &state->raster,
                                          .pMultisampleState = &state->multisample,
                                          .pDepthStencilState = &state->depth,
                                          .pColorBlendState = &state->blend,
                                          .pDynamicState = &state->dynamic,
                                          .layout = def->layout->layout,
                                          .renderPass = def->render_pass,
                                          .subpass = def->subpass};
}

VkResult virga_graphics_build(const virga_context *context, const virga_graphics_def *def, VkPipeline *pipeline,
                              const char **call)
{
    VkShaderModule modules[2] = {VK_NULL_HANDLE, VK_NULL_HANDLE};
    VkPipelineShaderStageCreateInfo stages[2];
    const constants values = {.own = def->constant,
                              .small_views = context->small_views,
                              .encoded = def->encoded,
                              .blend_background = def->blend_background,
                              .for_gpu = !context->for_software};
    const VkSpecializationInfo specialization = specialize(&values);
    VkResult result = module_create(context, def->vertex, &modules[0], call);
    if (result == VK_SUCCESS)
        result = module_create(context, def->fragment, &modules[1], call);
    for (int i = 0; i < 2; i++)
        stages[i] =
            (VkPipelineShaderStageCreateInfo){.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                              .stage = i ? VK_SHADER_STAGE_FRAGMENT_BIT : VK_SHADER_STAGE_VERTEX_BIT,
                                              .module = modules[i],
                                              .pName = "main",
                                              .pSpecializationInfo = &specialization};
    if (result == VK_SUCCESS) {
        graphics_state state;
        const VkGraphicsPipelineCreateInfo info = describe(def, &state, stages);
        *call = "vkCreateGraphicsPipelines";
        result =
            context->vk.CreateGraphicsPipelines(context->device, context->pipeline_cache, 1, &info, NULL, pipeline);
    }
    for (int i = 0; i < 2; i++)
        module_destroy(context, modules[i]);
    return result;
}
