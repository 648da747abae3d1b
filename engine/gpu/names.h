/* gpu/names.h - names of Vulkan objects, for debuggers and validation. Internal. */
#ifndef VIRGA_GPU_NAMES_H
#define VIRGA_GPU_NAMES_H

#include <virga/vulkan.h>

/* The name that debuggers and validation messages show. Does nothing without VK_EXT_debug_utils. */
void virga_set_name(virga_context *context, VkObjectType type, uint64_t handle, const char *name);

#endif
