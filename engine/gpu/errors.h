/* gpu/errors.h - failed calls and wrong arguments: a line in the log, and the result to return. Internal. */
#ifndef VIRGA_GPU_ERRORS_H
#define VIRGA_GPU_ERRORS_H

#include "core/log.h"
#include "gpu/context.h"

/* A Vulkan call failed. Remembers that the device is lost, if it is. */
virga_result virga_vulkan_failed(virga_context *context, VkResult result, const char *call);

/* One Vulkan call in a function that has `virga_result result` and a label `error`. */
#define VK_TRY(context, call)                                              \
    do {                                                                   \
        const VkResult vk_result_ = (context)->vk.call;                    \
        if (vk_result_ != VK_SUCCESS) {                                    \
            result = virga_vulkan_failed(context, vk_result_, "vk" #call); \
            goto error;                                                    \
        }                                                                  \
    } while (0)

/* One call of ours in such a function. */
#define TRY(call)        \
    do {                 \
        result = (call); \
        if (result < 0)  \
            goto error;  \
    } while (0)

/* Logs that host memory ran out for `what`. */
virga_result virga_out_of_host_memory(virga_context *context, const char *what);

/* Logs a wrong argument. Returns VIRGA_ERROR_INVALID. */
virga_result virga_wrong_argument(const virga_log *log, const char *format, ...) VIRGA_PRINTF(2, 3);

/* Logs that a call needs a frame that has begun. Returns VIRGA_ERROR_INVALID. `call`: what was called, and how. */
virga_result virga_frame_not_begun(const virga_log *log, const char *call);

/* A draw has nothing to draw. Returns VIRGA_NOT_READY. Hosts that check only for errors do not notice this, so `call`
 * is logged once; the next successful draw resets `logged`. It is not logged while pipelines are still being built
 * (`ready` is not VIRGA_OK), which is normal. */
virga_result virga_log_not_drawn(virga_context *context, const char *call, bool attached, virga_result ready,
                                 bool *logged);

#endif
