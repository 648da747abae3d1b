/* window.c - Vulkan's instance, and the window. */
#include "game.h"

#define MAX_WINDOW_EXTENSIONS 8

bool open_window(drive *d)
{
    char *error = d->error;
    const size_t error_size = sizeof d->error;
    uint32_t count = 0;
    const char **requested = d->chosen.out ? NULL : glfwGetRequiredInstanceExtensions(&count);
    const char *extensions[MAX_WINDOW_EXTENSIONS + 1];
    count = count < MAX_WINDOW_EXTENSIONS ? count : MAX_WINDOW_EXTENSIONS;
    for (uint32_t i = 0; i < count; i++)
        extensions[i] = requested[i];
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .pApplicationName = "drive", .apiVersion = VIRGA_VULKAN_API};
    VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pApplicationInfo = &application,
        .enabledExtensionCount = count,
        .ppEnabledExtensionNames = extensions,
    };
    host_request_portability(&info, extensions);
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

void close_window(drive *d)
{
    if (d->surface)
        vkDestroySurfaceKHR(d->instance, d->surface, NULL);
    if (d->window)
        glfwDestroyWindow(d->window);
    if (d->instance)
        vkDestroyInstance(d->instance, NULL);
}
