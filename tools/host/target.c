/* target.c - images, render passes and copies to the CPU. */
#include "target.h"

#include "passes.h"

#include <string.h>

static const struct {
    VkFormat format;
    uint32_t channels;
    const char *name;
} outputs_table[HOST_LAYER] = {
    [HOST_COLOR] = {VK_FORMAT_R32G32B32A32_SFLOAT, 4, "plate color"},
    [HOST_NORMAL] = {VK_FORMAT_R32G32B32A32_SFLOAT, 4, "plate normal"},
    [HOST_VELOCITY] = {VK_FORMAT_R32G32_SFLOAT, 2, "plate velocity"},
    [HOST_WATER] = {VK_FORMAT_R32G32_SFLOAT, 2, "plate water"},
    [HOST_ID] = {VK_FORMAT_R32_UINT, 1, "plate id"},
    [HOST_DEPTH] = {VK_FORMAT_D32_SFLOAT, 1, "plate depth"},
};

/* All layers have the same format, so that they share one pass. */
#define LAYER_FORMAT   VK_FORMAT_R32G32B32A32_SFLOAT
#define LAYER_CHANNELS 4

VkFormat host_output_format(host_output output)
{
    return output < HOST_LAYER ? outputs_table[output].format : LAYER_FORMAT;
}

/* Whether an output is sampled while layers are drawn, and its layout then. The others are in the layout for copies. */
static bool is_sampled(host_output output, VkImageLayout *layout)
{
    *layout = output == HOST_DEPTH ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                   : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return output == HOST_DEPTH || output == HOST_COLOR;
}

uint32_t host_output_channels(host_output output)
{
    return output < HOST_LAYER ? outputs_table[output].channels : LAYER_CHANNELS;
}

/* ---- passes ------------------------------------------------------------------------------------------------- */

/* An attachment that is cleared and drawn, and ends in the layout for sampling or copies. */
static VkAttachmentDescription drawn(host_output output)
{
    VkImageLayout final;
    if (!is_sampled(output, &final))
        final = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    return host_attachment(host_output_format(output), final);
}

#define READERS (VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT)

/* The first `kept` attachments keep what is there. */
static bool create_plate_pass(host_device *device, uint32_t kept, VkRenderPass *pass, char *error, size_t error_size)
{
    VkAttachmentDescription attachments[HOST_PLATE_COLORS + 1];
    for (uint32_t i = 0; i <= HOST_PLATE_COLORS; i++) {
        attachments[i] = drawn((host_output)i);
        if (i >= kept)
            continue;
        attachments[i].loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
        attachments[i].initialLayout = attachments[i].finalLayout;
    }
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | HOST_DEPTH_STAGES;
    const VkPipelineStageFlags copying = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const host_pass_def def = {
        .attachments = attachments,
        .color_count = HOST_PLATE_COLORS,
        .depth = true,
        /* After the copies of the previous frame, and after its layers have sampled. */
        .before = {copying | drawing | READERS, HOST_DRAW_WRITES, drawing, HOST_DRAW_READS | HOST_DRAW_WRITES},
        /* Before copies, the depth test of layers, and shaders that sample depth or color. */
        .after = {drawing, HOST_DRAW_WRITES, copying | HOST_DEPTH_STAGES | READERS,
                  VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_SHADER_READ_BIT |
                      VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT},
    };
    return host_pass_create(device, &def, pass, error, error_size);
}

bool host_target_create_kept_pass(host_device *device, VkRenderPass *pass, char *error, size_t error_size)
{
    return create_plate_pass(device, HOST_PLATE_COLORS, pass, error, error_size);
}

/* Layers are tested against the plate's depth in the shader, which samples it for soft edges anyway. An attached depth
 * would be stored at the end of the pass, a hazard with these reads. Only Vulkan 1.3 has passes that do not store. */
static bool create_color_pass(host_device *device, const VkAttachmentDescription *attachments, uint32_t count,
                              VkRenderPass *pass, char *error, size_t error_size)
{
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkPipelineStageFlags copying = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    const host_pass_def def = {
        .attachments = attachments,
        .color_count = count,
        /* Compatible passes have the same dependencies, so these are the union of what each pass needs. */
        .before = {copying | drawing, writes | VK_ACCESS_TRANSFER_WRITE_BIT, drawing,
                   VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | writes},
        .after = {drawing, writes, copying | READERS, VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_SHADER_READ_BIT},
    };
    return host_pass_create(device, &def, pass, error, error_size);
}

