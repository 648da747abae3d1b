/* reuse.c - see reuse.h. */
#include "reuse.h"

#include <string.h>

#include "pipeline.h"
#include "shaders/frame_gpu.h"

#include "reuse_check_comp.spv.h"
#include "reuse_find_comp.spv.h"
#include "reuse_frag.spv.h"
#include "reuse_slope_comp.spv.h"
#include "reuse_take_comp.spv.h"
#include "reuse_take_frag.spv.h"
#include "reuse_vert.spv.h"

#define GROUP 8 /* blocks along a side */

#define CONTRAST 0.5f /* more is shaded in each sub-frame, see host_reuse_gpu */
#define EDGE     0.2f
#define MOVED_PX 0.5f /* so is what moves farther from the first to the last */

enum {
    AT_DEPTH,
    AT_PLANES,
    AT_COLOR,
    AT_VELOCITY,
    AT_CHOICES,
    AT_FIRST_DEPTH,
    AT_FIRST, /* the colors */
    AT_SLOPES = AT_FIRST + HOST_PLATE_COLORS,
    AT_ID,
    BINDINGS
};

#define IMAGE  VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
#define BUFFER VK_DESCRIPTOR_TYPE_STORAGE_BUFFER

static const VkDescriptorType kinds[BINDINGS] = {IMAGE, BUFFER, IMAGE, IMAGE, BUFFER, IMAGE, IMAGE,
                                                 IMAGE, IMAGE,  IMAGE, IMAGE, BUFFER, IMAGE};

uint32_t host_reuse_share(uint32_t samples)
{
    if (samples >= 16 && samples % 4 == 0)
        return 4;
    return samples >= 4 && samples % 2 == 0 ? 2 : 1;
}

/* ---- create ------------------------------------------------------------------------------------------------- */

static uint32_t blocks(uint32_t pixels)
{
    return (pixels + HOST_REUSE_SIDE - 1) / HOST_REUSE_SIDE;
}

static bool create_first(host_device *device, host_reuse *u, char *error, size_t error_size)
{
    for (int i = 0; i <= HOST_PLATE_COLORS; i++) {
        const host_image_def def = {.format = host_output_format((host_output)i),
                                    .extent = {u->width, u->height, 1},
                                    .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                    .name = "shared sub-frame"};
        if (!host_image_create(device, &def, &u->first[i], error, error_size))
            return false;
    }
    return true;
}

static bool create_memory(host_device *device, host_reuse *u, char *error, size_t error_size)
{
    const host_image_def depth = {.format = VK_FORMAT_D32_SFLOAT,
                                  .extent = {u->width, u->height, 1},
                                  .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                                  .name = "depth to shade at"};
    const VkDeviceSize pixels = (VkDeviceSize)u->width * u->height;
    const struct {
        VkDeviceSize size;
        host_buffer *buffer;
        const char *name;
    } buffers[] = {
        {(VkDeviceSize)blocks(u->width) * blocks(u->height) * 4 * sizeof(float), &u->planes, "planes of depth"},
        {pixels * sizeof(uint32_t), &u->choices, "pixels taken"},
        {pixels * 2 * sizeof(float), &u->slopes, "slopes of depth"},
    };
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        if (!host_buffer_create(device, buffers[i].size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_DEVICE,
                                buffers[i].name, buffers[i].buffer, error, error_size))
            return false;
    return host_image_create(device, &depth, &u->depth, error, error_size) &&
           create_first(device, u, error, error_size);
}

static bool create_framebuffers(host_device *device, const host_target *target, host_reuse *u, char *error,
                                size_t error_size)
{
    const uint32_t count = HOST_PLATE_COLORS + 1;
    VkImageView views[HOST_PLATE_COLORS + 1];
    for (uint32_t i = 0; i < count; i++)
        views[i] = target->images[i].view;
    if (!host_framebuffer_create(device, u->pass, views, count, u->width, u->height, &u->depth_framebuffer, error,
                                 error_size))
        return false;
    views[HOST_PLATE_COLORS] = u->depth.view;
    return host_framebuffer_create(device, u->pass, views, count, u->width, u->height, &u->shade_framebuffer, error,
                                   error_size);
}

