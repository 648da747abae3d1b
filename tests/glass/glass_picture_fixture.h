/* glass_picture_fixture.h - a pane whose slots a test fills, a camera behind it or in front of it, and a background
 * picture to look at. */
#ifndef VIRGA_TESTS_GLASS_PICTURE_FIXTURE_H
#define VIRGA_TESTS_GLASS_PICTURE_FIXTURE_H

#include "../host/effect_fixture.h"
#include "camera.h"
#include "target.h"
#include <math.h>

#include "glass/glass_internal.h"

#include <virga/shared/random.h>
#include <virga/virga.h>

typedef struct shot {
    fixture gpu;
    virga_context *context;
    virga_glass *glass;
    virga_glass_settings settings;
    virga_glass_drop_gpu *drops; /* max_drops of them, to be put */
    uint32_t *film, *passed;     /* of cells */
    uint32_t drop_count;
    host_target picture;
    virga_target *layer;
    host_image plate; /* what is seen through the pane */
    bool give_color, give_depth;
    float scene_depth;     /* depth buffer value */
    uint32_t post_columns; /* of the picture, from the left, where the scene has another depth */
    float post_depth;
    host_camera camera;
    virga_glass_pose pose;
    double late_s; /* s, from the drawn time to the newest tick */
    host_buffer upload, download;
    const float *map, *relief; /* RGBA of the newest frame, `columns` to a row */
    uint32_t columns, rows;
    const virga_glass_ball_gpu *balls; /* of the newest frame, in any order */
    uint32_t ball_count, cut_count;
} shot;

/* A small pane of few cells. */
static inline virga_glass_def shot_def(void)
{
    virga_glass_def def = virga_default_glass_def();
    def.width_m = 0.096f;
    def.height_m = 0.064f;
    def.max_drops = 1024;
    def.max_texels = 192;
    def.height_map = true;
    return def;
}

static inline void shot_begin(shot *s, VkCommandBuffer *cmd)
{
    *cmd = effect_fixture_begin(&s->gpu, s->context);
}

static inline void shot_submit(shot *s)
{
    effect_fixture_complete(&s->gpu, s->context);
}

/* `ticks` without rain; the first step, of one tick, makes the pane. */
static inline void shot_step(shot *s, uint32_t ticks)
{
    VkCommandBuffer cmd;
    shot_begin(s, &cmd);
    const virga_glass_step_info info = {.first_tick = s->glass->last_tick + 1, .ticks = ticks, .air_density = 1.2f};
    REQUIRE(virga_glass_step(s->glass, cmd, &info) == VIRGA_OK);
    shot_submit(s);
}

static inline VkDeviceSize shot_map_bytes(const shot *s)
{
    return 32ull * s->glass->picture.max_columns * s->glass->picture.max_rows;
}

static inline void shot_buffers(shot *s)
{
    const virga_glass *g = s->glass;
    char *error = s->gpu.error;
    const size_t size = sizeof s->gpu.error;
    REQUIRE(host_buffer_create(&s->gpu.device, g->drops->size + g->film->size + g->passed->size,
                               VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD, "pane up", &s->upload, error,
                               size));
    REQUIRE(host_buffer_create(&s->gpu.device, shot_map_bytes(s) + g->picture.balls->size + 2 * sizeof(uint32_t),
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "map down", &s->download, error,
                               size));
    memset(s->upload.mapped, 0, s->upload.size);
    s->drops = s->upload.mapped;
    s->film = (uint32_t *)((char *)s->upload.mapped + g->drops->size);
    s->passed = (uint32_t *)((char *)s->upload.mapped + g->drops->size + g->film->size);
}

static inline void shot_open(shot *s, const virga_glass_def *given, uint32_t width, uint32_t height, bool timings)
{
    memset(s, 0, sizeof *s);
    s->context = effect_fixture_open(&s->gpu, timings, effect_fixture_log, NULL);
    const virga_glass_def small = shot_def();
    REQUIRE(virga_glass_create(s->context, given ? given : &small, &s->glass) == VIRGA_OK);
    s->settings = virga_default_glass_settings();
    s->scene_depth = 1;
    shot_buffers(s);
    REQUIRE(host_target_create(&s->gpu.device, width, height, &s->picture, s->gpu.error, sizeof s->gpu.error));
    virga_target_def layer = virga_default_target_def();
    host_target_describe_layer(&s->picture, &layer);
    REQUIRE(virga_target_create(s->context, &layer, &s->layer) == VIRGA_OK);
    REQUIRE(virga_glass_attach(s->glass, s->layer) == VIRGA_OK);
    shot_step(s, 1);
}