/* The velocity is in the layout for copies before and after. */
static bool create_moving_pass(host_device *device, host_target *target, char *error, size_t error_size)
{
    VkAttachmentDescription attachments[2] = {drawn(HOST_LAYER), drawn(HOST_VELOCITY)};
    attachments[0].storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachments[0].finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    attachments[1].loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachments[1].initialLayout = attachments[1].finalLayout;
    return create_color_pass(device, attachments, 2, &target->moving_pass, error, error_size);
}

static bool create_layer_passes(host_device *device, host_target *target, char *error, size_t error_size)
{
    const VkAttachmentDescription layer = drawn(HOST_LAYER);
    VkAttachmentDescription behind = layer;
    behind.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    behind.initialLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    behind.finalLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return create_color_pass(device, &layer, 1, &target->layer_pass, error, error_size) &&
           create_color_pass(device, &behind, 1, &target->behind_pass, error, error_size);
}

static bool create_framebuffer(host_device *device, const host_target *target, VkRenderPass pass,
                               const VkImageView *views, uint32_t count, VkFramebuffer *framebuffer, char *error,
                               size_t error_size)
{
    return host_framebuffer_create(device, pass, views, count, target->width, target->height, framebuffer, error,
                                   error_size);
}

/* ---- create and destroy ------------------------------------------------------------------------------------- */

static bool create_output(host_device *device, host_target *target, host_output output, const char *name, char *error,
                          size_t error_size)
{
    VkImageUsageFlags usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    if (output == HOST_COLOR || output == HOST_DEPTH)
        usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT; /* host_target_fill_plate */
    usage |= output == HOST_DEPTH ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    const host_image_def def = {.format = host_output_format(output),
                                .extent = {target->width, target->height, 1},
                                .usage = usage,
                                .name = name};
    const VkDeviceSize size = (VkDeviceSize)target->width * target->height * host_output_channels(output) * 4;
    return host_image_create(device, &def, &target->images[output], error, error_size) &&
           host_buffer_create(device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, name,
                              &target->copies[output], error, error_size);
}

bool host_target_add_layer(host_device *device, host_target *target, const char *name, bool kept, host_output *layer,
                           char *error, size_t error_size)
{
    const uint32_t index = target->layer_count;
    if (index == HOST_MAX_LAYERS)
        return host_fail(error, error_size, "a picture has at most %d layers", HOST_MAX_LAYERS);
    *layer = (host_output)(HOST_LAYER + index);
    if (!create_output(device, target, *layer, name, error, error_size) ||
        !create_framebuffer(device, target, target->layer_pass, &target->images[*layer].view, 1,
                            &target->layer_framebuffers[index], error, error_size))
        return false;
    target->kept_layers |= kept ? 1u << index : 0;
    target->layer_count++;
    return true;
}

static bool create_parts(host_device *device, host_target *target, char *error, size_t error_size)
{
    host_output first;
    VkImageView plate[HOST_PLATE_COLORS + 1];
    for (int i = 0; i < HOST_LAYER; i++)
        if (!create_output(device, target, (host_output)i, outputs_table[i].name, error, error_size))
            return false;
    for (int i = 0; i <= HOST_PLATE_COLORS; i++)
        plate[i] = target->images[i].view;
    return create_plate_pass(device, 0, &target->plate_pass, error, error_size) &&
           create_plate_pass(device, HOST_PLATE_COLORS + 1, &target->over_pass, error, error_size) &&
           create_layer_passes(device, target, error, error_size) &&
           create_framebuffer(device, target, target->plate_pass, plate, HOST_PLATE_COLORS + 1,
                              &target->plate_framebuffer, error, error_size) &&
           host_target_add_layer(device, target, "layer", false, &first, error, error_size);
}

bool host_target_create(host_device *device, uint32_t width, uint32_t height, host_target *target, char *error,
                        size_t error_size)
{
    memset(target, 0, sizeof *target);
    uint32_t limit = device->properties.limits.maxImageDimension2D;
    if (width == 0 || height == 0 || width > limit || height > limit)
        return host_fail(error, error_size, "picture size %u x %u: expected 1 to %u on this device", width, height,
                         limit);
    target->width = width;
    target->height = height;
    if (create_parts(device, target, error, error_size))
        return true;
    host_target_destroy(device, target);
    return false;
}

