/* stand_in.c - see stand_in.h. Objects and what is done with their memory; commands are in stand_in_commands.c. */
#include "stand_in_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

stand_in_state stand_in;

/* ---- objects: a table, and handles that are never used twice */

static stand_in_thing *things;
static uint32_t thing_count, thing_capacity, first_free;

void stand_in_wrong(const char *what, uint64_t handle)
{
    fprintf(stderr, "stand_in: %s (0x%llx)\n", what, (unsigned long long)handle);
    abort();
}

/* Bits of a handle: 24 of the index, 32 of how often it was used, 8 of the type. */
static uint64_t handle_of(uint32_t index)
{
    return (uint64_t)things[index].kind << 56 | (uint64_t)things[index].generation << 24 | (index + 1);
}

uint64_t stand_in_make(stand_in_kind kind)
{
    uint32_t index = first_free;
    if (index) {
        index--;
        first_free = things[index].next_free;
    } else {
        if (thing_count == thing_capacity) {
            thing_capacity = thing_capacity ? 2 * thing_capacity : 1024;
            things = realloc(things, thing_capacity * sizeof *things);
            if (!things)
                abort();
        }
        index = thing_count++;
        memset(&things[index], 0, sizeof things[index]);
    }
    const uint32_t generation = things[index].generation + 1;
    things[index] = (stand_in_thing){.kind = kind, .generation = generation, .alive = true};
    stand_in.live++;
    return handle_of(index);
}

stand_in_thing *stand_in_find(uint64_t handle, stand_in_kind kind)
{
    const uint64_t index = (handle & 0xffffff) - 1;
    if (!handle || index >= thing_count || !things[index].alive || handle_of((uint32_t)index) != handle)
        return NULL;
    const bool fits = kind == STAND_IN_ANY || things[index].kind == kind || things[index].kind == STAND_IN_ANY;
    return fits ? &things[index] : NULL;
}

stand_in_thing *stand_in_need(uint64_t handle, stand_in_kind kind, const char *call)
{
    stand_in_thing *thing = stand_in_find(handle, kind);
    if (!thing)
        stand_in_wrong(call, handle);
    return thing;
}

static void free_data(stand_in_thing *thing)
{
    if (thing->kind != STAND_IN_Memory)
        free(thing->data);
    else if (thing->data)
        munmap(thing->data, thing->size);
}

static void forget(stand_in_thing *thing)
{
    free_data(thing);
    thing->data = NULL;
    thing->alive = false;
    thing->next_free = first_free;
    first_free = (uint32_t)(thing - things) + 1;
}

void stand_in_destroy(uint64_t handle, stand_in_kind kind, const char *call)
{
    if (!handle)
        return;
    stand_in_thing *thing = stand_in_need(handle, kind, call);
    if (stand_in.in_order && !stand_in.lost && thing->last_use > stand_in_done_submission)
        stand_in_wrong("destroyed while a frame still uses it", handle);
    forget(thing);
    stand_in.live--;
}

uint64_t stand_in_object(VkObjectType type)
{
    (void)type;
    const uint64_t handle = stand_in_make(STAND_IN_ANY);
    stand_in.live--;
    return handle;
}

bool stand_in_close(void)
{
    static const char *const names[] = {STAND_IN_KINDS(STAND_IN_NAME) "object"};
    for (uint32_t i = 0; i < thing_count && stand_in.live; i++)
        if (things[i].alive && things[i].kind != STAND_IN_ANY && things[i].kind != STAND_IN_Commands)
            fprintf(stderr, "stand_in: left: a %s\n", names[things[i].kind]);
    for (uint32_t i = 0; i < thing_count; i++)
        if (things[i].alive)
            free_data(&things[i]);
    free(things);
    things = NULL;
    thing_count = thing_capacity = first_free = 0;
    return !stand_in.live;
}

/* ---- failures */

