/* gpu/target_create.c - creates the target of draws, a host's render pass or its dynamic rendering, after checks of its
 * definition; and destroys it. */
#include "gpu/target.h"

#include "core/settings.h"
#include "gpu/context.h"
#include "gpu/effect_targets.h"
#include "gpu/errors.h"
#include "gpu/pipelines.h"
#include "gpu/view.h"

#include <stdio.h>
#include <string.h>

virga_target_def virga_default_target_def(void)
{
    return (virga_target_def){.size = sizeof(virga_target_def),
                              .cookie = virga_settings_cookie("target_def"),
                              .color_count = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .depth_attached = true,
                              .blend_background = 0.18f};
}

/* Checks that this device supports the use that `what` describes, if a format is given. */
static virga_result check_format(const virga_context *context, const char *name, VkFormat format,
                                 VkFormatFeatureFlags wanted, const char *what)
{
    VkFormatProperties found;
    if (format == VK_FORMAT_UNDEFINED)
        return VIRGA_OK;
    context->vk.GetPhysicalDeviceFormatProperties(context->physical_device, format, &found);
    if (found.optimalTilingFeatures & wanted)
        return VIRGA_OK;
    return virga_wrong_argument(&context->log,
                                "target_def.%s: expected a format that this device can %s, got VkFormat %d", name, what,
                                (int)format);
}

/* Checks an attachment for motion vectors or the reactive mask: it exists, is not the colour attachment, and supports
 * blending. */
static virga_result check_extra(virga_context *context, const virga_target_def *def, uint32_t index, const char *name)
{
    if (!index)
        return VIRGA_OK;
    if (index >= def->color_count)
        return virga_wrong_argument(&context->log, "target_def.%s: expected less than color_count (%u), got %u", name,
                                    def->color_count, index);
    const VkFormat format = def->color_formats[index];
    if (format == VK_FORMAT_UNDEFINED && def->kind == VIRGA_TARGET_DYNAMIC)
        return virga_wrong_argument(&context->log, "target_def.color_formats[%u]: expected a format for %s, got none",
                                    index, name);
    char member[32];
    snprintf(member, sizeof member, "color_formats[%u]", index);
    return check_format(context, member, format, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT, "blend");
}

static virga_result check_extras(virga_context *context, const virga_target_def *def)
{
    const virga_result result = check_extra(context, def, def->motion_attachment, "motion_attachment");
    if (result)
        return result;
    if (def->reactive_attachment && def->reactive_attachment == def->motion_attachment)
        return virga_wrong_argument(&context->log,
                                    "target_def.reactive_attachment: expected another than "
                                    "motion_attachment (%u)",
                                    def->motion_attachment);
    return check_extra(context, def, def->reactive_attachment, "reactive_attachment");
}

/* Otherwise an invalid pipeline would be created, which few drivers report. */
static virga_result check_formats(const virga_context *context, const virga_target_def *def)
{
    virga_result result = check_format(context, "color_formats[0]", def->color_formats[0],
                                       VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT, "blend");
    if (!result)
        result = check_format(context, "depth_format", def->depth_format,
                              VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, "test depth in");
    if (!result && def->depth_format == VK_FORMAT_S8_UINT)
        result = virga_wrong_argument(&context->log,
                                      "target_def.depth_format: expected a format with depth, got VkFormat %d",
                                      (int)def->depth_format);
    if (!result)
        result = check_format(context, "stencil_format", def->stencil_format,
                              VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, "have a stencil in");
    return result;
}

static virga_result check_def(const virga_log *log, const virga_target_def *def)
{
    const virga_result result = virga_settings_check(log, "target_def", def->size, sizeof *def, def->cookie);
    if (result)
        return result;
    if ((uint32_t)def->kind > VIRGA_TARGET_DYNAMIC)
        return virga_wrong_argument(log, "target_def.kind: there is no kind %d", (int)def->kind);
    if (!def->samples || (uint32_t)def->samples > 64 || (def->samples & (def->samples - 1)))
        return virga_wrong_argument(log, "target_def.samples: expected a power of two up to 64, got %u",
                                    (unsigned)def->samples);
    if (def->color_count < 1 || def->color_count > VIRGA_MAX_ATTACHMENTS)
        return virga_wrong_argument(log, "target_def.color_count: expected 1 to 8, got %u", def->color_count);
    if (def->kind == VIRGA_TARGET_RENDER_PASS && !def->render_pass)
        return virga_wrong_argument(log, "target_def.render_pass: expected a VkRenderPass for this kind, got none");
    if (def->kind == VIRGA_TARGET_DYNAMIC && def->color_formats[0] == VK_FORMAT_UNDEFINED)
        return virga_wrong_argument(log,
                                    "target_def.color_formats[0]: expected a format for dynamic rendering, got none");
    if (def->kind == VIRGA_TARGET_DYNAMIC && def->depth_attached && def->depth_format == VK_FORMAT_UNDEFINED)
        return virga_wrong_argument(log, "target_def.depth_format: expected a format, as depth_attached is set");
    return VIRGA_OK;
}

