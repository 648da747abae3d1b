/* stand_in_facts.c - what the stand-in says of itself: properties, features, formats, memory and queues. */
#include "stand_in_internal.h"

#include <stdio.h>
#include <string.h>

/* Handles of the instance and the devices: addresses of nothing in particular. */
static char handles[4];

VkInstance stand_in_instance(void)
{
    return stand_in.through ? stand_in.instance : (VkInstance)(void *)&handles[0];
}

VkPhysicalDevice stand_in_physical(void)
{
    return stand_in.through ? stand_in.physical : (VkPhysicalDevice)(void *)&handles[1];
}

VkDevice stand_in_device(uint32_t index)
{
    return stand_in.through ? stand_in.device : (VkDevice)(void *)&handles[2 + index % 2];
}

void stand_in_open(void)
{
    VkPhysicalDeviceProperties *p = &stand_in.properties;
    memset(&stand_in, 0, sizeof stand_in);
    stand_in_done(stand_in_submitted());
    p->apiVersion = VK_API_VERSION_1_2;
    p->vendorID = 0x10005;
    p->deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    snprintf(p->deviceName, sizeof p->deviceName, "stand-in");
    p->limits = (VkPhysicalDeviceLimits){.maxImageDimension2D = 16384,
                                         .maxImageDimension3D = 2048,
                                         .maxImageArrayLayers = 2048,
                                         .maxTexelBufferElements = 1 << 27,
                                         .maxUniformBufferRange = 65536,
                                         .maxStorageBufferRange = UINT32_MAX,
                                         .maxPushConstantsSize = 256,
                                         .bufferImageGranularity = 1024,
                                         .maxPerStageDescriptorStorageBuffers = 64,
                                         .maxComputeSharedMemorySize = 32768,
                                         .maxComputeWorkGroupCount = {65535, 65535, 65535},
                                         .maxComputeWorkGroupInvocations = 1024,
                                         .maxComputeWorkGroupSize = {1024, 1024, 64},
                                         .maxViewports = 16,
                                         .maxViewportDimensions = {16384, 16384},
                                         .viewportBoundsRange = {-32768, 32767},
                                         .minTexelBufferOffsetAlignment = 16,
                                         .minUniformBufferOffsetAlignment = 64,
                                         .minStorageBufferOffsetAlignment = 16,
                                         .maxFramebufferWidth = 16384,
                                         .maxFramebufferHeight = 16384,
                                         .maxFramebufferLayers = 1024,
                                         .maxColorAttachments = 8,
                                         .maxVertexInputBindingStride = 2048,
                                         .maxDrawIndexedIndexValue = (1 << 24) - 1,
                                         .timestampPeriod = 1,
                                         .lineWidthRange = {1, 8},
                                         .nonCoherentAtomSize = 64};
}

static VKAPI_ATTR void VKAPI_CALL properties(VkPhysicalDevice device, VkPhysicalDeviceProperties *out)
{
    (void)device;
    *out = stand_in.properties;
}

static VKAPI_ATTR void VKAPI_CALL properties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2 *out)
{
    properties(device, &out->properties);
    for (VkBaseOutStructure *at = out->pNext; at; at = at->pNext)
        if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_PROPERTIES)
            ((VkPhysicalDeviceMultiviewProperties *)(void *)at)->maxMultiviewViewCount = 6;
}

static VKAPI_ATTR void VKAPI_CALL features2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2 *out)
{
    (void)device;
    out->features = (VkPhysicalDeviceFeatures){.independentBlend = VK_TRUE, .wideLines = VK_TRUE};
    for (VkBaseOutStructure *at = out->pNext; at; at = at->pNext)
        if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) {
            VkPhysicalDeviceVulkan12Features *of_1_2 = (VkPhysicalDeviceVulkan12Features *)(void *)at;
            of_1_2->scalarBlockLayout = of_1_2->timelineSemaphore = of_1_2->hostQueryReset = VK_TRUE;
        } else if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES) {
            ((VkPhysicalDeviceMultiviewFeatures *)(void *)at)->multiview = VK_TRUE;
        }
}

