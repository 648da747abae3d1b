/* accumulate.c - sums of sub-frames on the device, and means on the CPU. */
#include "accumulate.h"

#include "descriptors.h"
#include "passes.h"
#include "pipeline.h"
#include "shaders/frame_gpu.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accumulate_frag.spv.h"
#include "accumulate_frag_pair.spv.h"

/* ---- pictures ----------------------------------------------------------------------------------------------- */

bool host_drawn_create(uint32_t width, uint32_t height, host_drawn *p, char *error, size_t error_size)
{
    const size_t pixels = (size_t)width * height;
    *p = (host_drawn){.width = width, .height = height};
    p->color = calloc(pixels, 4 * sizeof(float));
    p->normal = calloc(pixels, 4 * sizeof(float));
    p->velocity = calloc(pixels, 2 * sizeof(float));
    p->water = calloc(pixels, 2 * sizeof(float));
    p->depth = calloc(pixels, sizeof(float));
    p->id = calloc(pixels, sizeof(uint32_t));
    bool made = p->color && p->normal && p->velocity && p->water && p->depth && p->id;
    for (int i = 0; i < HOST_MAX_LAYERS; i++) {
        p->layers[i] = calloc(pixels, 4 * sizeof(float));
        made = made && p->layers[i];
    }
    if (made)
        return true;
    host_drawn_destroy(p);
    return host_fail(error, error_size, "no memory for a picture of %u x %u", width, height);
}

void host_drawn_destroy(host_drawn *p)
{
    free(p->color);
    for (int i = 0; i < HOST_MAX_LAYERS; i++)
        free(p->layers[i]);
    free(p->normal);
    free(p->velocity);
    free(p->water);
    free(p->depth);
    free(p->id);
    memset(p, 0, sizeof *p);
}

/* Where a picture has an output that is summed. */
static float *floats_of(const host_drawn *p, host_output output)
{
    switch (output) {
    case HOST_COLOR: return p->color;
    case HOST_NORMAL: return p->normal;
    case HOST_VELOCITY: return p->velocity;
    case HOST_WATER: return p->water;
    default: return p->layers[output - HOST_LAYER];
    }
}

static bool is_kept(const host_target *target, host_output output)
{
    return output == HOST_ID || output == HOST_DEPTH ||
           (output >= HOST_LAYER && target->kept_layers & 1u << (output - HOST_LAYER));
}

static bool is_summed(const host_target *target, int output)
{
    return target->images[output].image && !is_kept(target, (host_output)output);
}

static bool is_added(const host_accumulator *a, const host_target *target, int output)
{
    return is_summed(target, output) && !(a->skipped & 1u << output);
}

/* Whether the frame has its mean: none of the sub-frames may have added it. */
static bool is_there(const host_accumulator *a, const host_target *target, int output)
{
    return is_summed(target, output) && a->counts[output];
}

/* ---- create ------------------------------------------------------------------------------------------------- */

/* The output, weights. */
static const VkDescriptorType kinds[2] = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};

static const VkPipelineColorBlendAttachmentState blend_sum = {.blendEnable = VK_TRUE,
                                                              .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
                                                              .dstColorBlendFactor = VK_BLEND_FACTOR_ONE,
                                                              .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                                                              .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                                                              .colorWriteMask = 0xf};

/* Of passes and pipelines. */
static int kind_of(host_output output)
{
    return host_output_channels(output) == 2;
}

/* Sub-frames are added one after another, each by its pass. */
static bool create_pass(host_accumulator *a, VkFormat format, VkRenderPass *pass, char *error, size_t error_size)
{
    VkAttachmentDescription attachment = host_attachment(format, VK_IMAGE_LAYOUT_GENERAL);
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    const host_pass_def def = {
        .attachments = &attachment,
        .color_count = 1,
        .general = true,
        .before = {drawing, writes, drawing, writes | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT},
        .after = {drawing, writes, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT},
    };
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.initialLayout = VK_IMAGE_LAYOUT_GENERAL;
    return host_pass_create(a->device, &def, pass, error, error_size);
}

static bool create_pipelines(host_accumulator *a, char *error, size_t error_size)
{
    const VkFormat formats[2] = {host_output_format(HOST_COLOR), host_output_format(HOST_VELOCITY)};
    const host_code codes[2] = {HOST_CODE(accumulate_frag), HOST_CODE(accumulate_frag_pair)};
    for (int i = 0; i < 2; i++) {
        if (!create_pass(a, formats[i], &a->passes[i], error, error_size))
            return false;
        const host_graphics_def def = {.vertex = host_fullscreen_vertex(),
                                       .fragment = codes[i],
                                       .layout = a->layout,
                                       .pass = a->passes[i],
                                       .colors = &blend_sum,
                                       .color_count = 1};
        if (!host_graphics_create(a->device, &def, &a->add[i], error, error_size))
            return false;
    }
    return true;
}

