/* window.c - Vulkan's instance, the window, and frames in flight: what every host has. */
#include "game.h"

#define MOST_WINDOW_EXTENSIONS 8

bool open_window(drive *d)
{
    char *error = d->error;
    const size_t error_size = sizeof d->error;
    uint32_t count = 0;
    const char **asked = d->chosen.out ? NULL : glfwGetRequiredInstanceExtensions(&count);
    const char *extensions[MOST_WINDOW_EXTENSIONS + 1];
    count = count < MOST_WINDOW_EXTENSIONS ? count : MOST_WINDOW_EXTENSIONS;
    for (uint32_t i = 0; i < count; i++)
        extensions[i] = asked[i];
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .pApplicationName = "drive", .apiVersion = VIRGA_VULKAN_API};
    VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pApplicationInfo = &application,
        .enabledExtensionCount = count,
        .ppEnabledExtensionNames = extensions,
    };
    host_ask_portability(&info, extensions);
    HOST_TRY(vkCreateInstance(&info, NULL, &d->instance));
    d->listed.instance = d->instance;
    if (!d->chosen.out) {
        d->window = glfwCreateWindow((int)d->chosen.width, (int)d->chosen.height, "drive", NULL, NULL);
        if (!d->window)
            return host_fail(error, error_size, "no window");
        HOST_TRY(glfwCreateWindowSurface(d->instance, d->window, NULL, &d->surface));
    }
    return true;
}

/* Two frames in flight, each with a command buffer and a fence. */
bool create_frames(drive *d, const host_device_info *chosen)
{
    char *error = d->error;
    const size_t error_size = sizeof d->error;
    host_device *device = &d->device;
    device->instance = &d->listed;
    device->physical = chosen->physical;
    device->queue_family = chosen->queue_family;
    device->independent_blend = true; /* glass is blended: one attachment needs no feature for it */
    vkGetPhysicalDeviceProperties(device->physical, &device->properties);
    vkGetPhysicalDeviceMemoryProperties(device->physical, &device->memory);
    vkGetDeviceQueue(device->device, device->queue_family, 0, &device->queue);
    for (uint32_t i = 0; i < HOST_FRAMES; i++) {
        host_frame *frame = &device->frames[i];
        const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                              .queueFamilyIndex = device->queue_family};
        HOST_TRY(vkCreateFence(device->device, &fence, NULL, &frame->fence));
        HOST_TRY(vkCreateCommandPool(device->device, &pool, NULL, &frame->pool));
        const VkCommandBufferAllocateInfo cmd = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                 .commandPool = frame->pool,
                                                 .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                 .commandBufferCount = 1};
        HOST_TRY(vkAllocateCommandBuffers(device->device, &cmd, &frame->cmd));
    }
    return true;
}

void close_window(drive *d)
{
    if (d->surface)
        vkDestroySurfaceKHR(d->instance, d->surface, NULL);
    if (d->window)
        glfwDestroyWindow(d->window);
    if (d->instance)
        vkDestroyInstance(d->instance, NULL);
}
