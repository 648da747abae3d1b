/* stage_passes.c - render passes, layouts, pipelines and samplers: what does not depend on the picture's size. */
#include "stage_internal.h"

#include "descriptors.h"
#include "passes.h"
#include "pipeline.h"

#include "full_vert.spv.h"
#include "show_frag.spv.h"
#include "sky_frag.spv.h"
#include "world_frag.spv.h"
#include "world_vert.spv.h"

#include <stddef.h>

/* ---- passes */

typedef struct pass_def {
    VkFormat color;
    bool depth, load; /* there is depth; what is there is drawn over */
    VkImageLayout color_before, color_after;
} pass_def;

/* What came before a pass and what follows it: broad stages, which a small renderer can afford. */
static bool create_pass(stage *s, const pass_def *def, VkRenderPass *pass, char *error, size_t error_size)
{
    VkAttachmentDescription attachments[2] = {
        host_attachment(def->color, def->color_after),
        host_attachment(VK_FORMAT_D32_SFLOAT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL),
    };
    attachments[0].initialLayout = def->color_before;
    if (def->load)
        attachments[0].loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    const VkPipelineStageFlags shading = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | HOST_DEPTH_STAGES;
    const VkPipelineStageFlags all =
        drawing | shading | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkAccessFlags used = HOST_DRAW_WRITES | HOST_DRAW_READS | VK_ACCESS_SHADER_READ_BIT;
    const host_pass_def made = {
        .attachments = attachments,
        .color_count = 1,
        .depth = def->depth,
        .before = {all, HOST_DRAW_WRITES | VK_ACCESS_TRANSFER_WRITE_BIT, drawing | shading, used},
        .after = {drawing, HOST_DRAW_WRITES, all, used | VK_ACCESS_TRANSFER_READ_BIT},
    };
    return host_pass_create(s->device, &made, pass, error, error_size);
}

static bool create_passes(stage *s, char *error, size_t error_size)
{
    const VkFormat radiance = VK_FORMAT_R16G16B16A16_SFLOAT;
    const VkImageLayout none = VK_IMAGE_LAYOUT_UNDEFINED, copied = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    const pass_def world = {radiance, true, false, none, copied};
    const pass_def over = {radiance, false, true, copied, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    const pass_def shown = {s->show_format, false, false, none, s->window ? VK_IMAGE_LAYOUT_PRESENT_SRC_KHR : copied};
    return create_pass(s, &world, &s->world_pass, error, error_size) &&
           create_pass(s, &over, &s->over_pass, error, error_size) &&
           create_pass(s, &shown, &s->show_pass, error, error_size);
}

/* ---- layouts */

#define IMAGE VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER

static const VkDescriptorType types[8] = {
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE};

static bool create_layouts(stage *s, char *error, size_t error_size)
{
    const VkShaderStageFlags drawing = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const host_set_shape frame = {types, 8, drawing}, material = {types + 1, 2, drawing},
                         show = {types + 1, 1, drawing};
    if (!host_set_layout_create(s->device, &frame, &s->frame_layout, error, error_size) ||
        !host_set_layout_create(s->device, &material, &s->material_layout, error, error_size) ||
        !host_set_layout_create(s->device, &show, &s->show_layout, error, error_size))
        return false;
    const VkDescriptorSetLayout world[2] = {s->frame_layout, s->material_layout};
    return host_pipeline_layout_create(s->device, world, 2, drawing, sizeof(struct drive_surface_gpu), &s->world_layout,
                                       error, error_size) &&
           host_pipeline_layout_create(s->device, &s->show_layout, 1, 0, 0, &s->show_pipeline_layout, error,
                                       error_size);
}

static bool create_sets(stage *s, char *error, size_t error_size)
{
    const VkDescriptorPoolSize sizes[2] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, HOST_FRAMES},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * STAGE_SETS + 6 * HOST_FRAMES + 1},
    };
    VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = STAGE_SETS + HOST_FRAMES + 1,
        .poolSizeCount = 2,
        .pPoolSizes = sizes,
    };
    HOST_TRY(vkCreateDescriptorPool(s->device->device, &pool, NULL, &s->pool));
    return host_sets_allocate(s->device, s->pool, s->frame_layout, HOST_FRAMES, s->frame_sets, error, error_size) &&
           host_sets_allocate(s->device, s->pool, s->show_layout, 1, &s->show_set, error, error_size);
}

static bool create_samplers(stage *s, char *error, size_t error_size)
{
    return host_sampler_create(s->device, HOST_SAMPLE_NEAREST, &s->nearest, error, error_size) &&
           host_sampler_create(s->device, HOST_SAMPLE_LINEAR, &s->smooth, error, error_size) &&
           host_sampler_create(s->device, HOST_SAMPLE_TEXTURE, &s->repeat, error, error_size);
}

