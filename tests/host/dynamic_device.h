/* dynamic_device.h - devices of this program have dynamic rendering, if it is supported. */
#ifndef VIRGA_TESTS_DYNAMIC_DEVICE_H
#define VIRGA_TESTS_DYNAMIC_DEVICE_H

#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <vulkan/vulkan.h>

static bool dynamic_rendering_there;
static PFN_vkCmdBeginRenderingKHR begin_rendering;
static PFN_vkCmdEndRenderingKHR end_rendering;

static inline bool has_dynamic_rendering(VkPhysicalDevice physical)
{
    uint32_t count = 0;
    bool found = false;
    vkEnumerateDeviceExtensionProperties(physical, NULL, &count, NULL);
    VkExtensionProperties *all = calloc(count + 1, sizeof *all);
    vkEnumerateDeviceExtensionProperties(physical, NULL, &count, all);
    for (uint32_t i = 0; i < count; i++)
        found = found || !strcmp(all[i].extensionName, VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME);
    free(all);
    return found;
}

/* Replaces the loader's: tools/host enables only what it uses, and it does not use dynamic rendering. */
VKAPI_ATTR VkResult VKAPI_CALL vkCreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo *info,
                                              const VkAllocationCallbacks *allocator, VkDevice *device)
{
    static const char *const names[] = {VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME};
    PFN_vkCreateDevice create = NULL;
    void *symbol = dlsym(RTLD_NEXT, "vkCreateDevice");
    memcpy(&create, &symbol, sizeof create);
    dynamic_rendering_there = has_dynamic_rendering(physical) && !info->enabledExtensionCount;
    if (!dynamic_rendering_there)
        return create(physical, info, allocator, device);
    VkPhysicalDeviceDynamicRenderingFeatures feature = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES, .dynamicRendering = VK_TRUE};
    feature.pNext = (void *)(uintptr_t)info->pNext;
    VkDeviceCreateInfo more = *info;
    more.pNext = &feature;
    more.enabledExtensionCount = 1;
    more.ppEnabledExtensionNames = names;
    const VkResult result = create(physical, &more, allocator, device);
    if (result == VK_SUCCESS) {
        begin_rendering = (PFN_vkCmdBeginRenderingKHR)vkGetDeviceProcAddr(*device, "vkCmdBeginRenderingKHR");
        end_rendering = (PFN_vkCmdEndRenderingKHR)vkGetDeviceProcAddr(*device, "vkCmdEndRenderingKHR");
    }
    return result;
}

#endif
