/* memory.c - one allocation for each buffer and image, because the host has few of them. */
#include "memory.h"

#include <string.h>

/* The memory type with all of `needed` and as many of `liked` as possible, or UINT32_MAX. */
static uint32_t find_type(const host_device *device, uint32_t allowed, VkMemoryPropertyFlags needed,
                          VkMemoryPropertyFlags liked)
{
    uint32_t best = UINT32_MAX;
    for (uint32_t i = 0; i < device->memory.memoryTypeCount; i++) {
        VkMemoryPropertyFlags flags = device->memory.memoryTypes[i].propertyFlags;
        if (!(allowed & (1u << i)) || (flags & needed) != needed)
            continue;
        if ((flags & liked) == liked)
            return i;
        if (best == UINT32_MAX)
            best = i;
    }
    return best;
}

static bool allocate(host_device *device, const VkMemoryRequirements *requirements, VkMemoryPropertyFlags needed,
                     VkMemoryPropertyFlags liked, const char *name, VkDeviceMemory *memory, uint32_t *type, char *error,
                     size_t error_size)
{
    *type = find_type(device, requirements->memoryTypeBits, needed, liked);
    if (*type == UINT32_MAX)
        return host_fail(error, error_size, "%s: no device memory of the needed kind", name);
    VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = requirements->size,
        .memoryTypeIndex = *type,
    };
    VkResult result = vkAllocateMemory(device->device, &info, NULL, memory);
    if (result != VK_SUCCESS)
        return host_fail(error, error_size, "%s: %llu bytes of device memory: %s", name,
                         (unsigned long long)requirements->size, host_result_name(result));
    return true;
}

/* ---- buffers ------------------------------------------------------------------------------------------------ */

static bool buffer_memory(host_device *device, host_buffer_kind kind, const char *name, host_buffer *buffer,
                          char *error, size_t error_size)
{
    VkMemoryPropertyFlags needed = 0, liked = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (kind != HOST_BUFFER_DEVICE)
        needed = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    if (kind == HOST_BUFFER_UPLOAD)
        needed |= VK_MEMORY_PROPERTY_HOST_COHERENT_BIT; /* Vulkan guarantees such a type */
    if (kind == HOST_BUFFER_READBACK)
        liked = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(device->device, buffer->buffer, &requirements);
    uint32_t type;
    if (!allocate(device, &requirements, needed, liked, name, &buffer->memory, &type, error, error_size))
        return false;
    buffer->coherent = device->memory.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    HOST_TRY(vkBindBufferMemory(device->device, buffer->buffer, buffer->memory, 0));
    if (kind != HOST_BUFFER_DEVICE)
        HOST_TRY(vkMapMemory(device->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->mapped));
    return true;
}

bool host_buffer_create(host_device *device, VkDeviceSize size, VkBufferUsageFlags usage, host_buffer_kind kind,
                        const char *name, host_buffer *buffer, char *error, size_t error_size)
{
    memset(buffer, 0, sizeof *buffer);
    VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
    HOST_TRY(vkCreateBuffer(device->device, &info, NULL, &buffer->buffer));
    device->live++;
    buffer->size = size;
    if (!buffer_memory(device, kind, name, buffer, error, error_size)) {
        host_buffer_destroy(device, buffer);
        return false;
    }
    host_name(device, VK_OBJECT_TYPE_BUFFER, (uint64_t)buffer->buffer, name);
    return true;
}

void host_buffer_destroy(host_device *device, host_buffer *buffer)
{
    if (!buffer->buffer)
        return;
    vkDestroyBuffer(device->device, buffer->buffer, NULL);
    vkFreeMemory(device->device, buffer->memory, NULL);
    device->live--;
    memset(buffer, 0, sizeof *buffer);
}

void host_buffer_invalidate(const host_device *device, const host_buffer *buffer)
{
    VkMappedMemoryRange range = {
        .sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE,
        .memory = buffer->memory,
        .size = VK_WHOLE_SIZE,
    };
    if (buffer->mapped && !buffer->coherent)
        vkInvalidateMappedMemoryRanges(device->device, 1, &range);
}

