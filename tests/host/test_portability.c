/* test_portability.c - devices that are not quite Vulkan (MoltenVK) show themselves only to who asks for them, and must
 * be made with the extension that says so. There is none here: the loader's answers are made up. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "device.h"

static const char *known; /* the one extension that there is; NULL: none */

static VkResult tell(uint32_t *count, VkExtensionProperties *properties)
{
    if (properties && known)
        strcpy(properties[0].extensionName, known);
    *count = known ? 1 : 0;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL vkEnumerateInstanceExtensionProperties(const char *layer, uint32_t *count,
                                                                      VkExtensionProperties *properties)
{
    (void)layer;
    return tell(count, properties);
}

VKAPI_ATTR VkResult VKAPI_CALL vkEnumerateDeviceExtensionProperties(VkPhysicalDevice device, const char *layer,
                                                                    uint32_t *count, VkExtensionProperties *properties)
{
    (void)device;
    (void)layer;
    return tell(count, properties);
}

static void an_instance_asks_for_such_devices_where_the_loader_knows_them(void **state)
{
    (void)state;
    const char *extensions[2] = {"VK_KHR_surface", NULL};
    VkInstanceCreateInfo info = {.enabledExtensionCount = 1, .ppEnabledExtensionNames = extensions};
    known = "VK_KHR_portability_enumeration";
    host_request_portability(&info, extensions);
    assert_int_equal(info.enabledExtensionCount, 2);
    assert_string_equal(info.ppEnabledExtensionNames[1], known);
    assert_int_equal(info.flags, VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR);
}

static void an_instance_of_an_older_loader_does_not(void **state)
{
    (void)state;
    const char *extensions[1] = {NULL};
    VkInstanceCreateInfo info = {.enabledExtensionCount = 0};
    known = "VK_KHR_surface";
    host_request_portability(&info, extensions);
    assert_int_equal(info.enabledExtensionCount, 0);
    assert_int_equal(info.flags, 0);
}

static void such_a_device_is_made_with_the_extension_that_says_so(void **state)
{
    (void)state;
    const char *names[HOST_DEVICE_EXTENSIONS];
    known = "VK_KHR_portability_subset";
    assert_int_equal(host_device_extensions(VK_NULL_HANDLE, false, names), 1);
    assert_string_equal(names[0], known);
    assert_int_equal(host_device_extensions(VK_NULL_HANDLE, true, names), 2);
    assert_string_equal(names[0], "VK_KHR_swapchain");
    assert_string_equal(names[1], known);
    known = NULL;
    assert_int_equal(host_device_extensions(VK_NULL_HANDLE, false, names), 0);
    assert_int_equal(host_device_extensions(VK_NULL_HANDLE, true, names), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_instance_asks_for_such_devices_where_the_loader_knows_them),
        cmocka_unit_test(an_instance_of_an_older_loader_does_not),
        cmocka_unit_test(such_a_device_is_made_with_the_extension_that_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
