/* gpu/errors.c - failed calls and wrong arguments: a line in the log, and the result to return. */
#include "gpu/errors.h"

#include "gpu/context.h"

#include <stdarg.h>
#include <stdio.h>

static const char *vulkan_result_name(VkResult result)
{
    switch (result) {
#define NAME(value)    \
    case value: {      \
        return #value; \
    }
        NAME(VK_SUCCESS)
        NAME(VK_NOT_READY)
        NAME(VK_TIMEOUT)
        NAME(VK_INCOMPLETE)
        NAME(VK_ERROR_OUT_OF_HOST_MEMORY)
        NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        NAME(VK_ERROR_INITIALIZATION_FAILED)
        NAME(VK_ERROR_DEVICE_LOST)
        NAME(VK_ERROR_MEMORY_MAP_FAILED)
        NAME(VK_ERROR_FEATURE_NOT_PRESENT)
        NAME(VK_ERROR_TOO_MANY_OBJECTS)
        NAME(VK_ERROR_FORMAT_NOT_SUPPORTED)
        NAME(VK_ERROR_FRAGMENTED_POOL)
        NAME(VK_ERROR_OUT_OF_POOL_MEMORY)
        NAME(VK_ERROR_UNKNOWN)
#undef NAME
    default: {
        return "another VkResult";
    }
    }
}

virga_result virga_vulkan_failed(virga_context *context, VkResult result, const char *call)
{
    if (result == VK_ERROR_DEVICE_LOST) {
        if (!context->lost)
            virga_log_write(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_DEVICE_LOST, "the device is lost, said %.100s",
                            call);
        context->lost = true;
        return VIRGA_ERROR_DEVICE_LOST;
    }
    virga_log_write(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_VULKAN_CALL, "%s (%d) from %.300s",
                    vulkan_result_name(result), (int)result, call);
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY)
        return VIRGA_ERROR_HOST_MEMORY;
    return result == VK_ERROR_OUT_OF_DEVICE_MEMORY ? VIRGA_ERROR_DEVICE_MEMORY : VIRGA_ERROR_VULKAN;
}

virga_result virga_out_of_host_memory(virga_context *context, const char *what)
{
    virga_log_write(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_HOST_MEMORY, "no host memory for %s", what);
    return VIRGA_ERROR_HOST_MEMORY;
}

virga_result virga_wrong_argument(const virga_log *log, const char *format, ...)
{
    char line[VIRGA_LOG_LINE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_ARGUMENT, "%s", line);
    return VIRGA_ERROR_INVALID;
}

virga_result virga_frame_not_begun(const virga_log *log, const char *call)
{
    virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_FRAME_ORDER, "%s: expected virga_frame_begin before it", call);
    return VIRGA_ERROR_INVALID;
}

virga_result virga_log_not_drawn(virga_context *context, const char *call, bool attached, virga_result ready,
                                 bool *logged)
{
    if (ready == VIRGA_OK && !*logged) {
        virga_log_write(&context->log, VIRGA_LOG_WARNING, VIRGA_LOG_NOT_DRAWN, "%s: %s", call,
                        attached ? "nothing was prepared in this frame" : "the target was not attached");
        *logged = true;
    }
    return VIRGA_NOT_READY;
}
