/* gpu/offscreen.c - see offscreen.h. */
#include "gpu/offscreen.h"

#include "gpu/context.h"
#include "gpu/errors.h"

#define MAX_ATTACHMENTS (VIRGA_OFFSCREEN_MAX_COLORS + 1)

static void offscreen_destroy(virga_context *context, virga_resource *resource)
{
    virga_offscreen *offscreen = (virga_offscreen *)resource;
    for (uint32_t i = 0; i < VIRGA_OFFSCREEN_MAX_LAYERS; i++)
        VIRGA_DESTROY(context, Framebuffer, offscreen->framebuffers[i]);
    VIRGA_DESTROY(context, RenderPass, offscreen->pass);
    VIRGA_DESTROY(context, RenderPass, offscreen->again);
    virga_free(&context->heap, offscreen);
}

void virga_offscreen_retire(virga_context *context, virga_offscreen **offscreen)
{
    if (!*offscreen)
        return;
    for (uint32_t i = 0; i < VIRGA_OFFSCREEN_MAX_COLORS; i++)
        VIRGA_RETIRE(context, (*offscreen)->colors[i]);
    VIRGA_RETIRE(context, (*offscreen)->depth);
    VIRGA_RETIRE(context, *offscreen);
}

static virga_result create_images(virga_context *context, const virga_offscreen_def *def, virga_offscreen *made)
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < made->color_count; i++)
        TRY(virga_image_create(context, def->colors[i], def->extent, def->layers,
                               VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | def->color_usage,
                               VK_IMAGE_ASPECT_COLOR_BIT, def->name, &made->colors[i]));
    if (def->depth)
        TRY(virga_image_create(context, def->depth, def->extent, def->layers,
                               VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                   def->depth_usage,
                               VK_IMAGE_ASPECT_DEPTH_BIT, def->name, &made->depth));
error:
    return result;
}

static VkAttachmentDescription describe_attachment(VkFormat format, VkImageLayout layout, bool keep)
{
    return (VkAttachmentDescription){.format = format,
                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                     .loadOp = keep ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR,
                                     .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                     .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                     .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                     .initialLayout = keep ? layout : VK_IMAGE_LAYOUT_UNDEFINED,
                                     .finalLayout = layout};
}

/* Earlier reads of the images complete before they are cleared, and later reads wait for the draw. */
static void describe_dependencies(const virga_offscreen_def *def, VkSubpassDependency dependencies[2])
{
    VkPipelineStageFlags draws = 0;
    VkAccessFlags writes = 0, reads = VK_ACCESS_SHADER_READ_BIT;
    if (def->colors[0]) {
        draws |= VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
        writes |= VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT;
    }
    if (def->depth) {
        draws |= VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
        writes |= VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    }
    if (def->readers & VK_PIPELINE_STAGE_TRANSFER_BIT)
        reads |= VK_ACCESS_TRANSFER_READ_BIT;
    dependencies[0] =
        (VkSubpassDependency){VK_SUBPASS_EXTERNAL, 0, def->readers | draws, draws, reads | writes, writes, 0};
    dependencies[1] = (VkSubpassDependency){0, VK_SUBPASS_EXTERNAL, draws, def->readers, writes, reads, 0};
}

static virga_result create_pass(virga_context *context, const virga_offscreen_def *def, const virga_offscreen *made,
                                bool keep, VkRenderPass *pass)
{
    virga_result result = VIRGA_OK;
    VkAttachmentDescription attachments[MAX_ATTACHMENTS];
    VkAttachmentReference colors[VIRGA_OFFSCREEN_MAX_COLORS];
    const VkAttachmentReference depth = {made->color_count, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDependency dependencies[2];
    for (uint32_t i = 0; i < made->color_count; i++) {
        attachments[i] = describe_attachment(def->colors[i], def->layout, keep);
        colors[i] = (VkAttachmentReference){i, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    }
    if (def->depth)
        attachments[made->color_count] = describe_attachment(def->depth, def->layout, keep);
    describe_dependencies(def, dependencies);
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = made->color_count,
                                          .pColorAttachments = colors,
                                          .pDepthStencilAttachment = def->depth ? &depth : NULL};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = made->color_count + (def->depth ? 1 : 0),
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = dependencies};
    VK_TRY(context, CreateRenderPass(context->device, &info, NULL, pass));
    context->objects++;
error:
    return result;
}