VkResult stand_in_try(void)
{
    if (stand_in.lost)
        return VK_ERROR_DEVICE_LOST;
    if (!stand_in.fail_in || --stand_in.fail_in)
        return VK_SUCCESS;
    stand_in.failed = true;
    stand_in.lost = stand_in.failure == VK_ERROR_DEVICE_LOST;
    return stand_in.failure;
}

/* ---- creation: objects with nothing in them */

#define PLAIN(name)                                                                                        \
    static VKAPI_ATTR VkResult VKAPI_CALL create_##name(VkDevice device, const Vk##name##CreateInfo *info, \
                                                        const VkAllocationCallbacks *with, Vk##name *made) \
    {                                                                                                      \
        (void)device;                                                                                      \
        (void)info;                                                                                        \
        (void)with;                                                                                        \
        const VkResult result = stand_in_try();                                                            \
        *made = result ? VK_NULL_HANDLE : (Vk##name)stand_in_make(STAND_IN_##name);                        \
        return result;                                                                                     \
    }
#define DESTROY(name)                                                                   \
    static VKAPI_ATTR void VKAPI_CALL destroy_##name(VkDevice device, Vk##name object,  \
                                                     const VkAllocationCallbacks *with) \
    {                                                                                   \
        (void)device;                                                                   \
        (void)with;                                                                     \
        stand_in_destroy((uint64_t)object, STAND_IN_##name, "vkDestroy" #name);         \
    }

#define PLAINS(X)          \
    X(BufferView)          \
    X(ImageView)           \
    X(Sampler)             \
    X(ShaderModule)        \
    X(DescriptorSetLayout) \
    X(DescriptorPool)      \
    X(PipelineLayout)      \
    X(PipelineCache)       \
    X(RenderPass)          \
    X(Framebuffer)
#define DESTROYED(X) PLAINS(X) X(Buffer) X(Image) X(QueryPool) X(Pipeline)

PLAINS(PLAIN)
DESTROYED(DESTROY)

static VKAPI_ATTR VkResult VKAPI_CALL create_Buffer(VkDevice device, const VkBufferCreateInfo *info,
                                                    const VkAllocationCallbacks *with, VkBuffer *made)
{
    const VkResult result = stand_in_try();
    (void)device;
    (void)with;
    *made = VK_NULL_HANDLE;
    if (result)
        return result;
    if (!info->size)
        stand_in_wrong("vkCreateBuffer: a size of 0", 0);
    *made = (VkBuffer)stand_in_make(STAND_IN_Buffer);
    stand_in_need((uint64_t)*made, STAND_IN_Buffer, "vkCreateBuffer")->size = info->size;
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_Image(VkDevice device, const VkImageCreateInfo *info,
                                                   const VkAllocationCallbacks *with, VkImage *made)
{
    const VkResult result = stand_in_try();
    (void)device;
    (void)with;
    *made = VK_NULL_HANDLE;
    if (result)
        return result;
    if (!info->extent.width || !info->extent.height || !info->extent.depth || !info->arrayLayers)
        stand_in_wrong("vkCreateImage: an extent of 0", 0);
    *made = (VkImage)stand_in_make(STAND_IN_Image);
    stand_in_need((uint64_t)*made, STAND_IN_Image, "vkCreateImage")->size =
        (VkDeviceSize)info->extent.width * info->extent.height * info->extent.depth * info->arrayLayers * 16;
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_QueryPool(VkDevice device, const VkQueryPoolCreateInfo *info,
                                                       const VkAllocationCallbacks *with, VkQueryPool *made)
{
    const VkResult result = stand_in_try();
    (void)device;
    (void)with;
    *made = result ? VK_NULL_HANDLE : (VkQueryPool)stand_in_make(STAND_IN_QueryPool);
    if (result)
        return result;
    stand_in_thing *pool = stand_in_need((uint64_t)*made, STAND_IN_QueryPool, "vkCreateQueryPool");
    pool->size = info->queryCount;
    pool->data = calloc(info->queryCount, sizeof(uint64_t));
    return VK_SUCCESS;
}

static VkResult create_pipelines(uint32_t count, VkPipeline *pipelines)
{
    const VkResult result = stand_in_try();
    stand_in.unbuilt = stand_in.unbuilt || result;
    for (uint32_t i = 0; i < count; i++)
        pipelines[i] = result ? VK_NULL_HANDLE : (VkPipeline)stand_in_make(STAND_IN_Pipeline);
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_compute(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                     const VkComputePipelineCreateInfo *infos,
                                                     const VkAllocationCallbacks *with, VkPipeline *pipelines)
{
    (void)device;
    (void)cache;
    (void)with;
    for (uint32_t i = 0; i < count; i++) {
        stand_in_need((uint64_t)infos[i].layout, STAND_IN_PipelineLayout, "a pipeline's layout does not exist");
        stand_in_need((uint64_t)infos[i].stage.module, STAND_IN_ShaderModule, "a pipeline's module does not exist");
    }
    return create_pipelines(count, pipelines);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_graphics(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                      const VkGraphicsPipelineCreateInfo *infos,
                                                      const VkAllocationCallbacks *with, VkPipeline *pipelines)
{
    (void)device;
    (void)cache;
    (void)with;
    for (uint32_t i = 0; i < count; i++)
        stand_in_need((uint64_t)infos[i].layout, STAND_IN_PipelineLayout, "a pipeline's layout does not exist");
    return create_pipelines(count, pipelines);
}

static VKAPI_ATTR VkResult VKAPI_CALL cache_data(VkDevice device, VkPipelineCache cache, size_t *size, void *data)
{
    const VkResult result = stand_in_try();
    (void)device;
    stand_in_need((uint64_t)cache, STAND_IN_PipelineCache, "vkGetPipelineCacheData");
    if (result)
        return result;
    if (data)
        memset(data, 7, *size < 48 ? *size : 48);
    *size = data && *size < 48 ? *size : 48;
    return VK_SUCCESS;
}

/* ---- memory. Types: 0 of the device; 1 mapped and coherent; 2 mapped and cached */

static VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice device, const VkMemoryAllocateInfo *info,
                                               const VkAllocationCallbacks *with, VkDeviceMemory *memory)
{
    VkResult result = stand_in_try();
    (void)device;
    (void)with;
    *memory = VK_NULL_HANDLE;
    if (!result && info->allocationSize > (VkDeviceSize)4 << 30)
        result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    const bool has_contents = !result && info->memoryTypeIndex;
    /* Large, and hardly any of it is used: pages that are not touched cost nothing. */
    void *data = has_contents
                     ? mmap(NULL, info->allocationSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)
                     : NULL;
    if (data == MAP_FAILED)
        result = VK_ERROR_OUT_OF_HOST_MEMORY;
    if (result)
        return result;
    *memory = (VkDeviceMemory)stand_in_make(STAND_IN_Memory);
    stand_in_thing *thing = stand_in_need((uint64_t)*memory, STAND_IN_Memory, "vkAllocateMemory");
    thing->data = data;
    thing->size = info->allocationSize;
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL free_memory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks *with)
{
    (void)device;
    (void)with;
    stand_in_destroy((uint64_t)memory, STAND_IN_Memory, "vkFreeMemory");
}

static VKAPI_ATTR VkResult VKAPI_CALL map(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset,
                                          VkDeviceSize size, VkMemoryMapFlags flags, void **data)
{
    const VkResult result = stand_in_try();
    const stand_in_thing *thing = stand_in_need((uint64_t)memory, STAND_IN_Memory, "vkMapMemory");
    (void)device;
    (void)size;
    (void)flags;
    if (!thing->data)
        stand_in_wrong("vkMapMemory: memory that the host can not see", (uint64_t)memory);
    *data = result ? NULL : (char *)thing->data + offset;
    return result;
}

static VKAPI_ATTR void VKAPI_CALL unmap(VkDevice device, VkDeviceMemory memory)
{
    (void)device;
    stand_in_need((uint64_t)memory, STAND_IN_Memory, "vkUnmapMemory");
}

static VKAPI_ATTR VkResult VKAPI_CALL ranges(VkDevice device, uint32_t count, const VkMappedMemoryRange *all)
{
    (void)device;
    for (uint32_t i = 0; i < count; i++)
        stand_in_need((uint64_t)all[i].memory, STAND_IN_Memory, "a range of mapped memory");
    return stand_in_try();
}

static void need_of(stand_in_thing *thing, VkMemoryRequirements *need)
{
    *need = (VkMemoryRequirements){(thing->size + 255) / 256 * 256, 256, 7};
}

static VKAPI_ATTR void VKAPI_CALL buffer_need(VkDevice device, VkBuffer buffer, VkMemoryRequirements *need)
{
    (void)device;
    need_of(stand_in_need((uint64_t)buffer, STAND_IN_Buffer, "vkGetBufferMemoryRequirements"), need);
}

static VKAPI_ATTR void VKAPI_CALL image_need(VkDevice device, VkImage image, VkMemoryRequirements *need)
{
    (void)device;
    need_of(stand_in_need((uint64_t)image, STAND_IN_Image, "vkGetImageMemoryRequirements"), need);
}

static VkResult bind(stand_in_thing *thing, VkDeviceMemory memory, VkDeviceSize offset)
{
    /* Memory of a host's callback is the test's own, and has no size. */
    const stand_in_thing *in = stand_in_need((uint64_t)memory, STAND_IN_Memory, "memory that is bound");
    if (in->kind == STAND_IN_Memory && offset + thing->size > in->size)
        stand_in_wrong("bound beyond the end of its memory", (uint64_t)memory);
    thing->memory = (uint64_t)memory;
    thing->offset = offset;
    return stand_in_try();
}

static VKAPI_ATTR VkResult VKAPI_CALL bind_buffer(VkDevice device, VkBuffer buffer, VkDeviceMemory memory,
                                                  VkDeviceSize offset)
{
    (void)device;
    return bind(stand_in_need((uint64_t)buffer, STAND_IN_Buffer, "vkBindBufferMemory"), memory, offset);
}

static VKAPI_ATTR VkResult VKAPI_CALL bind_image(VkDevice device, VkImage image, VkDeviceMemory memory,
                                                 VkDeviceSize offset)
{
    (void)device;
    return bind(stand_in_need((uint64_t)image, STAND_IN_Image, "vkBindImageMemory"), memory, offset);
}

/* ---- descriptor sets: they live as long as their pool, so a handle is the pool's */

static VKAPI_ATTR VkResult VKAPI_CALL allocate_sets(VkDevice device, const VkDescriptorSetAllocateInfo *info,
                                                    VkDescriptorSet *sets)
{
    const VkResult result = stand_in_try();
    (void)device;
    stand_in_need((uint64_t)info->descriptorPool, STAND_IN_DescriptorPool, "vkAllocateDescriptorSets");
    for (uint32_t i = 0; i < info->descriptorSetCount; i++)
        sets[i] = result ? VK_NULL_HANDLE : (VkDescriptorSet)info->descriptorPool;
    return result;
}

static VKAPI_ATTR void VKAPI_CALL update_sets(VkDevice device, uint32_t count, const VkWriteDescriptorSet *writes,
                                              uint32_t copy_count, const VkCopyDescriptorSet *copies)
{
    (void)device;
    (void)copy_count;
    (void)copies;
    for (uint32_t i = 0; i < count; i++)
        stand_in_need((uint64_t)writes[i].dstSet, STAND_IN_DescriptorPool, "vkUpdateDescriptorSets");
}

static VKAPI_ATTR VkResult VKAPI_CALL query_results(VkDevice device, VkQueryPool pool, uint32_t first, uint32_t count,
                                                    size_t size, void *data, VkDeviceSize stride,
                                                    VkQueryResultFlags flags)
{
    const VkResult result = stand_in_try();
    const stand_in_thing *thing = stand_in_need((uint64_t)pool, STAND_IN_QueryPool, "vkGetQueryPoolResults");
    (void)device;
    (void)stride;
    (void)flags;
    if (result)
        return result;
    if (first + count > thing->size || size < count * sizeof(uint64_t))
        stand_in_wrong("vkGetQueryPoolResults: beyond the end", (uint64_t)pool);
    const uint64_t *times = thing->data;
    for (uint32_t i = 0; i < count; i++)
        if (!times[first + i])
            return VK_NOT_READY;
    memcpy(data, times + first, count * sizeof(uint64_t));
    return VK_SUCCESS;
}

/* ---- the table */

static const stand_in_entry entries[] = {
#define CREATE_ENTRY(name)  {"vkCreate" #name, (PFN_vkVoidFunction)create_##name, true},
#define DESTROY_ENTRY(name) {"vkDestroy" #name, (PFN_vkVoidFunction)destroy_##name, true},
    PLAINS(CREATE_ENTRY) DESTROYED(DESTROY_ENTRY) CREATE_ENTRY(Buffer) CREATE_ENTRY(Image)
        CREATE_ENTRY(QueryPool){"vkCreateComputePipelines", (PFN_vkVoidFunction)create_compute, true},
    {"vkCreateGraphicsPipelines", (PFN_vkVoidFunction)create_graphics, true},
    {"vkGetPipelineCacheData", (PFN_vkVoidFunction)cache_data, true},
    {"vkAllocateMemory", (PFN_vkVoidFunction)allocate, false},
    {"vkFreeMemory", (PFN_vkVoidFunction)free_memory, false},
    {"vkMapMemory", (PFN_vkVoidFunction)map, false},
    {"vkUnmapMemory", (PFN_vkVoidFunction)unmap, false},
    {"vkFlushMappedMemoryRanges", (PFN_vkVoidFunction)ranges, false},
    {"vkInvalidateMappedMemoryRanges", (PFN_vkVoidFunction)ranges, false},
    {"vkGetBufferMemoryRequirements", (PFN_vkVoidFunction)buffer_need, false},
    {"vkGetImageMemoryRequirements", (PFN_vkVoidFunction)image_need, false},
    {"vkBindBufferMemory", (PFN_vkVoidFunction)bind_buffer, false},
    {"vkBindImageMemory", (PFN_vkVoidFunction)bind_image, false},
    {"vkAllocateDescriptorSets", (PFN_vkVoidFunction)allocate_sets, false},
    {"vkUpdateDescriptorSets", (PFN_vkVoidFunction)update_sets, false},
    {"vkGetQueryPoolResults", (PFN_vkVoidFunction)query_results, false},
};

/* What the null device of a real driver can not do either, though their names are like those of its functions. */
static bool is_ours(const char *name)
{
    static const char *const of_memory[] = {"Buffer", "Image", "QueryPool", "DescriptorPool", "Sampler", "Framebuffer"};
    for (size_t i = 0; i < sizeof of_memory / sizeof of_memory[0]; i++)
        if (strstr(name, of_memory[i]))
            return true;
    return false;
}

static const stand_in_entry *find(const stand_in_entry *table, uint32_t count, const char *name)
{
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(table[i].name, name))
            return &table[i];
    return NULL;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_of_device(VkDevice device, const char *name)
{
    (void)device;
    return stand_in_get(NULL, name);
}

PFN_vkVoidFunction VKAPI_CALL stand_in_get(VkInstance instance, const char *name)
{
    const stand_in_entry *entry = find(entries, sizeof entries / sizeof entries[0], name);
    (void)instance;
    if (!strcmp(name, "vkGetDeviceProcAddr"))
        return (PFN_vkVoidFunction)get_of_device;
    if (entry && stand_in.through && entry->compiles && !is_ours(name))
        return stand_in.through(stand_in.instance, name);
    if (!entry)
        entry = find(stand_in_commands, stand_in_command_count, name);
    if (!entry)
        entry = find(stand_in_facts, stand_in_fact_count, name);
    return entry ? entry->function : NULL;
}
