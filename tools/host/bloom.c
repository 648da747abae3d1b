/* bloom.c - see bloom.h. */
#include "bloom.h"

#include <math.h>
#include <string.h>

#include "pipeline.h"

#include "bloom_down_comp.spv.h"
#include "bloom_first_comp.spv.h"
#include "bloom_frag.spv.h"
#include "bloom_up_comp.spv.h"

#define GROUP  8 /* texels along a side */
#define STAGES (VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT)

/* As shaders/bloom_*.comp name them. */
enum { AT_COLOR, AT_DEPTH, AT_FROM, AT_FROM_MORE, AT_TO, AT_TO_MORE, BINDINGS };

static const VkDescriptorType kinds[BINDINGS] = {
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
    VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,          VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};

/* ---- create ------------------------------------------------------------------------------------------------- */

/* Texels along a side of a level; level 0 is the picture. The last one may lie half outside. */
static uint32_t level_size(uint32_t pixels, uint32_t level)
{
    return (pixels + (1u << level) - 1) >> level;
}

/* Mipmaps halve and round down; so that none loses a texel, the first one is a multiple of the last one's texel. */
static uint32_t first_size(uint32_t pixels, uint32_t levels)
{
    return level_size(pixels, levels) << (levels - 1);
}

static bool create_pictures(host_bloom *b, char *error, size_t error_size)
{
    const host_image_def def = {.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                .extent = {first_size(b->width, b->levels), first_size(b->height, b->levels), 1},
                                .levels = b->levels,
                                .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                .name = "bloom"};
    for (int i = 0; i < 2; i++) {
        if (!host_image_create(b->device, &def, &b->pictures[i], error, error_size))
            return false;
        for (uint32_t k = 0; k < b->levels; k++)
            if (!host_view_create(b->device, b->pictures[i].image, def.format, k, 0, &b->views[i][k], error,
                                  error_size))
                return false;
    }
    return true;
}

