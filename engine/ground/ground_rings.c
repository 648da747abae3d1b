/* ground/ground_rings.c - the ripple map: a table of waves, and a pass that adds up all active rings. */
#include "ground/ground_internal.h"

#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/retire.h"
#include "ground/ring_table.h"

#include "shaders/ground_ring_frag.spv.h"
#include "shaders/ground_ring_vert.spv.h"

#include <math.h>
#include <string.h>

#define WAVE_VALUES ((size_t)VIRGA_RING_DEPTHS * VIRGA_RING_TIMES * VIRGA_RING_RADII)

static void ripples_destroy(virga_context *context, virga_resource *resource)
{
    ground_ripples *ripples = (ground_ripples *)resource;
    VIRGA_DESTROY(context, Framebuffer, ripples->framebuffer);
    VIRGA_DESTROY(context, RenderPass, ripples->pass);
    virga_free(&context->heap, ripples);
}

void ground_ripples_retire(virga_context *context, ground_ripples **ripples)
{
    if (!*ripples)
        return;
    VIRGA_RETIRE(context, (*ripples)->map);
    VIRGA_RETIRE(context, (*ripples)->waves);
    VIRGA_RETIRE(context, (*ripples)->upload);
    VIRGA_RETIRE(context, (*ripples)->pipeline);
    VIRGA_RETIRE(context, *ripples);
}

VkDeviceSize ground_ripples_bytes(uint32_t texels)
{
    const VkDeviceSize map = (VkDeviceSize)texels * texels * 4, waves = WAVE_VALUES * 4 * sizeof(uint16_t);
    return map + 2 * waves; /* and their upload buffer */
}

static virga_result create_pass(virga_context *context, ground_ripples *ripples)
{
    virga_result result = VIRGA_OK;
    const VkAttachmentDescription attachment = {.format = VK_FORMAT_R16G16_SFLOAT,
                                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                                .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                                .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                                .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                                .finalLayout = VK_IMAGE_LAYOUT_GENERAL};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {
        .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS, .colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkPipelineStageFlags readers = VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                                         VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkPipelineStageFlags draws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT;
    const VkSubpassDependency dependencies[2] = {
        {VK_SUBPASS_EXTERNAL, 0, readers | draws, draws, VK_ACCESS_SHADER_READ_BIT | writes, writes, 0},
        {0, VK_SUBPASS_EXTERNAL, draws, readers, writes, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT, 0}};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = dependencies};
    VK_TRY(context, CreateRenderPass(context->device, &info, NULL, &ripples->pass));
    context->objects++;
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = ripples->pass,
                                                 .attachmentCount = 1,
                                                 .pAttachments = &ripples->map->layer_views[0],
                                                 .width = ripples->map->extent.width,
                                                 .height = ripples->map->extent.height,
                                                 .layers = 1};
    VK_TRY(context, CreateFramebuffer(context->device, &framebuffer, NULL, &ripples->framebuffer));
    context->objects++;
error:
    return result;
}

/* An entry of the wave table as its image stores it: slope divided by radius, faded to zero near the end of the table.
 * A pixel multiplies it by its offset from the centre. Radii are in centimetres, because in metres the slopes of the
 * crater may exceed half floats. In the centre both slope and radius are 0, so the entry of the next radius is used;
 * the difference is negligible. */
static uint16_t wave_entry(const float *slopes, size_t i)
{
    const size_t radius = i % VIRGA_RING_RADII, time = i / VIRGA_RING_RADII % VIRGA_RING_TIMES;
    const size_t middle = radius > 0 ? 0 : 1;
    const double reach = ring_reach((double)time * VIRGA_RING_TIME_S / (VIRGA_RING_TIMES - 1));
    const double share = (double)(radius + middle) / (VIRGA_RING_RADII - 1);
    const double last = fmin(fmax((share - 0.9) / 0.1, 0), 1), ends = 1 - last * last * (3 - 2 * last);
    return ring_half((float)((double)slopes[i + middle] * ends / (100 * share * reach)));
}

/* A texel stores four entries: this one, the next radius, and both at the next time (0 past the end). One fetch then
 * replaces the four that a bilinear filter needs. */
static void fill_texels(const uint16_t *entries, uint16_t *texels)
{
    for (size_t i = 0; i < WAVE_VALUES; i++) {
        const size_t radius = i % VIRGA_RING_RADII, time = i / VIRGA_RING_RADII % VIRGA_RING_TIMES;
        for (size_t corner = 0; corner < 4; corner++) {
            const bool there = radius + corner % 2 < VIRGA_RING_RADII && time + corner / 2 < VIRGA_RING_TIMES;
            texels[4 * i + corner] = there ? entries[i + corner % 2 + corner / 2 * VIRGA_RING_RADII] : 0;
        }
    }
}

