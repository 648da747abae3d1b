/* virga/base.h - results, log, host memory and version. Needs no Vulkan.
 *
 * Conventions of all Virga headers:
 *  - Units are SI (m, s, kg, rad), unless the name says another one (`rate_mm_h`, `fov_deg`, `water_nl`).
 *  - Coordinates are right-handed with Y up. Matrices are column-major float[16], as in GLSL and glTF.
 *  - Ranges are written `[a; b]`. A value outside its range is clamped where the comment says so. Otherwise it is
 *    refused with VIRGA_ERROR_INVALID and one log line.
 *  - Fields of definitions (`..._def`) are always clamped to their range, with one log line each. The object is then
 *    created with the clamped values.
 *  - NaN and infinity are always refused. Floats without a range may have any finite value.
 *  - World positions must lie within 1e9 m of the origin on each axis. A call with a position beyond that is refused.
 *  - A function that returns a result also returns VIRGA_ERROR_INVALID where a required pointer is NULL. It logs one
 *    line if there is an object whose log it can reach.
 *  - Definitions, settings and views are filled by their default function, which also sets `size` and `cookie`. A
 *    struct that was not filled by it is refused with VIRGA_ERROR_INVALID, in release builds too.
 *  - Everything that a settings struct points to is copied before the call returns, unless its comment says otherwise.
 */
#ifndef VIRGA_BASE_H
#define VIRGA_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VIRGA_VERSION_MAJOR 0
#define VIRGA_VERSION_MINOR 1
#define VIRGA_VERSION_PATCH 0

/* Marks the symbols that the shared library exports. All others are hidden. */
#if defined(VIRGA_STATIC)
#define VIRGA_API
#elif defined(__GNUC__)
#define VIRGA_API __attribute__((visibility("default")))
#else
#define VIRGA_API
#endif

/* Result of every call that can fail. 0 is success. Positive values are success with a remark. Negative values are
 * errors. */
typedef enum virga_result {
    VIRGA_OK = 0,

    /* Nothing was drawn or stepped, because something that the call needs is not there yet. */
    VIRGA_NOT_READY = 1,

    /* Done, but a part was switched off, clamped or made smaller. The log says which. */
    VIRGA_DEGRADED = 2,

    /* An argument is wrong, and nothing was changed. The log says which argument, and what was expected. */
    VIRGA_ERROR_INVALID = -1,

    /* The host allocator returned NULL. Nothing was changed. */
    VIRGA_ERROR_HOST_MEMORY = -2,

    /* There is no device memory left, or the budget is used up. Nothing was changed. */
    VIRGA_ERROR_DEVICE_MEMORY = -3,

    /* The device lacks a required feature or format. The log names it. */
    VIRGA_ERROR_UNSUPPORTED = -4,

    /* The device is lost. Every later call on the context returns this too; destroy functions still work. */
    VIRGA_ERROR_DEVICE_LOST = -5,

    /* Any other Vulkan error. The log has the call and its VkResult. */
    VIRGA_ERROR_VULKAN = -6,
} virga_result;

/* Returns the name of a result, e.g. "VIRGA_ERROR_INVALID". Never NULL. Thread-safety: any thread. */
VIRGA_API const char *virga_result_name(virga_result result);

/* Returns the version that the library was built as, e.g. "0.1.0". Thread-safety: any thread. */
VIRGA_API const char *virga_version(void);

typedef enum virga_log_level {
    VIRGA_LOG_ERROR = 0,   /* a call failed; its result says so too */
    VIRGA_LOG_WARNING = 1, /* something was clamped, dropped or switched off */
    VIRGA_LOG_INFO = 2,    /* what was created, and how much memory it takes */
} virga_log_level;

/* Ids of all log messages. An id never changes its meaning and is never used again for another message, so a host may
 * filter by id or assert on it. The text of a message may change. */
typedef enum virga_log_id {
    VIRGA_LOG_ARGUMENT = 1,         /* a wrong argument: which one, and what was expected */
    VIRGA_LOG_COOKIE = 2,           /* a struct was not filled by its default function */
    VIRGA_LOG_CLAMPED = 3,          /* a value was moved into its range */
    VIRGA_LOG_FEATURE_MISSING = 4,  /* the device lacks a required feature: its name */
    VIRGA_LOG_FUNCTION_MISSING = 5, /* vkGetInstanceProcAddr has neither the core name nor the one with a suffix */
    VIRGA_LOG_VULKAN_CALL = 6,      /* a Vulkan call failed: the call and its VkResult */
    VIRGA_LOG_DEVICE_LOST = 7,      /* logged once per context */
    VIRGA_LOG_HOST_MEMORY = 8,      /* the host allocator failed: how many bytes, and what for */
    VIRGA_LOG_DEVICE_MEMORY = 9,    /* a device allocation failed: how many bytes, and what for */
    VIRGA_LOG_LIVE_OBJECTS = 10,    /* a context was destroyed before objects that were made from it */
    VIRGA_LOG_CREATED = 11,         /* an object was created: what, and how much memory it takes */
    VIRGA_LOG_PIPELINE_CACHE = 12,  /* a pipeline cache blob does not fit this driver and is ignored */
    /* Frame indices or ticks went backwards, completed_index passed frame_index, or virga_frame_begin is missing. */
    VIRGA_LOG_FRAME_ORDER = 13,

    VIRGA_LOG_TICKS_DROPPED = 14,   /* a step was longer than max_ticks_per_step; the rest of its time is dropped */
    VIRGA_LOG_IMPACTS_DROPPED = 15, /* a step had more impacts than the buffer holds */
    VIRGA_LOG_SHRUNK = 16,          /* an effect was made smaller for the memory budget: which pools, and how small */

    /* A draw call found nothing to draw, because a call before it is missing: which one. Logged once, and again after
     * a draw that had everything it needs. Also: a view that was prepared was replaced before it was drawn. */
    VIRGA_LOG_NOT_DRAWN = 17,

    /* The device has not executed a frame that was reported as completed, see virga_frame_dropped. Logged at the first
     * such frame, and then at the 10th, 100th, ... */
    VIRGA_LOG_FRAME_LOST = 18,

    VIRGA_LOG_ENCODING = 19, /* a target has a UNORM format and no encoding, see virga_target_def.encoding */
} virga_log_id;

/* Returns the short, stable name of a log id, e.g. "argument". Never NULL. Thread-safety: any thread. */
VIRGA_API const char *virga_log_name(virga_log_id id);

/* Receives one log line, without a newline. `text` is valid during the call only. Called on the thread of the API
 * call that logs.
 *
 * A line that comes again is passed on only at the 10th, 100th, ... time, with the number of times, whatever numbers
 * are in it. A line that was not logged for 1000 frames counts as new, and before the first frame eight are passed on,
 * as objects may have the same mistake. virga_context_def.log_repeats switches this off. */
typedef void (*virga_log_fn)(void *user, virga_log_level level, virga_log_id id, const char *text);

/* Callbacks for host memory. Leave all zero to use malloc and free. Both are called on the thread of the API call,
 * and never while a command buffer is recorded. */
typedef struct virga_host_memory {
    /* Passed to both callbacks. */
    void *user;

    /* Returns memory aligned to 16 bytes, or NULL. */
    void *(*alloc)(void *user, size_t size);

    /* Gets back every pointer that `alloc` returned. Never called with NULL. */
    void (*free)(void *user, void *pointer);
} virga_host_memory;

#ifdef __cplusplus
}
#endif
#endif