/* A set that reads and writes levels, by their index from 0 on. */
static void write_set(const host_bloom *b, const host_bloom_def *def, VkDescriptorSet set, uint32_t from, uint32_t to)
{
    host_set_write_image(b->device, set, AT_COLOR, b->sampler, def->color, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    host_set_write_image(b->device, set, AT_DEPTH, b->sampler, def->depth,
                         VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    for (uint32_t i = 0; i < 2; i++) {
        host_set_write_image(b->device, set, AT_FROM + i, b->sampler, b->views[i][from], VK_IMAGE_LAYOUT_GENERAL);
        host_set_write_image(b->device, set, AT_TO + i, VK_NULL_HANDLE, b->views[i][to], VK_IMAGE_LAYOUT_GENERAL);
    }
}

static bool create_sets(host_bloom *b, const host_bloom_def *def, char *error, size_t error_size)
{
    const host_set_shape shape = {kinds, BINDINGS, STAGES};
    if (!host_sampler_create(b->device, HOST_SAMPLE_NEAREST, &b->sampler, error, error_size) ||
        !host_set_layout_create(b->device, &shape, &b->set_layout, error, error_size) ||
        !host_set_pool_create(b->device, &shape, 2 * b->levels, &b->pool, error, error_size) ||
        !host_sets_allocate(b->device, b->pool, b->set_layout, b->levels, b->down, error, error_size) ||
        !host_sets_allocate(b->device, b->pool, b->set_layout, b->levels, b->up, error, error_size) ||
        !host_pipeline_layout_create(b->device, &b->set_layout, 1, STAGES, sizeof b->push, &b->layout, error,
                                     error_size))
        return false;
    for (uint32_t k = 0; k < b->levels; k++) {
        write_set(b, def, b->down[k], k ? k - 1 : 0, k);
        write_set(b, def, b->up[k], k + 1 < b->levels ? k + 1 : k, k);
    }
    return true;
}

static bool create_pipelines(host_bloom *b, VkRenderPass pass, char *error, size_t error_size)
{
    const host_graphics_def over = {.vertex = host_fullscreen_vertex(),
                                    .fragment = HOST_CODE(bloom_frag),
                                    .layout = b->layout,
                                    .pass = pass,
                                    .colors = &host_blend_over,
                                    .color_count = 1};
    return host_compute_create(b->device, HOST_CODE(bloom_first_comp), b->layout, &b->first, error, error_size) &&
           host_compute_create(b->device, HOST_CODE(bloom_down_comp), b->layout, &b->next, error, error_size) &&
           host_compute_create(b->device, HOST_CODE(bloom_up_comp), b->layout, &b->sum, error, error_size) &&
           host_graphics_create(b->device, &over, &b->over, error, error_size);
}

bool host_bloom_create(host_device *device, const host_bloom_def *def, host_bloom *b, char *error, size_t error_size)
{
    const uint32_t least = def->width < def->height ? def->width : def->height;
    *b = (host_bloom){.device = device, .width = def->width, .height = def->height};
    while (b->levels < HOST_BLOOM_LEVELS && least >> (b->levels + 1))
        b->levels++;
    return !b->levels || (create_pictures(b, error, error_size) && create_sets(b, def, error, error_size) &&
                          create_pipelines(b, def->pass, error, error_size));
}

void host_bloom_destroy(host_bloom *b)
{
    if (!b->device)
        return;
    const VkDevice device = b->device->device;
    const VkPipeline pipelines[] = {b->first, b->next, b->sum, b->over};
    for (size_t i = 0; i < sizeof pipelines / sizeof *pipelines; i++)
        vkDestroyPipeline(device, pipelines[i], NULL);
    vkDestroyPipelineLayout(device, b->layout, NULL);
    vkDestroyDescriptorPool(device, b->pool, NULL);
    vkDestroyDescriptorSetLayout(device, b->set_layout, NULL);
    vkDestroySampler(device, b->sampler, NULL);
    for (int i = 0; i < 2; i++) {
        for (uint32_t k = 0; k < HOST_BLOOM_LEVELS; k++)
            vkDestroyImageView(device, b->views[i][k], NULL);
        host_image_destroy(b->device, &b->pictures[i]);
    }
    memset(b, 0, sizeof *b);
}

/* ---- recording ---------------------------------------------------------------------------------------------- */

/* Weights are fitted anew where air or the angle of a pixel has changed. */
static void weigh(host_bloom *b, const host_bloom_air *air, double pixel_rad)
{
    if (air->drop_m != b->air.drop_m || fabs(pixel_rad - b->pixel_rad) > 1e-3 * b->pixel_rad) {
        host_aureole_weights(air->drop_m, pixel_rad, b->levels, &b->kept, b->weights);
        b->pixel_rad = pixel_rad;
    }
    b->air = *air;
}

static void fill_push(host_bloom *b, const float clip_from_view[16])
{
    const double most = HOST_AUREOLE_MOST, once = most * exp(-most) / (1 - exp(-most));
    b->push = (struct host_bloom_gpu){
        .depth = {clip_from_view[10], clip_from_view[14], (float)b->air.sky_m,
                  (float)host_aureole_per_m(b->air.visibility_m)},
        .ray = {1 / clip_from_view[0], 1 / clip_from_view[5], clip_from_view[8], clip_from_view[9]},
        .single[3] = (float)(1 / (1 - once)),
    };
}

/* Sizes of what is written and read, as levels of the picture. */
static void set_sizes(host_bloom *b, uint32_t to, uint32_t from, bool reads)
{
    b->push.width = level_size(b->width, to);
    b->push.height = level_size(b->height, to);
    b->push.columns = reads ? level_size(b->width, from) : 0;
    b->push.rows = reads ? level_size(b->height, from) : 0;
}

static void bind(const host_bloom *b, VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline,
                 VkDescriptorSet set)
{
    vkCmdBindPipeline(cmd, point, pipeline);
    vkCmdBindDescriptorSets(cmd, point, b->layout, 0, 1, &set, 0, NULL);
    vkCmdPushConstants(cmd, b->layout, STAGES, 0, sizeof b->push, &b->push);
}

static void run(const host_bloom *b, VkCommandBuffer cmd, VkPipeline pipeline, VkDescriptorSet set)
{
    bind(b, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, set);
    vkCmdDispatch(cmd, (b->push.width + GROUP - 1) / GROUP, (b->push.height + GROUP - 1) / GROUP, 1);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

void host_bloom_record(host_bloom *b, VkCommandBuffer cmd, const host_bloom_air *air, const float clip_from_view[16])
{
    if (!b->levels)
        return;
    weigh(b, air, 2 / fabs((double)clip_from_view[5]) / b->height);
    fill_push(b, clip_from_view);
    host_label_begin(b->device, cmd, "bloom");
    for (int i = 0; i < 2; i++) /* after the last one was drawn; its contents are not needed */
        host_image_barrier(cmd, &b->pictures[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL,
                           VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0,
                           VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT);
    for (uint32_t k = 0; k < b->levels; k++) {
        set_sizes(b, k + 1, k, true);
        run(b, cmd, k ? b->next : b->first, b->down[k]);
    }
    for (uint32_t k = b->levels; k-- > 0;) {
        for (int c = 0; c < 3; c++) {
            b->push.single[c] = (float)b->weights[k].single[c];
            b->push.more[c] = (float)b->weights[k].more[c];
        }
        set_sizes(b, k + 1, k + 2, k + 1 < b->levels);
        run(b, cmd, b->sum, b->up[k]);
    }
    b->push.single[0] = (float)b->kept.single[0];
    b->push.more[0] = (float)b->kept.more[0];
    set_sizes(b, 0, 1, true);
    host_label_end(b->device, cmd);
}

void host_bloom_draw(const host_bloom *b, VkCommandBuffer cmd)
{
    if (!b->levels || b->push.width != b->width)
        return;
    bind(b, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, b->over, b->down[0]); /* it has the first level to read, too */
    vkCmdDraw(cmd, 3, 1, 0, 0);
}