static virga_result create_waves(virga_context *context, double texel_m, ground_ripples *ripples)
{
    virga_result result = VIRGA_OK;
    float *slopes = virga_alloc_array(&context->heap, WAVE_VALUES, sizeof *slopes);
    uint16_t *entries = virga_alloc_array(&context->heap, WAVE_VALUES, sizeof *entries);
    if (!slopes || !entries) {
        result = virga_out_of_host_memory(context, "the table of rings");
        goto error;
    }
    TRY(virga_image_create(context, VK_FORMAT_R16G16B16A16_SFLOAT, (VkExtent2D){VIRGA_RING_RADII, VIRGA_RING_TIMES},
                           VIRGA_RING_DEPTHS, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, "ground.waves", &ripples->waves));
    TRY(virga_buffer_create(context, WAVE_VALUES * 4 * sizeof(uint16_t), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                            VIRGA_HEAP_UPLOAD, "ground.waves_upload", &ripples->upload));
    ring_table_fill(slopes, 0.5 * texel_m);
    for (size_t i = 0; i < WAVE_VALUES; i++)
        entries[i] = wave_entry(slopes, i);
    fill_texels(entries, ripples->upload->memory.block.mapped);
    virga_buffer_flush(context, ripples->upload, 0, ripples->upload->size);
    TRY(virga_check_uploads(context));
error:
    virga_free(&context->heap, entries);
    virga_free(&context->heap, slopes);
    return result;
}

virga_result ground_ripples_create(virga_context *context, uint32_t texels, double texel_m, VkPipelineLayout layout,
                                   virga_pipeline_group *group, ground_ripples **ripples)
{
    virga_result result = VIRGA_OK;
    ground_ripples *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, "ripples");
    made->resource.destroy = ripples_destroy;
    TRY(virga_image_create(context, VK_FORMAT_R16G16_SFLOAT, (VkExtent2D){texels, texels}, 1,
                           VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                               VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, "ground.ripples", &made->map));
    TRY(create_waves(context, texel_m, made));
    TRY(create_pass(context, made));
    const virga_graphics_def def = {.vertex = VIRGA_SPIRV(ground_ring_vert),
                                    .fragment = VIRGA_SPIRV(ground_ring_frag),
                                    .layout = layout,
                                    .render_pass = made->pass,
                                    .color_count = 1,
                                    .blend_add = true,
                                    .group = group,
                                    .name = "ground.ripples"};
    TRY(virga_graphics_pipeline_create(context, &def, &made->pipeline));
    *ripples = made;
    return VIRGA_OK;
error:
    ground_ripples_retire(context, &made);
    return result;
}

void ground_ripples_upload(virga_context *context, VkCommandBuffer cmd, ground_ripples *ripples)
{
    const virga_image_state before = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0};
    const virga_image_state filled = {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                      VK_ACCESS_TRANSFER_WRITE_BIT};
    const virga_image_state ready = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                     VK_ACCESS_SHADER_READ_BIT};
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, VIRGA_RING_DEPTHS},
                                    .imageExtent = {VIRGA_RING_RADII, VIRGA_RING_TIMES, 1}};
    virga_image_barrier(context, cmd, ripples->waves->image, VK_IMAGE_ASPECT_COLOR_BIT, before, filled);
    context->vk.CmdCopyBufferToImage(cmd, ripples->upload->buffer, ripples->waves->image, filled.layout, 1, &copy);
    virga_image_barrier(context, cmd, ripples->waves->image, VK_IMAGE_ASPECT_COLOR_BIT, filled, ready);
    VIRGA_RETIRE(context, ripples->upload);
}

void ground_ripples_draw(virga_context *context, VkCommandBuffer cmd, const ground_ripples *ripples)
{
    const VkExtent2D extent = ripples->map->extent;
    const VkClearValue clear = {.color = {.float32 = {0, 0, 0, 0}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = ripples->pass,
                                         .framebuffer = ripples->framebuffer,
                                         .renderArea = {{0, 0}, extent},
                                         .clearValueCount = 1,
                                         .pClearValues = &clear};
    const VkViewport viewport = {0, 0, (float)extent.width, (float)extent.height, 0, 1};
    context->vk.CmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    context->vk.CmdSetViewport(cmd, 0, 1, &viewport);
    context->vk.CmdSetScissor(cmd, 0, 1, &begin.renderArea);
    context->vk.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, ripples->pipeline->pipeline);
    context->vk.CmdDraw(cmd, 6 * VIRGA_MAX_RINGS, 1, 0, 0);
    context->vk.CmdEndRenderPass(cmd);
}