static bool create_parts(host_accumulator *a, char *error, size_t error_size)
{
    const VkShaderStageFlags stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    const host_set_shape shape = {kinds, 2, stage};
    const uint32_t count = HOST_FRAMES * HOST_OUTPUT_COUNT;
    return host_buffer_create(a->device, sizeof(float), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_DEVICE,
                              "no weights", &a->no_weights, error, error_size) &&
           host_sampler_create(a->device, HOST_SAMPLE_NEAREST, &a->sampler, error, error_size) &&
           host_set_layout_create(a->device, &shape, &a->set_layout, error, error_size) &&
           host_set_pool_create(a->device, &shape, count, &a->pool, error, error_size) &&
           host_sets_allocate(a->device, a->pool, a->set_layout, count, a->sets[0], error, error_size) &&
           host_pipeline_layout_create(a->device, &a->set_layout, 1, stage, sizeof(struct host_accumulate_gpu),
                                       &a->layout, error, error_size) &&
           create_pipelines(a, error, error_size);
}

bool host_accumulator_create(host_device *device, uint32_t width, uint32_t height, host_accumulator *a, char *error,
                             size_t error_size)
{
    *a = (host_accumulator){.device = device, .width = width, .height = height};
    if (create_parts(a, error, error_size))
        return true;
    host_accumulator_destroy(a);
    return false;
}

void host_accumulator_destroy(host_accumulator *a)
{
    if (!a->device)
        return;
    for (int i = 0; i < 2; i++) {
        vkDestroyPipeline(a->device->device, a->add[i], NULL);
        vkDestroyRenderPass(a->device->device, a->passes[i], NULL);
    }
    vkDestroyPipelineLayout(a->device->device, a->layout, NULL);
    vkDestroyDescriptorPool(a->device->device, a->pool, NULL);
    vkDestroyDescriptorSetLayout(a->device->device, a->set_layout, NULL);
    vkDestroySampler(a->device->device, a->sampler, NULL);
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++) {
        vkDestroyFramebuffer(a->device->device, a->framebuffers[i], NULL);
        host_image_destroy(a->device, &a->sums[i]);
    }
    host_buffer_destroy(a->device, &a->no_weights);
    for (int i = 0; i < HOST_FRAMES; i++)
        host_buffer_destroy(a->device, &a->weights[i]);
    free(a->weight_sums);
    memset(a, 0, sizeof *a);
}

static bool create_weights(host_accumulator *a, char *error, size_t error_size)
{
    const size_t pixels = (size_t)a->width * a->height;
    for (int i = 0; i < HOST_FRAMES; i++)
        if (!a->weights[i].buffer &&
            !host_buffer_create(a->device, pixels * sizeof(float), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                HOST_BUFFER_UPLOAD, "weights of pixels", &a->weights[i], error, error_size))
            return false;
    a->weight_sums = calloc(pixels, sizeof(float));
    return a->weight_sums || host_fail(error, error_size, "no memory for a picture of %u x %u", a->width, a->height);
}

/* ---- recording ---------------------------------------------------------------------------------------------- */

void host_accumulator_reset(host_accumulator *a)
{
    a->samples = a->skipped = 0;
    memset(a->counts, 0, sizeof a->counts);
    free(a->weight_sums);
    a->weight_sums = NULL;
}

uint32_t host_accumulator_share(uint32_t samples)
{
    if (samples >= 16 && samples % 4 == 0)
        return 4;
    return samples >= 4 && samples % 2 == 0 ? 2 : 1;
}

void host_accumulator_skip(host_accumulator *a, host_output output)
{
    a->skipped |= 1u << output;
}

static uint32_t slot_of(const host_accumulator *a)
{
    return (uint32_t)(a->device->frame % HOST_FRAMES);
}

float *host_accumulator_weigh(host_accumulator *a, char *error, size_t error_size)
{
    if (!a->weight_sums && !create_weights(a, error, error_size))
        return NULL;
    return a->weights[slot_of(a)].mapped;
}

static bool create_sum(host_accumulator *a, host_output output, char *error, size_t error_size)
{
    host_image *sum = &a->sums[output];
    const host_image_def def = {.format = host_output_format(output),
                                .extent = {a->width, a->height, 1},
                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                         VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .name = "sum of sub-frames"};
    return host_image_create(a->device, &def, sum, error, error_size) &&
           host_framebuffer_create(a->device, a->passes[kind_of(output)], &sum->view, 1, a->width, a->height,
                                   &a->framebuffers[output], error, error_size);
}

