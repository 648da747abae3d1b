/* window.c - GLFW's window and Vulkan's swapchain. */
#include "view/window.h"

#include "png.h"

#include <stdlib.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

/* ---- the window */

static bool glfw_fail(const char *what, char *error, size_t error_size)
{
    const char *reason = NULL;
    glfwGetError(&reason);
    return host_fail(error, error_size, "%s: %s", what, reason ? reason : "no reason given");
}

bool view_window_open(view_window *window, const char *title, uint32_t width, uint32_t height, char *error,
                      size_t error_size)
{
    memset(window, 0, sizeof *window);
    if (!glfwInit())
        return glfw_fail("no display to open a window on (xvfb-run gives a program one)", error, error_size);
    if (!glfwVulkanSupported())
        return glfw_fail("this display and the Vulkan loader do not go together", error, error_size);
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window->glfw = glfwCreateWindow((int)width, (int)height, title, NULL, NULL);
    if (!window->glfw)
        return glfw_fail("cannot open a window", error, error_size);
    glfwSetWindowSizeLimits(window->glfw, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
    return true;
}

const char *const *view_window_extensions(uint32_t *count)
{
    return glfwGetRequiredInstanceExtensions(count);
}

void view_window_close(view_window *window)
{
    if (window->glfw)
        glfwDestroyWindow(window->glfw);
    glfwTerminate();
    memset(window, 0, sizeof *window);
}

/* ---- what the surface can */

/* 8 bits without conversion: the shaders and the panel write display values. */
static bool choose_format(view_window *w, char *error, size_t error_size)
{
    VkSurfaceFormatKHR formats[64];
    uint32_t count = 64;
    const VkPhysicalDevice physical = w->device->physical;
    HOST_TRY(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, w->surface, &count, formats));
    for (uint32_t i = 0; i < count; i++) {
        const VkFormat format = formats[i].format;
        if (format != VK_FORMAT_B8G8R8A8_UNORM && format != VK_FORMAT_R8G8B8A8_UNORM)
            continue;
        w->format = formats[i];
        return true;
    }
    return host_fail(error, error_size, "the window's surface has no format of 8 bits that are shown as they are");
}

static bool check_present(const view_window *w, char *error, size_t error_size)
{
    VkBool32 supported = VK_FALSE;
    HOST_TRY(
        vkGetPhysicalDeviceSurfaceSupportKHR(w->device->physical, w->device->queue_family, w->surface, &supported));
    return supported || host_fail(error, error_size, "this device cannot show pictures in a window; try --device cpu");
}