static VKAPI_ATTR void VKAPI_CALL memory_properties(VkPhysicalDevice device, VkPhysicalDeviceMemoryProperties *out)
{
    const VkMemoryPropertyFlags visible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    (void)device;
    memset(out, 0, sizeof *out);
    out->memoryTypeCount = 3;
    out->memoryTypes[0] = (VkMemoryType){VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
    out->memoryTypes[1] = (VkMemoryType){visible | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, 1};
    out->memoryTypes[2] = (VkMemoryType){visible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, 1};
    out->memoryHeapCount = 2;
    out->memoryHeaps[0] = (VkMemoryHeap){(VkDeviceSize)4 << 30, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
    out->memoryHeaps[1] = (VkMemoryHeap){(VkDeviceSize)4 << 30, 0};
}

static bool is_one_of(VkFormat format, const VkFormat *all, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (all[i] == format)
            return true;
    return false;
}
#define IS_ONE_OF(format, all) is_one_of(format, all, sizeof(all) / sizeof(all)[0])

static VKAPI_ATTR void VKAPI_CALL format_properties(VkPhysicalDevice device, VkFormat format, VkFormatProperties *out)
{
    static const VkFormat colors[] = {VK_FORMAT_R8_UNORM,      VK_FORMAT_R8G8B8A8_UNORM,
                                      VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_UNORM,
                                      VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R16_SFLOAT,
                                      VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT,
                                      VK_FORMAT_R32_SFLOAT,    VK_FORMAT_R32G32B32A32_SFLOAT,
                                      VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_B10G11R11_UFLOAT_PACK32};
    static const VkFormat integers[] = {VK_FORMAT_R8_UINT, VK_FORMAT_R32_UINT, VK_FORMAT_R8G8B8A8_UINT,
                                        VK_FORMAT_R16G16_SINT};
    static const VkFormat depths[] = {VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D24_UNORM_S8_UINT,
                                      VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_S8_UINT};
    const VkFormatFeatureFlags sampled =
        VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    const VkFormatFeatureFlags written =
        sampled | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
    (void)device;
    memset(out, 0, sizeof *out);
    if (IS_ONE_OF(format, depths))
        out->optimalTilingFeatures = sampled | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if (IS_ONE_OF(format, integers))
        out->optimalTilingFeatures = written;
    if (IS_ONE_OF(format, colors))
        out->optimalTilingFeatures =
            written | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
}

/* Family 0 can do everything, family 1 only copies. */
static VKAPI_ATTR void VKAPI_CALL queue_families(VkPhysicalDevice device, uint32_t *count, VkQueueFamilyProperties *out)
{
    const VkQueueFamilyProperties all[2] = {
        {VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT, 1, 64, {1, 1, 1}},
        {VK_QUEUE_TRANSFER_BIT, 1, 0, {1, 1, 1}}};
    (void)device;
    *count = out && *count < 2 ? *count : 2;
    if (out)
        memcpy(out, all, *count * sizeof all[0]);
}

const stand_in_entry stand_in_facts[] = {
    {"vkGetPhysicalDeviceProperties", (PFN_vkVoidFunction)properties, false},
    {"vkGetPhysicalDeviceProperties2", (PFN_vkVoidFunction)properties2, false},
    {"vkGetPhysicalDeviceFeatures2", (PFN_vkVoidFunction)features2, false},
    {"vkGetPhysicalDeviceMemoryProperties", (PFN_vkVoidFunction)memory_properties, false},
    {"vkGetPhysicalDeviceFormatProperties", (PFN_vkVoidFunction)format_properties, false},
    {"vkGetPhysicalDeviceQueueFamilyProperties", (PFN_vkVoidFunction)queue_families, false},
};
const uint32_t stand_in_fact_count = sizeof stand_in_facts / sizeof stand_in_facts[0];
