/* ground/ground_rings.c - the ripple map: a table of waves, and a pass that adds up all active rings. */
#include "ground/ground_internal.h"

#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/retire.h"
#include "ground/ring_table.h"

#include "shaders/ground_shaders.h"

#include <math.h>
#include <string.h>

#define WAVE_VALUES ((size_t)VIRGA_RING_LAYERS * VIRGA_RING_TIMES * VIRGA_RING_RADII)

void ground_ripples_retire(virga_context *context, ground_ripples *ripples)
{
    virga_offscreen_retire(context, &ripples->map);
    VIRGA_RETIRE(context, ripples->waves);
    VIRGA_RETIRE(context, ripples->upload);
    VIRGA_RETIRE(context, ripples->pipeline);
}

VkDeviceSize ground_ripples_bytes(uint32_t texels)
{
    const VkDeviceSize map = (VkDeviceSize)texels * texels * 4, waves = WAVE_VALUES * 4 * sizeof(uint16_t);
    return map + 2 * waves; /* and their upload buffer */
}

/* A row of the wave table as its image stores it, all radii at one time: slope divided by radius, faded to zero near
 * the end of the table. A pixel multiplies it by its offset from the centre. Radii are in centimetres, because in
 * metres the slopes of the crater may exceed half floats. In the centre both slope and radius are 0, so the entry of
 * the next radius is used; the difference is negligible. */
static void fill_entries(const float *slopes, double reach, uint16_t *entries)
{
    for (size_t radius = 0; radius < VIRGA_RING_RADII; radius++) {
        const size_t middle = radius > 0 ? 0 : 1;
        const double share = (double)(radius + middle) / (VIRGA_RING_RADII - 1);
        const double last = fmin(fmax((share - 0.9) / 0.1, 0), 1), ends = 1 - last * last * (3 - 2 * last);
        entries[radius] = ring_half((float)((double)slopes[radius + middle] * ends / (100 * share * reach)));
    }
}

/* A texel stores four entries: this one, the next radius, and both at the next time. One fetch then replaces the four
 * that a bilinear filter needs. Past the last radius they are 0. `next` may be NULL: 0. */
static void fill_texels(const uint16_t *entries, const uint16_t *next, uint16_t *texels)
{
    for (size_t radius = 0; radius < VIRGA_RING_RADII; radius++) {
        const bool last = radius + 1 == VIRGA_RING_RADII;
        texels[4 * radius] = entries[radius];
        texels[4 * radius + 1] = last ? 0 : entries[radius + 1];
        texels[4 * radius + 2] = next ? next[radius] : 0;
        texels[4 * radius + 3] = next && !last ? next[radius + 1] : 0;
    }
}

/* From the last time to the first, as a texel has the next one too. */
static void fill_layer(int layer, const float *slopes, uint16_t *texels)
{
    uint16_t rows[2][VIRGA_RING_RADII];
    for (int time = VIRGA_RING_TIMES - 1; time >= 0; time--) {
        const size_t at = ((size_t)layer * VIRGA_RING_TIMES + (size_t)time) * VIRGA_RING_RADII;
        const double reach = ring_reach(layer, time * ring_life(layer) / (VIRGA_RING_TIMES - 1));
        fill_entries(slopes + at, reach, rows[time % 2]);
        fill_texels(rows[time % 2], time + 1 < VIRGA_RING_TIMES ? rows[(time + 1) % 2] : NULL, texels + 4 * at);
    }
}

virga_result ground_ripples_fill(virga_context *context, double texel_m, ground_ripples *ripples)
{
    float *slopes = virga_alloc_array(&context->heap, WAVE_VALUES, sizeof *slopes);
    if (!slopes)
        return virga_out_of_host_memory(context, "the table of rings");
    ring_table_fill(slopes, 0.5 * texel_m);
    for (int layer = 0; layer < VIRGA_RING_LAYERS; layer++)
        fill_layer(layer, slopes, ripples->upload->memory.block.mapped);
    virga_free(&context->heap, slopes);
    virga_buffer_flush(context, ripples->upload, 0, ripples->upload->size);
    return virga_recording_result(context);
}

static virga_result create_waves(virga_context *context, ground_ripples *ripples)
{
    virga_result result = VIRGA_OK;
    TRY(virga_image_create(context, VK_FORMAT_R16G16B16A16_SFLOAT, (VkExtent2D){VIRGA_RING_RADII, VIRGA_RING_TIMES},
                           VIRGA_RING_LAYERS, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, "ground.waves", &ripples->waves));
    TRY(virga_buffer_create(context, WAVE_VALUES * 4 * sizeof(uint16_t), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                            VIRGA_HEAP_UPLOAD, "ground.waves_upload", &ripples->upload));
error:
    return result;
}

virga_result ground_ripples_create(virga_context *context, uint32_t texels, struct virga_layout *layout,
                                   virga_pipeline_group *group, ground_ripples *ripples)
{
    const virga_offscreen_def map = {.name = "ground.ripples",
                                     .extent = {texels, texels},
                                     .layers = 1,
                                     .colors = {VK_FORMAT_R16G16_SFLOAT},
                                     .color_usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                     .layout = VK_IMAGE_LAYOUT_GENERAL,
                                     .readers = VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                                                VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                                                VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT};
    virga_result result = VIRGA_OK;
    TRY(virga_offscreen_create(context, &map, &ripples->map));
    TRY(create_waves(context, ripples));
    const virga_graphics_def def = {.vertex = VIRGA_SPIRV(ground_ring_vert),
                                    .fragment = VIRGA_SPIRV(ground_ring_frag),
                                    .layout = layout,
                                    .render_pass = ripples->map->pass,
                                    .color_count = 1,
                                    .blend_add = true,
                                    .group = group,
                                    .name = "ground.ripples"};
    TRY(virga_graphics_pipeline_create(context, &def, &ripples->pipeline));
error:
    return result;
}

void ground_ripples_upload(virga_context *context, VkCommandBuffer cmd, ground_ripples *ripples)
{
    virga_fill_sampled(context, cmd, ripples->waves->image, ripples->upload->buffer,
                       (VkExtent2D){VIRGA_RING_RADII, VIRGA_RING_TIMES}, VIRGA_RING_LAYERS);
}

/* Wakes are left out where no wheel and no foot was for so long that none is left. */
static void draw_rings(const virga_ground *ground, VkCommandBuffer cmd)
{
    const virga_context *context = ground->base.context;
    const uint32_t vertices = VIRGA_RING_VERTICES(!context->for_software);
    context->vk.CmdDraw(cmd, vertices * VIRGA_MAX_RINGS, 1, 0, 0);
    if (ground->settings.wake_waves > 0 && ground->ticks < ground->wakes_end)
        context->vk.CmdDraw(cmd, vertices * VIRGA_MAX_WAKES, 1, vertices * VIRGA_MAX_RINGS, 0);
}

void ground_ripples_draw(const virga_ground *ground, VkCommandBuffer cmd)
{
    virga_context *context = ground->base.context;
    const ground_ripples *ripples = &ground->ripples;
    virga_offscreen_begin(context, cmd, ripples->map, 0);
    if (virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, ripples->pipeline))
        draw_rings(ground, cmd);
    ground_streams_draw(ground, cmd);
    virga_offscreen_end(context, cmd);
}