/* ---- a render pass, by what it was created with */

static virga_result check_attachment(const virga_context *context, const virga_target_def *def,
                                     const VkSubpassDescription *subpass, uint32_t index)
{
    const VkRenderPassCreateInfo *info = def->render_pass_info;
    const virga_log *log = &context->log;
    const uint32_t at = subpass->pColorAttachments[index].attachment;
    char member[48];
    if (at >= info->attachmentCount)
        return virga_wrong_argument(log, "target_def: color attachment %u of subpass %u is not used in the render pass",
                                    index, def->subpass);
    const VkAttachmentDescription *attachment = &info->pAttachments[at];
    if (def->color_formats[index] != VK_FORMAT_UNDEFINED && def->color_formats[index] != attachment->format)
        return virga_wrong_argument(log, "target_def.color_formats[%u]: expected the render pass's VkFormat %d, got %d",
                                    index, (int)attachment->format, (int)def->color_formats[index]);
    if (attachment->samples != def->samples)
        return virga_wrong_argument(log, "target_def.samples: expected %u, as the render pass has, got %u",
                                    (unsigned)attachment->samples, (unsigned)def->samples);
    snprintf(member, sizeof member, "render_pass: color attachment %u", index);
    return check_format(context, member, attachment->format, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT, "blend");
}

static virga_result check_pass_depth(const virga_log *log, const virga_target_def *def,
                                     const VkSubpassDescription *subpass)
{
    const VkAttachmentReference *depth = subpass->pDepthStencilAttachment;
    const bool there = depth && depth->attachment < def->render_pass_info->attachmentCount;
    const VkFormat format = there ? def->render_pass_info->pAttachments[depth->attachment].format : VK_FORMAT_UNDEFINED;
    const bool has_depth = there && format != VK_FORMAT_S8_UINT;
    if (has_depth == def->depth_attached)
        return VIRGA_OK;
    return virga_wrong_argument(log, "target_def.depth_attached: is %s, and subpass %u has %s depth attachment",
                                def->depth_attached ? "true" : "false", def->subpass, has_depth ? "a" : "no");
}

static virga_result check_pass(const virga_context *context, const virga_target_def *def)
{
    const virga_log *log = &context->log;
    const VkRenderPassCreateInfo *info = def->render_pass_info;
    if (def->kind != VIRGA_TARGET_RENDER_PASS)
        return VIRGA_OK;
    if (!info && context->strict)
        return virga_wrong_argument(log,
                                    "target_def.render_pass_info: expected it, as the context is strict; got NULL");
    if (!info)
        return VIRGA_OK;
    if (info->sType != VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO)
        return virga_wrong_argument(log, "target_def.render_pass_info: expected a VkRenderPassCreateInfo, got sType %d",
                                    (int)info->sType);
    if (def->subpass >= info->subpassCount)
        return virga_wrong_argument(log, "target_def.subpass: expected less than the render pass's %u, got %u",
                                    info->subpassCount, def->subpass);
    const VkSubpassDescription *subpass = &info->pSubpasses[def->subpass];
    if (subpass->colorAttachmentCount != def->color_count)
        return virga_wrong_argument(log, "target_def.color_count: expected %u, as subpass %u has, got %u",
                                    subpass->colorAttachmentCount, def->subpass, def->color_count);
    const uint32_t written[3] = {0, def->motion_attachment, def->reactive_attachment};
    virga_result result = VIRGA_OK;
    for (int i = 0; i < 3 && !result; i++)
        result = check_attachment(context, def, subpass, written[i]);
    return result ? result : check_pass_depth(log, def, subpass);
}

/* ---- several views */

/* The view mask with which the host made the subpass. */
static uint32_t mask_of_pass(const virga_target_def *def)
{
    for (const VkBaseInStructure *at = def->render_pass_info->pNext; at; at = at->pNext)
        if (at->sType == VK_STRUCTURE_TYPE_RENDER_PASS_MULTIVIEW_CREATE_INFO) {
            const VkRenderPassMultiviewCreateInfo *info = (const VkRenderPassMultiviewCreateInfo *)(const void *)at;
            return def->subpass < info->subpassCount ? info->pViewMasks[def->subpass] : 0;
        }
    return 0;
}

