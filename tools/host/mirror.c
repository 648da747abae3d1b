/* mirror.c - images and render passes of planar reflections. */
#include "mirror.h"

#include "passes.h"

#include <string.h>

static bool create_images(host_device *device, host_mirror *mirror, char *error, size_t error_size)
{
    host_image_def def = {
        .format = VK_FORMAT_R16G16B16A16_SFLOAT,
        .extent = {mirror->width, mirror->height, 1},
        .levels = host_mirror_level_count(mirror->width, mirror->height),
        .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
        .name = "mirror",
    };
    if (!host_image_create(device, &def, &mirror->color, error, error_size))
        return false;
    def.format = VK_FORMAT_R16_SFLOAT;
    def.levels = 1;
    def.name = "mirror near";
    if (!host_image_create(device, &def, &mirror->near, error, error_size))
        return false;
    def.format = VK_FORMAT_D32_SFLOAT;
    def.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    def.name = "mirror depth";
    return host_image_create(device, &def, &mirror->depth, error, error_size);
}

#define DRAWS VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT
#define READS VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT

static bool create_pass(host_device *device, host_mirror *mirror, char *error, size_t error_size)
{
    const VkAttachmentDescription attachments[] = {
        host_attachment(mirror->color.format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
        host_attachment(mirror->near.format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
        host_attachment(mirror->depth.format, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL),
    };
    const host_pass_def def = {
        .attachments = attachments,
        .color_count = 2,
        .depth = true,
        /* After the plate of the previous frame has sampled them. */
        .before = {READS | DRAWS | HOST_DEPTH_STAGES, HOST_DRAW_WRITES, DRAWS | HOST_DEPTH_STAGES,
                   HOST_DRAW_WRITES | HOST_DRAW_READS},
        .after = {DRAWS | HOST_DEPTH_STAGES, HOST_DRAW_WRITES, READS | DRAWS,
                  VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
                      VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT},
    };
    return host_pass_create(device, &def, &mirror->pass, error, error_size);
}

static bool create_haze_pass(host_device *device, host_mirror *mirror, char *error, size_t error_size)
{
    const VkImageLayout readable = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    VkAttachmentDescription attachment = host_attachment(mirror->color.format, readable);
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.initialLayout = readable;
    const host_pass_def def = {
        .attachments = &attachment,
        .color_count = 1,
        .before = {DRAWS, writes, DRAWS, writes | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT},
        .after = {DRAWS, writes, READS, VK_ACCESS_SHADER_READ_BIT},
    };
    return host_pass_create(device, &def, &mirror->haze_pass, error, error_size);
}

static bool create_framebuffers(host_device *device, host_mirror *mirror, char *error, size_t error_size)
{
    const VkImageView views[] = {mirror->levels.slices[0].view, mirror->near.view, mirror->depth.view};
    return host_framebuffer_create(device, mirror->pass, views, 3, mirror->width, mirror->height, &mirror->framebuffer,
                                   error, error_size) &&
           host_framebuffer_create(device, mirror->haze_pass, views, 1, mirror->width, mirror->height,
                                   &mirror->haze_framebuffer, error, error_size);
}

bool host_mirror_create(host_device *device, uint32_t width, uint32_t height, host_mirror *mirror, char *error,
                        size_t error_size)
{
    memset(mirror, 0, sizeof *mirror);
    mirror->width = width;
    mirror->height = height;
    if (create_images(device, mirror, error, error_size) && create_pass(device, mirror, error, error_size) &&
        create_haze_pass(device, mirror, error, error_size) &&
        host_mirror_levels_create(device, &mirror->color, &mirror->levels, error, error_size) &&
        create_framebuffers(device, mirror, error, error_size))
        return true;
    host_mirror_destroy(device, mirror);
    return false;
}

void host_mirror_destroy(host_device *device, host_mirror *mirror)
{
    vkDestroyFramebuffer(device->device, mirror->haze_framebuffer, NULL);
    vkDestroyRenderPass(device->device, mirror->haze_pass, NULL);
    vkDestroyFramebuffer(device->device, mirror->framebuffer, NULL);
    vkDestroyRenderPass(device->device, mirror->pass, NULL);
    host_mirror_levels_destroy(device, &mirror->levels);
    host_image_destroy(device, &mirror->depth);
    host_image_destroy(device, &mirror->near);
    host_image_destroy(device, &mirror->color);
    memset(mirror, 0, sizeof *mirror);
}

void host_mirror_begin(const host_mirror *mirror, VkCommandBuffer cmd)
{
    host_pass_begin(cmd, mirror->pass, mirror->framebuffer, mirror->width, mirror->height, 2);
}

void host_mirror_begin_haze(const host_mirror *mirror, VkCommandBuffer cmd)
{
    host_pass_begin(cmd, mirror->haze_pass, mirror->haze_framebuffer, mirror->width, mirror->height, 1);
}

void host_mirror_copy_down(const host_mirror *mirror, VkCommandBuffer cmd)
{
    host_mirror_levels_record(&mirror->levels, cmd, &mirror->color);
}