static bool create_pass(view_window *w, char *error, size_t error_size)
{
    VkAttachmentDescription attachment = host_attachment(w->format.format, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE; /* all of it is drawn over */
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    const host_pass_def def = {
        .attachments = &attachment,
        .color_count = 1,
        /* after the semaphore of the acquire */
        .before = {drawing, 0, drawing, writes | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT},
        /* before a copy, see view_window_copy */
        .after = {drawing, writes, VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT},
    };
    return host_pass_create(w->device, &def, &w->pass, error, error_size);
}

/* ---- the swapchain */

static void drop_images(view_window *w)
{
    for (uint32_t i = 0; i < w->image_count; i++) {
        host_slice_destroy(w->device, &w->slices[i]);
        vkDestroySemaphore(w->device->device, w->drawn[i], NULL);
    }
    memset(w->slices, 0, sizeof w->slices);
    memset(w->drawn, 0, sizeof w->drawn);
    w->image_count = 0;
    host_buffer_destroy(w->device, &w->copy);
}

static bool create_image(view_window *w, uint32_t i, char *error, size_t error_size)
{
    const host_image image = {.image = w->images[i], .format = w->format.format, .extent = {w->width, w->height, 1}};
    if (!host_slice_create(w->device, w->pass, &image, 0, 0, &w->slices[i], error, error_size))
        return false;
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    HOST_TRY(vkCreateSemaphore(w->device->device, &semaphore, NULL, &w->drawn[i]));
    return true;
}

static uint32_t clamp_side(uint32_t wanted, uint32_t low, uint32_t high)
{
    return wanted < low ? low : wanted > high ? high : wanted;
}

/* The size of the surface, or, if the surface has none, that of the window. */
static void choose_size(view_window *w, const VkSurfaceCapabilitiesKHR *can)
{
    int width = 0, height = 0;
    w->width = can->currentExtent.width;
    w->height = can->currentExtent.height;
    if (w->width != UINT32_MAX)
        return;
    glfwGetFramebufferSize(w->glfw, &width, &height);
    w->width = width > 0 ? clamp_side((uint32_t)width, can->minImageExtent.width, can->maxImageExtent.width) : 0;
    w->height = height > 0 ? clamp_side((uint32_t)height, can->minImageExtent.height, can->maxImageExtent.height) : 0;
}

static bool create_swapchain(view_window *w, const VkSurfaceCapabilitiesKHR *can, char *error, size_t error_size)
{
    uint32_t count = can->minImageCount + 1;
    if (can->maxImageCount && count > can->maxImageCount)
        count = can->maxImageCount;
    w->copyable = can->supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const VkSwapchainKHR old = w->swapchain;
    const VkSwapchainCreateInfoKHR info = {.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                           .surface = w->surface,
                                           .minImageCount = count,
                                           .imageFormat = w->format.format,
                                           .imageColorSpace = w->format.colorSpace,
                                           .imageExtent = {w->width, w->height},
                                           .imageArrayLayers = 1,
                                           .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                         (w->copyable ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : 0u),
                                           .preTransform = can->currentTransform,
                                           .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                           .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                                           .clipped = VK_TRUE,
                                           .oldSwapchain = old};
    const VkResult made = vkCreateSwapchainKHR(w->device->device, &info, NULL, &w->swapchain);
    if (made != VK_SUCCESS)
        w->swapchain = VK_NULL_HANDLE;
    vkDestroySwapchainKHR(w->device->device, old, NULL);
    HOST_TRY(made);
    uint32_t got = VIEW_MAX_IMAGES;
    HOST_TRY(vkGetSwapchainImagesKHR(w->device->device, w->swapchain, &got, w->images));
    for (; w->image_count < got; w->image_count++)
        if (!create_image(w, w->image_count, error, error_size))
            return false;
    return true;
}

/* Creates a swapchain with the current size of the window; none while the size is 0. */
static bool remake(view_window *w, char *error, size_t error_size)
{
    VkSurfaceCapabilitiesKHR can;
    if (!host_wait(w->device, error, error_size))
        return false;
    HOST_TRY(vkQueueWaitIdle(w->device->queue)); /* for presents, which have no fence */
    drop_images(w);
    HOST_TRY(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(w->device->physical, w->surface, &can));
    choose_size(w, &can);
    w->stale = true;
    if (!w->width || !w->height) {
        w->width = w->height = 0;
        return true;
    }
    if (!create_swapchain(w, &can, error, error_size))
        return false;
    w->stale = false;
    return true;
}

bool view_window_attach(view_window *w, const host_instance *instance, host_device *device, char *error,
                        size_t error_size)
{
    w->device = device;
    w->instance = instance->instance;
    HOST_TRY(glfwCreateWindowSurface(w->instance, w->glfw, NULL, &w->surface));
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    for (uint32_t i = 0; i < HOST_FRAMES; i++)
        HOST_TRY(vkCreateSemaphore(device->device, &semaphore, NULL, &w->acquired[i]));
    return check_present(w, error, error_size) && choose_format(w, error, error_size) &&
           create_pass(w, error, error_size) && remake(w, error, error_size);
}

void view_window_detach(view_window *w)
{
    if (!w->device)
        return;
    vkDeviceWaitIdle(w->device->device);
    drop_images(w);
    for (uint32_t i = 0; i < HOST_FRAMES; i++)
        vkDestroySemaphore(w->device->device, w->acquired[i], NULL);
    vkDestroyRenderPass(w->device->device, w->pass, NULL);
    vkDestroySwapchainKHR(w->device->device, w->swapchain, NULL);
    vkDestroySurfaceKHR(w->instance, w->surface, NULL);
    w->device = NULL;
}

/* ---- a frame */

bool view_window_acquire(view_window *w, bool *ready, char *error, size_t error_size)
{
    int width, height;
    *ready = false;
    glfwGetFramebufferSize(w->glfw, &width, &height);
    if (w->stale || (uint32_t)width != w->width || (uint32_t)height != w->height)
        if (!remake(w, error, error_size))
            return false;
    if (!w->width)
        return true;
    /* The frame that last used this semaphore has completed once its slot in the ring is free again. */
    const VkSemaphore semaphore = w->acquired[(w->device->frame + 1) % HOST_FRAMES];
    if (w->device->frame >= HOST_FRAMES &&
        !host_wait_frame(w->device, w->device->frame + 1 - HOST_FRAMES, error, error_size))
        return false;
    const VkResult got =
        vkAcquireNextImageKHR(w->device->device, w->swapchain, UINT64_MAX, semaphore, VK_NULL_HANDLE, &w->image);
    w->stale = got == VK_ERROR_OUT_OF_DATE_KHR || got == VK_SUBOPTIMAL_KHR;
    *ready = got == VK_SUCCESS || got == VK_SUBOPTIMAL_KHR;
    if (!*ready && !w->stale)
        HOST_TRY(got);
    return true;
}

void view_window_begin(const view_window *w, VkCommandBuffer cmd)
{
    host_pass_begin(cmd, w->pass, w->slices[w->image].framebuffer, w->width, w->height, 1);
}

void view_window_end(const view_window *w, VkCommandBuffer cmd)
{
    (void)w;
    vkCmdEndRenderPass(cmd);
}

bool view_window_present(view_window *w, char *error, size_t error_size)
{
    const VkSemaphore acquired = w->acquired[w->device->frame % HOST_FRAMES];
    if (!host_submit_for_window(w->device, acquired, w->drawn[w->image], error, error_size))
        return false;
    const VkPresentInfoKHR info = {.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                   .waitSemaphoreCount = 1,
                                   .pWaitSemaphores = &w->drawn[w->image],
                                   .swapchainCount = 1,
                                   .pSwapchains = &w->swapchain,
                                   .pImageIndices = &w->image};
    const VkResult shown = vkQueuePresentKHR(w->device->queue, &info);
    if (shown == VK_ERROR_OUT_OF_DATE_KHR || shown == VK_SUBOPTIMAL_KHR) {
        w->stale = true;
        return true;
    }
    HOST_TRY(shown);
    return true;
}

/* ---- its picture */

static void turn_image(const view_window *w, VkCommandBuffer cmd, VkImageLayout from, VkImageLayout to)
{
    const bool back = to == VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    const VkImageMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                          .srcAccessMask = back ? 0u : VK_ACCESS_TRANSFER_WRITE_BIT,
                                          .dstAccessMask = back ? 0u : VK_ACCESS_TRANSFER_READ_BIT,
                                          .oldLayout = from,
                                          .newLayout = to,
                                          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .image = w->images[w->image],
                                          .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         back ? VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT : VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0,
                         NULL, 1, &barrier);
}