static bool create_staging(host_device *device, const void *data, VkDeviceSize size, host_buffer *staging, char *error,
                           size_t error_size)
{
    if (!host_buffer_create(device, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD, "host staging", staging,
                            error, error_size))
        return false;
    memcpy(staging->mapped, data, (size_t)size);
    return true;
}

static bool copy_buffer(host_device *device, const host_buffer *from, const host_buffer *to, VkDeviceSize size,
                        char *error, size_t error_size)
{
    VkCommandBuffer cmd;
    if (!host_begin_frame(device, &cmd, error, error_size))
        return false;
    VkBufferCopy region = {.size = size};
    vkCmdCopyBuffer(cmd, from->buffer, to->buffer, 1, &region);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT);
    return host_submit(device, error, error_size) && host_wait(device, error, error_size);
}

#define MAX_UPDATE 65536u /* bytes in a vkCmdUpdateBuffer */

void host_buffer_update(VkCommandBuffer cmd, const host_buffer *buffer, const void *data, VkDeviceSize size,
                        VkPipelineStageFlags readers, VkAccessFlags access)
{
    const VkPipelineStageFlags copying = VK_PIPELINE_STAGE_TRANSFER_BIT;
    host_memory_barrier(cmd, readers, 0, copying, VK_ACCESS_TRANSFER_WRITE_BIT);
    for (VkDeviceSize from = 0; from < size; from += MAX_UPDATE)
        vkCmdUpdateBuffer(cmd, buffer->buffer, from, size - from < MAX_UPDATE ? size - from : MAX_UPDATE,
                          (const char *)data + from);
    host_memory_barrier(cmd, copying, VK_ACCESS_TRANSFER_WRITE_BIT, readers, access);
}

bool host_buffer_create_with(host_device *device, const void *data, VkDeviceSize size, VkBufferUsageFlags usage,
                             const char *name, host_buffer *buffer, char *error, size_t error_size)
{
    if (!host_buffer_create(device, size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_DEVICE, name, buffer,
                            error, error_size))
        return false;
    host_buffer staging = {0};
    bool ok = create_staging(device, data, size, &staging, error, error_size) &&
              copy_buffer(device, &staging, buffer, size, error, error_size);
    host_buffer_destroy(device, &staging);
    if (!ok)
        host_buffer_destroy(device, buffer);
    return ok;
}

/* ---- images ------------------------------------------------------------------------------------------------- */

static VkImageAspectFlags aspect_of(VkFormat format)
{
    return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

static bool image_memory_and_view(host_device *device, const char *name, host_image *image, char *error,
                                  size_t error_size)
{
    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(device->device, image->image, &requirements);
    uint32_t type;
    if (!allocate(device, &requirements, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, name, &image->memory, &type, error,
                  error_size))
        return false;
    HOST_TRY(vkBindImageMemory(device->device, image->image, image->memory, 0));
    VkImageViewType view_type = image->layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->image,
        .viewType = image->extent.depth > 1 ? VK_IMAGE_VIEW_TYPE_3D : view_type,
        .format = image->format,
        .subresourceRange = {aspect_of(image->format), 0, image->levels, 0, image->layers},
    };
    HOST_TRY(vkCreateImageView(device->device, &view, NULL, &image->view));
    return true;
}

bool host_image_create(host_device *device, const host_image_def *def, host_image *image, char *error,
                       size_t error_size)
{
    memset(image, 0, sizeof *image);
    image->format = def->format;
    image->extent = def->extent;
    image->levels = def->levels ? def->levels : 1;
    image->layers = def->layers ? def->layers : 1;
    VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = def->extent.depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D,
        .format = def->format,
        .extent = def->extent,
        .mipLevels = image->levels,
        .arrayLayers = image->layers,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = def->usage,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
    };
    HOST_TRY(vkCreateImage(device->device, &info, NULL, &image->image));
    device->live++;
    if (!image_memory_and_view(device, def->name, image, error, error_size)) {
        host_image_destroy(device, image);
        return false;
    }
    host_name(device, VK_OBJECT_TYPE_IMAGE, (uint64_t)image->image, def->name);
    return true;
}

