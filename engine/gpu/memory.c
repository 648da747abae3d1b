/* gpu/memory.c - device memory: few large pages, suballocated first fit; or the host's callbacks.
 *
 * Buffers and images never share a page, so bufferImageGranularity does not matter. A page keeps its free ranges in
 * order of offset; releasing merges neighbours, and an empty page is freed at once. */
#include "gpu/memory.h"

#include "gpu/context.h"
#include "gpu/errors.h"

#include <string.h>

#define PAGE_BYTES  ((VkDeviceSize)32 << 20) /* larger requests than half of this get a page of their own size */
#define PAGE_ROUND  ((VkDeviceSize)65536)
#define PAGE_BUDGET 256 /* minimum number of pages in a budget, so that little of it is unused space in pages */
/* Free ranges that a page stores; if there are more, a released range is unused until the page is empty. */
#define MAX_RANGES 256

typedef struct free_range {
    VkDeviceSize offset, size;
} free_range;

typedef struct virga_memory_page {
    struct virga_memory_page *next;
    VkDeviceMemory memory;
    VkDeviceSize size, used;
    char *mapped;
    uint32_t type_index, range_count;
    bool for_image;
    free_range ranges[MAX_RANGES];
} virga_memory_page;

static bool type_fits(const virga_context *context, uint32_t index, uint32_t bits, VkMemoryPropertyFlags wanted)
{
    return (bits & (1u << index)) && (context->memory_properties.memoryTypes[index].propertyFlags & wanted) == wanted;
}

/* The first memory type with all wanted and preferred properties. If there is none and cached memory is preferred, a
 * cached type (readers invalidate memory that is not coherent). Otherwise the first type with all wanted properties.
 * UINT32_MAX if there is none. */
static uint32_t choose_type(const virga_context *context, uint32_t bits, VkMemoryPropertyFlags wanted,
                            VkMemoryPropertyFlags preferred)
{
    const VkMemoryPropertyFlags choices[3] = {wanted | preferred,
                                              wanted | (preferred & VK_MEMORY_PROPERTY_HOST_CACHED_BIT), wanted};
    for (int choice = 0; choice < 3; choice++)
        for (uint32_t i = 0; i < context->memory_properties.memoryTypeCount; i++)
            if (type_fits(context, i, bits, choices[choice]))
                return i;
    return UINT32_MAX;
}

static VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment)
{
    return (value + alignment - 1) / alignment * alignment;
}

/* Allocates `size` bytes from the page's free ranges. False if no range is large enough. */
static bool page_allocate(virga_memory_page *page, VkDeviceSize size, VkDeviceSize alignment, VkDeviceSize *offset)
{
    for (uint32_t i = 0; i < page->range_count; i++) {
        free_range *range = &page->ranges[i];
        const VkDeviceSize start = align_up(range->offset, alignment), end = range->offset + range->size;
        if (start + size > end)
            continue;
        const free_range before = {range->offset, start - range->offset}, after = {start + size, end - start - size};
        if (before.size && after.size && page->range_count == MAX_RANGES)
            continue;
        if (before.size && after.size) {
            memmove(range + 1, range, (page->range_count - i) * sizeof *range);
            page->range_count++;
            range[0] = before;
            range[1] = after;
        } else if (before.size || after.size) {
            *range = before.size ? before : after;
        } else {
            memmove(range, range + 1, (page->range_count - i - 1) * sizeof *range);
            page->range_count--;
        }
        page->used += size;
        *offset = start;
        return true;
    }
    return false;
}

static void page_free(virga_memory_page *page, VkDeviceSize offset, VkDeviceSize size)
{
    page->used -= size;
    if (!page->used) {
        page->range_count = 1;
        page->ranges[0] = (free_range){0, page->size};
        return;
    }
    uint32_t i = 0;
    while (i < page->range_count && page->ranges[i].offset < offset)
        i++;
    const bool joins_before = i > 0 && page->ranges[i - 1].offset + page->ranges[i - 1].size == offset;
    const bool joins_after = i < page->range_count && offset + size == page->ranges[i].offset;
    if (joins_before && joins_after) {
        page->ranges[i - 1].size += size + page->ranges[i].size;
        memmove(&page->ranges[i], &page->ranges[i + 1], (page->range_count - i - 1) * sizeof page->ranges[0]);
        page->range_count--;
    } else if (joins_before) {
        page->ranges[i - 1].size += size;
    } else if (joins_after) {
        page->ranges[i].offset = offset;
        page->ranges[i].size += size;
    } else if (page->range_count < MAX_RANGES) {
        memmove(&page->ranges[i + 1], &page->ranges[i], (page->range_count - i) * sizeof page->ranges[0]);
        page->ranges[i] = (free_range){offset, size};
        page->range_count++;
    }
}

static void page_destroy(virga_context *context, virga_memory_page *page)
{
    for (virga_memory_page **at = &context->pages; *at; at = &(*at)->next)
        if (*at == page) {
            *at = page->next;
            break;
        }
    if (page->memory) {
        context->vk.FreeMemory(context->device, page->memory, NULL);
        context->objects--;
        context->device_allocations--;
        context->device_bytes -= page->size;
    }
    virga_free(&context->heap, page);
}