bool host_target_add_behind(host_device *device, host_target *target, char *error, size_t error_size)
{
    const host_image_def def = {.format = LAYER_FORMAT,
                                .extent = {target->width, target->height, 1},
                                .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                         VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                .name = "behind layers"};
    return host_image_create(device, &def, &target->behind, error, error_size) &&
           create_framebuffer(device, target, target->behind_pass, &target->behind.view, 1, &target->behind_framebuffer,
                              error, error_size);
}

bool host_target_add_moving(host_device *device, host_target *target, char *error, size_t error_size)
{
    const host_image_def def = {.format = LAYER_FORMAT,
                                .extent = {target->width, target->height, 1},
                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                .name = "moving water"};
    if (!create_moving_pass(device, target, error, error_size) ||
        !host_image_create(device, &def, &target->moving, error, error_size))
        return false;
    const VkImageView views[2] = {target->moving.view, target->images[HOST_VELOCITY].view};
    return create_framebuffer(device, target, target->moving_pass, views, 2, &target->moving_framebuffer, error,
                              error_size);
}

void host_target_drop_focus(host_device *device, host_target *target)
{
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++) {
        vkDestroyFramebuffer(device->device, target->focused_framebuffers[i], NULL);
        target->focused_framebuffers[i] = VK_NULL_HANDLE;
        host_image_destroy(device, &target->focused[i]);
    }
    for (int i = 0; i < HOST_MAX_LAYERS; i++) {
        vkDestroyFramebuffer(device->device, target->depth_framebuffers[i], NULL);
        target->depth_framebuffers[i] = VK_NULL_HANDLE;
        host_image_destroy(device, &target->layer_depths[i]);
    }
    vkDestroyRenderPass(device->device, target->depth_pass, NULL);
    target->depth_pass = VK_NULL_HANDLE;
    host_image_destroy(device, &target->depth_color);
    host_buffer_destroy(device, &target->pick);
}

void host_target_destroy(host_device *device, host_target *target)
{
    host_target_drop_focus(device, target);
    vkDestroyFramebuffer(device->device, target->moving_framebuffer, NULL);
    vkDestroyRenderPass(device->device, target->moving_pass, NULL);
    host_image_destroy(device, &target->moving);
    vkDestroyFramebuffer(device->device, target->behind_framebuffer, NULL);
    vkDestroyRenderPass(device->device, target->behind_pass, NULL);
    host_image_destroy(device, &target->behind);
    for (int i = 0; i < HOST_MAX_LAYERS; i++)
        vkDestroyFramebuffer(device->device, target->layer_framebuffers[i], NULL);
    vkDestroyFramebuffer(device->device, target->plate_framebuffer, NULL);
    vkDestroyRenderPass(device->device, target->layer_pass, NULL);
    vkDestroyRenderPass(device->device, target->plate_pass, NULL);
    vkDestroyRenderPass(device->device, target->over_pass, NULL);
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++) {
        host_buffer_destroy(device, &target->copies[i]);
        host_image_destroy(device, &target->images[i]);
    }
    memset(target, 0, sizeof *target);
}

/* ---- recording ---------------------------------------------------------------------------------------------- */

void host_target_begin_plate(const host_target *target, VkCommandBuffer cmd)
{
    host_pass_begin(cmd, target->plate_pass, target->plate_framebuffer, target->width, target->height,
                    HOST_PLATE_COLORS);
}

void host_target_begin_over(const host_target *target, VkCommandBuffer cmd)
{
    host_pass_begin(cmd, target->over_pass, target->plate_framebuffer, target->width, target->height,
                    HOST_PLATE_COLORS);
}

void host_target_end_plate(const host_target *target, VkCommandBuffer cmd)
{
    (void)target;
    vkCmdEndRenderPass(cmd);
}

/* A barrier between the plate pass or a reader, and a copy from or to the plate's color. */
static void color_barrier(const host_target *target, VkCommandBuffer cmd, VkImageLayout from, VkImageLayout to,
                          VkAccessFlags access)
{
    const bool to_copy = to != VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | READERS;
    if (to_copy)
        host_image_barrier(cmd, &target->images[HOST_COLOR], from, to, drawing, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                           VK_PIPELINE_STAGE_TRANSFER_BIT, access);
    else
        host_image_barrier(cmd, &target->images[HOST_COLOR], from, to, VK_PIPELINE_STAGE_TRANSFER_BIT, access,
                           READERS | VK_PIPELINE_STAGE_TRANSFER_BIT,
                           VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT);
}

