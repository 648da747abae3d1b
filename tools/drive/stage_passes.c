/* stage_passes.c - render passes, layouts, pipelines and samplers: what does not depend on the picture's size. */
#include "stage_internal.h"

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

/* What came before a pass and what follows it, as wide as such a small renderer can afford. */
static bool create_pass(stage *s, const pass_def *def, VkRenderPass *pass, char *error, size_t error_size)
{
    const VkImageLayout kept = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    const VkAttachmentLoadOp load = def->load ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
    const VkAttachmentDescription attachments[2] = {
        {.format = def->color,
         .samples = VK_SAMPLE_COUNT_1_BIT,
         .loadOp = load,
         .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
         .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
         .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
         .initialLayout = def->color_before,
         .finalLayout = def->color_after},
        {.format = VK_FORMAT_D32_SFLOAT,
         .samples = VK_SAMPLE_COUNT_1_BIT,
         .loadOp = load,
         .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
         .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
         .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
         .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
         .finalLayout = kept},
    };
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {
        .colorAttachmentCount = 1, .pColorAttachments = &color, .pDepthStencilAttachment = def->depth ? &depth : NULL};
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                         VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                         VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    const VkPipelineStageFlags using =
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkAccessFlags written = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const VkAccessFlags read = VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    const VkSubpassDependency around[2] = {
        {VK_SUBPASS_EXTERNAL, 0, drawing | using, drawing | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
         written | VK_ACCESS_TRANSFER_WRITE_BIT, written | read | VK_ACCESS_SHADER_READ_BIT, 0},
        {0, VK_SUBPASS_EXTERNAL, drawing, drawing | using, written,
         written | read | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT, 0},
    };
    VkRenderPassCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = def->depth ? 2 : 1,
        .pAttachments = attachments,
        .subpassCount = 1,
        .pSubpasses = &subpass,
        .dependencyCount = 2,
        .pDependencies = around,
    };
    HOST_TRY(vkCreateRenderPass(s->device->device, &info, NULL, pass));
    return true;
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

static bool create_set_layout(stage *s, uint32_t count, bool numbers, VkDescriptorSetLayout *layout, char *error,
                              size_t error_size)
{
    VkDescriptorSetLayoutBinding bindings[8];
    for (uint32_t i = 0; i < count; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType =
                numbers && i == 0 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
        };
    VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = count, .pBindings = bindings};
    HOST_TRY(vkCreateDescriptorSetLayout(s->device->device, &info, NULL, layout));
    return true;
}

static bool create_layouts(stage *s, char *error, size_t error_size)
{
    if (!create_set_layout(s, 7, true, &s->frame_layout, error, error_size) ||
        !create_set_layout(s, 2, false, &s->material_layout, error, error_size) ||
        !create_set_layout(s, 1, false, &s->show_layout, error, error_size))
        return false;
    const VkDescriptorSetLayout world[2] = {s->frame_layout, s->material_layout};
    const VkPushConstantRange surface = {VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                         sizeof(struct drive_surface_gpu)};
    VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 2,
        .pSetLayouts = world,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &surface,
    };
    HOST_TRY(vkCreatePipelineLayout(s->device->device, &info, NULL, &s->world_layout));
    info = (VkPipelineLayoutCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, .setLayoutCount = 1, .pSetLayouts = &s->show_layout};
    HOST_TRY(vkCreatePipelineLayout(s->device->device, &info, NULL, &s->show_pipeline_layout));
    return true;
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
    for (uint32_t i = 0; i <= HOST_FRAMES; i++) {
        VkDescriptorSetAllocateInfo allocate = {
            .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
            .descriptorPool = s->pool,
            .descriptorSetCount = 1,
            .pSetLayouts = i < HOST_FRAMES ? &s->frame_layout : &s->show_layout,
        };
        HOST_TRY(
            vkAllocateDescriptorSets(s->device->device, &allocate, i < HOST_FRAMES ? &s->frame_sets[i] : &s->show_set));
    }
    return true;
}

static bool create_samplers(stage *s, char *error, size_t error_size)
{
    VkSamplerCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .maxLod = VK_LOD_CLAMP_NONE,
    };
    HOST_TRY(vkCreateSampler(s->device->device, &info, NULL, &s->nearest));
    info.magFilter = info.minFilter = VK_FILTER_LINEAR;
    HOST_TRY(vkCreateSampler(s->device->device, &info, NULL, &s->smooth));
    info.addressModeU = info.addressModeV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    info.anisotropyEnable = s->device->anisotropy > 1;
    info.maxAnisotropy = s->device->anisotropy;
    HOST_TRY(vkCreateSampler(s->device->device, &info, NULL, &s->repeat));
    return true;
}

/* ---- pipelines */

typedef struct pipeline_def {
    const uint32_t *vertex, *fragment;
    size_t vertex_size, fragment_size;
    bool mesh;  /* reads vertices, writes depth; else one triangle that covers all */
    bool depth; /* the pass has depth */
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
static const VkDynamicState states[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
static const VkPipelineDynamicStateCreateInfo dynamic = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, .dynamicStateCount = 2, .pDynamicStates = states};

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
    const VkPipelineColorBlendAttachmentState plain = {.colorWriteMask = 0xf};
    const VkPipelineColorBlendStateCreateInfo blend = {.sType =
                                                           VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                       .attachmentCount = 1,
                                                       .pAttachments = &plain};
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
    const pipeline_def world = {world_vert_spv, world_frag_spv, sizeof world_vert_spv, sizeof world_frag_spv,
                                true,           true,           s->world_layout,       s->world_pass};
    const pipeline_def sky = {full_vert_spv, sky_frag_spv, sizeof full_vert_spv, sizeof sky_frag_spv,
                              false,         true,         s->world_layout,      s->world_pass};
    const pipeline_def shown = {full_vert_spv, show_frag_spv, sizeof full_vert_spv,    sizeof show_frag_spv,
                                false,         false,         s->show_pipeline_layout, s->show_pass};
    return create_pipeline(s, &world, &s->world_pipeline, error, error_size) &&
           create_pipeline(s, &sky, &s->sky_pipeline, error, error_size) &&
           create_pipeline(s, &shown, &s->show_pipeline, error, error_size);
}

/* ---- all of it */

static bool create_data(stage *s, char *error, size_t error_size)
{
    const uint8_t texel[4] = {255, 255, 255, 255};
    const host_image_def white = {.format = VK_FORMAT_R8G8B8A8_UNORM,
                                  .extent = {1, 1, 1},
                                  .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                  .name = "drive white"};
    for (uint32_t i = 0; i < HOST_FRAMES; i++)
        if (!host_buffer_create(s->device, sizeof(struct drive_frame_gpu), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                HOST_BUFFER_UPLOAD, "drive frame", &s->numbers[i], error, error_size))
            return false;
    return host_image_create(s->device, &white, &s->white, error, error_size) &&
           host_image_upload(s->device, &s->white, texel, sizeof texel, 4, error, error_size);
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
