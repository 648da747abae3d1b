/* gpu/memory.h - device memory, from few large pages or from the host's callbacks. Internal. */
#ifndef VIRGA_GPU_MEMORY_H
#define VIRGA_GPU_MEMORY_H

#include <virga/vulkan.h>

/* A piece of device memory. */
typedef struct virga_memory {
    virga_memory_block block;
    struct virga_memory_page *page; /* NULL: from the host's callback */
    VkDeviceSize size;
    uint32_t type_index;
} virga_memory;

/* Memory of a type with all `wanted` properties, and with the preferred ones if the device has such a type. `name` is
 * for the log. */
virga_result virga_memory_allocate(virga_context *context, const VkMemoryRequirements *requirements,
                                   VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred, bool for_image,
                                   const char *name, virga_memory *memory);
void virga_memory_release(virga_context *context, virga_memory *memory);

#endif
