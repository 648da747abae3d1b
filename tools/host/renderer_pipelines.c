/* renderer_pipelines.c - layouts and pipelines of the plate. */
#include <stddef.h>
#include <string.h>

#include "renderer_internal.h"

#include "cutout_frag.spv.h"
#include "scene_frag.spv.h"
#include "scene_frag_mirror.spv.h"
#include "scene_vert.spv.h"
#include "scene_vert_mirror.spv.h"
#include "sky_frag.spv.h"
#include "sky_frag_mirror.spv.h"
#include "sky_vert.spv.h"

static bool create_layouts(host_renderer *r, char *error, size_t error_size)
{
    const VkDescriptorSetLayoutBinding frame[] = {
        {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
        {2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
        {3, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
        {4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
        {5, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
        {6, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
        {7, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
    };
    VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 8,
        .pBindings = frame,
    };
    HOST_TRY(vkCreateDescriptorSetLayout(r->device->device, &info, NULL, &r->frame_layout));
    const VkDescriptorSetLayoutBinding material[] = {
        {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
    };
    info.bindingCount = 2;
    info.pBindings = material;
    HOST_TRY(vkCreateDescriptorSetLayout(r->device->device, &info, NULL, &r->material_layout));

    const VkDescriptorSetLayout sets[] = {r->frame_layout, r->material_layout};
    VkPushConstantRange surface = {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(struct host_surface_gpu)};
    VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 2,
        .pSetLayouts = sets,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &surface,
    };
    HOST_TRY(vkCreatePipelineLayout(r->device->device, &layout, NULL, &r->layout));
    return true;
}

/* ---- one pipeline ------------------------------------------------------------------------------------------- */

enum { SHADER_SCENE_VERT, SHADER_CUTOUT, SHADER_SCENE_FRAG, SHADER_SKY_VERT, SHADER_SKY_FRAG, SHADER_COUNT, NO_SHADER };

static const struct {
    int vertex, fragment;
    bool write_depth, write_color, blend;
    VkCompareOp compare;
} recipes[HOST_PIPELINE_COUNT] = {
    [HOST_PIPELINE_DEPTH] = {SHADER_SCENE_VERT, NO_SHADER, true, false, false, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_CUTOUT] = {SHADER_SCENE_VERT, SHADER_CUTOUT, true, false, false, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_SHADE] = {SHADER_SCENE_VERT, SHADER_SCENE_FRAG, false, true, false, VK_COMPARE_OP_EQUAL},
    [HOST_PIPELINE_GLASS] = {SHADER_SCENE_VERT, SHADER_SCENE_FRAG, false, true, true, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_SKY] = {SHADER_SKY_VERT, SHADER_SKY_FRAG, false, true, false, VK_COMPARE_OP_LESS_OR_EQUAL},
};

/* A set of all pipelines: the plate's, or the mirror's. */
typedef struct pipeline_set {
    VkRenderPass pass;
    uint32_t colors;  /* attachments of the pass */
    bool mirror;
    VkShaderModule modules[SHADER_COUNT];
    VkPipeline (*pipelines)[2];
} pipeline_set;

/* Glass changes the colour alone: normal, velocity, id and depth stay those of what is behind it. */
static void fill_blend(host_pipeline kind, bool mirror, VkPipelineColorBlendAttachmentState states[HOST_PLATE_COLORS])
{
    const VkColorComponentFlags all =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    memset(states, 0, HOST_PLATE_COLORS * sizeof *states);
    for (int i = 0; i < HOST_PLATE_COLORS; i++)
        if (recipes[kind].write_color && (i == 0 || !recipes[kind].blend))
            states[i].colorWriteMask = all;
    if (recipes[kind].blend) {
        states[0].blendEnable = VK_TRUE;
        states[0].srcColorBlendFactor = states[0].srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        states[0].dstColorBlendFactor = states[0].dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        if (mirror) { /* whose alpha is a distance */
            states[0].srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
            states[0].dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        }
    }
}

static VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, VkShaderModule module)
{
    return (VkPipelineShaderStageCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = which,
        .module = module,
        .pName = "main",
    };
}

static bool create_pipeline(host_renderer *r, const pipeline_set *set, host_pipeline kind, bool two_sided, char *error,
                            size_t error_size)
{
    bool depth_only = recipes[kind].fragment == NO_SHADER;
    VkPipelineShaderStageCreateInfo stages[2] = {stage(VK_SHADER_STAGE_VERTEX_BIT, set->modules[recipes[kind].vertex])};
    if (!depth_only)
        stages[1] = stage(VK_SHADER_STAGE_FRAGMENT_BIT, set->modules[recipes[kind].fragment]);

    const VkVertexInputBindingDescription binding = {0, sizeof(host_vertex), VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription attributes[] = {
        {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(host_vertex, position)},
        {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(host_vertex, normal)},
        {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(host_vertex, uv)},
    };
    VkPipelineVertexInputStateCreateInfo vertex = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = kind == HOST_PIPELINE_SKY ? 0 : 1,
        .pVertexBindingDescriptions = &binding,
        .vertexAttributeDescriptionCount = kind == HOST_PIPELINE_SKY ? 0 : 3,
        .pVertexAttributeDescriptions = attributes,
    };
    VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1,
    };
    VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .cullMode = two_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT,
        .frontFace = set->mirror ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE,
        .lineWidth = 1.0f,
    };
    VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT,
    };
    VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = recipes[kind].write_depth,
        .depthCompareOp = recipes[kind].compare,
    };
    VkPipelineColorBlendAttachmentState attachments[HOST_PLATE_COLORS];
    fill_blend(kind, set->mirror, attachments);
    VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = set->colors,
        .pAttachments = attachments,
    };
    const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = dynamic_states,
    };
    VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .stageCount = depth_only ? 1 : 2,
        .pStages = stages,
        .pVertexInputState = &vertex,
        .pInputAssemblyState = &assembly,
        .pViewportState = &viewport,
        .pRasterizationState = &raster,
        .pMultisampleState = &samples,
        .pDepthStencilState = &depth,
        .pColorBlendState = &blend,
        .pDynamicState = &dynamic,
        .layout = r->layout,
        .renderPass = set->pass,
    };
    HOST_TRY(vkCreateGraphicsPipelines(r->device->device, VK_NULL_HANDLE, 1, &info, NULL,
                                       &set->pipelines[kind][two_sided]));
    return true;
}

