/* gpu/functions.h - the table of Vulkan entry points, all from the host's vkGetInstanceProcAddr. Internal.
 *
 * One line per function. Functions of the last list are optional. A function is looked up by its core name first and,
 * if that is NULL, by its name with an extension's suffix. */
#ifndef VIRGA_GPU_FUNCTIONS_H
#define VIRGA_GPU_FUNCTIONS_H

#include "core/log.h"

#include <virga/vulkan.h>

#define VIRGA_INSTANCE_FUNCTIONS(X)           \
    X(GetPhysicalDeviceProperties)            \
    X(GetPhysicalDeviceProperties2)           \
    X(GetPhysicalDeviceFeatures2)             \
    X(GetPhysicalDeviceMemoryProperties)      \
    X(GetPhysicalDeviceFormatProperties)      \
    X(GetPhysicalDeviceQueueFamilyProperties) \
    X(GetDeviceProcAddr)

#define VIRGA_DEVICE_FUNCTIONS(X)   \
    X(AllocateMemory)               \
    X(FreeMemory)                   \
    X(MapMemory)                    \
    X(UnmapMemory)                  \
    X(FlushMappedMemoryRanges)      \
    X(InvalidateMappedMemoryRanges) \
    X(CreateBuffer)                 \
    X(DestroyBuffer)                \
    X(CreateBufferView)             \
    X(DestroyBufferView)            \
    X(GetBufferMemoryRequirements)  \
    X(BindBufferMemory)             \
    X(CreateImage)                  \
    X(DestroyImage)                 \
    X(GetImageMemoryRequirements)   \
    X(BindImageMemory)              \
    X(CreateImageView)              \
    X(DestroyImageView)             \
    X(CreateSampler)                \
    X(DestroySampler)               \
    X(CreateShaderModule)           \
    X(DestroyShaderModule)          \
    X(CreateDescriptorSetLayout)    \
    X(DestroyDescriptorSetLayout)   \
    X(CreateDescriptorPool)         \
    X(DestroyDescriptorPool)        \
    X(AllocateDescriptorSets)       \
    X(UpdateDescriptorSets)         \
    X(CreatePipelineLayout)         \
    X(DestroyPipelineLayout)        \
    X(CreatePipelineCache)          \
    X(DestroyPipelineCache)         \
    X(GetPipelineCacheData)         \
    X(CreateComputePipelines)       \
    X(CreateGraphicsPipelines)      \
    X(DestroyPipeline)              \
    X(CreateRenderPass)             \
    X(DestroyRenderPass)            \
    X(CreateFramebuffer)            \
    X(DestroyFramebuffer)           \
    X(CreateQueryPool)              \
    X(DestroyQueryPool)             \
    X(GetQueryPoolResults)          \
    X(CmdResetQueryPool)            \
    X(CmdWriteTimestamp)            \
    X(CmdPipelineBarrier)           \
    X(CmdBindPipeline)              \
    X(CmdSetLineWidth)              \
    X(CmdBindDescriptorSets)        \
    X(CmdPushConstants)             \
    X(CmdDispatch)                  \
    X(CmdDispatchIndirect)          \
    X(CmdDraw)                      \
    X(CmdDrawIndexed)               \
    X(CmdDrawIndirect)              \
    X(CmdDrawIndexedIndirect)       \
    X(CmdBindVertexBuffers)         \
    X(CmdBindIndexBuffer)           \
    X(CmdSetViewport)               \
    X(CmdSetScissor)                \
    X(CmdBeginRenderPass)           \
    X(CmdEndRenderPass)             \
    X(CmdCopyBufferToImage)         \
    X(CmdCopyImage)                 \
    X(CmdCopyImageToBuffer)         \
    X(CmdClearColorImage)           \
    X(CmdCopyBuffer)                \
    X(CmdFillBuffer)                \
    X(CmdUpdateBuffer)

#define VIRGA_OPTIONAL_FUNCTIONS(X) \
    X(SetDebugUtilsObjectNameEXT)   \
    X(CmdBeginDebugUtilsLabelEXT)   \
    X(CmdEndDebugUtilsLabelEXT)

typedef struct virga_functions {
#define VIRGA_MEMBER(name) PFN_vk##name name;
    VIRGA_INSTANCE_FUNCTIONS(VIRGA_MEMBER)
    VIRGA_DEVICE_FUNCTIONS(VIRGA_MEMBER)
    VIRGA_OPTIONAL_FUNCTIONS(VIRGA_MEMBER)
#undef VIRGA_MEMBER
} virga_functions;

/* Fills the instance part. A missing function is VIRGA_ERROR_UNSUPPORTED with a line that names it. */
virga_result virga_functions_load_instance(virga_functions *functions, const virga_log *log,
                                           PFN_vkGetInstanceProcAddr get, VkInstance instance);

/* Fills the device part, after the instance part. */
virga_result virga_functions_load_device(virga_functions *functions, const virga_log *log, VkDevice device);

#endif
