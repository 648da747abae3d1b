/* device.h - the logical device with one queue, and the frames that are in flight. */
#ifndef VIRGA_HOST_DEVICE_H
#define VIRGA_HOST_DEVICE_H

#include "device_list.h"

#include <virga/vulkan.h>

#define HOST_FRAMES 2 /* command buffers in flight */

typedef struct host_frame {
    VkCommandPool pool;
    VkCommandBuffer cmd;
    VkFence fence;
    uint64_t index; /* of the frame last submitted from here; 0: none */
} host_frame;

typedef struct host_device {
    const host_instance *instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t queue_family;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties memory;
    bool independent_blend; /* false: glass is drawn as a cut-out */
    bool clip_distance;     /* false: puddles mirror the sky only */
    bool wide_lines;        /* enabled, see virga_context_def */
    float anisotropy;       /* of texture samplers; 0: not supported. May be lowered before a renderer is created */
    PFN_vkSetDebugUtilsObjectNameEXT set_name;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label;

    host_frame frames[HOST_FRAMES];
    uint64_t frame;     /* index of the frame being recorded, or of the last one; 1 is the first */
    uint64_t completed; /* last frame known to be complete */
    uint32_t live;      /* buffers and images of memory.h that exist */

    void (*warn)(void *user, const char *text); /* set after creation; NULL: a line on standard error */
    void *warn_user;
} host_device;

bool host_device_create(host_device *device, const host_instance *instance, const host_device_info *info, char *error,
                        size_t error_size);

/* The same for a VkDevice that the caller created. The host owns it from now on, also on failure. Optional features
 * count as not enabled. */
bool host_device_wrap(host_device *device, const host_instance *instance, const host_device_info *info, VkDevice made,
                      char *error, size_t error_size);

/* Definition of a context on this device, with all other fields at their defaults. */
virga_context_def host_context_def(const host_device *device);

/* Waits for the device and destroys it. Returns the number of buffers and images that were not destroyed, 0 if none
 * leaked. */
uint32_t host_device_destroy(host_device *device);

/* Reports one line, through device->warn. */
void host_warn(const host_device *device, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Names a Vulkan object for debuggers. Does nothing if the extension is not enabled. */
void host_name(const host_device *device, VkObjectType type, uint64_t handle, const char *name);
void host_label_begin(const host_device *device, VkCommandBuffer cmd, const char *name);
void host_label_end(const host_device *device, VkCommandBuffer cmd);

/* Waits until a command buffer is free, begins it and increments `device->frame`. */
bool host_begin_frame(host_device *device, VkCommandBuffer *cmd, char *error, size_t error_size);

/* Ends and submits the newest command buffer. */
bool host_submit(host_device *device, char *error, size_t error_size);

/* The same, but waits for `acquired` before colors are written, and signals `drawn` at the end. */
bool host_submit_for_window(host_device *device, VkSemaphore acquired, VkSemaphore drawn, char *error,
                            size_t error_size);

/* Waits until a frame is complete, which must be one of the newest HOST_FRAMES. */
bool host_wait_frame(host_device *device, uint64_t frame, char *error, size_t error_size);

/* Waits until all that was submitted is complete. */
bool host_wait(host_device *device, char *error, size_t error_size);

#endif
