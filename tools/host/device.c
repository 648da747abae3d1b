/* device.c - the logical device with one queue, and the ring of command buffers that frames are recorded into. */
#include "device.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <virga/vulkan.h>

#define ANISOTROPY 8.0f
#define ANISOTROPY_SOFTWARE \
    4.0f /* good enough for a road; the plate already costs two to three times as much as without */

/* Enables optional features that the device has. virga_enable_features sets what Virga requires. */
static void enable_optional(host_device *device, VkPhysicalDeviceFeatures *enabled)
{
    VkPhysicalDeviceFeatures available;
    vkGetPhysicalDeviceFeatures(device->physical, &available);
    device->independent_blend = available.independentBlend;
    enabled->independentBlend = available.independentBlend;
    device->clip_distance = available.shaderClipDistance;
    enabled->shaderClipDistance = available.shaderClipDistance;
    /* For the benches, which count what shaders do. */
    enabled->fragmentStoresAndAtomics = available.fragmentStoresAndAtomics;
    enabled->vertexPipelineStoresAndAtomics = available.vertexPipelineStoresAndAtomics;
    device->wide_lines = available.wideLines;
    enabled->wideLines = available.wideLines;
    if (available.samplerAnisotropy) {
        enabled->samplerAnisotropy = VK_TRUE;
        bool software = device->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
        float limit = device->properties.limits.maxSamplerAnisotropy, wanted = ANISOTROPY;
        if (software)
            wanted = ANISOTROPY_SOFTWARE;
        device->anisotropy = limit < wanted ? limit : wanted;
    }
}

static bool create_logical(host_device *device, VkDevice *made, char *error, size_t error_size)
{
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12};
    virga_result result = virga_enable_features(&features);
    if (result < 0)
        return host_fail(error, error_size, "virga_enable_features gave %s", virga_result_name(result));
    enable_optional(device, &features.features);

    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = device->queue_family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    const char *extensions[HOST_DEVICE_EXTENSIONS];
    const uint32_t extension_count = host_device_extensions(device->physical, device->instance->presents, extensions);
    VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &features,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = extension_count,
        .ppEnabledExtensionNames = extensions,
    };
    HOST_TRY(vkCreateDevice(device->physical, &info, NULL, made));
    return true;
}

static bool create_frames(host_device *device, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < HOST_FRAMES; i++) {
        host_frame *frame = &device->frames[i];
        VkCommandPoolCreateInfo pool = {
            .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
            .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
            .queueFamilyIndex = device->queue_family,
        };
        HOST_TRY(vkCreateCommandPool(device->device, &pool, NULL, &frame->pool));
        VkCommandBufferAllocateInfo allocate = {
            .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
            .commandPool = frame->pool,
            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
            .commandBufferCount = 1,
        };
        HOST_TRY(vkAllocateCommandBuffers(device->device, &allocate, &frame->cmd));
        VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        HOST_TRY(vkCreateFence(device->device, &fence, NULL, &frame->fence));
    }
    return true;
}

static void load_debug_functions(host_device *device)
{
    VkInstance vk = device->instance->instance;
    device->set_name = (PFN_vkSetDebugUtilsObjectNameEXT)vkGetInstanceProcAddr(vk, "vkSetDebugUtilsObjectNameEXT");
    device->begin_label = (PFN_vkCmdBeginDebugUtilsLabelEXT)vkGetInstanceProcAddr(vk, "vkCmdBeginDebugUtilsLabelEXT");
    device->end_label = (PFN_vkCmdEndDebugUtilsLabelEXT)vkGetInstanceProcAddr(vk, "vkCmdEndDebugUtilsLabelEXT");
}

static void describe(host_device *device, const host_instance *instance, const host_device_info *info)
{
    memset(device, 0, sizeof *device);
    device->instance = instance;
    device->physical = info->physical;
    device->queue_family = info->queue_family;
    vkGetPhysicalDeviceProperties(info->physical, &device->properties);
    vkGetPhysicalDeviceMemoryProperties(info->physical, &device->memory);
}

/* Gets the queue of a logical device and creates the frames. */
static bool use_device(host_device *device, VkDevice made, char *error, size_t error_size)
{
    device->device = made;
    vkGetDeviceQueue(device->device, device->queue_family, 0, &device->queue);
    if (!create_frames(device, error, error_size)) {
        host_device_destroy(device);
        return false;
    }
    if (device->instance->debug_utils)
        load_debug_functions(device);
    return true;
}