static bool create_pipelines(host_device *device, host_reuse *u, char *error, size_t error_size)
{
    static const VkPipelineColorBlendAttachmentState kept[HOST_PLATE_COLORS];
    VkPipelineColorBlendAttachmentState taken[HOST_PLATE_COLORS];
    for (int i = 0; i < HOST_PLATE_COLORS; i++)
        taken[i] = host_blend_replace;
    const host_graphics_def fill = {
        .vertex = HOST_CODE(reuse_vert),
        .fragment = HOST_CODE(reuse_frag),
        .layout = u->bindings.layout,
        .pass = u->pass,
        .depth_test = true,
        .depth_write = true,
        .compare = VK_COMPARE_OP_ALWAYS,
        .colors = kept,
        .color_count = HOST_PLATE_COLORS,
    };
    host_graphics_def take = fill;
    take.fragment = HOST_CODE(reuse_take_frag);
    take.depth_write = false;
    take.compare = VK_COMPARE_OP_LESS;
    take.colors = taken;
    const VkPipelineLayout layout = u->bindings.layout;
    return host_compute_create(device, HOST_CODE(reuse_find_comp), layout, &u->find, error, error_size) &&
           host_compute_create(device, HOST_CODE(reuse_check_comp), layout, &u->check, error, error_size) &&
           host_compute_create(device, HOST_CODE(reuse_slope_comp), layout, &u->slope, error, error_size) &&
           host_compute_create(device, HOST_CODE(reuse_take_comp), layout, &u->choose, error, error_size) &&
           host_graphics_create(device, &fill, &u->fill, error, error_size) &&
           host_graphics_create(device, &take, &u->take, error, error_size);
}

