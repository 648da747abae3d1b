/* gpu/checks.c - checks of arguments that several effects share. */
#include "gpu/checks.h"

#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/resources.h"

virga_result virga_host_buffer_check(const virga_context *context, const char *name, VkBuffer buffer)
{
    if (buffer && virga_buffer_is_retired(context, buffer))
        return virga_wrong_argument(&context->log, "%s: expected a buffer that lives, got one of a destroyed object",
                                    name);
    return VIRGA_OK;
}

virga_result virga_host_list_check(const virga_context *context, const char *name, VkBuffer buffer, VkDeviceSize offset,
                                   VkDeviceSize size, VkDeviceSize min_size)
{
    if (virga_host_buffer_check(context, name, buffer))
        return VIRGA_ERROR_INVALID;
    const VkDeviceSize required = context->properties.limits.minStorageBufferOffsetAlignment;
    const VkDeviceSize alignment = required > 4 ? required : 4; /* it contains indirect arguments */
    if (offset % alignment)
        return virga_wrong_argument(&context->log, "%s_offset: expected a multiple of %llu on this device, got %llu",
                                    name, (unsigned long long)alignment, (unsigned long long)offset);
    if (size && size < min_size)
        return virga_wrong_argument(&context->log, "%s_size: expected at least %llu bytes, got %llu", name,
                                    (unsigned long long)min_size, (unsigned long long)size);
    return VIRGA_OK;
}

VkDeviceSize virga_host_list_range(const virga_context *context, VkDeviceSize size, VkDeviceSize max_range)
{
    const VkDeviceSize limit = context->properties.limits.maxStorageBufferRange;
    max_range = max_range < limit ? max_range : limit;
    return !size ? VK_WHOLE_SIZE : size < max_range ? size : max_range;
}

bool virga_fit_storage(const virga_context *context, const char *name, uint32_t bytes_each, uint32_t *size)
{
    const uint32_t bytes = context->properties.limits.maxStorageBufferRange, max = bytes / bytes_each - 1;
    if (*size <= max)
        return false;
    virga_log_write(&context->log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED,
                    "%s: %u, as storage buffers of this device hold no more than %u bytes", name, max, bytes);
    *size = max;
    return true;
}