static virga_result check_view_mask(const virga_context *context, const virga_target_def *def)
{
    const virga_log *log = &context->log;
    if (def->kind == VIRGA_TARGET_RENDER_PASS && def->render_pass_info && mask_of_pass(def) != def->view_mask)
        return virga_wrong_argument(log, "target_def.view_mask: expected 0x%x, as subpass %u has, got 0x%x",
                                    mask_of_pass(def), def->subpass, def->view_mask);
    if (!def->view_mask)
        return VIRGA_OK;
    VkPhysicalDeviceMultiviewFeatures features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES};
    VkPhysicalDeviceFeatures2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features};
    VkPhysicalDeviceMultiviewProperties limits = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &limits};
    context->vk.GetPhysicalDeviceFeatures2(context->physical_device, &all);
    context->vk.GetPhysicalDeviceProperties2(context->physical_device, &properties);
    if (!features.multiview) {
        virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_FEATURE_MISSING,
                        "target_def.view_mask: the device lacks the feature multiview (passes of several views)");
        return VIRGA_ERROR_UNSUPPORTED;
    }
    if (limits.maxMultiviewViewCount < 32 && def->view_mask >> limits.maxMultiviewViewCount)
        return virga_wrong_argument(log, "target_def.view_mask: expected the bits of up to %u views, got 0x%x",
                                    limits.maxMultiviewViewCount, def->view_mask);
    return VIRGA_OK;
}

/* ---- encoding */

/* Formats into which hosts write colors as the screen shows them. */
static bool is_screen_format(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R5G6B5_UNORM_PACK16:
    case VK_FORMAT_B5G6R5_UNORM_PACK16:
    case VK_FORMAT_R8G8B8_UNORM:
    case VK_FORMAT_B8G8R8_UNORM:
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_A8B8G8R8_UNORM_PACK32:
    case VK_FORMAT_A2R10G10B10_UNORM_PACK32:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32: return true;
    default: return false;
    }
}

/* The format of attachment 0, as far as it is known. The subpass was checked. */
static VkFormat color_format_of(const virga_target_def *def)
{
    const VkRenderPassCreateInfo *info = def->kind == VIRGA_TARGET_RENDER_PASS ? def->render_pass_info : NULL;
    return info ? info->pAttachments[info->pSubpasses[def->subpass].pColorAttachments[0].attachment].format
                : def->color_formats[0];
}

static virga_result check_encoding(const virga_log *log, const virga_target_def *def)
{
    const VkFormat format = color_format_of(def);
    const virga_result result = virga_encoding_check(log, "target_def.encoding", def->encoding, format);
    if (result)
        return result;
    if (!(def->blend_background >= 0.0001f && def->blend_background <= 1))
        return virga_wrong_argument(log, "target_def.blend_background: expected 0.0001 to 1, got %g",
                                    (double)def->blend_background);
    if (def->encoding == VIRGA_ENCODING_NOT_GIVEN && is_screen_format(format))
        virga_log_write(log, VIRGA_LOG_WARNING, VIRGA_LOG_ENCODING,
                        "target_def.encoding: not given, so linear light is written into the UNORM VkFormat %d; where "
                        "the screen shows its values as they are, rain is too dark: give VIRGA_ENCODING_SRGB",
                        (int)format);
    return VIRGA_OK;
}

/* ---- create and destroy */

virga_result virga_target_create(virga_context *context, const virga_target_def *def, virga_target **target)
{
    if (target)
        *target = NULL;
    virga_result result = virga_context_check_create(context, def && target, "virga_target_create");
    if (!result)
        result = check_def(&context->log, def);
    if (!result)
        result = check_formats(context, def);
    if (!result)
        result = check_extras(context, def);
    if (!result)
        result = check_pass(context, def);
    if (!result)
        result = check_view_mask(context, def);
    if (!result)
        result = check_encoding(&context->log, def);
    if (result)
        return result;
    virga_target *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, "a target");
    made->context = context;
    made->def = *def;
    made->def.render_pass_info = NULL; /* the host's */
    result = virga_target_class_join(context, made);
    if (result) {
        virga_free(&context->heap, made);
        return result;
    }
    virga_context_join(context);
    made->next_target = context->first_target;
    context->first_target = made;
    *target = made;
    return VIRGA_OK;
}

void virga_target_destroy(virga_target **target)
{
    if (!target || !*target)
        return;
    virga_context *context = (*target)->context;
    virga_target **at = &context->first_target;
    while (*at != *target)
        at = &(*at)->next_target;
    *at = (*target)->next_target;
    (*target)->class_of->targets--;
    virga_target_class_use((*target)->class_of); /* an effect that leaves it must not free it yet */
    virga_effects_forget_target(*target);
    virga_target_class_leave(context, (*target)->class_of);
    virga_free(&context->heap, *target);
    *target = NULL;
    virga_context_leave(context);
}
