/* memory.h - buffers and images with memory of their own, uploads through a staging buffer, read-back. */
#ifndef VIRGA_HOST_MEMORY_H
#define VIRGA_HOST_MEMORY_H

#include "device.h"

typedef enum host_buffer_kind {
    HOST_BUFFER_DEVICE,   /* device memory, not mapped */
    HOST_BUFFER_UPLOAD,   /* written by the CPU */
    HOST_BUFFER_READBACK, /* read by the CPU; cached if the device has such memory */
} host_buffer_kind;

typedef struct host_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceSize size;
    void *mapped;  /* NULL for HOST_BUFFER_DEVICE */
    bool coherent; /* false: call host_buffer_invalidate before reading */
} host_buffer;

bool host_buffer_create(host_device *device, VkDeviceSize size, VkBufferUsageFlags usage, host_buffer_kind kind,
                        const char *name, host_buffer *buffer, char *error, size_t error_size);
void host_buffer_destroy(host_device *device, host_buffer *buffer);

/* Makes the device's writes visible to the CPU. */
void host_buffer_invalidate(const host_device *device, const host_buffer *buffer);

/* Records an update of a device buffer, with barriers before and after it against the stages `readers`. */
void host_buffer_update(VkCommandBuffer cmd, const host_buffer *buffer, const void *data, VkDeviceSize size,
                        VkPipelineStageFlags readers, VkAccessFlags access);

/* Creates a device buffer with contents. Adds TRANSFER_DST to the usage. Waits until the upload has completed. */
bool host_buffer_create_with(host_device *device, const void *data, VkDeviceSize size, VkBufferUsageFlags usage,
                             const char *name, host_buffer *buffer, char *error, size_t error_size);

typedef struct host_image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view; /* all levels and layers */
    VkFormat format;
    VkExtent3D extent;
    uint32_t levels, layers;
} host_image;

typedef struct host_image_def {
    VkFormat format;
    VkExtent3D extent; /* depth above 1 makes a 3D image */
    uint32_t levels;   /* 0 means 1 */
    uint32_t layers;   /* 0 means 1; above 1 makes an array */
    VkImageUsageFlags usage;
    const char *name;
} host_image_def;

/* Texels along a side of a mipmap level. */
uint32_t host_level_size(uint32_t size, uint32_t level);

bool host_image_create(host_device *device, const host_image_def *def, host_image *image, char *error,
                       size_t error_size);
void host_image_destroy(host_device *device, host_image *image);

/* Uploads all levels of an image with one layer and leaves it in SHADER_READ_ONLY_OPTIMAL. `data` has the levels one
 * after another, tightly packed: `size` bytes, `texel` bytes per texel. The image needs TRANSFER_DST. Waits until the
 * upload has completed. */
bool host_image_upload(host_device *device, host_image *image, const void *data, VkDeviceSize size, uint32_t texel,
                       char *error, size_t error_size);

/* Creates an image and uploads its contents. Adds SAMPLED and TRANSFER_DST to the usage. */
bool host_image_create_with(host_device *device, const host_image_def *def, const void *data, VkDeviceSize size,
                            uint32_t texel, host_image *image, char *error, size_t error_size);

/* A 2D view of one level of one layer. */
bool host_view_create(host_device *device, VkImage image, VkFormat format, uint32_t level, uint32_t layer,
                      VkImageView *view, char *error, size_t error_size);

/* Records a barrier for all memory. */
void host_memory_barrier(VkCommandBuffer cmd, VkPipelineStageFlags from_stage, VkAccessFlags from_access,
                         VkPipelineStageFlags to_stage, VkAccessFlags to_access);

/* Records a layout transition of a whole image. */
void host_image_barrier(VkCommandBuffer cmd, const host_image *image, VkImageLayout from, VkImageLayout to,
                        VkPipelineStageFlags from_stage, VkAccessFlags from_access, VkPipelineStageFlags to_stage,
                        VkAccessFlags to_access);

#endif
