/* device_list.h - the devices of an instance, and the choice of one. */
#ifndef VIRGA_HOST_DEVICE_LIST_H
#define VIRGA_HOST_DEVICE_LIST_H

#include "instance.h"

#define HOST_MAX_DEVICES 16

typedef struct host_device_info {
    VkPhysicalDevice physical;
    VkPhysicalDeviceType type;
    char name[VK_MAX_PHYSICAL_DEVICE_NAME_SIZE];
    char driver[VK_MAX_DRIVER_NAME_SIZE + VK_MAX_DRIVER_INFO_SIZE + 4];
    uint32_t api_version;
    uint32_t queue_family;     /* graphics and compute */
    VkDeviceSize memory_bytes; /* of device-local heaps */
    bool usable;
    char reason[256]; /* why it is not usable; empty if it is */
} host_device_info;

const char *host_device_type_name(VkPhysicalDeviceType type);

/* Fills `infos`, in the order of the loader, and returns how many there are (at most `capacity`). */
uint32_t host_devices_list(const host_instance *instance, host_device_info *infos, uint32_t capacity);

/* Selects a device. `wanted` is a number of the list, "gpu", "cpu" or part of a name in any case. NULL selects the best
 * usable one: discrete, integrated, virtual, then software. */
bool host_device_pick(const host_device_info *infos, uint32_t count, const char *wanted, uint32_t *index, char *error,
                      size_t error_size);

/* Fills `names` with the extensions to enable and returns their number: the swapchain if the device presents, and
 * VK_KHR_portability_subset if the device has it, because it must be enabled then. */
enum { HOST_DEVICE_EXTENSIONS = 2 };
uint32_t host_device_extensions(VkPhysicalDevice physical, bool presents, const char *names[HOST_DEVICE_EXTENSIONS]);

#endif
