/* gpu/target.c - what draws go into: a host's render pass, or its dynamic rendering. */
#include "gpu/context.h"

#define TARGET_COOKIE VIRGA_COOKIE(2)

virga_target_def virga_default_target_def(void)
{
    return (virga_target_def){.size = sizeof(virga_target_def),
                              .cookie = TARGET_COOKIE,
                              .color_count = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .depth_attached = true};
}

static virga_result check_def(const virga_log *log, const virga_target_def *def)
{
    const virga_result result =
        virga_settings_check(log, "target_def", def->size, sizeof *def, def->cookie, TARGET_COOKIE);
    if (result)
        return result;
    if ((uint32_t)def->kind > VIRGA_TARGET_DYNAMIC)
        return virga_wrong_argument(log, "target_def.kind: there is no kind %d", (int)def->kind);
    if (!def->samples || (uint32_t)def->samples > 64 || (def->samples & (def->samples - 1)))
        return virga_wrong_argument(log, "target_def.samples: expected a power of two up to 64, got %u",
                                    (unsigned)def->samples);
    if (def->color_count < 1 || def->color_count > 8)
        return virga_wrong_argument(log, "target_def.color_count: expected 1 to 8, got %u", def->color_count);
    if (def->kind == VIRGA_TARGET_RENDER_PASS && !def->render_pass)
        return virga_wrong_argument(log, "target_def.render_pass: expected a VkRenderPass for this kind, got none");
    if (def->kind == VIRGA_TARGET_DYNAMIC && def->color_format == VK_FORMAT_UNDEFINED)
        return virga_wrong_argument(log, "target_def.color_format: expected a format for dynamic rendering, got none");
    if (def->kind == VIRGA_TARGET_DYNAMIC && def->depth_attached && def->depth_format == VK_FORMAT_UNDEFINED)
        return virga_wrong_argument(log, "target_def.depth_format: expected a format, as depth_attached is set");
    return VIRGA_OK;
}

virga_result virga_target_create(virga_context *context, const virga_target_def *def, virga_target **target)
{
    if (target)
        *target = NULL;
    if (!context || !def || !target)
        return virga_wrong_argument(context ? &context->log : NULL, "virga_target_create: NULL argument");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    const virga_result result = check_def(&context->log, def);
    if (result)
        return result;
    virga_target *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, "a target");
    made->context = context;
    made->def = *def;
    made->serial = ++context->target_serial;
    *target = made;
    return VIRGA_OK;
}

void virga_target_destroy(virga_target **target)
{
    if (!target || !*target)
        return;
    virga_free(&(*target)->context->heap, *target);
    *target = NULL;
}

virga_result virga_target_pipeline(const virga_target *target, virga_graphics_def def, virga_pipeline **pipeline)
{
    VkFormat formats[8] = {target->def.color_format};
    const VkPipelineRenderingCreateInfo rendering = {.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                     .colorAttachmentCount = target->def.color_count,
                                                     .pColorAttachmentFormats = formats,
                                                     .depthAttachmentFormat = target->def.depth_format,
                                                     .stencilAttachmentFormat = target->def.stencil_format};
    def.color_count = target->def.color_count;
    def.samples = target->def.samples;
    def.depth_test = def.depth_test && target->def.depth_attached;
    def.reversed_depth = target->def.reversed_depth;
    if (target->def.kind == VIRGA_TARGET_DYNAMIC) {
        def.next = &rendering;
    } else {
        def.render_pass = target->def.render_pass;
        def.subpass = target->def.subpass;
    }
    return virga_graphics_pipeline_create(target->context, &def, pipeline);
}
