/* ground/ground_streams.c - waves on running water, in the ripple map: see shaders/ground/stream.glsl. */
#include "ground/ground_internal.h"

#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/retire.h"
#include "gpu/timers.h"
#include "ground/stream_table.h"

#include "shaders/ground_shaders.h"

#include <virga/shared/random.h>

#include <math.h>
#include <stddef.h>

#define TILE_BYTES ((VkDeviceSize)4 * VIRGA_STREAM_TILE * VIRGA_STREAM_TILE)
/* A group of waves lasts about as long: bottom and viscosity damp waves of 16 to 64 mm on 3 to 10 mm of water at 0.2 to
 * 0.6 / s, and eddies on the bed live for some depths over the speed of its shear, 5 mm / (15 mm/s). */
#define PERIOD_S  1.6
#define HALF_TURN 3.14159265358979323846

uint32_t ground_streams_blocks(const virga_ground_def *def)
{
    /* The cells whose middles are around the map, of which the first lies anywhere in its block; and a block behind the
     * last one. */
    const double cells = ceil(def->ripple_texels * (double)def->ripple_texel_m / (double)def->cell_m) + 2;
    const double blocks = ceil((cells + VIRGA_STREAM_BLOCK - 1) / VIRGA_STREAM_BLOCK) + 1;
    return (uint32_t)fmin(blocks, VIRGA_STREAM_MAX_SIDE / VIRGA_STREAM_BLOCK);
}

VkDeviceSize ground_streams_bytes(void)
{
    return 2 * TILE_BYTES; /* and its upload buffer */
}

void ground_streams_retire(virga_context *context, ground_streams *streams)
{
    VIRGA_RETIRE(context, streams->tile);
    VIRGA_RETIRE(context, streams->upload);
    VIRGA_RETIRE(context, streams->draw);
}

virga_result ground_streams_create(virga_context *context, const virga_offscreen *map, struct virga_layout *layout,
                                   virga_pipeline_group *group, ground_streams *streams)
{
    virga_result result = VIRGA_OK;
    TRY(virga_image_create(context, VK_FORMAT_R8G8B8A8_UNORM, (VkExtent2D){VIRGA_STREAM_TILE, VIRGA_STREAM_TILE}, 1,
                           VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT,
                           "ground.stream_tile", &streams->tile));
    TRY(virga_buffer_create(context, TILE_BYTES, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, VIRGA_HEAP_UPLOAD,
                            "ground.stream_tile_upload", &streams->upload));
    const virga_graphics_def def = {.vertex = VIRGA_SPIRV(ground_stream_vert),
                                    .fragment = VIRGA_SPIRV(ground_stream_frag),
                                    .layout = layout,
                                    .render_pass = map->pass,
                                    .color_count = 1,
                                    .blend_add = true,
                                    .group = group,
                                    .name = "ground.streams"};
    TRY(virga_graphics_pipeline_create(context, &def, &streams->draw));
error:
    return result;
}

virga_result ground_streams_fill_tile(virga_context *context, ground_streams *streams)
{
    stream_table_fill(streams->upload->memory.block.mapped);
    virga_buffer_flush(context, streams->upload, 0, streams->upload->size);
    return virga_recording_result(context);
}

void ground_streams_upload(virga_context *context, VkCommandBuffer cmd, ground_streams *streams)
{
    virga_fill_sampled(context, cmd, streams->tile->image, streams->upload->buffer,
                       (VkExtent2D){VIRGA_STREAM_TILE, VIRGA_STREAM_TILE}, 1);
}

/* The two layers of waves take turns: each begins where the other is at its highest, and has a weight that is 0 as it
 * begins and ends. The squares of both add up to 1, and so do the variances of what is independent: it does not pulse.
 * Each time a layer begins at another place of the picture. */
static void fill_layers(virga_ground_tick_gpu *out)
{
    for (uint32_t layer = 0; layer < VIRGA_STREAM_LAYERS; layer++) {
        const uint32_t ticks = out->last_tick + layer * (out->stream_period / 2);
        const uint32_t age = ticks % out->stream_period, turn = ticks / out->stream_period;
        out->stream_age_s[layer] = (float)age * out->tick_s;
        out->stream_weight[layer] = (float)sin(HALF_TURN * age / out->stream_period);
        for (uint32_t i = 0; i < VIRGA_STREAM_OCTAVES; i++) {
            const uint32_t h = virga_hash4(out->seed, turn, layer, i), at = 2 * (layer * VIRGA_STREAM_OCTAVES + i);
            out->stream_place[at] = (float)(h & 0xffff) / 65536;
            out->stream_place[at + 1] = (float)(h >> 16) / 65536;
        }
    }
}

void ground_streams_fill(const virga_ground *ground, virga_ground_tick_gpu *out)
{
    static const double waves_m[] = {VIRGA_STREAM_WAVE_LIST};
    static const double turns[][2] = {{VIRGA_STREAM_TURN_0}, {VIRGA_STREAM_TURN_1}, {VIRGA_STREAM_TURN_2}};
    const double cell = (double)ground->def.cell_m, half = 0.5 * PERIOD_S / ground->def.tick_s;
    double corner_m[2];
    for (int axis = 0; axis < 2; axis++) {
        const double first = floor(ground->ripple_low_m[axis] / cell - 0.5);
        out->stream_low[axis] = (int32_t)(floor(first / VIRGA_STREAM_BLOCK) * VIRGA_STREAM_BLOCK);
        corner_m[axis] = ground->window.low[axis] * (double)VIRGA_GROUND_TILE * cell;
    }
    out->stream_blocks = ground_streams_blocks(&ground->def);
    out->stream_period = 2 * (uint32_t)fmax(floor(half + 0.5), 1);
    out->stream_waves = ground->settings.stream_waves;
    out->stream_texel_m = ground->def.ripple_texel_m;
    fill_layers(out);
    for (int i = 0; i < VIRGA_STREAM_OCTAVES; i++) {
        const double side_m = waves_m[i] * VIRGA_STREAM_TILE_WAVES, c = turns[i][0], s = turns[i][1];
        const double x = (c * corner_m[0] - s * corner_m[1]) / side_m, y = (s * corner_m[0] + c * corner_m[1]) / side_m;
        out->stream_corner[2 * i] = (float)(x - floor(x));
        out->stream_corner[2 * i + 1] = (float)(y - floor(y));
    }
}

void ground_streams_step(virga_ground *ground, VkCommandBuffer cmd)
{
    virga_context *context = ground->base.context;
    const uint32_t blocks = ground_streams_blocks(&ground->def);
    if (ground->settings.stream_waves <= 0)
        return;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "ground.streams");
    virga_dispatch_2d(context, cmd, ground->stream, blocks, blocks);
    virga_compute_barrier(context, cmd);
    virga_dispatch(context, cmd, ground->stream_list, 1);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_VERTICES);
    virga_pass_end(context, cmd, scope);
}

void ground_streams_draw(const virga_ground *ground, VkCommandBuffer cmd)
{
    virga_context *context = ground->base.context;
    if (ground->settings.stream_waves > 0 &&
        virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, ground->streams.draw))
        context->vk.CmdDrawIndirect(cmd, ground->rings->buffer, GROUND_STREAMS_OFFSET, 1, 0);
}
