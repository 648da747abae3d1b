/* instance.c - the Vulkan instance, with the validation layer and synchronization validation where asked for. */
#include "device.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <virga/vulkan.h>

#define VALIDATION_LAYER       "VK_LAYER_KHRONOS_validation"
#define MESSAGES_PRINTED       16 /* after that they are counted only */
#define MOST_WINDOW_EXTENSIONS 8

bool host_fail(char *error, size_t error_size, const char *format, ...)
{
    if (!error || error_size == 0)
        return false;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error, error_size, format, arguments);
    va_end(arguments);
    return false;
}

const char *host_result_name(VkResult result)
{
    switch (result) {
    case VK_SUCCESS: return "VK_SUCCESS";
    case VK_NOT_READY: return "VK_NOT_READY";
    case VK_TIMEOUT: return "VK_TIMEOUT";
    case VK_INCOMPLETE: return "VK_INCOMPLETE";
    case VK_ERROR_OUT_OF_HOST_MEMORY: return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED: return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST: return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED: return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT: return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT: return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT: return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "VK_ERROR_INCOMPATIBLE_DRIVER: there is no Vulkan driver (on Debian mesa-vulkan-drivers has software "
               "Vulkan)";
    case VK_ERROR_TOO_MANY_OBJECTS: return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_FORMAT_NOT_SUPPORTED: return "VK_ERROR_FORMAT_NOT_SUPPORTED";
    default: return "an unknown error";
    }
}

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    (void)severity;
    (void)types;
    host_instance *instance = user;
    /* The loader's own chatter (a driver manifest that is absent) comes this way too, and is no finding. */
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

void host_ask_portability(VkInstanceCreateInfo *info, const char **extensions)
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

bool host_instance_create_for_window(host_instance *instance, bool validate, const char *const *window_extensions,
                                     uint32_t window_extension_count, char *error, size_t error_size)
{
    memset(instance, 0, sizeof *instance);
    instance->presents = window_extension_count > 0;
    const char *asked = getenv("VIRGA_VALIDATE");
    validate = validate || (asked && *asked && strcmp(asked, "0") != 0);

    uint32_t version = VK_API_VERSION_1_0;
    HOST_TRY(vkEnumerateInstanceVersion(&version));
    if (version < VIRGA_VULKAN_API)
        return host_fail(error, error_size, "the Vulkan loader is older than Vulkan 1.2");
    if (validate && !has_layer(VALIDATION_LAYER))
        return host_fail(error, error_size, "validation was asked for, but %s is not installed", VALIDATION_LAYER);

    instance->validation = validate;
    instance->debug_utils = has_extension(NULL, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    const char *layers[] = {VALIDATION_LAYER};
    const char *extensions[3 + MOST_WINDOW_EXTENSIONS];
    uint32_t extension_count = 0;
    while (extension_count < window_extension_count && extension_count < MOST_WINDOW_EXTENSIONS) {
        extensions[extension_count] = window_extensions[extension_count];
        extension_count++;
    }
    if (instance->debug_utils)
        extensions[extension_count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    if (validate && has_extension(VALIDATION_LAYER, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME))
        extensions[extension_count++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;

    VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = instance,
    };
    const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = instance->debug_utils ? &messenger : NULL, /* catches what create and destroy do wrong too */
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = enables,
    };
    VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "virga",
        .apiVersion = VIRGA_VULKAN_API,
    };
    VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validate ? &features : NULL,
        .pApplicationInfo = &application,
        .enabledLayerCount = validate ? 1 : 0,
        .ppEnabledLayerNames = layers,
        .enabledExtensionCount = extension_count,
        .ppEnabledExtensionNames = extensions,
    };
    host_ask_portability(&info, extensions);
    HOST_TRY(vkCreateInstance(&info, NULL, &instance->instance));

    PFN_vkCreateDebugUtilsMessengerEXT create_messenger =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance->instance, "vkCreateDebugUtilsMessengerEXT");
    if (validate && create_messenger)
        HOST_TRY(create_messenger(instance->instance, &messenger, NULL, &instance->messenger));
    return true;
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
    instance->instance = VK_NULL_HANDLE; /* the message count stays readable */
    instance->messenger = VK_NULL_HANDLE;
}
