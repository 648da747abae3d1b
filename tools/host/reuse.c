/* reuse.c - see reuse.h. */
#include "reuse.h"

#include <string.h>

#include "pipeline.h"
#include "shaders/frame_gpu.h"

#include "reuse_check_comp.spv.h"
#include "reuse_choose_frag.spv.h"
#include "reuse_find_comp.spv.h"
#include "reuse_slope_frag.spv.h"
#include "reuse_take_frag.spv.h"

#define GROUP  8 /* blocks along a side */
#define SEEN   VK_FORMAT_R32G32B32A32_SFLOAT
#define PLACES VK_FORMAT_R8_UINT

#define CONTRAST 0.5f /* more is shaded in each sub-frame, see host_reuse_gpu */
#define EDGE     0.2f
#define DARK     0.25f /* of white. Shading takes 165 ms in place of 210 by that, for an error larger by 0.2 % */
#define MOVED_PX 0.5f  /* so is what moves farther from the first to the last */

enum {
    AT_DEPTH,
    AT_PLANES,
    AT_COLOR,
    AT_VELOCITY,
    AT_KINDS_WRITTEN,
    AT_FIRST_DEPTH,
    AT_FIRST, /* the colors */
    AT_SEEN = AT_FIRST + HOST_PLATE_COLORS,
    AT_ID,
    AT_KINDS,
    AT_PLACES,
    BINDINGS
};

#define IMAGE   VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
#define WRITTEN VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
#define BUFFER  VK_DESCRIPTOR_TYPE_STORAGE_BUFFER

static const VkDescriptorType types[BINDINGS] = {IMAGE, BUFFER, IMAGE, IMAGE, WRITTEN, IMAGE, IMAGE, IMAGE,
                                                 IMAGE, IMAGE,  IMAGE, IMAGE, IMAGE,   IMAGE, IMAGE};

#define SHOWN VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL

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

static bool create_images(host_device *device, host_reuse *u, char *error, size_t error_size)
{
    const VkExtent3D pixels = {u->width, u->height, 1}, of_blocks = {blocks(u->width), blocks(u->height), 1};
    const VkImageUsageFlags drawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const struct {
        host_image *image;
        host_image_def def;
    } images[] = {
        {&u->depth,
         {.format = VK_FORMAT_D32_SFLOAT,
          .extent = pixels,
          .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
          .name = "depth to shade at"}},
        {&u->id,
         {.format = host_output_format(HOST_ID),
          .extent = pixels,
          .usage = drawn | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, /* its layout in the plate's pass */
          .name = "ids of a sub-frame"}},
        {&u->seen, {.format = SEEN, .extent = pixels, .usage = drawn, .name = "depth of the shared sub-frame"}},
        {&u->places, {.format = PLACES, .extent = pixels, .usage = drawn, .name = "places of pixels to take"}},
        {&u->kinds,
         {.format = VK_FORMAT_R32_UINT,
          .extent = of_blocks,
          .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
          .name = "kinds of blocks"}},
    };
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        if (!host_image_create(device, &images[i].def, images[i].image, error, error_size))
            return false;
    return create_first(device, u, error, error_size);
}

/* The depth of the plate, and ids of their own, since what is taken has ids too. */
static bool create_framebuffers(host_device *device, const host_target *target, host_reuse *u, char *error,
                                size_t error_size)
{
    const uint32_t count = HOST_PLATE_COLORS + 1;
    VkImageView views[HOST_PLATE_COLORS + 1];
    for (uint32_t i = 0; i < count; i++)
        views[i] = target->images[i].view;
    views[HOST_ID] = u->id.view;
    if (!host_framebuffer_create(device, u->pass, views, count, u->width, u->height, &u->depth_framebuffer, error,
                                 error_size))
        return false;
    views[HOST_ID] = target->images[HOST_ID].view;
    views[HOST_DEPTH] = u->depth.view;
    return host_framebuffer_create(device, u->pass, views, count, u->width, u->height, &u->shade_framebuffer, error,
                                   error_size);
}