/* ---- pipelines */

typedef struct pipeline_def {
    const uint32_t *vertex, *fragment;
    size_t vertex_size, fragment_size;
    bool mesh;  /* reads vertices, writes depth; else one triangle that covers all */
    bool depth; /* the pass has depth */
    bool glass; /* what is behind shines through, times the blend constants */
    VkPipelineLayout layout;
    VkRenderPass pass;
} pipeline_def;

static bool create_module(stage *s, const uint32_t *code, size_t size, VkShaderModule *module, char *error,
                          size_t error_size)
{
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
    HOST_TRY(vkCreateShaderModule(s->device->device, &info, NULL, module));
    return true;
}

/* The same for all. */
static const VkPipelineInputAssemblyStateCreateInfo assembly = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
    .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
static const VkPipelineViewportStateCreateInfo viewport = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
static const VkPipelineRasterizationStateCreateInfo raster = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
static const VkPipelineMultisampleStateCreateInfo samples = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO, .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
static const VkDynamicState states[3] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                         VK_DYNAMIC_STATE_BLEND_CONSTANTS};

/* Alpha holds a distance and is not blended. */
static const VkPipelineColorBlendAttachmentState plain = {.colorWriteMask = 0xf};
static const VkPipelineColorBlendAttachmentState through = {
    .blendEnable = VK_TRUE,
    .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
    .dstColorBlendFactor = VK_BLEND_FACTOR_CONSTANT_COLOR,
    .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
    .dstAlphaBlendFactor = VK_BLEND_FACTOR_ZERO,
    .colorWriteMask = 0xf,
};

static VkResult build(stage *s, const pipeline_def *def, const VkShaderModule modules[2], VkPipeline *pipeline)
{
    const VkPipelineShaderStageCreateInfo stages[2] = {{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                        .stage = VK_SHADER_STAGE_VERTEX_BIT,
                                                        .module = modules[0],
                                                        .pName = "main"},
                                                       {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                        .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
                                                        .module = modules[1],
                                                        .pName = "main"}};
    const VkVertexInputBindingDescription stride = {0, sizeof(host_vertex), VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription attributes[3] = {
        {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(host_vertex, position)},
        {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(host_vertex, normal)},
        {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(host_vertex, uv)}};
    const VkPipelineVertexInputStateCreateInfo input = {.sType =
                                                            VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
                                                        .vertexBindingDescriptionCount = def->mesh,
                                                        .pVertexBindingDescriptions = &stride,
                                                        .vertexAttributeDescriptionCount = def->mesh ? 3 : 0,
                                                        .pVertexAttributeDescriptions = attributes};
    const VkPipelineDepthStencilStateCreateInfo depth = {.sType =
                                                             VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                                                         .depthTestEnable = def->mesh,
                                                         .depthWriteEnable = def->mesh,
                                                         .depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL};
    const VkPipelineColorBlendStateCreateInfo blend = {.sType =
                                                           VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                       .attachmentCount = 1,
                                                       .pAttachments = def->glass ? &through : &plain};
    const VkPipelineDynamicStateCreateInfo dynamic = {.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                      .dynamicStateCount = def->glass ? 3 : 2,
                                                      .pDynamicStates = states};
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .stageCount = 2,
                                         .pStages = stages,
                                         .pVertexInputState = &input,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &viewport,
                                         .pRasterizationState = &raster,
                                         .pMultisampleState = &samples,
                                         .pDepthStencilState = def->depth ? &depth : NULL,
                                         .pColorBlendState = &blend,
                                         .pDynamicState = &dynamic,
                                         .layout = def->layout,
                                         .renderPass = def->pass};
    return vkCreateGraphicsPipelines(s->device->device, VK_NULL_HANDLE, 1, &info, NULL, pipeline);
}

static bool create_pipeline(stage *s, const pipeline_def *def, VkPipeline *pipeline, char *error, size_t error_size)
{
    VkShaderModule modules[2] = {VK_NULL_HANDLE, VK_NULL_HANDLE};
    const bool made = create_module(s, def->vertex, def->vertex_size, &modules[0], error, error_size) &&
                      create_module(s, def->fragment, def->fragment_size, &modules[1], error, error_size);
    const VkResult result = made ? build(s, def, modules, pipeline) : VK_SUCCESS;
    for (int i = 0; i < 2; i++)
        vkDestroyShaderModule(s->device->device, modules[i], NULL);
    if (result != VK_SUCCESS)
        return host_fail(error, error_size, "vkCreateGraphicsPipelines gave %s", host_result_name(result));
    return made;
}