/* RGBA floats of the background seen through the pane, of the picture's size. */
static inline void shot_plate(shot *s, const float *pixels)
{
    const host_image_def def = {.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                .extent = {s->picture.width, s->picture.height, 1},
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .name = "test plate"};
    if (!s->plate.image)
        REQUIRE(host_image_create(&s->gpu.device, &def, &s->plate, s->gpu.error, sizeof s->gpu.error));
    REQUIRE(host_image_upload(&s->gpu.device, &s->plate, pixels, 16ull * s->picture.width * s->picture.height, 16,
                              s->gpu.error, sizeof s->gpu.error));
    s->give_color = true;
}

static inline void shot_aim(shot *s, const double at[3], const double to[3], double fov_deg)
{
    const host_camera_key key = {0, {at[0], at[1], at[2]}, {to[0], to[1], to[2]}, 0, false};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = fov_deg, .near_m = 0.01, .far_m = 100};
    host_camera_at(&path, 0, s->picture.width, s->picture.height, NULL, &s->camera);
}

/* Looks straight at the pane's centre, so that all of its width (or height) is in the picture. `side` 1: from
 * outside. */
static inline void shot_face(shot *s, double side, double fov_deg)
{
    const double u = 0.5 * (double)s->glass->def.width_m, v = 0.5 * (double)s->glass->def.height_m;
    const double aspect = (double)s->picture.width / s->picture.height;
    const double away = fmax(v, u / aspect) / tan(fov_deg * M_PI / 360);
    shot_aim(s, (const double[3]){u, v, side * away}, (const double[3]){u, v, 0}, fov_deg);
}

static inline virga_glass_drop_gpu *shot_drop(shot *s, double u, double v, uint32_t water_nl)
{
    REQUIRE(s->drop_count < s->glass->def.max_drops);
    virga_glass_drop_gpu *drop = &s->drops[s->drop_count];
    *drop = (virga_glass_drop_gpu){.position = {(float)u, (float)v},
                                   .previous_position = {(float)u, (float)v},
                                   .water_nl = water_nl,
                                   .kind = VIRGA_GLASS_DROP,
                                   .age_s = 100,
                                   .id = s->drop_count,
                                   .random = virga_hash1(s->drop_count)};
    s->drop_count++;
    return drop;
}

/* Water (nl) of a drop at rest whose base has this radius. */
static inline uint32_t shot_water(const shot *s, double radius_m)
{
    return (uint32_t)(glass_cap_volume(glass_seen_deg(&s->settings)) * radius_m * radius_m * radius_m * 1e12 + 0.5);
}

static inline void shot_forget(shot *s)
{
    memset(s->upload.mapped, 0, s->upload.size);
    s->drop_count = 0;
}

static inline virga_view shot_view(const shot *s)
{
    virga_view view = virga_default_view();
    host_camera_view(&s->camera, &s->camera, 0, &view);
    if (s->give_depth)
        view.depth = host_target_depth(&s->picture);
    if (s->give_color)
        view.color = (virga_image){.image = s->plate.image,
                                   .view = s->plate.view,
                                   .format = s->plate.format,
                                   .extent = s->plate.extent,
                                   .before = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                              VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT}};
    return view;
}

static inline void shot_memory(VkCommandBuffer cmd, VkPipelineStageFlags from, VkAccessFlags wrote,
                               VkPipelineStageFlags to, VkAccessFlags reads)
{
    const VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = wrote, .dstAccessMask = reads};
    vkCmdPipelineBarrier(cmd, from, to, 0, 1, &barrier, 0, NULL, 0, NULL);
}

/* Writes the drops of the test into the pane's state. */
static inline void shot_put(shot *s, VkCommandBuffer cmd)
{
    const virga_glass *g = s->glass;
    const VkPipelineStageFlags transfer = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkBufferCopy drops = {0, 0, g->drops->size}, film = {g->drops->size, 0, g->film->size},
                       passed = {g->drops->size + g->film->size, 0, g->passed->size};
    shot_memory(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | transfer, VK_ACCESS_SHADER_WRITE_BIT, transfer,
                VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdCopyBuffer(cmd, s->upload.buffer, g->drops->buffer, 1, &drops);
    vkCmdCopyBuffer(cmd, s->upload.buffer, g->film->buffer, 1, &film);
    vkCmdCopyBuffer(cmd, s->upload.buffer, g->passed->buffer, 1, &passed);
    uint32_t slots[4096], shown[4] = {s->drop_count, (s->drop_count + VIRGA_GLASS_GROUP - 1) / VIRGA_GLASS_GROUP, 1, 1};
    REQUIRE(g->def.max_drops <= 4096);
    for (uint32_t i = 0; i < g->def.max_drops; i++)
        slots[i] = i;
    vkCmdFillBuffer(cmd, g->film_blocks->buffer, 0, VK_WHOLE_SIZE, 1);
    vkCmdUpdateBuffer(cmd, g->list->buffer, sizeof(virga_list_gpu), g->def.max_drops * 4ull, slots);
    vkCmdUpdateBuffer(cmd, g->state->buffer, offsetof(virga_glass_state_gpu, shown), sizeof shown, shown);
    shot_memory(cmd, transfer, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
}

static inline void shot_record_plate(const shot *s, VkCommandBuffer cmd)
{
    const VkClearAttachment clear = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {s->scene_depth, 0}}};
    const VkClearRect all = {{{0, 0}, {s->picture.width, s->picture.height}}, 0, 1};
    const VkClearAttachment post = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {s->post_depth, 0}}};
    const VkClearRect left = {{{0, 0}, {s->post_columns, s->picture.height}}, 0, 1};
    host_target_begin_plate(&s->picture, cmd);
    vkCmdClearAttachments(cmd, 1, &clear, 1, &all);
    if (s->post_columns)
        vkCmdClearAttachments(cmd, 1, &post, 1, &left);
    host_target_end_plate(&s->picture, cmd);
}