/* Its draw writes all of its attachments: what the shared sub-frame saw, or places and the depth to shade at, which the
 * draws of the plate are tested against. */
static bool create_whole_pass(host_device *device, VkFormat format, bool depth, VkRenderPass *pass, char *error,
                              size_t error_size)
{
    VkAttachmentDescription attachments[2] = {
        host_attachment(format, SHOWN),
        host_attachment(host_output_format(HOST_DEPTH), VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)};
    const VkPipelineStageFlags drawing =
        VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | (depth ? HOST_DEPTH_STAGES : 0);
    const VkPipelineStageFlags reading = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    const VkAccessFlags color = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, writes = depth ? HOST_DRAW_WRITES : color;
    const host_pass_def def = {.attachments = attachments,
                               .color_count = 1,
                               .depth = depth,
                               .before = {drawing | reading, writes, drawing, writes},
                               .after = {drawing, writes, reading | drawing,
                                         VK_ACCESS_SHADER_READ_BIT | (depth ? HOST_DRAW_READS | writes : 0)}};
    attachments[0].loadOp = attachments[1].loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    return host_pass_create(device, &def, pass, error, error_size);
}

static bool create_whole_passes(host_device *device, host_reuse *u, char *error, size_t error_size)
{
    const VkImageView choice[2] = {u->places.view, u->depth.view};
    return create_whole_pass(device, SEEN, false, &u->slope_pass, error, error_size) &&
           create_whole_pass(device, PLACES, true, &u->choose_pass, error, error_size) &&
           host_framebuffer_create(device, u->slope_pass, &u->seen.view, 1, u->width, u->height, &u->slope_framebuffer,
                                   error, error_size) &&
           host_framebuffer_create(device, u->choose_pass, choice, 2, u->width, u->height, &u->choose_framebuffer,
                                   error, error_size);
}

static bool create_pipelines(host_device *device, host_reuse *u, char *error, size_t error_size)
{
    VkPipelineColorBlendAttachmentState taken[HOST_PLATE_COLORS];
    for (int i = 0; i < HOST_PLATE_COLORS; i++)
        taken[i] = host_blend_replace;
    taken[HOST_ID].colorWriteMask = 0; /* ids are read of the first one alone */
    const VkPipelineLayout layout = u->bindings.layout;
    const host_graphics_def choose = {
        .vertex = host_fullscreen_vertex(),
        .fragment = HOST_CODE(reuse_choose_frag),
        .layout = layout,
        .pass = u->choose_pass,
        .depth_test = true,
        .depth_write = true,
        .compare = VK_COMPARE_OP_ALWAYS,
        .colors = taken,
        .color_count = 1,
    };
    const host_graphics_def take = {
        .vertex = host_fullscreen_vertex(),
        .fragment = HOST_CODE(reuse_take_frag),
        .layout = layout,
        .pass = u->shade_pass,
        .depth_test = true,
        .compare = VK_COMPARE_OP_GREATER,
        .colors = taken,
        .color_count = HOST_PLATE_COLORS,
    };
    return host_compute_create(device, HOST_CODE(reuse_find_comp), layout, &u->find, error, error_size) &&
           host_compute_create(device, HOST_CODE(reuse_check_comp), layout, &u->check, error, error_size) &&
           host_fullscreen_create(device, host_fullscreen_vertex(), HOST_CODE(reuse_slope_frag), layout, u->slope_pass,
                                  &u->slope, error, error_size) &&
           host_graphics_create(device, &choose, &u->choose, error, error_size) &&
           host_graphics_create(device, &take, &u->take, error, error_size);
}

