/* virga/base.h - results, log, host memory and version. Knows no Vulkan.
 *
 * Conventions of every Virga header:
 *  - SI units (m, s, kg, rad) unless the name carries another one (`rate_mm_h`, `fov_deg`, `water_nl`).
 *  - Right-handed, Y up. Matrices are column-major float[16], as GLSL and glTF store them.
 *  - Ranges are written `[a; b]`; a value outside is clamped where the comment says so and refused
 *    with VIRGA_ERROR_INVALID and one log line otherwise. NaN and infinity are always refused. Fields of
 *    definitions (`..._def`) that have a range are clamped with one log line each, and creating goes on.
 *  - Places in the world lie within 1e9 m of its origin on each axis; beyond, a call is refused. Floats without a range
 *    may have any finite value.
 *  - Functions that return a result take NULL for what they need as VIRGA_ERROR_INVALID, with one log line where
 *    there is an object whose log can be reached.
 *  - Settings structs are filled by their default function, which also sets `size` and `cookie`; a struct
 *    that did not come from it is refused with VIRGA_ERROR_INVALID in release builds too.
 *  - Everything a settings struct points to is copied before the call returns.
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

/* Marks what the shared library exports; everything else is hidden. */
#if defined(VIRGA_STATIC)
#define VIRGA_API
#elif defined(__GNUC__)
#define VIRGA_API __attribute__((visibility("default")))
#else
#define VIRGA_API
#endif

/* Result of every call that can fail. 0 is success, positive is success with a remark, negative is an error. */
typedef enum virga_result {
    VIRGA_OK = 0,
    VIRGA_NOT_READY = 1,               /* nothing was drawn or stepped: something it needs has not been given yet */
    VIRGA_DEGRADED = 2,                /* done, with a part switched off or shrunk; the log says which */
    VIRGA_ERROR_INVALID = -1,          /* an argument is wrong; nothing changed; the log says which and what was
                                        * expected */
    VIRGA_ERROR_HOST_MEMORY = -2,      /* the host allocator returned NULL; nothing changed */
    VIRGA_ERROR_DEVICE_MEMORY = -3,    /* no device memory, or over the budget; nothing changed */
    VIRGA_ERROR_UNSUPPORTED = -4,      /* the device lacks a required feature or format; the log names it */
    VIRGA_ERROR_DEVICE_LOST = -5,      /* sticky: every later call on the context returns it; destroy still works */
    VIRGA_ERROR_VULKAN = -6,           /* any other Vulkan failure; the log has the call and its result */
} virga_result;

/* Name of a result, e.g. "VIRGA_ERROR_INVALID". Never NULL. Thread-safety: any thread. */
VIRGA_API const char *virga_result_name(virga_result result);

/* Version the library was built as, e.g. "0.1.0". Thread-safety: any thread. */
VIRGA_API const char *virga_version(void);

typedef enum virga_log_level {
    VIRGA_LOG_ERROR = 0,   /* a call failed; its result says so too */
    VIRGA_LOG_WARNING = 1, /* something was clamped, dropped or switched off */
    VIRGA_LOG_INFO = 2,    /* what was created, and its size in memory */
} virga_log_level;

/* Stable ids of everything the library can say. Ids never change meaning and are never reused, so a host may
 * filter or assert on them; the text beside them may be reworded. */
typedef enum virga_log_id {
    VIRGA_LOG_ARGUMENT = 1,          /* a wrong argument: which, and what was expected */
    VIRGA_LOG_COOKIE = 2,            /* a settings struct was not made by its default function */
    VIRGA_LOG_CLAMPED = 3,           /* a value was moved into its range */
    VIRGA_LOG_FEATURE_MISSING = 4,   /* the device lacks a required feature: its name */
    VIRGA_LOG_FUNCTION_MISSING = 5,  /* vkGetInstanceProcAddr gave neither the core nor the suffixed name */
    VIRGA_LOG_VULKAN_CALL = 6,       /* a Vulkan call failed: its text and result */
    VIRGA_LOG_DEVICE_LOST = 7,       /* said once for each context */
    VIRGA_LOG_HOST_MEMORY = 8,       /* the host allocator failed: how many bytes for what */
    VIRGA_LOG_DEVICE_MEMORY = 9,     /* device memory failed: how many bytes for what */
    VIRGA_LOG_LIVE_OBJECTS = 10,     /* a context was destroyed while effects made from it were alive */
    VIRGA_LOG_CREATED = 11,          /* an object was created: what, and its memory */
    VIRGA_LOG_PIPELINE_CACHE = 12,   /* a pipeline cache blob was not accepted and is ignored */
    VIRGA_LOG_FRAME_ORDER = 13,      /* frame indices went backwards, or completed passed frame */
    VIRGA_LOG_TICKS_DROPPED = 14,    /* a step asked for more time than max_ticks_per_step covers */
    VIRGA_LOG_IMPACTS_DROPPED = 15,  /* more impacts in a step than the buffer holds */
    VIRGA_LOG_SHRUNK = 16,           /* an effect was made smaller for the memory budget: which pools, and how small */
    VIRGA_LOG_NOT_DRAWN = 17,        /* a draw found nothing to draw: what was not called before it. Said once, and
                                      * again after a draw that had all it needs */
} virga_log_id;

/* Short stable name of a log id, e.g. "argument". Never NULL. Thread-safety: any thread. */
VIRGA_API const char *virga_log_name(virga_log_id id);

/* Receives one line, without a newline. `text` lives for the call only. Called on the thread of the API call. */
typedef void (*virga_log_fn)(void *user, virga_log_level level, virga_log_id id, const char *text);

/* Host memory. Leave all zero for malloc and free. `alloc` returns memory aligned to 16 bytes or NULL; the
 * matching `free` gets back every pointer that `alloc` gave and never NULL. Called on the thread of the API call,
 * and never while a command buffer is being recorded into. */
typedef struct virga_host_memory {
    void *user;
    void *(*alloc)(void *user, size_t size);
    void (*free)(void *user, void *pointer);
} virga_host_memory;

#ifdef __cplusplus
}
#endif
#endif
