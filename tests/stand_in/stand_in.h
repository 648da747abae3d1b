/* stand_in.h - a Vulkan device that is no device: a test answers all calls of the library. No driver is needed.
 *
 * It counts objects, and ends the program with one line where Vulkan is misused: an object that does not exist is used
 * or destroyed, or one is destroyed that a frame still needs. Transfers, timestamps and fills are executed by
 * stand_in_submit, as far as their memory has contents: that of host-visible types has, that of the device has not.
 * Dispatches and draws are counted. One per process; calls come from one thread.
 *
 * With `through`, the functions that compile shaders go to a real driver. Mesa's null device (RADV_FORCE_FAMILY)
 * compiles to a GPU's code, but crashes in most other calls. */
#ifndef VIRGA_TESTS_STAND_IN_H
#define VIRGA_TESTS_STAND_IN_H

#include <stdbool.h>
#include <stdint.h>

#include <vulkan/vulkan.h>

/* All zero: nothing fails. Tests change it at any time. */
typedef struct stand_in_state {
    uint32_t fail_in; /* the call that fails, counted from 1 among those that can; 0: none. Becomes 0 then */
    VkResult failure; /* what it returns; VK_ERROR_DEVICE_LOST: so do all later calls */
    bool lost;        /* the device is lost */
    bool failed;      /* a call has failed since the test reset this */
    bool unbuilt;     /* a pipeline could not be created since the test reset this */

    bool in_order;    /* objects must live until the frames that use them are done, see stand_in_done */
    uint32_t garbage; /* what is copied out of the device's memory: 0: zeros; else numbers that follow from this seed */

    uint32_t live; /* objects that exist, without those of stand_in_open and of the test */

    /* (optional) The driver that compiles: shader modules, layouts, render passes, caches and pipelines. Set it with
     * its handles before stand_in_get is used. */
    PFN_vkGetInstanceProcAddr through;
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;

    uint64_t timestamp_ns; /* from one timestamp to the next; 0: 1 */

    /* (optional) Called for each name that the library gives to an object. */
    void (*named)(VkObjectType type, uint64_t object, const char *name);

    /* Reported by the device. stand_in_open fills it as of a desktop GPU. */
    VkPhysicalDeviceProperties properties;
} stand_in_state;

extern stand_in_state stand_in;

/* Begins anew: forgets everything, and fills `properties`. */
void stand_in_open(void);

/* The entry point for virga_context_def.get_instance_proc_addr. NULL for names that it does not answer. */
PFN_vkVoidFunction VKAPI_CALL stand_in_get(VkInstance instance, const char *name);

/* Handles for the definition of a context. Two devices have the same properties. */
VkInstance stand_in_instance(void);
VkPhysicalDevice stand_in_physical(void);
VkDevice stand_in_device(uint32_t index);

/* An object of the test's own: of any type that is not dispatchable. Freed by stand_in_close. */
uint64_t stand_in_object(VkObjectType type);

/* What a command buffer has got since stand_in_begin. */
typedef struct stand_in_counts {
    uint32_t commands, dispatches, draws;
} stand_in_counts;

/* A command buffer, ready to record. It can be begun again and again. */
VkCommandBuffer stand_in_begin(VkCommandBuffer again);
stand_in_counts stand_in_count(VkCommandBuffer cmd);

/* The device executes a command buffer. What it uses is in use until stand_in_done. */
void stand_in_submit(VkCommandBuffer cmd);

/* Submissions up to this one are done. Submissions are numbered from 1. */
void stand_in_done(uint64_t submission);
uint64_t stand_in_submitted(void);

/* Frees the test's objects. False, with one line on stderr, if the library left any. */
bool stand_in_close(void);

#endif
