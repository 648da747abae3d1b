/* gpu/device_check.c - the requirements for a device, as tables, and the check of a device against them. */
#include "gpu/device_check.h"

#include "gpu/functions.h"

#include <stdio.h>
#include <string.h>

#define FEATURE_12(member, why)                                                                                    \
    {                                                                                                              \
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, offsetof(VkPhysicalDeviceVulkan12Features, member), \
            #member, why                                                                                           \
    }

static const virga_feature required[] = {
    {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
     offsetof(VkPhysicalDeviceFeatures2, features) + offsetof(VkPhysicalDeviceFeatures, independentBlend),
     "independentBlend", "drawing into the first of several attachments and leaving the others alone"},
    FEATURE_12(scalarBlockLayout, "structs shared by C and GLSL are laid out alike"),
};

/* Formats, and the features that they need with optimal tiling. */
static const struct {
    VkFormat format;
    VkFormatFeatureFlags features;
    const char *name, *what;
} formats[] = {
    {VK_FORMAT_D32_SFLOAT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT,
     "D32_SFLOAT", "a sampled depth attachment"},
    {VK_FORMAT_R32_UINT, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, "R32_UINT",
     "a sampled color attachment"},
};

const virga_feature *virga_required_features(uint32_t *count)
{
    if (count)
        *count = (uint32_t)(sizeof required / sizeof required[0]);
    return required;
}

/* The VkBool32 of a feature in a chain, or NULL if the chain has no such struct. */
static VkBool32 *find_flag(VkPhysicalDeviceFeatures2 *chain, const virga_feature *feature)
{
    for (VkBaseOutStructure *at = (VkBaseOutStructure *)chain; at; at = at->pNext)
        if (at->sType == feature->struct_type)
            return (VkBool32 *)((char *)at + feature->offset);
    return NULL;
}

virga_result virga_enable_features(VkPhysicalDeviceFeatures2 *chain)
{
    const uint32_t count = (uint32_t)(sizeof required / sizeof required[0]);
    for (uint32_t i = 0; i < count; i++)
        if (!find_flag(chain, &required[i]))
            return VIRGA_ERROR_INVALID;
    for (uint32_t i = 0; i < count; i++)
        *find_flag(chain, &required[i]) = VK_TRUE;
    return VIRGA_OK;
}

static virga_result refuse(char *reason, size_t size, const char *format, const char *a, const char *b)
{
    if (reason && size)
        snprintf(reason, size, format, a, b);
    return VIRGA_ERROR_UNSUPPORTED;
}

/* A log that stores the text of its newest line. */
typedef struct kept_line {
    char *text;
    size_t size;
} kept_line;

static void keep_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    const kept_line *line = user;
    (void)level;
    (void)id;
    if (line->text && line->size)
        snprintf(line->text, line->size, "%s", text);
}

static virga_result check_limits(const VkPhysicalDeviceLimits *limits, char *reason, size_t size)
{
    if (limits->maxComputeWorkGroupInvocations < 256 || limits->maxComputeWorkGroupSize[0] < 256)
        return refuse(reason, size, "%s%s", "has compute workgroups of fewer than 256 invocations", "");
    if (limits->maxPerStageDescriptorStorageBuffers < VIRGA_STORAGE_BUFFERS)
        return refuse(reason, size, "%s%s", "lets a shader see fewer than 16 storage buffers", "");
    return VIRGA_OK;
}

static virga_result check_features(const virga_functions *vk, VkPhysicalDevice device, char *reason, size_t size)
{
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12};
    vk->GetPhysicalDeviceFeatures2(device, &features);
    /* Every device of Vulkan 1.2 has these two. Asked through an older instance it seems to have no feature at all. */
    if (!features12.timelineSemaphore && !features12.hostQueryReset)
        return refuse(reason, size, "%s%s", "is asked through an instance that is older than Vulkan 1.2: ",
                      "set VkApplicationInfo::apiVersion to 1.2");
    for (size_t i = 0; i < sizeof required / sizeof required[0]; i++)
        if (!*find_flag(&features, &required[i]))
            return refuse(reason, size, "lacks the feature %s (%s)", required[i].name, required[i].why);
    return VIRGA_OK;
}

static virga_result check_formats(const virga_functions *vk, VkPhysicalDevice device, char *reason, size_t size)
{
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        VkFormatProperties properties;
        vk->GetPhysicalDeviceFormatProperties(device, formats[i].format, &properties);
        if ((properties.optimalTilingFeatures & formats[i].features) != formats[i].features)
            return refuse(reason, size, "can not use the format %s as %s", formats[i].name, formats[i].what);
    }
    return VIRGA_OK;
}

virga_result virga_check_device(PFN_vkGetInstanceProcAddr get_instance_proc_addr, VkInstance instance,
                                VkPhysicalDevice physical_device, char *reason, size_t reason_size)
{
    virga_functions vk;
    memset(&vk, 0, sizeof vk);
    if (!get_instance_proc_addr || !instance || !physical_device)
        return VIRGA_ERROR_INVALID;
    kept_line line = {reason, reason_size};
    const virga_log log = {keep_line, &line};
    if (virga_functions_load_instance(&vk, &log, get_instance_proc_addr, instance))
        return VIRGA_ERROR_UNSUPPORTED;

    VkPhysicalDeviceProperties properties;
    vk.GetPhysicalDeviceProperties(physical_device, &properties);
    if (properties.apiVersion < VIRGA_VULKAN_API) {
        char version[32];
        snprintf(version, sizeof version, "%u.%u", VK_API_VERSION_MAJOR(properties.apiVersion),
                 VK_API_VERSION_MINOR(properties.apiVersion));
        return refuse(reason, reason_size, "knows Vulkan %s, and %s is needed", version, "1.2");
    }
    virga_result result = check_limits(&properties.limits, reason, reason_size);
    if (!result)
        result = check_features(&vk, physical_device, reason, reason_size);
    return result ? result : check_formats(&vk, physical_device, reason, reason_size);
}