static inline void shot_copy_map(shot *s, VkCommandBuffer cmd)
{
    virga_glass_map map;
    virga_glass_map_get(s->glass, &map);
    s->columns = map.columns;
    s->rows = map.rows;
    if (!map.image)
        return;
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {map.columns, map.rows, 1}};
    vkCmdCopyImageToBuffer(cmd, map.image, VK_IMAGE_LAYOUT_GENERAL, s->download.buffer, 1, &copy);
    VkBufferImageCopy relief = copy;
    relief.bufferOffset = 16ull * map.columns * map.rows;
    vkCmdCopyImageToBuffer(cmd, s->glass->picture.relief->image, VK_IMAGE_LAYOUT_GENERAL, s->download.buffer, 1,
                           &relief);
    const struct glass_picture *picture = &s->glass->picture;
    const VkBufferCopy balls = {0, shot_map_bytes(s), picture->balls->size};
    const VkBufferCopy counts = {offsetof(virga_glass_work_gpu, shaped), shot_map_bytes(s) + picture->balls->size,
                                 2 * sizeof(uint32_t)};
    vkCmdCopyBuffer(cmd, picture->balls->buffer, s->download.buffer, 1, &balls);
    vkCmdCopyBuffer(cmd, picture->work->buffer, s->download.buffer, 1, &counts);
    shot_memory(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                VK_ACCESS_HOST_READ_BIT);
}

/* Prepares and draws. The pixels, premultiplied, and the map live until the next frame. */
static inline const float *shot_draw(shot *s, bool refraction)
{
    VkCommandBuffer cmd;
    REQUIRE(virga_glass_set(s->glass, &s->settings) == VIRGA_OK);
    const virga_view view = shot_view(s);
    shot_begin(s, &cmd);
    shot_put(s, cmd);
    shot_record_plate(s, cmd);
    REQUIRE(virga_glass_prepare(s->glass, cmd, &view, &s->pose, virga_glass_time(s->glass) - s->late_s) == VIRGA_OK);
    shot_copy_map(s, cmd);
    host_target_begin_layer(&s->picture, cmd);
    REQUIRE((refraction ? virga_glass_draw_refraction : virga_glass_draw)(s->glass, cmd, s->layer) == VIRGA_OK);
    host_target_end_layer(&s->picture, cmd);
    host_target_copy_out(&s->picture, cmd, 1u << HOST_LAYER);
    shot_submit(s);
    host_buffer_invalidate(&s->gpu.device, &s->download);
    s->map = s->download.mapped;
    s->relief = s->map + 4ull * s->columns * s->rows;
    s->balls = (const void *)((const char *)s->download.mapped + shot_map_bytes(s));
    const uint32_t *counts = (const void *)((const char *)s->balls + s->glass->picture.balls->size);
    s->ball_count = counts[0];
    s->cut_count = counts[1];
    return host_target_floats(&s->gpu.device, &s->picture, HOST_LAYER);
}

/* Returns the number of validation messages plus the number of live objects: 0 if all is correct. */
static inline void shot_close(shot *s)
{
    virga_target_destroy(&s->layer);
    virga_glass_destroy(&s->glass);
    virga_context_destroy(&s->context);
    host_target_destroy(&s->gpu.device, &s->picture);
    if (s->plate.image)
        host_image_destroy(&s->gpu.device, &s->plate);
    host_buffer *const buffers[] = {&s->upload, &s->download};
    assert_int_equal(effect_fixture_end(&s->gpu, buffers, sizeof buffers / sizeof buffers[0]), 0);
}

#endif