bool view_window_copy(view_window *w, VkCommandBuffer cmd, char *error, size_t error_size)
{
    if (!w->copyable)
        return host_fail(error, error_size, "this window's pictures cannot be read back");
    if (!w->copy.buffer &&
        !host_buffer_create(w->device, (VkDeviceSize)w->width * w->height * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                            HOST_BUFFER_READBACK, "window copy", &w->copy, error, error_size))
        return false;
    const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                      .imageExtent = {w->width, w->height, 1}};
    turn_image(w, cmd, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(cmd, w->images[w->image], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, w->copy.buffer, 1, &region);
    turn_image(w, cmd, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
    return true;
}

bool view_window_write(view_window *w, const char *path, char *error, size_t error_size)
{
    const size_t pixels = (size_t)w->width * w->height;
    const bool swapped = w->format.format == VK_FORMAT_B8G8R8A8_UNORM;
    uint8_t *rgb = w->copy.buffer ? malloc(pixels * 3) : NULL;
    if (!rgb)
        return host_fail(error, error_size, "%s: no picture of the window was read back", path);
    host_buffer_invalidate(w->device, &w->copy);
    const uint8_t *from = w->copy.mapped;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            rgb[i * 3 + c] = from[i * 4 + (swapped ? 2 - c : c)];
    const bool written = png_write(path, w->width, w->height, 3, rgb, error, error_size);
    free(rgb);
    return written;
}
