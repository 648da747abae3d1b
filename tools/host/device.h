/* device.h - Vulkan instance with optional validation, the list of devices, the chosen device and its frames. */
#ifndef VIRGA_HOST_DEVICE_H
#define VIRGA_HOST_DEVICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

#define HOST_MAX_DEVICES 16
#define HOST_FRAMES 2 /* command buffers in flight */

/* ---- errors ------------------------------------------------------------------------------------------------- */

/* Writes one line into `error` (may be NULL) and returns false, so that `return host_fail(...)` reads well. */
bool host_fail(char *error, size_t error_size, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Name of a VkResult, e.g. "VK_ERROR_DEVICE_LOST". */
const char *host_result_name(VkResult result);

/* Wraps a Vulkan call in a function that has `error` and `error_size`: on failure it names the call and returns. */
#define HOST_TRY(call)                                                                                       \
    do {                                                                                                     \
        VkResult host_try_result = (call);                                                                   \
        if (host_try_result < 0)                                                                             \
            return host_fail(error, error_size, "%s gave %s", #call, host_result_name(host_try_result));     \
    } while (0)

/* ---- instance ----------------------------------------------------------------------------------------------- */

/* Must not move while it lives: the validation layer reports into it. */
typedef struct host_instance {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    bool validation;           /* layer and synchronization validation are on */
    bool debug_utils;          /* names and labels may be set */
    bool presents;             /* made for a window: devices get VK_KHR_swapchain */
    uint32_t messages;         /* warnings and errors the layer has reported so far */
    char first_message[1024];  /* the first of them */
} host_instance;

/* `validate`, or VIRGA_VALIDATE=1 in the environment, turns validation on; it is an error if the layer is absent. */
bool host_instance_create(host_instance *instance, bool validate, char *error, size_t error_size);

/* The same with the extensions that a window needs, at most 8, so that devices of it can present. */
bool host_instance_create_for_window(host_instance *instance, bool validate, const char *const *extensions,
                                     uint32_t extension_count, char *error, size_t error_size);
void host_instance_destroy(host_instance *instance);

/* Asks for devices that are not quite Vulkan too, where the loader knows of them: MoltenVK, the one of macOS. Writes
 * an extension's name behind the `info->enabledExtensionCount` of `extensions`, which has room for it. */
void host_ask_portability(VkInstanceCreateInfo *info, const char **extensions);

/* ---- which device ------------------------------------------------------------------------------------------- */

typedef struct host_device_info {
    VkPhysicalDevice physical;
    VkPhysicalDeviceType type;
    char name[VK_MAX_PHYSICAL_DEVICE_NAME_SIZE];
    char driver[VK_MAX_DRIVER_NAME_SIZE + VK_MAX_DRIVER_INFO_SIZE + 4];
    uint32_t api_version;
    uint32_t queue_family;   /* graphics and compute */
    VkDeviceSize memory_bytes; /* of device-local heaps */
    bool usable;
    char reason[256];        /* why not; empty if usable */
} host_device_info;

const char *host_device_type_name(VkPhysicalDeviceType type);

/* Fills `infos`, in the order of the loader, and returns how many there are (at most `capacity`). */
uint32_t host_devices_list(const host_instance *instance, host_device_info *infos, uint32_t capacity);

/* Chooses: `wanted` NULL takes the best usable (discrete, integrated, virtual, software); else a number of the list,
 * "gpu", "cpu", or part of a name in any case. */
bool host_device_pick(const host_device_info *infos, uint32_t count, const char *wanted, uint32_t *index, char *error,
                      size_t error_size);

/* The extensions that a device is made with: the swapchain where it is to present, and VK_KHR_portability_subset where
 * the device has it, as it must be enabled then. Returns how many of `names` are set. */
enum { HOST_DEVICE_EXTENSIONS = 2 };
uint32_t host_device_extensions(VkPhysicalDevice physical, bool presents, const char *names[HOST_DEVICE_EXTENSIONS]);

/* ---- the device --------------------------------------------------------------------------------------------- */

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
    bool independent_blend;   /* else glass is drawn as a cut-out */
    bool clip_distance;       /* else puddles mirror the sky alone */
    bool wide_lines;          /* enabled, see virga_context_def */
    float anisotropy;         /* of texture samplers; 0 where absent. May be lowered before a renderer is created */
    PFN_vkSetDebugUtilsObjectNameEXT set_name;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label;

    host_frame frames[HOST_FRAMES];
    uint64_t frame;           /* index of the frame being recorded, or of the last one; 1 is the first */
    uint64_t completed;       /* last frame known to be complete */
    uint32_t live;            /* buffers and images of memory.h that are alive */

    void (*warn)(void *user, const char *text); /* set after creation; NULL: a line on standard error */
    void *warn_user;
} host_device;

bool host_device_create(host_device *device, const host_instance *instance, const host_device_info *info, char *error,
                        size_t error_size);

/* Waits for the device, destroys it, returns the number of buffers and images that were still alive (0 is right). */
uint32_t host_device_destroy(host_device *device);

/* Says one warning line. */
void host_warn(const host_device *device, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Names a Vulkan object for debuggers; nothing where the extension is off. */
void host_name(const host_device *device, VkObjectType type, uint64_t handle, const char *name);
void host_label_begin(const host_device *device, VkCommandBuffer cmd, const char *name);
void host_label_end(const host_device *device, VkCommandBuffer cmd);

/* Waits until a command buffer is free, begins it and counts `device->frame` up. */
bool host_begin_frame(host_device *device, VkCommandBuffer *cmd, char *error, size_t error_size);

/* Ends and submits the command buffer begun last. */
bool host_submit(host_device *device, char *error, size_t error_size);

/* The same, but drawing waits for a semaphore before it writes colors, and signals another when all is done. */
bool host_submit_for_window(host_device *device, VkSemaphore acquired, VkSemaphore drawn, char *error,
                            size_t error_size);

/* Waits until a frame is complete, which must be one of the newest HOST_FRAMES. */
bool host_wait_frame(host_device *device, uint64_t frame, char *error, size_t error_size);

/* Waits until all that was submitted is complete. */
bool host_wait(host_device *device, char *error, size_t error_size);

#endif
