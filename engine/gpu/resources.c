/* gpu/resources.c - buffers and images, with their memory, their views and their debug names. */
#include "gpu/resources.h"

#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/memory.h"
#include "gpu/names.h"
#include "gpu/retire.h"

#include <string.h>

/* ---- buffers */

static void buffer_destroy(virga_context *context, virga_resource *resource)
{
    virga_buffer *buffer = (virga_buffer *)resource;
    VIRGA_DESTROY(context, BufferView, buffer->texels);
    VIRGA_DESTROY(context, Buffer, buffer->buffer);
    virga_memory_release(context, &buffer->memory);
    virga_free(&context->heap, buffer);
}

static void heap_flags(virga_heap_kind heap, VkMemoryPropertyFlags *wanted, VkMemoryPropertyFlags *preferred)
{
    *wanted = heap == VIRGA_HEAP_DEVICE ? 0 : VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    *preferred = heap == VIRGA_HEAP_DEVICE ? VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT
                 : heap == VIRGA_HEAP_UPLOAD
                     ? VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                     : VK_MEMORY_PROPERTY_HOST_CACHED_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
}

/* Checks a limit before a resource is created: beyond it, the behaviour of the device is undefined. */
static virga_result check_limit(virga_context *context, const char *name, const char *what, VkDeviceSize value,
                                VkDeviceSize limit)
{
    if (value <= limit)
        return VIRGA_OK;
    virga_log_write(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FEATURE_MISSING,
                    "%s: %llu %s, and the device allows %llu", name, (unsigned long long)value, what,
                    (unsigned long long)limit);
    return VIRGA_ERROR_UNSUPPORTED;
}

/* Creates a view of the whole buffer, for shaders that fetch texels. With small_views it covers the maximum size of a
 * view; it is then bound, but not read. */
static virga_result create_texels(virga_context *context, const char *name, virga_buffer *buffer)
{
    virga_result result = VIRGA_OK;
    const VkDeviceSize texels = buffer->size / 16, max_texels = context->properties.limits.maxTexelBufferElements;
    const VkBufferViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                         .buffer = buffer->buffer,
                                         .format = VK_FORMAT_R32G32B32A32_UINT,
                                         .range = texels > max_texels ? max_texels * 16 : VK_WHOLE_SIZE};
    if (!context->small_views)
        TRY(check_limit(context, name, "texels", texels, max_texels));
    VK_TRY(context, CreateBufferView(context->device, &info, NULL, &buffer->texels));
    context->objects++;
error:
    return result;
}

virga_result virga_buffer_create(virga_context *context, VkDeviceSize size, VkBufferUsageFlags usage,
                                 virga_heap_kind heap, const char *name, virga_buffer **created)
{
    virga_result result = VIRGA_OK;
    if (usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)
        result = check_limit(context, name, "bytes", size, context->properties.limits.maxStorageBufferRange);
    if (result)
        return result;
    virga_buffer *buffer = virga_alloc(&context->heap, sizeof *buffer);
    if (!buffer)
        return virga_out_of_host_memory(context, name);
    buffer->resource.destroy = buffer_destroy;
    buffer->size = size;

    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
    VkMemoryRequirements need;
    VkMemoryPropertyFlags wanted, preferred;
    VK_TRY(context, CreateBuffer(context->device, &info, NULL, &buffer->buffer));
    context->objects++;
    context->vk.GetBufferMemoryRequirements(context->device, buffer->buffer, &need);
    /* Mapped ranges are flushed in whole atoms, so they must not share an atom with another buffer. */
    const VkDeviceSize atom = context->properties.limits.nonCoherentAtomSize;
    if (heap != VIRGA_HEAP_DEVICE && need.alignment < atom)
        need.alignment = atom;
    if (heap != VIRGA_HEAP_DEVICE)
        need.size = (need.size + atom - 1) / atom * atom;
    heap_flags(heap, &wanted, &preferred);
    TRY(virga_memory_allocate(context, &need, wanted, preferred, false, name, &buffer->memory));
    const virga_memory_block *block = &buffer->memory.block;
    VK_TRY(context, BindBufferMemory(context->device, buffer->buffer, block->memory, block->offset));
    buffer->coherent = context->memory_properties.memoryTypes[buffer->memory.type_index].propertyFlags &
                       VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    virga_set_name(context, VK_OBJECT_TYPE_BUFFER, (uint64_t)buffer->buffer, name);
    if (usage & VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT)
        TRY(create_texels(context, name, buffer));
    *created = buffer;
    return VIRGA_OK;
error:
    buffer_destroy(context, &buffer->resource);
    return result;
}

bool virga_buffer_is_retired(const virga_context *context, VkBuffer buffer)
{
    for (const virga_resource *retired = context->retired; retired; retired = retired->next)
        if (retired->destroy == buffer_destroy && ((const virga_buffer *)retired)->buffer == buffer)
            return true;
    return false;
}

/* The mapped range, extended to whole atoms. They belong to this buffer, see virga_buffer_create. */
static VkMappedMemoryRange mapped_range(virga_context *context, const virga_buffer *buffer, VkDeviceSize offset,
                                        VkDeviceSize size)
{
    const VkDeviceSize atom = context->properties.limits.nonCoherentAtomSize;
    const VkDeviceSize first = (buffer->memory.block.offset + offset) / atom * atom;
    const VkDeviceSize end = (buffer->memory.block.offset + offset + size + atom - 1) / atom * atom;
    return (VkMappedMemoryRange){.sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE,
                                 .memory = buffer->memory.block.memory,
                                 .offset = first,
                                 .size = end - first};
}