/* A sum of nothing. What read or wrote the one before is done. */
static void clear_sum(VkCommandBuffer cmd, const host_image *sum)
{
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                               copying = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    const VkClearColorValue nothing = {{0}};
    host_image_barrier(cmd, sum, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, drawing | copying, 0, copying,
                       VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdClearColorImage(cmd, sum->image, VK_IMAGE_LAYOUT_GENERAL, &nothing, 1, &all);
    host_image_barrier(cmd, sum, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL, copying,
                       VK_ACCESS_TRANSFER_WRITE_BIT, drawing,
                       VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
}

/* The sum, and the sets of an output. The device does not use them yet. */
static bool prepare(host_accumulator *a, VkCommandBuffer cmd, const host_target *target, host_output output,
                    char *error, size_t error_size)
{
    host_image *sum = &a->sums[output];
    if (!sum->image && !create_sum(a, output, error, error_size))
        return false;
    clear_sum(cmd, sum);
    for (uint32_t i = 0; i < HOST_FRAMES; i++) {
        const VkDescriptorSet set = a->sets[i][output];
        host_set_write_image(a->device, set, 0, a->sampler, host_target_shown(target, output)->view,
                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        host_set_write_buffer(a->device, set, 1, kinds[1],
                              a->weight_sums ? a->weights[i].buffer : a->no_weights.buffer);
    }
    return true;
}

static void add(const host_accumulator *a, VkCommandBuffer cmd, host_output output)
{
    const struct host_accumulate_gpu push = {a->width, a->weight_sums != NULL};
    const int kind = kind_of(output);
    host_pass_begin(cmd, a->passes[kind], a->framebuffers[output], a->width, a->height, 1);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, a->add[kind]);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, a->layout, 0, 1, &a->sets[slot_of(a)][output], 0,
                            NULL);
    vkCmdPushConstants(cmd, a->layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
}

bool host_accumulator_add(host_accumulator *a, VkCommandBuffer cmd, const host_target *target, bool keep, char *error,
                          size_t error_size)
{
    const size_t pixels = (size_t)a->width * a->height;
    const float *weights = a->weights[slot_of(a)].mapped;
    uint32_t kept = 0;
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++) {
        kept |= is_kept(target, (host_output)i) ? 1u << i : 0;
        if (is_added(a, target, i) && !a->counts[i] && !prepare(a, cmd, target, (host_output)i, error, error_size))
            return false;
    }
    host_label_begin(a->device, cmd, "accumulate");
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++)
        if (is_added(a, target, i))
            host_target_begin_read(target, cmd, (host_output)i);
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++)
        if (is_added(a, target, i))
            add(a, cmd, (host_output)i);
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++)
        if (is_added(a, target, i))
            host_target_end_read(target, cmd, (host_output)i);
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++)
        a->counts[i] += is_added(a, target, i);
    a->skipped = 0;
    if (keep || !a->samples)
        host_target_copy_out(target, cmd, kept);
    host_label_end(a->device, cmd);
    for (size_t i = 0; a->weight_sums && i < pixels; i++)
        a->weight_sums[i] += weights[i];
    a->samples++;
    return true;
}

void host_accumulator_copy_out(const host_accumulator *a, VkCommandBuffer cmd, const host_target *target)
{
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++) {
        const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                          .imageExtent = {a->width, a->height, 1}};
        if (is_there(a, target, i))
            vkCmdCopyImageToBuffer(cmd, a->sums[i].image, VK_IMAGE_LAYOUT_GENERAL, target->copies[i].buffer, 1,
                                   &region);
    }
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
}

/* ---- means -------------------------------------------------------------------------------------------------- */

static void divide(const host_accumulator *a, const float *sums, host_output output, float *means)
{
    const size_t pixels = (size_t)a->width * a->height, channels = host_output_channels(output);
    const float factor = 1.0f / (float)a->counts[output];
    if (!a->weight_sums) {
        for (size_t i = 0; i < pixels * channels; i++)
            means[i] = sums[i] * factor;
        return;
    }
    for (size_t i = 0; i < pixels; i++) {
        const float share = 1.0f / a->weight_sums[i];
        for (size_t c = 0; c < channels; c++)
            means[i * channels + c] = sums[i * channels + c] * share;
    }
}

static void normalise(const host_accumulator *a, float *normals)
{
    const size_t pixels = (size_t)a->width * a->height;
    for (size_t i = 0; i < pixels; i++) {
        float *n = &normals[i * 4];
        const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), factor = 1.0f / length;
        for (int c = 0; length > 0.0f && c < 3; c++)
            n[c] *= factor;
    }
}

void host_accumulator_finish(const host_accumulator *a, const host_target *target, host_drawn *p)
{
    const size_t pixels = (size_t)a->width * a->height;
    for (int i = 0; i < HOST_OUTPUT_COUNT; i++) {
        const host_output output = (host_output)i;
        if (!target->images[i].image)
            continue;
        if (is_there(a, target, i))
            divide(a, host_target_floats(a->device, target, output), output, floats_of(p, output));
        else if (i >= HOST_LAYER && !is_summed(target, i))
            memcpy(floats_of(p, output), host_target_floats(a->device, target, output), pixels * 4 * sizeof(float));
    }
    if (a->samples > 1 || a->weight_sums)
        normalise(a, p->normal);
    memcpy(p->depth, host_target_floats(a->device, target, HOST_DEPTH), pixels * sizeof(float));
    memcpy(p->id, host_target_ids(a->device, target), pixels * sizeof(uint32_t));
}