/* After the pass has cleared it. */
static void fill_depth(const host_target *target, VkCommandBuffer cmd, const host_buffer *depth)
{
    const host_image *image = &target->images[HOST_DEPTH];
    const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1},
                                      .imageExtent = image->extent};
    const VkPipelineStageFlags copying = VK_PIPELINE_STAGE_TRANSFER_BIT, readers = HOST_DEPTH_STAGES | READERS;
    VkImageLayout layout;
    is_sampled(HOST_DEPTH, &layout);
    host_image_barrier(cmd, image, layout, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, readers,
                       VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, copying, VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdCopyBufferToImage(cmd, depth->buffer, image->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    host_image_barrier(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout, copying, VK_ACCESS_TRANSFER_WRITE_BIT,
                       readers | copying,
                       VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                           VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT);
}

void host_target_fill_plate(const host_target *target, VkCommandBuffer cmd, const host_buffer *pixels,
                            const host_buffer *depth)
{
    const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageExtent = target->images[HOST_COLOR].extent};
    host_target_begin_plate(target, cmd);
    host_target_end_plate(target, cmd);
    color_barrier(target, cmd, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdCopyBufferToImage(cmd, pixels->buffer, target->images[HOST_COLOR].image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           1, &region);
    color_barrier(target, cmd, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                  VK_ACCESS_TRANSFER_WRITE_BIT);
    if (depth)
        fill_depth(target, cmd, depth);
}

/* The pass of layers clears; the pass of `behind` ignores the clear value. */
static void begin_pass(const host_target *target, VkCommandBuffer cmd, VkRenderPass pass, VkFramebuffer framebuffer)
{
    host_pass_begin(cmd, pass, framebuffer, target->width, target->height, 1);
}

void host_target_begin_output(const host_target *target, VkCommandBuffer cmd, host_output layer)
{
    begin_pass(target, cmd, target->layer_pass, target->layer_framebuffers[layer - HOST_LAYER]);
}

void host_target_begin_layer(const host_target *target, VkCommandBuffer cmd)
{
    host_target_begin_output(target, cmd, HOST_LAYER);
}

void host_target_begin_moving(const host_target *target, VkCommandBuffer cmd)
{
    begin_pass(target, cmd, target->moving_pass, target->moving_framebuffer);
}

void host_target_begin_behind(const host_target *target, VkCommandBuffer cmd)
{
    const VkImageSubresourceLayers all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageCopy region = {.srcSubresource = all, .dstSubresource = all, .extent = target->behind.extent};
    color_barrier(target, cmd, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                  VK_ACCESS_TRANSFER_READ_BIT);
    host_image_barrier(cmd, &target->behind, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, READERS,
                       0, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdCopyImage(cmd, target->images[HOST_COLOR].image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target->behind.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    color_barrier(target, cmd, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, 0);
    begin_pass(target, cmd, target->behind_pass, target->behind_framebuffer);
}

void host_target_end_layer(const host_target *target, VkCommandBuffer cmd)
{
    (void)target;
    vkCmdEndRenderPass(cmd);
}

static virga_image sampled(const host_target *target, host_output output)
{
    const host_image *image = &target->images[output];
    virga_image_state state = {.stage = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, .access = VK_ACCESS_SHADER_READ_BIT};
    is_sampled(output, &state.layout);
    return (virga_image){
        .image = image->image,
        .view = image->view,
        .format = image->format,
        .extent = image->extent,
        .layers = 1,
        .before = state,
        .after = state,
    };
}

virga_image host_target_depth(const host_target *target)
{
    return sampled(target, HOST_DEPTH);
}

virga_image host_target_color(const host_target *target)
{
    return sampled(target, HOST_COLOR);
}

virga_image host_target_behind(const host_target *target)
{
    const virga_image_state state = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, READERS, VK_ACCESS_SHADER_READ_BIT};
    return (virga_image){.image = target->behind.image,
                         .view = target->behind.view,
                         .format = target->behind.format,
                         .extent = target->behind.extent,
                         .layers = 1,
                         .before = state,
                         .after = state};
}

void host_target_describe_layer(const host_target *target, virga_target_def *def)
{
    def->kind = VIRGA_TARGET_RENDER_PASS;
    def->render_pass = target->layer_pass;
    def->subpass = 0;
    def->color_formats[0] = LAYER_FORMAT;
    def->color_count = 1;
    def->samples = VK_SAMPLE_COUNT_1_BIT;
    def->depth_attached = false; /* tested in the shader, see create_color_pass */
    def->reversed_depth = false;
}

void host_target_describe_moving(const host_target *target, virga_target_def *def)
{
    host_target_describe_layer(target, def);
    def->render_pass = target->moving_pass;
    def->color_formats[1] = host_output_format(HOST_VELOCITY);
    def->color_count = 2;
    def->motion_attachment = 1;
}

static void copy_image(const host_target *target, VkCommandBuffer cmd, host_output output)
{
    const host_image *image = host_target_shown(target, output);
    VkBufferImageCopy region = {
        .imageSubresource = {output == HOST_DEPTH ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .imageExtent = image->extent,
    };
    vkCmdCopyImageToBuffer(cmd, image->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target->copies[output].buffer, 1,
                           &region);
}

/* Whether the drawn image is copied, which may be in the layout for shaders. */
static bool is_drawn(const host_target *target, host_output output)
{
    return host_target_shown(target, output) == &target->images[output];
}

/* The drawn image into the layout for copies, and back. */
static void begin_drawn_copy(const host_target *target, VkCommandBuffer cmd, host_output output)
{
    VkImageLayout layout;
    if (is_sampled(output, &layout))
        host_image_barrier(cmd, &target->images[output], layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | HOST_DEPTH_STAGES | READERS,
                           VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                           VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
}

static void end_drawn_copy(const host_target *target, VkCommandBuffer cmd, host_output output)
{
    VkImageLayout layout;
    if (is_sampled(output, &layout))
        host_image_barrier(cmd, &target->images[output], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout,
                           VK_PIPELINE_STAGE_TRANSFER_BIT, 0, HOST_DEPTH_STAGES | READERS,
                           VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_SHADER_READ_BIT);
}

void host_target_copy_plate(const host_target *target, VkCommandBuffer cmd,
                            const host_image copies[HOST_PLATE_COLORS + 1])
{
    for (uint32_t i = 0; i <= HOST_PLATE_COLORS; i++) {
        const VkImageSubresourceLayers part = {i == HOST_DEPTH ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT,
                                               0, 0, 1};
        const VkImageCopy region = {.srcSubresource = part, .dstSubresource = part, .extent = copies[i].extent};
        begin_drawn_copy(target, cmd, (host_output)i);
        vkCmdCopyImage(cmd, target->images[i].image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copies[i].image,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        end_drawn_copy(target, cmd, (host_output)i);
    }
}

const host_image *host_target_shown(const host_target *target, host_output output)
{
    return target->in_focus && target->focused[output].image ? &target->focused[output] : &target->images[output];
}

void host_target_copy_out(const host_target *target, VkCommandBuffer cmd, uint32_t outputs)
{
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++) {
        if (!(outputs & (1u << i)) || !target->images[i].image)
            continue;
        const bool drawn = is_drawn(target, (host_output)i);
        if (drawn)
            begin_drawn_copy(target, cmd, (host_output)i);
        copy_image(target, cmd, (host_output)i);
        if (drawn)
            end_drawn_copy(target, cmd, (host_output)i);
    }
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_HOST_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
}

/* The depth is not summed, so it is not read here. */
void host_target_begin_read(const host_target *target, VkCommandBuffer cmd, host_output output)
{
    VkImageLayout layout;
    if (is_sampled(output, &layout) && is_drawn(target, output))
        return;
    host_image_barrier(cmd, host_target_shown(target, output), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, READERS, VK_ACCESS_SHADER_READ_BIT);
}

void host_target_end_read(const host_target *target, VkCommandBuffer cmd, host_output output)
{
    VkImageLayout layout;
    if (is_sampled(output, &layout) && is_drawn(target, output))
        return;
    host_image_barrier(cmd, host_target_shown(target, output), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, READERS, 0,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_TRANSFER_READ_BIT);
}

const float *host_target_floats(const host_device *device, const host_target *target, host_output output)
{
    host_buffer_invalidate(device, &target->copies[output]);
    return target->copies[output].mapped;
}

const uint32_t *host_target_ids(const host_device *device, const host_target *target)
{
    host_buffer_invalidate(device, &target->copies[HOST_ID]);
    return target->copies[HOST_ID].mapped;
}
