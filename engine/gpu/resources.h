/* gpu/resources.h - buffers and images, with their memory, their views and their debug names. Internal. */
#ifndef VIRGA_GPU_RESOURCES_H
#define VIRGA_GPU_RESOURCES_H

#include "gpu/memory.h"
#include "gpu/retire.h"

typedef struct virga_buffer {
    virga_resource resource; /* first */
    VkBuffer buffer;
    /* As R32G32B32A32_UINT, if the usage includes a uniform texel buffer. It covers the whole buffer, or with the
     * context's small_views the maximum size of a view. */
    VkBufferView texels;
    VkDeviceSize size;
    virga_memory memory;
    bool coherent;
} virga_buffer;

typedef struct virga_image_2d {
    virga_resource resource; /* first */
    VkImage image;
    VkImageView view;         /* all layers, as a 2D array */
    VkImageView *layer_views; /* one layer each, as plain 2D */
    VkImageView seen_view;    /* the first layer in another format, to sample from; NULL: there is none */
    uint32_t layers;
    VkExtent2D extent;
    VkFormat format;
    virga_memory memory;
} virga_image_2d;

/* The kind of memory of a buffer. */
typedef enum virga_heap_kind {
    VIRGA_HEAP_DEVICE,   /* on the device */
    VIRGA_HEAP_UPLOAD,   /* mapped, written by the host each frame */
    VIRGA_HEAP_READBACK, /* mapped, read by the host */
} virga_heap_kind;

virga_result virga_buffer_create(virga_context *context, VkDeviceSize size, VkBufferUsageFlags usage,
                                 virga_heap_kind heap, const char *name, virga_buffer **buffer);

/* `layers` 0: a 3D image of depth 1. */
virga_result virga_image_create(virga_context *context, VkFormat format, VkExtent2D extent, uint32_t layers,
                                VkImageUsageFlags usage, VkImageAspectFlags aspect, const char *name,
                                virga_image_2d **image);

/* The same, and samplers see it in another format of as many bytes, `seen_as`; VK_FORMAT_UNDEFINED: they do not. Passes
 * write what no storage image can have. */
virga_result virga_image_create_seen_as(virga_context *context, VkFormat format, VkFormat seen_as, VkExtent2D extent,
                                        uint32_t layers, VkImageUsageFlags usage, VkImageAspectFlags aspect,
                                        const char *name, virga_image_2d **image);

/* Whether it is a buffer of the library whose object was destroyed, and which frames in flight may still use. */
bool virga_buffer_is_retired(const virga_context *context, VkBuffer buffer);

/* These make the host's writes visible to the device, and the device's writes visible to the host. A failed flush is
 * logged, and the API call that flushed returns virga_recording_result(). */
void virga_buffer_flush(virga_context *context, const virga_buffer *buffer, VkDeviceSize offset, VkDeviceSize size);
void virga_buffer_invalidate(virga_context *context, const virga_buffer *buffer);

/* The error of the flushes, and of the pipelines built on use, since the last call; or VIRGA_OK. After a device loss:
 * VIRGA_ERROR_DEVICE_LOST. */
virga_result virga_recording_result(virga_context *context);

#endif