static void write_set(const host_device *device, const host_target *target, const host_reuse *u)
{
    const VkDescriptorSet set = u->bindings.sets[0];
    const VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    host_set_write_buffer(device, set, AT_PLANES, BUFFER, u->planes.buffer);
    host_set_write_buffer(device, set, AT_CHOICES, BUFFER, u->choices.buffer);
    host_set_write_buffer(device, set, AT_SLOPES, BUFFER, u->slopes.buffer);
    host_set_write_image(device, set, AT_DEPTH, u->sampler, target->images[HOST_DEPTH].view,
                         VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    host_set_write_image(device, set, AT_COLOR, u->sampler, target->images[HOST_COLOR].view, layout);
    host_set_write_image(device, set, AT_VELOCITY, u->sampler, target->images[HOST_VELOCITY].view, layout);
    host_set_write_image(device, set, AT_ID, u->sampler, target->images[HOST_ID].view, layout);
    host_set_write_image(device, set, AT_FIRST_DEPTH, u->sampler, u->first[HOST_DEPTH].view, layout);
    for (uint32_t i = 0; i < HOST_PLATE_COLORS; i++)
        host_set_write_image(device, set, AT_FIRST + i, u->sampler, u->first[i].view, layout);
}

bool host_reuse_create(host_device *device, const host_target *target, host_reuse *u, char *error, size_t error_size)
{
    const VkShaderStageFlags stages = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const host_bindings_def def = {.shape = {kinds, BINDINGS, stages},
                                   .set_count = 1,
                                   .push_stages = stages,
                                   .push_bytes = sizeof(struct host_reuse_gpu)};
    memset(u, 0, sizeof *u);
    u->width = target->width;
    u->height = target->height;
    if (!create_memory(device, u, error, error_size) ||
        !host_target_create_kept_pass(device, &u->pass, error, error_size) ||
        !create_framebuffers(device, target, u, error, error_size) ||
        !host_sampler_create(device, HOST_SAMPLE_NEAREST, &u->sampler, error, error_size) ||
        !host_bindings_create(device, &def, &u->bindings, error, error_size) ||
        !create_pipelines(device, u, error, error_size))
        return false;
    write_set(device, target, u);
    return true;
}

void host_reuse_destroy(host_device *device, host_reuse *u)
{
    vkDestroyPipeline(device->device, u->find, NULL);
    vkDestroyPipeline(device->device, u->check, NULL);
    vkDestroyPipeline(device->device, u->slope, NULL);
    vkDestroyPipeline(device->device, u->choose, NULL);
    vkDestroyPipeline(device->device, u->fill, NULL);
    vkDestroyPipeline(device->device, u->take, NULL);
    host_bindings_destroy(device, &u->bindings);
    vkDestroySampler(device->device, u->sampler, NULL);
    vkDestroyFramebuffer(device->device, u->depth_framebuffer, NULL);
    vkDestroyFramebuffer(device->device, u->shade_framebuffer, NULL);
    vkDestroyRenderPass(device->device, u->pass, NULL);
    host_buffer_destroy(device, &u->planes);
    host_buffer_destroy(device, &u->choices);
    host_buffer_destroy(device, &u->slopes);
    host_image_destroy(device, &u->depth);
    for (int i = 0; i <= HOST_PLATE_COLORS; i++)
        host_image_destroy(device, &u->first[i]);
    memset(u, 0, sizeof *u);
}

/* ---- recording ---------------------------------------------------------------------------------------------- */

static void bind(const host_reuse *u, VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline,
                 const struct host_reuse_gpu *push)
{
    vkCmdBindPipeline(cmd, point, pipeline);
    vkCmdBindDescriptorSets(cmd, point, u->bindings.layout, 0, 1, u->bindings.sets, 0, NULL);
    vkCmdPushConstants(cmd, u->bindings.layout, VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof *push, push);
}

static uint32_t groups(uint32_t items)
{
    return (items + GROUP - 1) / GROUP;
}

static void dispatch_blocks(const host_reuse *u, VkCommandBuffer cmd, VkPipeline pipeline,
                            const struct host_reuse_gpu *push)
{
    bind(u, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, push);
    vkCmdDispatch(cmd, groups(blocks(u->width)), groups(blocks(u->height)), 1);
}

static void dispatch_pixels(const host_reuse *u, VkCommandBuffer cmd, VkPipeline pipeline,
                            const struct host_reuse_gpu *push)
{
    bind(u, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, push);
    vkCmdDispatch(cmd, groups(u->width), groups(u->height), 1);
}

/* Keeps the sub-frame that is drawn. What read the one before is done. */
static void copy_first(const host_reuse *u, VkCommandBuffer cmd, const host_target *target)
{
    const VkPipelineStageFlags readers = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                               copying = VK_PIPELINE_STAGE_TRANSFER_BIT;
    for (int i = 0; i <= HOST_PLATE_COLORS; i++)
        host_image_barrier(cmd, &u->first[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, readers,
                           0, copying, VK_ACCESS_TRANSFER_WRITE_BIT);
    host_target_copy_plate(target, cmd, u->first);
    for (int i = 0; i <= HOST_PLATE_COLORS; i++)
        host_image_barrier(cmd, &u->first[i], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, copying, VK_ACCESS_TRANSFER_WRITE_BIT, readers,
                           VK_ACCESS_SHADER_READ_BIT);
}

void host_reuse_find(const host_reuse *u, VkCommandBuffer cmd, const host_target *target, float part,
                     const host_moving *moving)
{
    const float moved = MOVED_PX / (part > 1e-6f ? part : 1e-6f);
    struct host_reuse_gpu push = {
        .width = u->width, .height = u->height, .contrast = CONTRAST, .edge = EDGE, .moved2 = moved * moved};
    host_moving_push(moving, &push);
    host_target_begin_read(target, cmd, HOST_VELOCITY);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                        VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT);
    dispatch_blocks(u, cmd, u->find, &push);
    host_target_end_read(target, cmd, HOST_VELOCITY);
    copy_first(u, cmd, target);
    dispatch_pixels(u, cmd, u->slope, &push);
}

void host_reuse_begin_depth(const host_reuse *u, VkCommandBuffer cmd)
{
    host_pass_begin(cmd, u->pass, u->depth_framebuffer, u->width, u->height, HOST_PLATE_COLORS);
}

void host_reuse_end_depth(const host_reuse *u, VkCommandBuffer cmd, const host_target *target, const float shift_px[2],
                          const host_moving *moving)
{
    struct host_reuse_gpu push = {
        .width = u->width, .height = u->height, .contrast = CONTRAST, .shift_x = shift_px[0], .shift_y = shift_px[1]};
    host_moving_push(moving, &push);
    const VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    vkCmdEndRenderPass(cmd);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | compute, VK_ACCESS_SHADER_WRITE_BIT, compute,
                        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    host_target_begin_read(target, cmd, HOST_ID);
    dispatch_blocks(u, cmd, u->check, &push);
    host_memory_barrier(cmd, compute, VK_ACCESS_SHADER_WRITE_BIT, compute, VK_ACCESS_SHADER_READ_BIT);
    dispatch_pixels(u, cmd, u->choose, &push);
    host_target_end_read(target, cmd, HOST_ID);
    host_memory_barrier(cmd, compute, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                        VK_ACCESS_SHADER_READ_BIT);
}

void host_reuse_begin_shade(const host_reuse *u, VkCommandBuffer cmd)
{
    const struct host_reuse_gpu push = {.width = u->width, .height = u->height};
    host_pass_begin(cmd, u->pass, u->shade_framebuffer, u->width, u->height, HOST_PLATE_COLORS);
    bind(u, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, u->fill, &push);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, u->take);
    vkCmdDraw(cmd, 3, 1, 3, 0);
}
