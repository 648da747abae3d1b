/* instance.h - the Vulkan instance, with optional validation. */
#ifndef VIRGA_HOST_INSTANCE_H
#define VIRGA_HOST_INSTANCE_H

#include "fail.h"

#include <stdint.h>

/* Must not move while it lives: the validation layer reports into it. */
typedef struct host_instance {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    bool validation;          /* layer and synchronization validation are on */
    bool debug_utils;         /* names and labels may be set */
    bool presents;            /* made for a window: devices get VK_KHR_swapchain */
    uint32_t messages;        /* warnings and errors the layer has reported so far */
    char first_message[1024]; /* the first of them */
} host_instance;

/* `validate`, or VIRGA_VALIDATE=1 in the environment, turns validation on; it is an error if the layer is absent. */
bool host_instance_create(host_instance *instance, bool validate, char *error, size_t error_size);

/* The same with the extensions that a window needs, at most 8, so that devices of it can present. */
bool host_instance_create_for_window(host_instance *instance, bool validate, const char *const *extensions,
                                     uint32_t extension_count, char *error, size_t error_size);
void host_instance_destroy(host_instance *instance);

/* Enables VK_KHR_portability_enumeration where the loader has it: the list then has MoltenVK too, the driver of macOS.
 * Appends the name to `extensions`, which needs room behind `info->enabledExtensionCount` for it. */
void host_request_portability(VkInstanceCreateInfo *info, const char **extensions);

#endif
