/* stage_images.c - the images whose size is that of the window: the swapchain or a picture, color, depth, and what is
 * behind water. They are created again when the size changes; there are none while the window is minimised. */
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include "stage_internal.h"

#include <string.h>

bool stage_images_choose(stage *s, char *error, size_t error_size)
{
    s->show_format = VK_FORMAT_R8G8B8A8_SRGB;
    if (!s->window)
        return true;
    VkSurfaceFormatKHR formats[64];
    uint32_t count = 64;
    HOST_TRY(vkGetPhysicalDeviceSurfaceFormatsKHR(s->device->physical, s->surface, &count, formats));
    for (uint32_t i = 0; i < count; i++)
        if (formats[i].format == VK_FORMAT_B8G8R8A8_SRGB || formats[i].format == VK_FORMAT_R8G8B8A8_SRGB) {
            s->show_format = formats[i].format;
            return true;
        }
    return host_fail(error, error_size, "the window takes no sRGB format");
}

static bool create_swapchain(stage *s, const VkSurfaceCapabilitiesKHR *can, char *error, size_t error_size)
{
    const uint32_t max_count = can->maxImageCount ? can->maxImageCount : STAGE_IMAGES;
    const uint32_t wanted = can->minImageCount + 1;
    VkSwapchainCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = s->surface,
        .minImageCount = wanted < max_count ? wanted : max_count,
        .imageFormat = s->show_format,
        .imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR,
        .imageExtent = {s->width, s->height},
        .imageArrayLayers = 1,
        .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
        .preTransform = can->currentTransform,
        .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
        .presentMode = VK_PRESENT_MODE_FIFO_KHR, /* always supported */
        .clipped = VK_TRUE,
    };
    HOST_TRY(vkCreateSwapchainKHR(s->device->device, &info, NULL, &s->swapchain));
    s->image_count = STAGE_IMAGES;
    HOST_TRY(vkGetSwapchainImagesKHR(s->device->device, s->swapchain, &s->image_count, s->images));
    for (uint32_t i = 0; i < s->image_count; i++) {
        VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
        HOST_TRY(vkCreateSemaphore(s->device->device, &semaphore, NULL, &s->finished[i]));
    }
    return true;
}

static bool create_image(stage *s, VkFormat format, VkImageUsageFlags usage, const char *name, host_image *image,
                         char *error, size_t error_size)
{
    const host_image_def def = {.format = format, .extent = {s->width, s->height, 1}, .usage = usage, .name = name};
    return host_image_create(s->device, &def, image, error, error_size);
}

static bool create_framebuffer(stage *s, VkRenderPass pass, const VkImageView *views, uint32_t count,
                               VkFramebuffer *framebuffer, char *error, size_t error_size)
{
    return host_framebuffer_create(s->device, pass, views, count, s->width, s->height, framebuffer, error, error_size);
}

/* What is shown: the images of the swapchain, or the picture. */
static bool create_slices(stage *s, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < s->image_count; i++) {
        const host_image of_window = {
            .image = s->images[i], .format = s->show_format, .extent = {s->width, s->height, 1}};
        if (!host_slice_create(s->device, s->show_pass, s->window ? &of_window : &s->picture, 0, 0, &s->slices[i],
                               error, error_size))
            return false;
    }
    return true;
}

static bool create_images(stage *s, char *error, size_t error_size)
{
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT, drawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    if (!create_image(s, VK_FORMAT_R16G16B16A16_SFLOAT, drawn | sampled | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                      "drive color", &s->color, error, error_size) ||
        !create_image(s, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | sampled, "drive depth",
                      &s->depth, error, error_size) ||
        !create_image(s, VK_FORMAT_R16G16B16A16_SFLOAT, sampled | VK_IMAGE_USAGE_TRANSFER_DST_BIT, "drive behind",
                      &s->behind, error, error_size) ||
        !create_image(s, VK_FORMAT_R16G16B16A16_SFLOAT, sampled | VK_IMAGE_USAGE_TRANSFER_DST_BIT, "drive through",
                      &s->through, error, error_size))
        return false;
    const VkImageView views[2] = {s->color.view, s->depth.view};
    if (!create_framebuffer(s, s->world_pass, views, 2, &s->world_framebuffer, error, error_size) ||
        !create_framebuffer(s, s->over_pass, views, 1, &s->over_framebuffer, error, error_size))
        return false;
    if (!s->window) {
        if (!create_image(s, s->show_format, drawn | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, "drive picture", &s->picture,
                          error, error_size) ||
            !host_buffer_create(s->device, (VkDeviceSize)s->width * s->height * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                HOST_BUFFER_READBACK, "drive copy", &s->copy, error, error_size))
            return false;
        s->image_count = 1;
    }
    return create_slices(s, error, error_size);
}

void stage_images_destroy(stage *s)
{
    const VkDevice device = s->device->device;
    vkDestroyFramebuffer(device, s->world_framebuffer, NULL);
    vkDestroyFramebuffer(device, s->over_framebuffer, NULL);
    for (uint32_t i = 0; i < s->image_count; i++) {
        host_slice_destroy(s->device, &s->slices[i]);
        vkDestroySemaphore(device, s->finished[i], NULL);
    }
    if (s->swapchain)
        vkDestroySwapchainKHR(device, s->swapchain, NULL);
    s->swapchain = VK_NULL_HANDLE;
    s->world_framebuffer = s->over_framebuffer = VK_NULL_HANDLE;
    memset(s->slices, 0, sizeof s->slices);
    memset(s->finished, 0, sizeof s->finished);
    s->image_count = 0;
    host_image_destroy(s->device, &s->color);
    host_image_destroy(s->device, &s->depth);
    host_image_destroy(s->device, &s->behind);
    host_image_destroy(s->device, &s->through);
    host_image_destroy(s->device, &s->picture);
    host_buffer_destroy(s->device, &s->copy);
}

/* Waits, because frames in flight use the old images. */
bool stage_images_again(stage *s, bool *resized, char *error, size_t error_size)
{
    int width = (int)s->width, height = (int)s->height;
    VkSurfaceCapabilitiesKHR can;
    if (!host_wait(s->device, error, error_size))
        return false;
    HOST_TRY(vkDeviceWaitIdle(s->device->device)); /* for presents too */
    stage_images_destroy(s);
    s->has_last = false;
    if (s->window) {
        glfwGetFramebufferSize(s->window, &width, &height);
        HOST_TRY(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(s->device->physical, s->surface, &can));
        if (can.currentExtent.width != UINT32_MAX) {
            width = (int)can.currentExtent.width;
            height = (int)can.currentExtent.height;
        }
    }
    s->width = width > 0 && height > 0 ? (uint32_t)width : 0;
    s->height = s->width ? (uint32_t)height : 0;
    if (!s->width)
        return true;
    *resized = true;
    return (!s->window || create_swapchain(s, &can, error, error_size)) && create_images(s, error, error_size);
}

bool stage_images_fit(stage *s, bool *resized, char *error, size_t error_size)
{
    if (!s->window)
        return s->color.image || stage_images_again(s, resized, error, error_size);
    int width, height;
    glfwGetFramebufferSize(s->window, &width, &height);
    if (width <= 0 || height <= 0) {
        s->width = s->height = 0;
        return true;
    }
    return (s->swapchain && (uint32_t)width == s->width && (uint32_t)height == s->height) ||
           stage_images_again(s, resized, error, error_size);
}