static virga_result page_create(virga_context *context, VkDeviceSize size, uint32_t type_index, bool for_image,
                                virga_memory_page **created)
{
    virga_result result = VIRGA_OK;
    virga_memory_page *page = virga_alloc(&context->heap, sizeof *page);
    if (!page)
        return virga_out_of_host_memory(context, "a page of device memory");
    page->type_index = type_index;
    page->for_image = for_image;
    page->size = size;
    page->range_count = 1;
    page->ranges[0] = (free_range){0, size};
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = size, .memoryTypeIndex = type_index};
    VK_TRY(context, AllocateMemory(context->device, &info, NULL, &page->memory));
    context->objects++;
    context->device_allocations++;
    context->device_bytes += size;
    page->next = context->pages;
    context->pages = page;
    if (context->memory_properties.memoryTypes[type_index].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
        void *mapped = NULL;
        VK_TRY(context, MapMemory(context->device, page->memory, 0, VK_WHOLE_SIZE, 0, &mapped));
        page->mapped = mapped;
    }
    *created = page;
    return VIRGA_OK;
error:
    page_destroy(context, page);
    return result;
}

/* The limit of allocated bytes in total; 0: no limit. */
static VkDeviceSize current_budget(const virga_context *context)
{
    const VkDeviceSize share = context->budget_share;
    return share && share < context->memory_budget ? share : context->memory_budget;
}

/* VIRGA_ERROR_DEVICE_MEMORY if `size` more bytes would exceed the budget. */
static virga_result check_budget(virga_context *context, VkDeviceSize size, const char *name)
{
    const VkDeviceSize budget = current_budget(context), in_use = context->device_bytes;
    if (!budget || (in_use <= budget && size <= budget - in_use))
        return VIRGA_OK;
    context->over_budget = true;
    if (context->may_shrink || context->share_is_wish)
        return VIRGA_ERROR_DEVICE_MEMORY;
    virga_log_write(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_DEVICE_MEMORY,
                    "%s needs %llu bytes and the budget of %llu bytes has %llu left", name, (unsigned long long)size,
                    (unsigned long long)budget, (unsigned long long)(in_use < budget ? budget - in_use : 0));
    return VIRGA_ERROR_DEVICE_MEMORY;
}

/* Size of a new page for a request. */
static VkDeviceSize page_size(const virga_context *context, VkDeviceSize need)
{
    const VkDeviceSize budget = current_budget(context), own = align_up(need, PAGE_ROUND);
    VkDeviceSize common = PAGE_BYTES;
    if (budget && budget / PAGE_BUDGET < common)
        common = align_up(budget / PAGE_BUDGET + 1, PAGE_ROUND);
    const bool fits = !budget || context->device_bytes + common <= budget;
    return need > common / 2 || !fits ? own : common;
}

/* Allocates from a page with space, or from a new one. */
static virga_result allocate_from_pages(virga_context *context, const VkMemoryRequirements *need, uint32_t type_index,
                                        bool for_image, const char *name, virga_memory *memory)
{
    VkDeviceSize offset = 0;
    virga_memory_page *page = context->pages;
    for (; page; page = page->next)
        if (page->type_index == type_index && page->for_image == for_image &&
            page_allocate(page, need->size, need->alignment, &offset))
            break;
    if (!page) {
        const VkDeviceSize size = page_size(context, need->size);
        virga_result result = check_budget(context, size, name);
        if (!result)
            result = page_create(context, size, type_index, for_image, &page);
        if (!page)
            return result;
        page_allocate(page, need->size, need->alignment, &offset);
    }
    memory->page = page;
    memory->block = (virga_memory_block){page->memory, offset, page->mapped ? page->mapped + offset : NULL, NULL};
    return VIRGA_OK;
}

static virga_result allocate_from_host(virga_context *context, const VkMemoryRequirements *need, uint32_t type_index,
                                       bool mapped, const char *name, virga_memory *memory)
{
    const virga_result result = check_budget(context, need->size, name);
    if (result)
        return result;
    const VkResult result_of_host =
        context->device_memory.alloc(context->device_memory.user, need, type_index, mapped, &memory->block);
    if (result_of_host != VK_SUCCESS)
        return virga_vulkan_failed(context, result_of_host, "the host's device memory callback");
    context->device_allocations++;
    context->device_bytes += need->size;
    return VIRGA_OK;
}

virga_result virga_memory_allocate(virga_context *context, const VkMemoryRequirements *requirements,
                                   VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred, bool for_image,
                                   const char *name, virga_memory *memory)
{
    memset(memory, 0, sizeof *memory);
    const uint32_t type = choose_type(context, requirements->memoryTypeBits, wanted, preferred);
    if (type == UINT32_MAX) {
        virga_log_write(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_DEVICE_MEMORY, "no memory type suits %s", name);
        return VIRGA_ERROR_DEVICE_MEMORY;
    }
    const bool mapped = wanted & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    const virga_result result = context->device_memory.alloc
                                    ? allocate_from_host(context, requirements, type, mapped, name, memory)
                                    : allocate_from_pages(context, requirements, type, for_image, name, memory);
    if (result)
        return result;
    memory->size = requirements->size;
    memory->type_index = type;
    context->device_used += requirements->size;
    return VIRGA_OK;
}

void virga_memory_release(virga_context *context, virga_memory *memory)
{
    if (!memory->block.memory)
        return;
    context->device_used -= memory->size;
    if (memory->page) {
        page_free(memory->page, memory->block.offset, memory->size);
        if (!memory->page->used)
            page_destroy(context, memory->page);
    } else {
        context->device_memory.free(context->device_memory.user, &memory->block);
        context->device_allocations--;
        context->device_bytes -= memory->size;
    }
    memset(memory, 0, sizeof *memory);
}
