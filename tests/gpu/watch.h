/* watch.h - a vkGetInstanceProcAddr between Virga and the loader. It counts created and destroyed objects, makes the
 * call fail that a test selects, and changes the reported properties of the device if a test wants that. One per
 * process. */
#ifndef VIRGA_TESTS_GPU_WATCH_H
#define VIRGA_TESTS_GPU_WATCH_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vulkan/vulkan.h>

#include "../host/kept_pipelines.h"

/* Types of object that are created by vkCreate(device, info, allocator, object). */
#define WATCH_CREATED(X)   \
    X(Buffer)              \
    X(Image)               \
    X(ImageView)           \
    X(BufferView)          \
    X(Sampler)             \
    X(DescriptorSetLayout) \
    X(DescriptorPool)      \
    X(PipelineLayout)      \
    X(PipelineCache)       \
    X(RenderPass)          \
    X(Framebuffer)         \
    X(QueryPool)

#define WATCH_KIND(name) WATCH_##name,
typedef enum watch_kind {
    WATCH_CREATED(WATCH_KIND) WATCH_ShaderModule,
    WATCH_Pipeline,
    WATCH_Memory,
    WATCH_KINDS
} watch_kind;
#undef WATCH_KIND

static const char *const watch_names[WATCH_KINDS] = {
#define WATCH_NAME(name) #name,
    WATCH_CREATED(WATCH_NAME) "ShaderModule", "Pipeline", "Memory"
#undef WATCH_NAME
};

enum { WATCH_MAX_MEMORIES = 4096 };

/* All zero: nothing is counted yet, nothing fails, nothing is changed. */
static struct watch {
    uint32_t live[WATCH_KINDS], made[WATCH_KINDS], destroyed[WATCH_KINDS];
    VkDeviceSize bytes, max_bytes; /* of device memory: current and max */
    struct {
        VkDeviceMemory memory;
        VkDeviceSize size;
    } memories[WATCH_MAX_MEMORIES];

    uint32_t calls;   /* number of calls since watch_fail that can fail */
    uint32_t fail_at; /* number of the call to fail, from 1; 0: none */
    bool failed;      /* that call was reached */
    const char *failed_call;
    VkResult failure;

    const void *cache_data; /* initial data of the newest pipeline cache */
    size_t cache_size;

    uint32_t full_barriers; /* recorded barriers that make all commands wait for all others */

    void (*before_pipeline)(void); /* called before each pipeline creation, on the same thread */

    const char *hidden; /* a function that the instance does not report */
    void (*lie_properties)(VkPhysicalDeviceProperties *properties);
    void (*lie_features)(VkPhysicalDeviceFeatures2 *features);
    void (*lie_format)(VkFormat format, VkFormatProperties *properties);
    void (*lie_memory)(VkPhysicalDeviceMemoryProperties *properties);
    uint32_t lie_types; /* bit mask of memory types that buffers may use; 0: unchanged */

    bool keep_pipelines;   /* each kind is created once, see kept_pipelines.h; for one thread */
    uint64_t device_calls; /* calls that can fail; a lost device must not get any more */
} watch;

static inline uint32_t watch_sum(const uint32_t counts[WATCH_KINDS])
{
    uint32_t sum = 0;
    for (int i = 0; i < WATCH_KINDS; i++)
        sum += counts[i];
    return sum;
}

/* Starts to count the calls that can fail, and makes the call with that number fail. */
static inline void watch_fail(uint32_t number, VkResult failure)
{
    watch.calls = 0;
    watch.fail_at = number;
    watch.failed = false;
    watch.failure = failure;
}

static inline bool watch_fails(const char *call)
{
    watch.device_calls++;
    if (++watch.calls != watch.fail_at)
        return false;
    watch.failed = true;
    watch.failed_call = call;
    return true;
}