void virga_buffer_flush(virga_context *context, const virga_buffer *buffer, VkDeviceSize offset, VkDeviceSize size)
{
    const VkMappedMemoryRange range = mapped_range(context, buffer, offset, size);
    if (buffer->coherent || context->lost)
        return;
    const VkResult result = context->vk.FlushMappedMemoryRanges(context->device, 1, &range);
    if (result != VK_SUCCESS)
        context->recording_failed = virga_vulkan_failed(context, result, "vkFlushMappedMemoryRanges");
}

void virga_buffer_invalidate(virga_context *context, const virga_buffer *buffer)
{
    const VkMappedMemoryRange range = mapped_range(context, buffer, 0, buffer->size);
    if (buffer->coherent || context->lost)
        return;
    const VkResult result = context->vk.InvalidateMappedMemoryRanges(context->device, 1, &range);
    if (result != VK_SUCCESS)
        virga_vulkan_failed(context, result, "vkInvalidateMappedMemoryRanges"); /* statistics do not change */
}

virga_result virga_recording_result(virga_context *context)
{
    const virga_result result = context->recording_failed;
    context->recording_failed = VIRGA_OK;
    return context->lost ? VIRGA_ERROR_DEVICE_LOST : result;
}

/* ---- images */

static void image_destroy(virga_context *context, virga_resource *resource)
{
    virga_image_2d *image = (virga_image_2d *)resource;
    for (uint32_t i = 0; image->layer_views && i < image->layers; i++)
        VIRGA_DESTROY(context, ImageView, image->layer_views[i]);
    virga_free(&context->heap, image->layer_views);
    VIRGA_DESTROY(context, ImageView, image->seen_view);
    VIRGA_DESTROY(context, ImageView, image->view);
    VIRGA_DESTROY(context, Image, image->image);
    virga_memory_release(context, &image->memory);
    virga_free(&context->heap, image);
}

static virga_result view_create(virga_context *context, const virga_image_2d *image, VkImageViewType type,
                                VkImageAspectFlags aspect, uint32_t first, uint32_t count, VkImageView *view)
{
    virga_result result = VIRGA_OK;
    const VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = image->image,
                                        .viewType = type,
                                        .format = image->format,
                                        .subresourceRange = {aspect, 0, 1, first, count ? count : 1}};
    VK_TRY(context, CreateImageView(context->device, &info, NULL, view));
    context->objects++;
error:
    return result;
}

/* The format may have no storage images, so the view is for samplers alone. */
static virga_result seen_view_create(virga_context *context, VkFormat seen_as, virga_image_2d *image)
{
    virga_result result = VIRGA_OK;
    const VkImageViewUsageCreateInfo sampled = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_USAGE_CREATE_INFO,
                                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    const VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .pNext = &sampled,
                                        .image = image->image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = seen_as,
                                        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VK_TRY(context, CreateImageView(context->device, &info, NULL, &image->seen_view));
    context->objects++;
error:
    return result;
}

virga_result virga_image_create(virga_context *context, VkFormat format, VkExtent2D extent, uint32_t layers,
                                VkImageUsageFlags usage, VkImageAspectFlags aspect, const char *name,
                                virga_image_2d **created)
{
    return virga_image_create_seen_as(context, format, VK_FORMAT_UNDEFINED, extent, layers, usage, aspect, name,
                                      created);
}

virga_result virga_image_create_seen_as(virga_context *context, VkFormat format, VkFormat seen_as, VkExtent2D extent,
                                        uint32_t layers, VkImageUsageFlags usage, VkImageAspectFlags aspect,
                                        const char *name, virga_image_2d **created)
{
    const VkPhysicalDeviceLimits *limits = &context->properties.limits;
    const uint32_t side = extent.width > extent.height ? extent.width : extent.height;
    virga_result result = check_limit(context, name, "texels a side", side, limits->maxImageDimension2D);
    if (!result)
        result = check_limit(context, name, "layers", layers, limits->maxImageArrayLayers);
    if (result)
        return result;
    virga_image_2d *image = virga_alloc(&context->heap, sizeof *image);
    if (!image)
        return virga_out_of_host_memory(context, name);
    image->resource.destroy = image_destroy;
    image->format = format;
    image->extent = extent;
    image->layers = layers;
    if (layers)
        image->layer_views = virga_alloc_array(&context->heap, layers, sizeof image->layer_views[0]);
    if (layers && !image->layer_views) {
        result = virga_out_of_host_memory(context, name);
        goto error;
    }
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .flags = seen_as ? VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT : 0,
                                    .imageType = layers ? VK_IMAGE_TYPE_2D : VK_IMAGE_TYPE_3D,
                                    .format = format,
                                    .extent = {extent.width, extent.height, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = layers ? layers : 1,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .tiling = VK_IMAGE_TILING_OPTIMAL,
                                    .usage = usage};
    VkMemoryRequirements need;
    VK_TRY(context, CreateImage(context->device, &info, NULL, &image->image));
    context->objects++;
    context->vk.GetImageMemoryRequirements(context->device, image->image, &need);
    TRY(virga_memory_allocate(context, &need, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, true, name, &image->memory));
    VK_TRY(context,
           BindImageMemory(context->device, image->image, image->memory.block.memory, image->memory.block.offset));
    TRY(view_create(context, image, layers ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_3D, aspect, 0, layers,
                    &image->view));
    for (uint32_t i = 0; i < layers; i++)
        TRY(view_create(context, image, VK_IMAGE_VIEW_TYPE_2D, aspect, i, 1, &image->layer_views[i]));
    if (seen_as)
        TRY(seen_view_create(context, seen_as, image));
    virga_set_name(context, VK_OBJECT_TYPE_IMAGE, (uint64_t)image->image, name);
    *created = image;
    return VIRGA_OK;
error:
    image_destroy(context, &image->resource);
    return result;
}
