/* gpu/names.c - names of Vulkan objects, for debuggers and validation. */
#include "gpu/names.h"

#include "gpu/context.h"

void virga_set_name(virga_context *context, VkObjectType type, uint64_t handle, const char *name)
{
    if (!context->debug_names || !context->vk.SetDebugUtilsObjectNameEXT)
        return;
    const VkDebugUtilsObjectNameInfoEXT info = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                                .objectType = type,
                                                .objectHandle = handle,
                                                .pObjectName = name};
    context->vk.SetDebugUtilsObjectNameEXT(context->device, &info);
}