static inline void watch_count(watch_kind kind, VkResult result)
{
    if (result == VK_SUCCESS) {
        watch.live[kind]++;
        watch.made[kind]++;
    }
}

static inline void watch_uncount(watch_kind kind, bool object)
{
    if (object) {
        watch.live[kind]--;
        watch.destroyed[kind]++;
    }
}

/* ---- functions of the device */

#define WATCH_WRAP(name)                                                                                             \
    static VKAPI_ATTR VkResult VKAPI_CALL watch_Create##name(VkDevice device, const Vk##name##CreateInfo *info,      \
                                                             const VkAllocationCallbacks *allocator, Vk##name *made) \
    {                                                                                                                \
        if (watch_fails("vkCreate" #name))                                                                           \
            return watch.failure;                                                                                    \
        watch_see_##name(info);                                                                                      \
        const VkResult result = vkCreate##name(device, info, allocator, made);                                       \
        watch_count(WATCH_##name, result);                                                                           \
        return result;                                                                                               \
    }                                                                                                                \
    static VKAPI_ATTR void VKAPI_CALL watch_Destroy##name(VkDevice device, Vk##name object,                          \
                                                          const VkAllocationCallbacks *allocator)                    \
    {                                                                                                                \
        watch_uncount(WATCH_##name, object != VK_NULL_HANDLE);                                                       \
        vkDestroy##name(device, object, allocator);                                                                  \
    }

#define watch_see_Buffer(info)
#define watch_see_Image(info)
#define watch_see_ImageView(info)
#define watch_see_BufferView(info)
#define watch_see_Sampler(info)
#define watch_see_DescriptorSetLayout(info)
#define watch_see_DescriptorPool(info)
#define watch_see_PipelineLayout(info)
#define watch_see_RenderPass(info)
#define watch_see_Framebuffer(info)
#define watch_see_QueryPool(info)
#define watch_see_PipelineCache(info) \
    (watch.cache_data = (info)->pInitialData, watch.cache_size = (info)->initialDataSize)

WATCH_CREATED(WATCH_WRAP)
#undef WATCH_WRAP

/* ---- pipelines */

static VKAPI_ATTR VkResult VKAPI_CALL watch_CreateComputePipelines(VkDevice device, VkPipelineCache cache,
                                                                   uint32_t count,
                                                                   const VkComputePipelineCreateInfo *infos,
                                                                   const VkAllocationCallbacks *allocator,
                                                                   VkPipeline *pipelines)
{
    memset(pipelines, 0, count * sizeof *pipelines); /* as Vulkan requires if one fails */
    if (watch_fails("vkCreateComputePipelines"))
        return watch.failure;
    if (watch.before_pipeline)
        watch.before_pipeline();
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < count && result == VK_SUCCESS; i++) {
        result = watch.keep_pipelines ? kept_compute(device, cache, &infos[i], &pipelines[i])
                                      : vkCreateComputePipelines(device, cache, 1, &infos[i], allocator, &pipelines[i]);
        watch_count(WATCH_Pipeline, result);
    }
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL watch_CreateGraphicsPipelines(VkDevice device, VkPipelineCache cache,
                                                                    uint32_t count,
                                                                    const VkGraphicsPipelineCreateInfo *infos,
                                                                    const VkAllocationCallbacks *allocator,
                                                                    VkPipeline *pipelines)
{
    memset(pipelines, 0, count * sizeof *pipelines);
    if (watch_fails("vkCreateGraphicsPipelines"))
        return watch.failure;
    if (watch.before_pipeline)
        watch.before_pipeline();
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < count && result == VK_SUCCESS; i++) {
        if (!watch.keep_pipelines)
            result = vkCreateGraphicsPipelines(device, cache, 1, &infos[i], allocator, &pipelines[i]);
        else if (infos[i].renderPass)
            result = kept_graphics(device, cache, &infos[i], &pipelines[i]);
        else /* for dynamic rendering, which this device lacks: a number that is never drawn with */
            pipelines[i] = (VkPipeline)(uintptr_t)1;
        watch_count(WATCH_Pipeline, result);
    }
    return result;
}

static VKAPI_ATTR void VKAPI_CALL watch_DestroyPipeline(VkDevice device, VkPipeline pipeline,
                                                        const VkAllocationCallbacks *allocator)
{
    watch_uncount(WATCH_Pipeline, pipeline != VK_NULL_HANDLE);
    if (!watch.keep_pipelines)
        vkDestroyPipeline(device, pipeline, allocator);
}

static VKAPI_ATTR VkResult VKAPI_CALL watch_CreateShaderModule(VkDevice device, const VkShaderModuleCreateInfo *info,
                                                               const VkAllocationCallbacks *allocator,
                                                               VkShaderModule *module)
{
    if (watch_fails("vkCreateShaderModule"))
        return watch.failure;
    VkResult result = VK_SUCCESS;
    if (watch.keep_pipelines)
        *module = kept_number_module(info);
    else
        result = vkCreateShaderModule(device, info, allocator, module);
    watch_count(WATCH_ShaderModule, result);
    return result;
}

static VKAPI_ATTR void VKAPI_CALL watch_DestroyShaderModule(VkDevice device, VkShaderModule module,
                                                            const VkAllocationCallbacks *allocator)
{
    watch_uncount(WATCH_ShaderModule, module != VK_NULL_HANDLE);
    if (!watch.keep_pipelines)
        vkDestroyShaderModule(device, module, allocator);
}

/* ---- memory */

static VKAPI_ATTR VkResult VKAPI_CALL watch_AllocateMemory(VkDevice device, const VkMemoryAllocateInfo *info,
                                                           const VkAllocationCallbacks *allocator,
                                                           VkDeviceMemory *memory)
{
    if (watch_fails("vkAllocateMemory"))
        return watch.failure;
    const VkResult result = vkAllocateMemory(device, info, allocator, memory);
    watch_count(WATCH_Memory, result);
    if (result != VK_SUCCESS)
        return result;
    watch.bytes += info->allocationSize;
    watch.max_bytes = watch.bytes > watch.max_bytes ? watch.bytes : watch.max_bytes;
    for (uint32_t i = 0; i < WATCH_MAX_MEMORIES; i++)
        if (!watch.memories[i].memory) {
            watch.memories[i].memory = *memory;
            watch.memories[i].size = info->allocationSize;
            break;
        }
    return result;
}

static VKAPI_ATTR void VKAPI_CALL watch_FreeMemory(VkDevice device, VkDeviceMemory memory,
                                                   const VkAllocationCallbacks *allocator)
{
    watch_uncount(WATCH_Memory, memory != VK_NULL_HANDLE);
    for (uint32_t i = 0; memory && i < WATCH_MAX_MEMORIES; i++)
        if (watch.memories[i].memory == memory) {
            watch.bytes -= watch.memories[i].size;
            watch.memories[i].memory = VK_NULL_HANDLE;
            break;
        }
    vkFreeMemory(device, memory, allocator);
}

static VKAPI_ATTR VkResult VKAPI_CALL watch_MapMemory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset,
                                                      VkDeviceSize size, VkMemoryMapFlags flags, void **data)
{
    return watch_fails("vkMapMemory") ? watch.failure : vkMapMemory(device, memory, offset, size, flags, data);
}

static VKAPI_ATTR VkResult VKAPI_CALL watch_BindBufferMemory(VkDevice device, VkBuffer buffer, VkDeviceMemory memory,
                                                             VkDeviceSize offset)
{
    return watch_fails("vkBindBufferMemory") ? watch.failure : vkBindBufferMemory(device, buffer, memory, offset);
}

static VKAPI_ATTR VkResult VKAPI_CALL watch_BindImageMemory(VkDevice device, VkImage image, VkDeviceMemory memory,
                                                            VkDeviceSize offset)
{
    return watch_fails("vkBindImageMemory") ? watch.failure : vkBindImageMemory(device, image, memory, offset);
}

static VKAPI_ATTR VkResult VKAPI_CALL watch_AllocateDescriptorSets(VkDevice device,
                                                                   const VkDescriptorSetAllocateInfo *info,
                                                                   VkDescriptorSet *sets)
{
    return watch_fails("vkAllocateDescriptorSets") ? watch.failure : vkAllocateDescriptorSets(device, info, sets);
}

static VKAPI_ATTR VkResult VKAPI_CALL watch_FlushMappedMemoryRanges(VkDevice device, uint32_t count,
                                                                    const VkMappedMemoryRange *ranges)
{
    return watch_fails("vkFlushMappedMemoryRanges") ? watch.failure : vkFlushMappedMemoryRanges(device, count, ranges);
}

static VKAPI_ATTR VkResult VKAPI_CALL watch_InvalidateMappedMemoryRanges(VkDevice device, uint32_t count,
                                                                         const VkMappedMemoryRange *ranges)
{
    return watch_fails("vkInvalidateMappedMemoryRanges") ? watch.failure
                                                         : vkInvalidateMappedMemoryRanges(device, count, ranges);
}

static VKAPI_ATTR VkResult VKAPI_CALL watch_GetQueryPoolResults(VkDevice device, VkQueryPool pool, uint32_t first,
                                                                uint32_t count, size_t size, void *data,
                                                                VkDeviceSize stride, VkQueryResultFlags flags)
{
    return watch_fails("vkGetQueryPoolResults")
               ? watch.failure
               : vkGetQueryPoolResults(device, pool, first, count, size, data, stride, flags);
}

static VKAPI_ATTR VkResult VKAPI_CALL watch_GetPipelineCacheData(VkDevice device, VkPipelineCache cache, size_t *size,
                                                                 void *data)
{
    return watch_fails("vkGetPipelineCacheData") ? watch.failure : vkGetPipelineCacheData(device, cache, size, data);
}

static VKAPI_ATTR void VKAPI_CALL watch_GetBufferMemoryRequirements(VkDevice device, VkBuffer buffer,
                                                                    VkMemoryRequirements *need)
{
    vkGetBufferMemoryRequirements(device, buffer, need);
    if (watch.lie_types)
        need->memoryTypeBits = watch.lie_types;
}

static VKAPI_ATTR void VKAPI_CALL watch_CmdPipelineBarrier(VkCommandBuffer cmd, VkPipelineStageFlags from,
                                                           VkPipelineStageFlags to, VkDependencyFlags flags,
                                                           uint32_t memory_count, const VkMemoryBarrier *memory,
                                                           uint32_t buffer_count, const VkBufferMemoryBarrier *buffers,
                                                           uint32_t image_count, const VkImageMemoryBarrier *images)
{
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    watch.full_barriers += (from & all) && (to & all);
    vkCmdPipelineBarrier(cmd, from, to, flags, memory_count, memory, buffer_count, buffers, image_count, images);
}

/* ---- functions of the instance */

static VKAPI_ATTR void VKAPI_CALL watch_GetPhysicalDeviceMemoryProperties(VkPhysicalDevice device,
                                                                          VkPhysicalDeviceMemoryProperties *properties)
{
    vkGetPhysicalDeviceMemoryProperties(device, properties);
    if (watch.lie_memory)
        watch.lie_memory(properties);
}

static VKAPI_ATTR void VKAPI_CALL watch_GetPhysicalDeviceProperties(VkPhysicalDevice device,
                                                                    VkPhysicalDeviceProperties *properties)
{
    vkGetPhysicalDeviceProperties(device, properties);
    if (watch.lie_properties)
        watch.lie_properties(properties);
}

static VKAPI_ATTR void VKAPI_CALL watch_GetPhysicalDeviceFeatures2(VkPhysicalDevice device,
                                                                   VkPhysicalDeviceFeatures2 *features)
{
    vkGetPhysicalDeviceFeatures2(device, features);
    if (watch.lie_features)
        watch.lie_features(features);
}

static VKAPI_ATTR void VKAPI_CALL watch_GetPhysicalDeviceFormatProperties(VkPhysicalDevice device, VkFormat format,
                                                                          VkFormatProperties *properties)
{
    vkGetPhysicalDeviceFormatProperties(device, format, properties);
    if (watch.lie_format)
        watch.lie_format(format, properties);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL watch_GetDeviceProcAddr(VkDevice device, const char *name);

static inline PFN_vkVoidFunction watch_find(const char *name)
{
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } wrapped[] = {
#define WATCH_ENTRY(name) {"vk" #name, (PFN_vkVoidFunction)watch_##name},
#define WATCH_PAIR(name)  WATCH_ENTRY(Create##name) WATCH_ENTRY(Destroy##name)
        /* clang-format off */
        WATCH_CREATED(WATCH_PAIR)
        WATCH_ENTRY(CreateShaderModule)
        WATCH_ENTRY(DestroyShaderModule)
        WATCH_ENTRY(CreateComputePipelines)
        WATCH_ENTRY(CreateGraphicsPipelines)
        WATCH_ENTRY(DestroyPipeline)
        WATCH_ENTRY(AllocateMemory)
        WATCH_ENTRY(FreeMemory)
        WATCH_ENTRY(MapMemory)
        WATCH_ENTRY(BindBufferMemory)
        WATCH_ENTRY(GetBufferMemoryRequirements)
        WATCH_ENTRY(BindImageMemory)
        WATCH_ENTRY(AllocateDescriptorSets)
        WATCH_ENTRY(FlushMappedMemoryRanges)
        WATCH_ENTRY(InvalidateMappedMemoryRanges)
        WATCH_ENTRY(GetQueryPoolResults)
        WATCH_ENTRY(GetPipelineCacheData)
        WATCH_ENTRY(CmdPipelineBarrier)
        WATCH_ENTRY(GetPhysicalDeviceProperties)
        WATCH_ENTRY(GetPhysicalDeviceFeatures2)
        WATCH_ENTRY(GetPhysicalDeviceFormatProperties)
        WATCH_ENTRY(GetPhysicalDeviceMemoryProperties)
        WATCH_ENTRY(GetDeviceProcAddr)
    /* clang-format on */
#undef WATCH_PAIR
#undef WATCH_ENTRY
    };
    for (size_t i = 0; i < sizeof wrapped / sizeof wrapped[0]; i++)
        if (!strcmp(wrapped[i].name, name))
            return wrapped[i].function;
    return NULL;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL watch_GetDeviceProcAddr(VkDevice device, const char *name)
{
    const PFN_vkVoidFunction wrapped = watch_find(name);
    return wrapped ? wrapped : vkGetDeviceProcAddr(device, name);
}

/* The value for virga_context_def.get_instance_proc_addr. Hides a function and all its suffixed names. */
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL watch_get_instance_proc_addr(VkInstance instance, const char *name)
{
    if (watch.hidden && !strncmp(name, watch.hidden, strlen(watch.hidden)))
        return NULL;
    const PFN_vkVoidFunction wrapped = watch_find(name);
    return wrapped ? wrapped : vkGetInstanceProcAddr(instance, name);
}

/* "2 Buffer, 1 Memory": the live objects, for a message. */
static inline const char *watch_alive(void)
{
    static char text[256];
    size_t at = 0;
    text[0] = 0;
    for (int i = 0; i < WATCH_KINDS && at < sizeof text; i++)
        if (watch.live[i])
            at +=
                (size_t)snprintf(text + at, sizeof text - at, "%s%u %s", at ? ", " : "", watch.live[i], watch_names[i]);
    return text;
}

#endif