bool host_device_create(host_device *device, const host_instance *instance, const host_device_info *info, char *error,
                        size_t error_size)
{
    VkDevice made;
    describe(device, instance, info);
    return create_logical(device, &made, error, error_size) && use_device(device, made, error, error_size);
}

bool host_device_wrap(host_device *device, const host_instance *instance, const host_device_info *info, VkDevice made,
                      char *error, size_t error_size)
{
    describe(device, instance, info);
    return use_device(device, made, error, error_size);
}

virga_context_def host_context_def(const host_device *device)
{
    virga_context_def def = virga_default_context_def();
    def.instance = device->instance->instance;
    def.physical_device = device->physical;
    def.device = device->device;
    def.queue_family = device->queue_family;
    def.get_instance_proc_addr = vkGetInstanceProcAddr;
    def.wide_lines = device->wide_lines;
    return def;
}

uint32_t host_device_destroy(host_device *device)
{
    if (!device->device)
        return 0;
    vkDeviceWaitIdle(device->device);
    for (uint32_t i = 0; i < HOST_FRAMES; i++) {
        vkDestroyFence(device->device, device->frames[i].fence, NULL);
        vkDestroyCommandPool(device->device, device->frames[i].pool, NULL);
    }
    vkDestroyDevice(device->device, NULL);
    uint32_t live = device->live;
    memset(device, 0, sizeof *device);
    return live;
}

void host_warn(const host_device *device, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (device->warn)
        device->warn(device->warn_user, text);
    else
        fprintf(stderr, "warning: %s\n", text);
}

void host_name(const host_device *device, VkObjectType type, uint64_t handle, const char *name)
{
    if (!device->set_name || !handle || !name)
        return;
    VkDebugUtilsObjectNameInfoEXT info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
        .objectType = type,
        .objectHandle = handle,
        .pObjectName = name,
    };
    device->set_name(device->device, &info);
}

void host_label_begin(const host_device *device, VkCommandBuffer cmd, const char *name)
{
    VkDebugUtilsLabelEXT label = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name};
    if (device->begin_label)
        device->begin_label(cmd, &label);
}

void host_label_end(const host_device *device, VkCommandBuffer cmd)
{
    if (device->end_label)
        device->end_label(cmd);
}

/* Waits for the last submission of a slot of the ring. */
static bool wait_frame(host_device *device, host_frame *frame, char *error, size_t error_size)
{
    if (frame->index <= device->completed)
        return true;
    HOST_TRY(vkWaitForFences(device->device, 1, &frame->fence, VK_TRUE, UINT64_MAX));
    device->completed = frame->index; /* one queue: earlier frames are complete too */
    return true;
}

bool host_begin_frame(host_device *device, VkCommandBuffer *cmd, char *error, size_t error_size)
{
    host_frame *frame = &device->frames[(device->frame + 1) % HOST_FRAMES];
    if (!wait_frame(device, frame, error, error_size))
        return false;
    HOST_TRY(vkResetCommandPool(device->device, frame->pool, 0));
    VkCommandBufferBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    HOST_TRY(vkBeginCommandBuffer(frame->cmd, &begin));
    device->frame++;
    *cmd = frame->cmd;
    return true;
}

bool host_submit(host_device *device, char *error, size_t error_size)
{
    return host_submit_for_window(device, VK_NULL_HANDLE, VK_NULL_HANDLE, error, error_size);
}

bool host_submit_for_window(host_device *device, VkSemaphore acquired, VkSemaphore drawn, char *error,
                            size_t error_size)
{
    host_frame *frame = &device->frames[device->frame % HOST_FRAMES];
    HOST_TRY(vkEndCommandBuffer(frame->cmd));
    HOST_TRY(vkResetFences(device->device, 1, &frame->fence));
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .waitSemaphoreCount = acquired ? 1 : 0,
        .pWaitSemaphores = &acquired,
        .pWaitDstStageMask = &stage,
        .commandBufferCount = 1,
        .pCommandBuffers = &frame->cmd,
        .signalSemaphoreCount = drawn ? 1 : 0,
        .pSignalSemaphores = &drawn,
    };
    HOST_TRY(vkQueueSubmit(device->queue, 1, &submit, frame->fence));
    frame->index = device->frame;
    return true;
}

bool host_wait_frame(host_device *device, uint64_t frame, char *error, size_t error_size)
{
    return wait_frame(device, &device->frames[frame % HOST_FRAMES], error, error_size);
}

bool host_wait(host_device *device, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < HOST_FRAMES; i++) /* oldest first, so that `completed` only rises */
        if (!wait_frame(device, &device->frames[(device->frame + 1 + i) % HOST_FRAMES], error, error_size))
            return false;
    return true;
}