static void write_set(const host_device *device, const host_target *target, const host_reuse *u)
{
    const VkDescriptorSet set = u->bindings.sets[0];
    host_set_write_buffer(device, set, AT_PLANES, BUFFER, u->planes.buffer);
    host_set_write_image(device, set, AT_KINDS_WRITTEN, VK_NULL_HANDLE, u->kinds.view, VK_IMAGE_LAYOUT_GENERAL);
    host_set_write_image(device, set, AT_KINDS, u->sampler, u->kinds.view, VK_IMAGE_LAYOUT_GENERAL);
    host_set_write_image(device, set, AT_SEEN, u->sampler, u->seen.view, SHOWN);
    host_set_write_image(device, set, AT_PLACES, u->sampler, u->places.view, SHOWN);
    host_set_write_image(device, set, AT_DEPTH, u->sampler, target->images[HOST_DEPTH].view,
                         VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    host_set_write_image(device, set, AT_COLOR, u->sampler, target->images[HOST_COLOR].view, SHOWN);
    host_set_write_image(device, set, AT_VELOCITY, u->sampler, target->images[HOST_VELOCITY].view, SHOWN);
    host_set_write_image(device, set, AT_ID, u->sampler, u->id.view, SHOWN);
    host_set_write_image(device, set, AT_FIRST_DEPTH, u->sampler, u->first[HOST_DEPTH].view, SHOWN);
    for (uint32_t i = 0; i < HOST_PLATE_COLORS; i++)
        host_set_write_image(device, set, AT_FIRST + i, u->sampler, u->first[i].view, SHOWN);
}

bool host_reuse_create(host_device *device, const host_target *target, host_reuse *u, char *error, size_t error_size)
{
    const VkShaderStageFlags stages = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const host_bindings_def def = {.shape = {types, BINDINGS, stages},
                                   .set_count = 1,
                                   .push_stages = stages,
                                   .push_bytes = sizeof(struct host_reuse_gpu)};
    memset(u, 0, sizeof *u);
    u->width = target->width;
    u->height = target->height;
    u->shade_pass = target->over_pass;
    const VkDeviceSize planes = (VkDeviceSize)blocks(u->width) * blocks(u->height) * 4 * sizeof(float);
    if (!host_buffer_create(device, planes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_DEVICE, "planes of depth",
                            &u->planes, error, error_size) ||
        !create_images(device, u, error, error_size) ||
        !host_target_create_kept_pass(device, &u->pass, error, error_size) ||
        !create_framebuffers(device, target, u, error, error_size) ||
        !create_whole_passes(device, u, error, error_size) ||
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
    vkDestroyPipeline(device->device, u->take, NULL);
    host_bindings_destroy(device, &u->bindings);
    vkDestroySampler(device->device, u->sampler, NULL);
    vkDestroyFramebuffer(device->device, u->depth_framebuffer, NULL);
    vkDestroyFramebuffer(device->device, u->shade_framebuffer, NULL);
    vkDestroyFramebuffer(device->device, u->slope_framebuffer, NULL);
    vkDestroyFramebuffer(device->device, u->choose_framebuffer, NULL);
    vkDestroyRenderPass(device->device, u->pass, NULL);
    vkDestroyRenderPass(device->device, u->slope_pass, NULL);
    vkDestroyRenderPass(device->device, u->choose_pass, NULL);
    host_buffer_destroy(device, &u->planes);
    host_image_destroy(device, &u->depth);
    host_image_destroy(device, &u->id);
    host_image_destroy(device, &u->seen);
    host_image_destroy(device, &u->places);
    host_image_destroy(device, &u->kinds);
    for (int i = 0; i <= HOST_PLATE_COLORS; i++)
        host_image_destroy(device, &u->first[i]);
    memset(u, 0, sizeof *u);
}

/* ---- recording ---------------------------------------------------------------------------------------------- */

/* `shift_px`: NULL where there is none yet. */
static struct host_reuse_gpu push_of(const host_reuse *u, const float shift_px[2])
{
    const float dark = u->white * DARK;
    return (struct host_reuse_gpu){.width = u->width,
                                   .height = u->height,
                                   .contrast = CONTRAST,
                                   .edge = EDGE,
                                   .dark = dark > 1e-6f ? dark : 1e-6f,
                                   .shift_x = shift_px ? shift_px[0] : 0.0f,
                                   .shift_y = shift_px ? shift_px[1] : 0.0f};
}

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

static void draw_all(const host_reuse *u, VkCommandBuffer cmd, VkPipeline pipeline, const struct host_reuse_gpu *push)
{
    bind(u, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline, push);
    vkCmdDraw(cmd, 3, 1, 0, 0);
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
    struct host_reuse_gpu push = push_of(u, NULL);
    push.moved2 = moved * moved;
    host_moving_push(moving, &push);
    host_target_begin_read(target, cmd, HOST_VELOCITY);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                        VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT);
    dispatch_blocks(u, cmd, u->find, &push);
    host_target_end_read(target, cmd, HOST_VELOCITY);
    copy_first(u, cmd, target);
    host_pass_begin(cmd, u->slope_pass, u->slope_framebuffer, u->width, u->height, 1);
    draw_all(u, cmd, u->slope, &push);
    vkCmdEndRenderPass(cmd);
}

/* The sky draws no id. */
static void clear_ids(const host_reuse *u, VkCommandBuffer cmd)
{
    const VkClearAttachment id = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .colorAttachment = HOST_ID};
    const VkClearRect all = {.rect = {{0, 0}, {u->width, u->height}}, .layerCount = 1};
    vkCmdClearAttachments(cmd, 1, &id, 1, &all);
}

