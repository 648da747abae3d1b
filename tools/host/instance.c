/* instance.c - the Vulkan instance, optionally with the validation layer and synchronization validation. */
#include "instance.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <virga/vulkan.h>

#define VALIDATION_LAYER      "VK_LAYER_KHRONOS_validation"
#define MESSAGES_PRINTED      16 /* further messages are only counted */
#define MAX_WINDOW_EXTENSIONS 8

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    (void)severity;
    (void)types;
    host_instance *instance = user;
    /* The loader reports here too, for example a missing driver manifest. Such messages do not count. */
    if (data->pMessageIdName && strcmp(data->pMessageIdName, "Loader Message") == 0)
        return VK_FALSE;
    if (instance->messages == 0)
        snprintf(instance->first_message, sizeof instance->first_message, "%s", data->pMessage);
    if (instance->messages < MESSAGES_PRINTED)
        fprintf(stderr, "validation: %s\n", data->pMessage);
    instance->messages++;
    return VK_FALSE;
}

static bool has_layer(const char *name)
{
    uint32_t count = 0;
    if (vkEnumerateInstanceLayerProperties(&count, NULL) != VK_SUCCESS || count == 0)
        return false;
    VkLayerProperties *layers = calloc(count, sizeof *layers);
    bool found = false;
    if (layers && vkEnumerateInstanceLayerProperties(&count, layers) >= 0)
        for (uint32_t i = 0; i < count && !found; i++)
            found = strcmp(layers[i].layerName, name) == 0;
    free(layers);
    return found;
}

static bool has_extension(const char *layer, const char *name)
{
    uint32_t count = 0;
    if (vkEnumerateInstanceExtensionProperties(layer, &count, NULL) != VK_SUCCESS || count == 0)
        return false;
    VkExtensionProperties *extensions = calloc(count, sizeof *extensions);
    bool found = false;
    if (extensions && vkEnumerateInstanceExtensionProperties(layer, &count, extensions) >= 0)
        for (uint32_t i = 0; i < count && !found; i++)
            found = strcmp(extensions[i].extensionName, name) == 0;
    free(extensions);
    return found;
}

void host_request_portability(VkInstanceCreateInfo *info, const char **extensions)
{
    if (!has_extension(NULL, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME))
        return;
    extensions[info->enabledExtensionCount++] = VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME;
    info->ppEnabledExtensionNames = extensions;
    info->flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;
}

bool host_instance_create(host_instance *instance, bool validate, char *error, size_t error_size)
{
    return host_instance_create_for_window(instance, validate, NULL, 0, error, error_size);
}

/* Whether the required layers and extensions exist. */
static bool check_support(const host_instance *instance, char *error, size_t error_size)
{
    uint32_t version = VK_API_VERSION_1_0;
    HOST_TRY(vkEnumerateInstanceVersion(&version));
    if (version < VIRGA_VULKAN_API)
        return host_fail(error, error_size, "the Vulkan loader is older than Vulkan 1.2");
    if (instance->validation && !has_layer(VALIDATION_LAYER))
        return host_fail(error, error_size, "validation was asked for, but %s is not installed", VALIDATION_LAYER);
    return true;
}

/* Fills `extensions` and returns how many there are. */
static uint32_t list_extensions(const host_instance *instance, const char *const *of_window, uint32_t window_count,
                                const char *extensions[2 + MAX_WINDOW_EXTENSIONS])
{
    uint32_t count = 0;
    for (; count < window_count && count < MAX_WINDOW_EXTENSIONS; count++)
        extensions[count] = of_window[count];
    if (instance->debug_utils)
        extensions[count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    if (instance->validation && has_extension(VALIDATION_LAYER, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME))
        extensions[count++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
    return count;
}

static VkDebugUtilsMessengerCreateInfoEXT describe_messenger(host_instance *instance)
{
    return (VkDebugUtilsMessengerCreateInfoEXT){
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = instance,
    };
}

static bool create_messenger(host_instance *instance, const VkDebugUtilsMessengerCreateInfoEXT *info, char *error,
                             size_t error_size)
{
    PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance->instance, "vkCreateDebugUtilsMessengerEXT");
    if (instance->validation && create)
        HOST_TRY(create(instance->instance, info, NULL, &instance->messenger));
    return true;
}

bool host_instance_create_for_window(host_instance *instance, bool validate, const char *const *window_extensions,
                                     uint32_t window_extension_count, char *error, size_t error_size)
{
    memset(instance, 0, sizeof *instance);
    const char *variable = getenv("VIRGA_VALIDATE");
    instance->presents = window_extension_count > 0;
    instance->validation = validate || (variable && *variable && strcmp(variable, "0") != 0);
    if (!check_support(instance, error, error_size))
        return false;
    instance->debug_utils = has_extension(NULL, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    const char *layers[] = {VALIDATION_LAYER}, *extensions[3 + MAX_WINDOW_EXTENSIONS];
    const VkDebugUtilsMessengerCreateInfoEXT messenger = describe_messenger(instance);
    const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = instance->debug_utils ? &messenger : NULL, /* also checks the calls that create and destroy it */
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = enables,
    };
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "virga",
        .apiVersion = VIRGA_VULKAN_API,
    };
    VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = instance->validation ? &features : NULL,
        .pApplicationInfo = &application,
        .enabledLayerCount = instance->validation ? 1 : 0,
        .ppEnabledLayerNames = layers,
        .enabledExtensionCount = list_extensions(instance, window_extensions, window_extension_count, extensions),
        .ppEnabledExtensionNames = extensions,
    };
    host_request_portability(&info, extensions);
    HOST_TRY(vkCreateInstance(&info, NULL, &instance->instance));
    return create_messenger(instance, &messenger, error, error_size);
}

void host_instance_destroy(host_instance *instance)
{
    if (!instance->instance)
        return;
    PFN_vkDestroyDebugUtilsMessengerEXT destroy_messenger = (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
        instance->instance, "vkDestroyDebugUtilsMessengerEXT");
    if (instance->messenger && destroy_messenger)
        destroy_messenger(instance->instance, instance->messenger, NULL);
    vkDestroyInstance(instance->instance, NULL);
    instance->instance = VK_NULL_HANDLE; /* the message count can still be read */
    instance->messenger = VK_NULL_HANDLE;
}
