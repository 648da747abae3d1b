/* target_focus.c - what a target has for a lens: the depth of layers, and the plate and the layers out of focus. */
#include "target.h"

#include "passes.h"

#include <string.h>

#define READERS (VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT)

static bool is_color(const host_target *target, host_output output)
{
    return output == HOST_COLOR || (output >= HOST_LAYER && target->images[output].image &&
                                    !(target->kept_layers & 1u << (output - HOST_LAYER)));
}

/* ---- create and destroy ------------------------------------------------------------------------------------- */

/* The color is not stored. Before: the readers of the last frame. */
static bool create_depth_pass(host_device *device, host_target *target, char *error, size_t error_size)
{
    const host_image *layer = &target->images[HOST_LAYER];
    VkAttachmentDescription attachments[2] = {
        host_attachment(layer->format, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
        host_attachment(VK_FORMAT_D32_SFLOAT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)};
    attachments[0].storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | HOST_DEPTH_STAGES;
    const host_pass_def def = {
        .attachments = attachments,
        .color_count = 1,
        .depth = true,
        .before = {drawing | READERS, HOST_DRAW_WRITES, drawing, HOST_DRAW_READS | HOST_DRAW_WRITES},
        .after = {drawing, HOST_DRAW_WRITES, READERS | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT},
    };
    return host_pass_create(device, &def, &target->depth_pass, error, error_size);
}

static bool create_image(host_device *device, const host_target *target, VkFormat format, VkImageUsageFlags usage,
                         const char *name, host_image *image, char *error, size_t error_size)
{
    const host_image_def def = {
        .format = format, .extent = {target->width, target->height, 1}, .usage = usage, .name = name};
    return host_image_create(device, &def, image, error, error_size);
}

static bool create_layer_depth(host_device *device, host_target *target, uint32_t layer, char *error, size_t error_size)
{
    host_image *depth = &target->layer_depths[layer];
    if (!create_image(device, target, VK_FORMAT_D32_SFLOAT,
                      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                          VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                      "layer depth", depth, error, error_size))
        return false;
    const VkImageView views[2] = {target->depth_color.view, depth->view};
    return host_framebuffer_create(device, target->depth_pass, views, 2, target->width, target->height,
                                   &target->depth_framebuffers[layer], error, error_size);
}

static bool create_focused(host_device *device, host_target *target, host_output output, char *error, size_t error_size)
{
    host_image *image = &target->focused[output];
    return create_image(device, target, target->images[output].format,
                        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                            VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                        "in focus", image, error, error_size) &&
           host_framebuffer_create(device, target->layer_pass, &image->view, 1, target->width, target->height,
                                   &target->focused_framebuffers[output], error, error_size);
}

bool host_target_add_focus(host_device *device, host_target *target, uint32_t layers_with_depth, char *error,
                           size_t error_size)
{
    if (!create_depth_pass(device, target, error, error_size) ||
        !create_image(device, target, target->images[HOST_LAYER].format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                      "color of layer depths", &target->depth_color, error, error_size) ||
        !host_buffer_create(device, sizeof(host_pick) * (HOST_MAX_LAYERS + 1), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                            HOST_BUFFER_READBACK, "picked pixel", &target->pick, error, error_size))
        return false;
    for (uint32_t i = 0; i < target->layer_count; i++)
        if ((layers_with_depth & 1u << i) && !create_layer_depth(device, target, i, error, error_size))
            return false;
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++)
        if (is_color(target, (host_output)i) && !create_focused(device, target, (host_output)i, error, error_size))
            return false;
    return true;
}

/* ---- recording ---------------------------------------------------------------------------------------------- */

void host_target_begin_layer_depth(const host_target *target, VkCommandBuffer cmd, host_output layer)
{
    host_pass_begin(cmd, target->depth_pass, target->depth_framebuffers[layer - HOST_LAYER], target->width,
                    target->height, 1);
}

void host_target_describe_layer_depth(const host_target *target, virga_target_def *def)
{
    host_target_describe_layer(target, def);
    def->render_pass = target->depth_pass;
    def->depth_format = VK_FORMAT_D32_SFLOAT;
    def->depth_attached = true;
    def->depth_written = true;
}

void host_target_read_layer(const host_target *target, VkCommandBuffer cmd, host_output layer)
{
    host_image_barrier(cmd, &target->images[layer], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, READERS, VK_ACCESS_SHADER_READ_BIT);
}

void host_target_begin_focused(const host_target *target, VkCommandBuffer cmd, host_output output)
{
    host_pass_begin(cmd, target->layer_pass, target->focused_framebuffers[output], target->width, target->height, 1);
}

static virga_image read_by_shaders(const host_image *image, VkImageLayout layout)
{
    const virga_image_state state = {layout, READERS, VK_ACCESS_SHADER_READ_BIT};
    return (virga_image){.image = image->image,
                         .view = image->view,
                         .format = image->format,
                         .extent = image->extent,
                         .layers = 1,
                         .before = state,
                         .after = state};
}

virga_image host_target_layer(const host_target *target, host_output layer)
{
    return read_by_shaders(&target->images[layer], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

virga_image host_target_layer_depth(const host_target *target, host_output layer)
{
    const host_image *depth = &target->layer_depths[layer - HOST_LAYER];
    return read_by_shaders(depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
}

/* ---- one pixel ---------------------------------------------------------------------------------------------- */

static void pick_pixel(const host_target *target, VkCommandBuffer cmd, const host_image *image, VkImageLayout layout,
                       const uint32_t at[2], VkDeviceSize offset)
{
    const bool depth = image->format == VK_FORMAT_D32_SFLOAT;
    const VkBufferImageCopy region = {
        .bufferOffset = offset,
        .imageSubresource = {depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .imageOffset = {(int32_t)at[0], (int32_t)at[1], 0},
        .imageExtent = {1, 1, 1},
    };
    const VkAccessFlags writes =
        depth ? VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT : VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    host_image_barrier(cmd, image, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | HOST_DEPTH_STAGES | READERS, writes,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    vkCmdCopyImageToBuffer(cmd, image->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target->pick.buffer, 1, &region);
    host_image_barrier(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                       READERS | HOST_DEPTH_STAGES, VK_ACCESS_SHADER_READ_BIT);
}

void host_target_pick(const host_target *target, VkCommandBuffer cmd, const uint32_t at[2])
{
    const VkImageLayout depth_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    pick_pixel(target, cmd, &target->images[HOST_DEPTH], depth_layout, at, offsetof(host_pick, depth));
    for (uint32_t i = 0; i < target->layer_count; i++) {
        const VkDeviceSize offset = sizeof(host_pick) * (i + 1);
        if (!target->layer_depths[i].image)
            continue;
        pick_pixel(target, cmd, &target->images[HOST_LAYER + i], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, at, offset);
        pick_pixel(target, cmd, &target->layer_depths[i], depth_layout, at, offset + offsetof(host_pick, depth));
    }
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
}

float host_target_picked_depth(const host_device *device, const host_target *target, float coverage)
{
    const host_pick *picked = target->pick.mapped;
    float depth;
    host_buffer_invalidate(device, &target->pick);
    depth = picked[0].depth;
    for (uint32_t i = 0; i < target->layer_count; i++)
        if (target->layer_depths[i].image && picked[i + 1].color[3] >= coverage && picked[i + 1].depth < depth)
            depth = picked[i + 1].depth;
    return depth;
}
