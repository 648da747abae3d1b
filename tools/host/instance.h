/* instance.h - the Vulkan instance, with optional validation. */
#ifndef VIRGA_HOST_INSTANCE_H
#define VIRGA_HOST_INSTANCE_H

#include "fail.h"

#include <stdint.h>

/* Must not be moved or copied: the validation layer holds a pointer to it. */
typedef struct host_instance {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    bool validation;          /* layer and synchronization validation are on */
    bool debug_utils;         /* names and labels may be set */
    bool presents;            /* created for a window: devices get VK_KHR_swapchain */
    uint32_t messages;        /* warnings and errors the layer has reported so far */
    char first_message[1024]; /* the first of them */
} host_instance;

/* `validate`, or VIRGA_VALIDATE=1 in the environment, enables validation. It is an error if the layer is not installed.
 * */
bool host_instance_create(host_instance *instance, bool validate, char *error, size_t error_size);

/* The same with the extensions that a window needs, at most 8, so that devices of it can present. */
bool host_instance_create_for_window(host_instance *instance, bool validate, const char *const *extensions,
                                     uint32_t extension_count, char *error, size_t error_size);
void host_instance_destroy(host_instance *instance);

/* Enables VK_KHR_portability_enumeration if the loader has it. Then the list of devices includes MoltenVK, the driver
 * of macOS. Appends the name to `extensions`, which needs space for one more. */
void host_request_portability(VkInstanceCreateInfo *info, const char **extensions);

#endif
