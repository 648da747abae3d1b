/* amd_driver.h - Mesa's null device of a GPU of AMD, which compiles and does nothing else. */
#ifndef VIRGA_TESTS_AMD_DRIVER_H
#define VIRGA_TESTS_AMD_DRIVER_H

#include "amd_table.h"
#include "stand_in.h"

typedef struct amd_driver {
    char name[VK_MAX_PHYSICAL_DEVICE_NAME_SIZE + 64]; /* of device and driver */
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    PFN_vkCreateRenderPass create_render_pass;
    PFN_vkDestroyRenderPass destroy_render_pass;
} amd_driver;

/* Opens the device of `card`, a name of RADV_FORCE_FAMILY, and makes it the compiler of the stand-in. What is compiled
 * from then on is added to the table. NULL, or why there is no such device. */
const char *amd_driver_open(amd_driver *driver, const char *card, amd_table *table);
void amd_driver_close(amd_driver *driver);

/* For virga_context_def.get_instance_proc_addr: asks the compiler for statistics. */
PFN_vkVoidFunction VKAPI_CALL amd_driver_get(VkInstance instance, const char *name);

#endif
