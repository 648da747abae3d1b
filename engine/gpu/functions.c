/* gpu/functions.c - loads the table of entry points. */
#include "gpu/functions.h"

#include <stdio.h>

/* Where functions are looked up: in a device, or without one in an instance. */
typedef struct lookup {
    PFN_vkGetInstanceProcAddr get_of_instance;
    VkInstance instance;
    PFN_vkGetDeviceProcAddr get_of_device;
    VkDevice device;
} lookup;

static PFN_vkVoidFunction find_exact(const lookup *in, const char *name)
{
    return in->device ? in->get_of_device(in->device, name) : in->get_of_instance(in->instance, name);
}

/* Looks up the core name first, then the names of the same function in extensions. */
static PFN_vkVoidFunction find(const lookup *in, const char *name)
{
    static const char *const suffixes[] = {"", "KHR", "EXT"};
    for (size_t i = 0; i < sizeof suffixes / sizeof suffixes[0]; i++) {
        char full[96];
        snprintf(full, sizeof full, "vk%s%s", name, suffixes[i]);
        PFN_vkVoidFunction function = find_exact(in, full);
        if (function)
            return function;
    }
    return NULL;
}

static virga_result missing(const virga_log *log, const lookup *in, const char *name)
{
    virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_FUNCTION_MISSING,
                    "vkGetInstanceProcAddr gives no vk%s, neither by its core name nor with KHR or EXT%s", name,
                    in->device ? "" : "; an instance of Vulkan 1.0 does not: set VkApplicationInfo::apiVersion to 1.2");
    return VIRGA_ERROR_UNSUPPORTED;
}

#define LOAD(name)                                    \
    functions->name = (PFN_vk##name)find(&in, #name); \
    if (!functions->name)                             \
        return missing(log, &in, #name);

virga_result virga_functions_load_instance(virga_functions *functions, const virga_log *log,
                                           PFN_vkGetInstanceProcAddr get, VkInstance instance)
{
    const lookup in = {.get_of_instance = get, .instance = instance};
    VIRGA_INSTANCE_FUNCTIONS(LOAD)
    /* These functions belong to an instance extension. Only vkGetInstanceProcAddr returns NULL if the host has not
     * enabled it. For a device, loaders always return a function. */
#define LOAD_OPTIONAL(name) functions->name = (PFN_vk##name)find_exact(&in, "vk" #name);
    VIRGA_OPTIONAL_FUNCTIONS(LOAD_OPTIONAL)
    return VIRGA_OK;
}

virga_result virga_functions_load_device(virga_functions *functions, const virga_log *log, VkDevice device)
{
    const lookup in = {.get_of_device = functions->GetDeviceProcAddr, .device = device};
    VIRGA_DEVICE_FUNCTIONS(LOAD)
#define RELOAD_OPTIONAL(name) \
    if (functions->name)      \
        functions->name = (PFN_vk##name)find_exact(&in, "vk" #name);
    VIRGA_OPTIONAL_FUNCTIONS(RELOAD_OPTIONAL)
    return VIRGA_OK;
}
