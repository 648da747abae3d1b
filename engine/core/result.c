/* core/result.c - names of results and log ids, and the version. */
#include <virga/base.h>

/* The switches have no default label, so the compiler warns about every missing entry. */
#define RESULTS(X)               \
    X(VIRGA_OK)                  \
    X(VIRGA_NOT_READY)           \
    X(VIRGA_DEGRADED)            \
    X(VIRGA_ERROR_INVALID)       \
    X(VIRGA_ERROR_HOST_MEMORY)   \
    X(VIRGA_ERROR_DEVICE_MEMORY) \
    X(VIRGA_ERROR_UNSUPPORTED)   \
    X(VIRGA_ERROR_DEVICE_LOST)   \
    X(VIRGA_ERROR_VULKAN)

#define LOG_IDS(X)                                    \
    X(VIRGA_LOG_ARGUMENT, "argument")                 \
    X(VIRGA_LOG_COOKIE, "cookie")                     \
    X(VIRGA_LOG_CLAMPED, "clamped")                   \
    X(VIRGA_LOG_FEATURE_MISSING, "feature-missing")   \
    X(VIRGA_LOG_FUNCTION_MISSING, "function-missing") \
    X(VIRGA_LOG_VULKAN_CALL, "vulkan-call")           \
    X(VIRGA_LOG_DEVICE_LOST, "device-lost")           \
    X(VIRGA_LOG_HOST_MEMORY, "host-memory")           \
    X(VIRGA_LOG_DEVICE_MEMORY, "device-memory")       \
    X(VIRGA_LOG_LIVE_OBJECTS, "live-objects")         \
    X(VIRGA_LOG_CREATED, "created")                   \
    X(VIRGA_LOG_PIPELINE_CACHE, "pipeline-cache")     \
    X(VIRGA_LOG_FRAME_ORDER, "frame-order")           \
    X(VIRGA_LOG_TICKS_DROPPED, "ticks-dropped")       \
    X(VIRGA_LOG_IMPACTS_DROPPED, "impacts-dropped")   \
    X(VIRGA_LOG_SHRUNK, "shrunk")                     \
    X(VIRGA_LOG_NOT_DRAWN, "not-drawn")               \
    X(VIRGA_LOG_FRAME_LOST, "frame-lost")             \
    X(VIRGA_LOG_ENCODING, "encoding")

#define RESULT_CASE(value) \
    case value: {          \
        return #value;     \
    }

const char *virga_result_name(virga_result result)
{
    switch (result) {
        RESULTS(RESULT_CASE)
    }
    return "VIRGA_UNKNOWN_RESULT";
}

#define LOG_ID_CASE(value, name) \
    case value: {                \
        return name;             \
    }

const char *virga_log_name(virga_log_id id)
{
    switch (id) {
        LOG_IDS(LOG_ID_CASE)
    }
    return "unknown";
}

#define TEXT_OF(value)                    #value
#define VERSION_TEXT(major, minor, patch) TEXT_OF(major) "." TEXT_OF(minor) "." TEXT_OF(patch)

const char *virga_version(void)
{
    return VERSION_TEXT(VIRGA_VERSION_MAJOR, VIRGA_VERSION_MINOR, VIRGA_VERSION_PATCH);
}
