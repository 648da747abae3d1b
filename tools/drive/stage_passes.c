/* stage_passes.c - render passes, descriptors, pipelines and samplers: what does not depend on the picture's size. */
#include "stage_internal.h"

#include "pipeline.h"

#include "full_vert.spv.h"
#include "shelter_vert.spv.h"
#include "show_frag.spv.h"
#include "sky_frag.spv.h"
#include "world_frag.spv.h"
#include "world_vert.spv.h"

#define SHELTER_TEXELS 1024 /* 32 mm each: half the width of a pixel some metres away */

/* ---- passes */

typedef struct pass_def {
    VkFormat color;   /* VK_FORMAT_UNDEFINED: depth alone */
    bool depth, load; /* has depth; keeps the contents */
    VkImageLayout color_before, color_after;
} pass_def;

/* Dependencies on all commands before and after the pass are simple, and fast enough for a small renderer. */
static bool create_pass(stage *s, const pass_def *def, VkRenderPass *pass, char *error, size_t error_size)
{
    const bool colored = def->color != VK_FORMAT_UNDEFINED;
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
        .attachments = colored ? attachments : attachments + 1,
        .color_count = colored,
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
    const pass_def shelter = {VK_FORMAT_UNDEFINED, true, false, none, none};
    const pass_def shown = {s->show_format, false, false, none, s->window ? VK_IMAGE_LAYOUT_PRESENT_SRC_KHR : copied};
    return create_pass(s, &world, &s->world_pass, error, error_size) &&
           create_pass(s, &over, &s->over_pass, error, error_size) &&
           create_pass(s, &shelter, &s->shelter_pass, error, error_size) &&
           create_pass(s, &shown, &s->show_pass, error, error_size);
}

/* ---- descriptors */

#define IMAGE VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER

static const VkDescriptorType types[9] = {
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE};

static bool create_bindings(stage *s, char *error, size_t error_size)
{
    const VkShaderStageFlags drawing = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const host_set_shape material = {types + 1, 2, drawing};
    if (!host_set_layout_create(s->device, &material, &s->material_layout, error, error_size) ||
        !host_set_pool_create(s->device, &material, STAGE_SETS, &s->material_pool, error, error_size))
        return false;
    const host_bindings_def show = {.shape = {types + 1, 1, drawing}, .set_count = 1};
    const host_bindings_def world = {.shape = {types, 9, drawing},
                                     .set_count = HOST_FRAMES,
                                     .push_stages = drawing,
                                     .push_bytes = sizeof(struct drive_surface_gpu),
                                     .next = s->material_layout};
    return host_bindings_create(s->device, &world, &s->world, error, error_size) &&
           host_bindings_create(s->device, &show, &s->show, error, error_size);
}

/* ---- pipelines */

/* Multiplies the color behind glass by the blend constants. Alpha is a distance and is not blended. */
static const VkPipelineColorBlendAttachmentState through = {.blendEnable = VK_TRUE,
                                                            .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
                                                            .dstColorBlendFactor = VK_BLEND_FACTOR_CONSTANT_COLOR,
                                                            .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                                                            .dstAlphaBlendFactor = VK_BLEND_FACTOR_ZERO,
                                                            .colorWriteMask = 0xf};

static bool create_shelter(stage *s, char *error, size_t error_size)
{
    const host_graphics_def def = {.vertex = HOST_CODE(shelter_vert),
                                   .layout = s->world.layout,
                                   .pass = s->shelter_pass,
                                   .attribute_count = 1,
                                   .depth_test = true,
                                   .depth_write = true,
                                   .compare = VK_COMPARE_OP_LESS};
    return host_graphics_create(s->device, &def, &s->shelter_pipeline, error, error_size) &&
           host_shelter_create(s->device, s->shelter_pass, SHELTER_TEXELS, &s->shelter, error, error_size);
}

static bool create_pipelines(stage *s, char *error, size_t error_size)
{
    host_graphics_def mesh = {.vertex = HOST_CODE(world_vert),
                              .fragment = HOST_CODE(world_frag),
                              .layout = s->world.layout,
                              .pass = s->world_pass,
                              .attribute_count = 3,
                              .depth_test = true,
                              .depth_write = true,
                              .compare = VK_COMPARE_OP_LESS_OR_EQUAL,
                              .colors = &host_blend_replace,
                              .color_count = 1};
    if (!host_graphics_create(s->device, &mesh, &s->world_pipeline, error, error_size))
        return false;
    mesh.colors = &through;
    mesh.blend_constants = true;
    return host_graphics_create(s->device, &mesh, &s->glass_pipeline, error, error_size) &&
           host_fullscreen_create(s->device, HOST_CODE(full_vert), HOST_CODE(sky_frag), s->world.layout, s->world_pass,
                                  &s->sky_pipeline, error, error_size) &&
           host_fullscreen_create(s->device, HOST_CODE(full_vert), HOST_CODE(show_frag), s->show.layout, s->show_pass,
                                  &s->show_pipeline, error, error_size);
}

/* ---- all of it */

static bool create_data(stage *s, char *error, size_t error_size)
{
    const uint8_t texel[4] = {255, 255, 255, 255};
    const host_image_def white = {.format = VK_FORMAT_R8G8B8A8_UNORM, .extent = {1, 1, 1}, .name = "drive white"};
    for (uint32_t i = 0; i < HOST_FRAMES; i++)
        if (!host_buffer_create(s->device, sizeof(struct drive_frame_gpu), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                HOST_BUFFER_UPLOAD, "drive frame", &s->uniforms[i], error, error_size))
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
           create_bindings(s, error, error_size) && host_samplers_create(device, s->samplers, error, error_size) &&
           create_pipelines(s, error, error_size) && create_shelter(s, error, error_size) &&
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
        host_buffer_destroy(s->device, &s->uniforms[i]);
    }
    host_image_destroy(s->device, &s->white);
    const VkPipeline pipelines[] = {s->world_pipeline, s->glass_pipeline, s->sky_pipeline, s->show_pipeline,
                                    s->shelter_pipeline};
    const VkRenderPass passes[] = {s->world_pass, s->over_pass, s->show_pass, s->shelter_pass};
    host_shelter_destroy(s->device, &s->shelter);
    for (int i = 0; i < 5; i++)
        vkDestroyPipeline(device, pipelines[i], NULL);
    for (int i = 0; i < 4; i++)
        vkDestroyRenderPass(device, passes[i], NULL);
    host_bindings_destroy(s->device, &s->world);
    host_bindings_destroy(s->device, &s->show);
    vkDestroyDescriptorPool(device, s->material_pool, NULL);
    vkDestroyDescriptorSetLayout(device, s->material_layout, NULL);
    host_samplers_destroy(s->device, s->samplers);
}