static bool create_pipelines(stage *s, char *error, size_t error_size)
{
    const pipeline_def world = {.vertex = world_vert_spv,
                                .fragment = world_frag_spv,
                                .vertex_size = sizeof world_vert_spv,
                                .fragment_size = sizeof world_frag_spv,
                                .mesh = true,
                                .depth = true,
                                .layout = s->world_layout,
                                .pass = s->world_pass};
    const pipeline_def sky = {.vertex = full_vert_spv,
                              .fragment = sky_frag_spv,
                              .vertex_size = sizeof full_vert_spv,
                              .fragment_size = sizeof sky_frag_spv,
                              .depth = true,
                              .layout = s->world_layout,
                              .pass = s->world_pass};
    const pipeline_def shown = {.vertex = full_vert_spv,
                                .fragment = show_frag_spv,
                                .vertex_size = sizeof full_vert_spv,
                                .fragment_size = sizeof show_frag_spv,
                                .layout = s->show_pipeline_layout,
                                .pass = s->show_pass};
    pipeline_def glass = world;
    glass.glass = true;
    return create_pipeline(s, &world, &s->world_pipeline, error, error_size) &&
           create_pipeline(s, &glass, &s->glass_pipeline, error, error_size) &&
           create_pipeline(s, &sky, &s->sky_pipeline, error, error_size) &&
           create_pipeline(s, &shown, &s->show_pipeline, error, error_size);
}

/* ---- all of it */

static bool create_data(stage *s, char *error, size_t error_size)
{
    const uint8_t texel[4] = {255, 255, 255, 255};
    const host_image_def white = {.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {1, 1, 1}, .name = "drive white"};
    for (uint32_t i = 0; i < HOST_FRAMES; i++)
        if (!host_buffer_create(s->device, sizeof(struct drive_frame_gpu), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                HOST_BUFFER_UPLOAD, "drive frame", &s->numbers[i], error, error_size))
            return false;
    return host_image_create_with(s->device, &white, texel, sizeof texel, 4, &s->white, error, error_size);
}

static bool create_acquired(stage *s, char *error, size_t error_size)
{
    VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    for (uint32_t i = 0; i < HOST_FRAMES; i++)
        HOST_TRY(vkCreateSemaphore(s->device->device, &semaphore, NULL, &s->acquired[i]));
    return true;
}

bool stage_create(stage *s, host_device *device, struct GLFWwindow *window, VkSurfaceKHR surface, uint32_t width,
                  uint32_t height, char *error, size_t error_size)
{
    bool resized;
    *s = (stage){.device = device, .window = window, .surface = surface, .width = width, .height = height};
    return stage_images_choose(s, error, error_size) && create_passes(s, error, error_size) &&
           create_layouts(s, error, error_size) && create_sets(s, error, error_size) &&
           create_samplers(s, error, error_size) && create_pipelines(s, error, error_size) &&
           create_data(s, error, error_size) && create_acquired(s, error, error_size) &&
           stage_images_again(s, &resized, error, error_size);
}

void stage_destroy(stage *s)
{
    if (!s->device || !s->device->device)
        return;
    const VkDevice device = s->device->device;
    vkDeviceWaitIdle(device);
    stage_images_destroy(s);
    for (uint32_t i = 0; i < HOST_FRAMES; i++) {
        vkDestroySemaphore(device, s->acquired[i], NULL);
        host_buffer_destroy(s->device, &s->numbers[i]);
    }
    host_image_destroy(s->device, &s->white);
    const VkPipeline pipelines[] = {s->world_pipeline, s->sky_pipeline, s->show_pipeline};
    const VkPipelineLayout layouts[] = {s->world_layout, s->show_pipeline_layout};
    const VkDescriptorSetLayout sets[] = {s->frame_layout, s->material_layout, s->show_layout};
    const VkRenderPass passes[] = {s->world_pass, s->over_pass, s->show_pass};
    const VkSampler samplers[] = {s->smooth, s->nearest, s->repeat};
    vkDestroyPipeline(device, s->glass_pipeline, NULL);
    for (int i = 0; i < 3; i++) {
        vkDestroyPipeline(device, pipelines[i], NULL);
        vkDestroyDescriptorSetLayout(device, sets[i], NULL);
        vkDestroyRenderPass(device, passes[i], NULL);
        vkDestroySampler(device, samplers[i], NULL);
    }
    vkDestroyPipelineLayout(device, layouts[0], NULL);
    vkDestroyPipelineLayout(device, layouts[1], NULL);
    vkDestroyDescriptorPool(device, s->pool, NULL);
}
