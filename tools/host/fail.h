/* fail.h - errors of the host: one line of text, and false. */
#ifndef VIRGA_HOST_FAIL_H
#define VIRGA_HOST_FAIL_H

#include <stdbool.h>
#include <stddef.h>
#include <vulkan/vulkan.h>

/* Writes one line into `error` (may be NULL) and returns false, so that `return host_fail(...)` reads well. */
bool host_fail(char *error, size_t error_size, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Name of a VkResult, e.g. "VK_ERROR_DEVICE_LOST". */
const char *host_result_name(VkResult result);

/* Wraps a Vulkan call in a function that has `error` and `error_size`: on failure it names the call and returns. */
#define HOST_TRY(call)                                                                                   \
    do {                                                                                                 \
        VkResult host_try_result = (call);                                                               \
        if (host_try_result < 0)                                                                         \
            return host_fail(error, error_size, "%s gave %s", #call, host_result_name(host_try_result)); \
    } while (0)

#endif