void host_image_destroy(host_device *device, host_image *image)
{
    if (!image->image)
        return;
    vkDestroyImageView(device->device, image->view, NULL);
    vkDestroyImage(device->device, image->image, NULL);
    vkFreeMemory(device->device, image->memory, NULL);
    device->live--;
    memset(image, 0, sizeof *image);
}

bool host_view_create(host_device *device, VkImage image, VkFormat format, uint32_t level, uint32_t layer,
                      VkImageView *view, char *error, size_t error_size)
{
    const VkImageViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = format,
        .subresourceRange = {aspect_of(format), level, 1, layer, 1},
    };
    HOST_TRY(vkCreateImageView(device->device, &info, NULL, view));
    return true;
}

void host_memory_barrier(VkCommandBuffer cmd, VkPipelineStageFlags from_stage, VkAccessFlags from_access,
                         VkPipelineStageFlags to_stage, VkAccessFlags to_access)
{
    const VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = from_access, .dstAccessMask = to_access};
    vkCmdPipelineBarrier(cmd, from_stage, to_stage, 0, 1, &barrier, 0, NULL, 0, NULL);
}

void host_image_barrier(VkCommandBuffer cmd, const host_image *image, VkImageLayout from, VkImageLayout to,
                        VkPipelineStageFlags from_stage, VkAccessFlags from_access, VkPipelineStageFlags to_stage,
                        VkAccessFlags to_access)
{
    VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = from_access,
        .dstAccessMask = to_access,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->image,
        .subresourceRange = {aspect_of(image->format), 0, image->levels, 0, image->layers},
    };
    vkCmdPipelineBarrier(cmd, from_stage, to_stage, 0, 0, NULL, 0, NULL, 1, &barrier);
}

uint32_t host_level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

static void record_image_copy(VkCommandBuffer cmd, const host_buffer *staging, const host_image *image, uint32_t texel)
{
    host_image_barrier(cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_TRANSFER_WRITE_BIT);
    const VkExtent3D whole = image->extent;
    VkDeviceSize offset = 0;
    for (uint32_t level = 0; level < image->levels; level++) {
        const VkExtent3D extent = {host_level_size(whole.width, level), host_level_size(whole.height, level),
                                   host_level_size(whole.depth, level)};
        VkBufferImageCopy region = {
            .bufferOffset = offset,
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1},
            .imageExtent = extent,
        };
        vkCmdCopyBufferToImage(cmd, staging->buffer, image->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        offset += (VkDeviceSize)extent.width * extent.height * extent.depth * texel;
    }
    host_image_barrier(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                       VK_ACCESS_SHADER_READ_BIT);
}

bool host_image_upload(host_device *device, host_image *image, const void *data, VkDeviceSize size, uint32_t texel,
                       char *error, size_t error_size)
{
    host_buffer staging = {0};
    VkCommandBuffer cmd;
    bool ok = create_staging(device, data, size, &staging, error, error_size) &&
              host_begin_frame(device, &cmd, error, error_size);
    if (ok) {
        record_image_copy(cmd, &staging, image, texel);
        ok = host_submit(device, error, error_size) && host_wait(device, error, error_size);
    }
    host_buffer_destroy(device, &staging);
    return ok;
}

bool host_image_create_with(host_device *device, const host_image_def *def, const void *data, VkDeviceSize size,
                            uint32_t texel, host_image *image, char *error, size_t error_size)
{
    host_image_def filled = *def;
    filled.usage |= VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (!host_image_create(device, &filled, image, error, error_size))
        return false;
    if (host_image_upload(device, image, data, size, texel, error, error_size))
        return true;
    host_image_destroy(device, image);
    return false;
}
