/* device_list.c - which devices there are, why one cannot be used, and which one is chosen. */
#include "device_list.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <virga/vulkan.h>

const char *host_device_type_name(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return "software";
    default: return "other";
    }
}

static bool has_extension(VkPhysicalDevice physical, const char *name)
{
    uint32_t count = 0;
    if (vkEnumerateDeviceExtensionProperties(physical, NULL, &count, NULL) != VK_SUCCESS || count == 0)
        return false;
    VkExtensionProperties *extensions = calloc(count, sizeof *extensions);
    bool found = false;
    if (extensions && vkEnumerateDeviceExtensionProperties(physical, NULL, &count, extensions) >= 0)
        for (uint32_t i = 0; i < count && !found; i++)
            found = strcmp(extensions[i].extensionName, name) == 0;
    free(extensions);
    return found;
}

uint32_t host_device_extensions(VkPhysicalDevice physical, bool presents, const char *names[HOST_DEVICE_EXTENSIONS])
{
    static const char portability[] = "VK_KHR_portability_subset"; /* its macro is among the beta extensions' */
    uint32_t count = 0;
    if (presents)
        names[count++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    if (has_extension(physical, portability))
        names[count++] = portability;
    return count;
}

/* The device with the smallest rank is chosen. */
static int rank(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return 4;
    default: return 3;
    }
}

static bool find_queue_family(VkPhysicalDevice physical, uint32_t *family)
{
    const VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    VkQueueFamilyProperties families[32];
    uint32_t count = 32;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t i = 0; i < count; i++) {
        if ((families[i].queueFlags & needed) == needed) {
            *family = i;
            return true;
        }
    }
    return false;
}

/* A format that the host's targets and textures need and the device lacks, or NULL. */
static const char *missing_format(VkPhysicalDevice physical)
{
    static const struct {
        VkFormat format;
        VkFormatFeatureFlags features;
        const char *what;
    } needs[] = {
        {VK_FORMAT_R32G32B32A32_SFLOAT,
         VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT,
         "blending into R32G32B32A32_SFLOAT is not supported"},
        {VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT,
         "blending into R32G32_SFLOAT is not supported"},
        {VK_FORMAT_D32_SFLOAT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT,
         "D32_SFLOAT cannot be drawn to and sampled"},
    };
    for (size_t i = 0; i < sizeof needs / sizeof *needs; i++) {
        VkFormatProperties properties;
        vkGetPhysicalDeviceFormatProperties(physical, needs[i].format, &properties);
        if ((properties.optimalTilingFeatures & needs[i].features) != needs[i].features)
            return needs[i].what;
    }
    return NULL;
}

static void check(const host_instance *instance, host_device_info *info)
{
    const char *format = NULL;
    info->usable = false;
    if (virga_check_device(vkGetInstanceProcAddr, instance->instance, info->physical, info->reason,
                           sizeof info->reason) < 0)
        return;
    if (!find_queue_family(info->physical, &info->queue_family))
        snprintf(info->reason, sizeof info->reason, "no queue does both graphics and compute");
    else if ((format = missing_format(info->physical)))
        snprintf(info->reason, sizeof info->reason, "%s", format);
    else {
        info->usable = true;
        info->reason[0] = 0;
    }
}

static void describe(VkPhysicalDevice physical, host_device_info *info)
{
    memset(info, 0, sizeof *info);
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    info->physical = physical;
    info->type = properties.deviceType;
    info->api_version = properties.apiVersion;
    snprintf(info->name, sizeof info->name, "%s", properties.deviceName);
    snprintf(info->driver, sizeof info->driver, "unknown");
    if (properties.apiVersion >= VK_API_VERSION_1_2) {
        VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
        VkPhysicalDeviceProperties2 both = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
        vkGetPhysicalDeviceProperties2(physical, &both);
        snprintf(info->driver, sizeof info->driver, "%s, %s", driver.driverName, driver.driverInfo);
    }
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    for (uint32_t i = 0; i < memory.memoryHeapCount; i++)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            info->memory_bytes += memory.memoryHeaps[i].size;
}

uint32_t host_devices_list(const host_instance *instance, host_device_info *infos, uint32_t capacity)
{
    VkPhysicalDevice devices[HOST_MAX_DEVICES];
    uint32_t count = HOST_MAX_DEVICES;
    if (vkEnumeratePhysicalDevices(instance->instance, &count, devices) < 0)
        return 0;
    if (count > capacity)
        count = capacity;
    for (uint32_t i = 0; i < count; i++) {
        describe(devices[i], &infos[i]);
        check(instance, &infos[i]);
    }
    return count;
}

/* Whether `part` is in `text`, in any case. */
static bool contains(const char *text, const char *part)
{
    for (; *text; text++) {
        size_t i = 0;
        while (part[i] && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i]))
            i++;
        if (!part[i])
            return true;
    }
    return false;
}

static bool matches(const host_device_info *info, const char *wanted)
{
    if (!wanted)
        return true;
    bool software = info->type == VK_PHYSICAL_DEVICE_TYPE_CPU;
    if (strcmp(wanted, "cpu") == 0)
        return software;
    if (strcmp(wanted, "gpu") == 0)
        return !software;
    return contains(info->name, wanted);
}

/* "no device 7: there is only 0, cpu", or "there are 0, gpu; 1, cpu": the values of --device. */
static bool refuse_number(const host_device_info *infos, uint32_t count, const char *wanted, char *error,
                          size_t error_size)
{
    char list[256] = "";
    for (uint32_t i = 0; i < count; i++) {
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%u, %s", i ? "; " : "", i,
                 matches(&infos[i], "cpu") ? "cpu" : "gpu");
    }
    return host_fail(error, error_size, "no device %s: there %s %s", wanted, count == 1 ? "is only" : "are", list);
}

static bool pick_number(const host_device_info *infos, uint32_t count, const char *wanted, uint32_t *index, char *error,
                        size_t error_size)
{
    unsigned long number = strtoul(wanted, NULL, 10);
    if (number >= count)
        return refuse_number(infos, count, wanted, error, error_size);
    if (!infos[number].usable)
        return host_fail(error, error_size, "device %s (%s) cannot be used: %s", wanted, infos[number].name,
                         infos[number].reason);
    *index = (uint32_t)number;
    return true;
}

bool host_device_pick(const host_device_info *infos, uint32_t count, const char *wanted, uint32_t *index, char *error,
                      size_t error_size)
{
    if (count == 0)
        return host_fail(error, error_size, "no Vulkan device: install a driver, e.g. mesa-vulkan-drivers");
    if (wanted && *wanted && strspn(wanted, "0123456789") == strlen(wanted))
        return pick_number(infos, count, wanted, index, error, error_size);

    uint32_t best = count, refused = count;
    for (uint32_t i = 0; i < count; i++) {
        if (!matches(&infos[i], wanted))
            continue;
        if (!infos[i].usable)
            refused = i;
        else if (best == count || rank(infos[i].type) < rank(infos[best].type))
            best = i;
    }
    if (best < count) {
        *index = best;
        return true;
    }
    if (refused < count)
        return host_fail(error, error_size, "%s cannot be used: %s", infos[refused].name, infos[refused].reason);
    return host_fail(error, error_size, "no device matches \"%s\"; the devices are listed by: virga info",
                     wanted ? wanted : "");
}
