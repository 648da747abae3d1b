/* gpu/checks.h - checks of arguments that several effects share. Internal. */
#ifndef VIRGA_GPU_CHECKS_H
#define VIRGA_GPU_CHECKS_H

#include "core/log.h"

#include <virga/vulkan.h>

/* A buffer that a host passes on from an object of the context that was destroyed since is refused. One of the host's
 * own, or NULL, is not checked. `name` is the member that holds it. */
virga_result virga_host_buffer_check(const virga_context *context, const char *name, VkBuffer buffer);

/* The same for a list in a storage buffer. Its offset must also be aligned, and its size (0: not given) must hold
 * `min_size` bytes. The members name_offset and name_size belong to it. */
virga_result virga_host_list_check(const virga_context *context, const char *name, VkBuffer buffer, VkDeviceSize offset,
                                   VkDeviceSize size, VkDeviceSize min_size);

/* The range to bind of such a list: its size, at most `max_range` and what the device allows; VK_WHOLE_SIZE if no size
 * is given. */
VkDeviceSize virga_host_list_range(const virga_context *context, VkDeviceSize size, VkDeviceSize max_range);

/* Reduces a size of a definition to what a storage buffer of the device holds, with room for a head. True if that
 * changed it, with a line in the log. */
bool virga_fit_storage(const virga_context *context, const char *name, uint32_t bytes_each, uint32_t *size);

#endif