static virga_result create_framebuffers(virga_context *context, uint32_t layers, virga_offscreen *made)
{
    virga_result result = VIRGA_OK;
    for (uint32_t layer = 0; layer < layers; layer++) {
        VkImageView views[MAX_ATTACHMENTS];
        for (uint32_t i = 0; i < made->color_count; i++)
            views[i] = made->colors[i]->layer_views[layer];
        if (made->depth)
            views[made->color_count] = made->depth->layer_views[layer];
        const VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                              .renderPass = made->pass,
                                              .attachmentCount = made->color_count + (made->depth ? 1 : 0),
                                              .pAttachments = views,
                                              .width = made->extent.width,
                                              .height = made->extent.height,
                                              .layers = 1};
        VK_TRY(context, CreateFramebuffer(context->device, &info, NULL, &made->framebuffers[layer]));
        context->objects++;
    }
error:
    return result;
}

virga_result virga_offscreen_create(virga_context *context, const virga_offscreen_def *def, virga_offscreen **offscreen)
{
    virga_result result = VIRGA_OK;
    virga_offscreen *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, def->name);
    made->resource.destroy = offscreen_destroy;
    made->extent = def->extent;
    made->reversed_depth = def->reversed_depth;
    while (made->color_count < VIRGA_OFFSCREEN_MAX_COLORS && def->colors[made->color_count])
        made->color_count++;
    TRY(create_images(context, def, made));
    TRY(create_pass(context, def, made, false, &made->pass));
    TRY(create_pass(context, def, made, true, &made->again));
    TRY(create_framebuffers(context, def->layers, made));
    *offscreen = made;
    return VIRGA_OK;
error:
    virga_offscreen_retire(context, &made);
    return result;
}

static void begin(virga_context *context, VkCommandBuffer cmd, const virga_offscreen *offscreen, VkRenderPass pass,
                  uint32_t layer)
{
    VkClearValue clears[MAX_ATTACHMENTS] = {{.color = {.uint32 = {0}}}};
    clears[offscreen->color_count].depthStencil.depth = offscreen->reversed_depth ? 0 : 1;
    const VkRenderPassBeginInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                        .renderPass = pass,
                                        .framebuffer = offscreen->framebuffers[layer],
                                        .renderArea = {{0, 0}, offscreen->extent},
                                        .clearValueCount = offscreen->color_count + (offscreen->depth ? 1 : 0),
                                        .pClearValues = clears};
    const VkViewport viewport = {0, 0, (float)offscreen->extent.width, (float)offscreen->extent.height, 0, 1};
    context->vk.CmdBeginRenderPass(cmd, &info, VK_SUBPASS_CONTENTS_INLINE);
    context->vk.CmdSetViewport(cmd, 0, 1, &viewport);
    context->vk.CmdSetScissor(cmd, 0, 1, &info.renderArea);
}

void virga_offscreen_begin(virga_context *context, VkCommandBuffer cmd, const virga_offscreen *offscreen,
                           uint32_t layer)
{
    begin(context, cmd, offscreen, offscreen->pass, layer);
}

void virga_offscreen_resume(virga_context *context, VkCommandBuffer cmd, const virga_offscreen *offscreen,
                            uint32_t layer)
{
    begin(context, cmd, offscreen, offscreen->again, layer);
}

void virga_offscreen_end(virga_context *context, VkCommandBuffer cmd)
{
    context->vk.CmdEndRenderPass(cmd);
}
