/* gpu/functions.c - loads the table of entry points. */
#include "gpu/functions.h"

#include <stdio.h>

typedef PFN_vkVoidFunction (*lookup_fn)(const void *context, const char *name);

typedef struct instance_lookup {
    PFN_vkGetInstanceProcAddr get;
    VkInstance instance;
} instance_lookup;

typedef struct device_lookup {
    PFN_vkGetDeviceProcAddr get;
    VkDevice device;
} device_lookup;

static PFN_vkVoidFunction from_instance(const void *context, const char *name)
{
    const instance_lookup *lookup = context;
    return lookup->get(lookup->instance, name);
}

static PFN_vkVoidFunction from_device(const void *context, const char *name)
{
    const device_lookup *lookup = context;
    return lookup->get(lookup->device, name);
}

/* Looks up the core name first, then the names of the same function in extensions. */
static PFN_vkVoidFunction find(lookup_fn lookup, const void *context, const char *name)
{
    static const char *const suffixes[] = {"", "KHR", "EXT"};
    for (size_t i = 0; i < sizeof suffixes / sizeof suffixes[0]; i++) {
        char full[96];
        snprintf(full, sizeof full, "vk%s%s", name, suffixes[i]);
        PFN_vkVoidFunction function = lookup(context, full);
        if (function)
            return function;
    }
    return NULL;
}

static virga_result missing(const virga_log *log, const char *name)
{
    virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_FUNCTION_MISSING,
                    "vkGetInstanceProcAddr gives no vk%s, neither by its core name nor with KHR or EXT", name);
    return VIRGA_ERROR_UNSUPPORTED;
}

virga_result virga_functions_load_instance(virga_functions *functions, const virga_log *log,
                                           PFN_vkGetInstanceProcAddr get, VkInstance instance)
{
    const instance_lookup lookup = {get, instance};
#define VIRGA_LOAD(name)                                                 \
    functions->name = (PFN_vk##name)find(from_instance, &lookup, #name); \
    if (!functions->name)                                                \
        return missing(log, #name);
    VIRGA_INSTANCE_FUNCTIONS(VIRGA_LOAD)
#undef VIRGA_LOAD
    /* These functions belong to an instance extension. Only vkGetInstanceProcAddr returns NULL if the host has not
     * enabled it. For a device, loaders always return a function. */
#define VIRGA_LOAD(name) functions->name = (PFN_vk##name)get(instance, "vk" #name);
    VIRGA_OPTIONAL_FUNCTIONS(VIRGA_LOAD)
#undef VIRGA_LOAD
    return VIRGA_OK;
}

virga_result virga_functions_load_device(virga_functions *functions, const virga_log *log, VkDevice device)
{
    const device_lookup lookup = {functions->GetDeviceProcAddr, device};
#define VIRGA_LOAD(name)                                               \
    functions->name = (PFN_vk##name)find(from_device, &lookup, #name); \
    if (!functions->name)                                              \
        return missing(log, #name);
    VIRGA_DEVICE_FUNCTIONS(VIRGA_LOAD)
#undef VIRGA_LOAD
#define VIRGA_LOAD(name) \
    if (functions->name) \
        functions->name = (PFN_vk##name)from_device(&lookup, "vk" #name);
    VIRGA_OPTIONAL_FUNCTIONS(VIRGA_LOAD)
#undef VIRGA_LOAD
    return VIRGA_OK;
}