void host_reuse_begin_depth(const host_reuse *u, VkCommandBuffer cmd)
{
    host_image_barrier(cmd, &u->id, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
    host_pass_begin(cmd, u->pass, u->depth_framebuffer, u->width, u->height, HOST_PLATE_COLORS);
    clear_ids(u, cmd);
}

void host_reuse_end_depth(const host_reuse *u, VkCommandBuffer cmd, const float shift_px[2], const host_moving *moving)
{
    struct host_reuse_gpu push = push_of(u, shift_px);
    const VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                               fragment = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    host_moving_push(moving, &push);
    vkCmdEndRenderPass(cmd);
    host_image_barrier(cmd, &u->id, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, SHOWN,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, compute | fragment, VK_ACCESS_SHADER_READ_BIT);
    host_image_barrier(cmd, &u->kinds, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, compute | fragment, 0,
                       compute, VK_ACCESS_SHADER_WRITE_BIT);
    host_memory_barrier(cmd, compute, VK_ACCESS_SHADER_WRITE_BIT, compute,
                        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    dispatch_blocks(u, cmd, u->check, &push);
    host_memory_barrier(cmd, compute, VK_ACCESS_SHADER_WRITE_BIT, fragment, VK_ACCESS_SHADER_READ_BIT);
}

/* Only pixels that are taken pass the depth test of what takes them. */
void host_reuse_begin_shade(const host_reuse *u, VkCommandBuffer cmd, const float shift_px[2])
{
    const struct host_reuse_gpu push = push_of(u, shift_px);
    const VkViewport between = {
        0, 0, (float)u->width, (float)u->height, (float)HOST_REUSE_BETWEEN, (float)HOST_REUSE_BETWEEN};
    host_pass_begin(cmd, u->choose_pass, u->choose_framebuffer, u->width, u->height, 1);
    draw_all(u, cmd, u->choose, &push);
    vkCmdEndRenderPass(cmd);
    host_pass_begin(cmd, u->shade_pass, u->shade_framebuffer, u->width, u->height, HOST_PLATE_COLORS);
    vkCmdSetViewport(cmd, 0, 1, &between);
    draw_all(u, cmd, u->take, &push);
    host_set_area(cmd, u->width, u->height);
}