/* ---- all of them -------------------------------------------------------------------------------------------- */

typedef struct code {
    const uint32_t *words;
    size_t size;
} code;

#define CODE(name) {name##_spv, sizeof name##_spv}

static bool create_modules(host_renderer *r, pipeline_set *set, char *error, size_t error_size)
{
    static const code sources[2][SHADER_COUNT] = {
        {
            [SHADER_SCENE_VERT] = CODE(scene_vert),
            [SHADER_CUTOUT] = CODE(cutout_frag),
            [SHADER_SCENE_FRAG] = CODE(scene_frag),
            [SHADER_SKY_VERT] = CODE(sky_vert),
            [SHADER_SKY_FRAG] = CODE(sky_frag),
        },
        {
            [SHADER_SCENE_VERT] = CODE(scene_vert_mirror),
            [SHADER_CUTOUT] = CODE(cutout_frag),
            [SHADER_SCENE_FRAG] = CODE(scene_frag_mirror),
            [SHADER_SKY_VERT] = CODE(sky_vert),
            [SHADER_SKY_FRAG] = CODE(sky_frag_mirror),
        },
    };
    for (int i = 0; i < SHADER_COUNT; i++) {
        VkShaderModuleCreateInfo info = {
            .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
            .codeSize = sources[set->mirror][i].size,
            .pCode = sources[set->mirror][i].words,
        };
        HOST_TRY(vkCreateShaderModule(r->device->device, &info, NULL, &set->modules[i]));
    }
    return true;
}

static bool build(host_renderer *r, pipeline_set *set, char *error, size_t error_size)
{
    bool ok = create_modules(r, set, error, error_size);
    for (int kind = 0; ok && kind < HOST_PIPELINE_COUNT; kind++) {
        if (kind == HOST_PIPELINE_GLASS && !r->device->independent_blend)
            continue; /* meshes have no glass then */
        for (int two_sided = 0; ok && two_sided < 2; two_sided++)
            ok = create_pipeline(r, set, (host_pipeline)kind, two_sided, error, error_size);
    }
    for (int i = 0; i < SHADER_COUNT; i++)
        vkDestroyShaderModule(r->device->device, set->modules[i], NULL);
    return ok;
}

bool host_renderer_build_pipelines(host_renderer *r, VkRenderPass pass, char *error, size_t error_size)
{
    pipeline_set set = {.pass = pass, .colors = HOST_PLATE_COLORS, .pipelines = r->pipelines};
    return create_layouts(r, error, error_size) && build(r, &set, error, error_size);
}

bool host_renderer_build_mirror(host_renderer *r, char *error, size_t error_size)
{
    pipeline_set set = {.pass = r->mirror.pass, .colors = 1, .mirror = true, .pipelines = r->mirror_pipelines};
    return build(r, &set, error, error_size);
}
