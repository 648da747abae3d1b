/* rain_picture_fixture.h - rain, a camera in it, the picture that its streaks are drawn to by any kind of pass, and the
 * output of prepare. */
#ifndef VIRGA_TESTS_RAIN_PICTURE_FIXTURE_H
#define VIRGA_TESTS_RAIN_PICTURE_FIXTURE_H

#include "rain_fixture.h"
#include "rain_one_streak.h"

#include <math.h>

#include "../host/dynamic_device.h"
#include "../host/picture_depth.h"
#include "camera.h"
#include "rain/rain_internal.h"
#include "target.h"

/* ---- a shot: rain, a picture, and the output of prepare */

enum { EVERY_STREAK = -1 };

typedef struct shot {
    rain_fixture f;
    host_target picture;
    tested_pass tested;  /* with the background's depth attached */
    virga_target *layer; /* of the pass that is drawn to */
    virga_target_def layer_def;
    host_camera camera, open;
    double shutter_s, frame_interval_s; /* s; the drawn time is frame_interval_s before the time of the rain */
    uint32_t sub_frames;
    float aperture_m, focus_m;
    host_buffer streaks, prepared, slots, order;
    float scene_depth; /* depth buffer value */
    uint32_t wall_top; /* first row with a nearer depth; 0: no row has it */
    float wall_depth;
    bool give_depth, reversed;
    int only;  /* index of the one streak to draw */
    bool wide; /* draw it as a wide one */
} shot;

static inline void add_picture(shot *s, uint32_t width, uint32_t height)
{
    REQUIRE(host_target_create(&s->f.gpu.device, width, height, &s->picture, s->f.gpu.error, sizeof s->f.gpu.error));
    s->layer_def = virga_default_target_def();
    host_target_describe_layer(&s->picture, &s->layer_def);
    REQUIRE(virga_target_create(s->f.context, &s->layer_def, &s->layer) == VIRGA_OK);
    REQUIRE(virga_rain_attach(s->f.rain, s->layer) == VIRGA_OK);
}

static inline void remove_picture(shot *s)
{
    virga_target_destroy(&s->layer);
    tested_pass_destroy(&s->f.gpu.device, &s->tested);
    host_target_destroy(&s->f.gpu.device, &s->picture);
}

/* Rain, and a camera at eye height that looks level along -Z. */
static inline void open_shot_of(shot *s, const virga_rain_def *def, float rate_mm_h)
{
    memset(s, 0, sizeof *s);
    rain_fixture_open(&s->f);
    rain_fixture_rain(&s->f, def);
    const virga_rain *rain = s->f.rain;
    rain_fixture_readback(&s->f, rain->streak_buffer->size, &s->streaks);
    rain_fixture_readback(&s->f, rain->prepared_buffer->size, &s->prepared);
    rain_fixture_readback(&s->f, rain->slot_buffer->size, &s->slots);
    rain_fixture_readback(&s->f, rain->order_buffer->size, &s->order);
    s->f.settings.rate_mm_h = rate_mm_h;
    s->f.camera[1] = 1.7;
    s->shutter_s = 1.0 / 96;
    s->sub_frames = 1;
    s->only = EVERY_STREAK;
    s->scene_depth = 1;
}

/* In the open. */
static inline virga_rain_def shot_def(void)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 16384;
    def.range_m = 8;
    def.occlusion_size = 0;
    return def;
}

static inline void open_shot(shot *s, float rate_mm_h)
{
    const virga_rain_def def = shot_def();
    open_shot_of(s, &def, rate_mm_h);
}

static inline void close_shot(shot *s)
{
    remove_picture(s);
    host_buffer *buffers[] = {&s->streaks, &s->prepared, &s->slots, &s->order};
    for (size_t i = 0; i < 4; i++)
        host_buffer_destroy(&s->f.gpu.device, buffers[i]);
    rain_fixture_close(&s->f);
}

static inline void apply_settings(shot *s)
{
    assert_int_equal(virga_rain_set(s->f.rain, &s->f.settings), VIRGA_OK);
}

static inline void aim(shot *s, host_camera *camera, const double at[3], const double to[3])
{
    const host_camera_key key = {0, {at[0], at[1], at[2]}, {to[0], to[1], to[2]}, 0, false};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 40, .near_m = 0.1, .far_m = 100};
    host_camera_at(&path, 0, s->picture.width, s->picture.height, NULL, camera);
}

static inline void aim_level(shot *s)
{
    aim(s, &s->camera, s->f.camera, (const double[3]){0, s->f.camera[1], -5});
    s->open = s->camera;
}

static inline virga_view view_of(const shot *s)
{
    virga_view view = virga_default_view();
    host_camera_view(&s->camera, &s->open, s->shutter_s, &view);
    if (s->reversed)
        picture_reverse_depth(&view);
    view.sub_frames = s->sub_frames;
    view.aperture_m = s->aperture_m;
    view.focus_m = s->focus_m;
    if (s->give_depth)
        view.depth = host_target_depth(&s->picture);
    return view;
}

static inline float stored_depth(const shot *s, double distance_m)
{
    return picture_stored_depth(&s->camera, s->reversed, distance_m);
}

/* ---- drawing a frame */

static inline void record_scene_depth(const shot *s, VkCommandBuffer cmd)
{
    const VkClearAttachment clear = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {s->scene_depth, 0}}};
    const VkClearRect all = {{{0, 0}, {s->picture.width, s->picture.height}}, 0, 1};
    host_target_begin_plate(&s->picture, cmd);
    vkCmdClearAttachments(cmd, 1, &clear, 1, &all);
    if (s->wall_top) {
        const VkClearAttachment wall = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {s->wall_depth, 0}}};
        const VkClearRect rows = {
            {{0, (int32_t)s->wall_top}, {s->picture.width, s->picture.height - s->wall_top}}, 0, 1};
        vkCmdClearAttachments(cmd, 1, &wall, 1, &rows);
    }
    host_target_end_plate(&s->picture, cmd);
}

/* Reads the output of prepare back and reduces its draw to one streak if `only` requests one. */
static inline void record_prepared(shot *s, VkCommandBuffer cmd)
{
    const virga_rain *rain = s->f.rain;
    const virga_rain_buffer from[] = {{rain->streak_buffer->buffer, 0, rain->streak_buffer->size},
                                      {rain->prepared_buffer->buffer, 0, rain->prepared_buffer->size},
                                      {rain->slot_buffer->buffer, 0, rain->slot_buffer->size},
                                      {rain->drop_buffer->buffer, 0, rain->drop_buffer->size},
                                      {rain->order_buffer->buffer, 0, rain->order_buffer->size}};
    const host_buffer *to[] = {&s->streaks, &s->prepared, &s->slots, &s->f.drops, &s->order};
    for (size_t i = 0; i < 5; i++)
        rain_fixture_copy(cmd, &from[i], to[i]);
    if (s->only != EVERY_STREAK)
        record_only(s->f.rain, cmd, (uint32_t)s->only, s->wide);
}

static const host_image *layer_image(const shot *s)
{
    return &s->picture.images[HOST_LAYER];
}

/* The layer with dynamic rendering, and with the plate's depth attached where the target has it. */
static inline void record_dynamic(const shot *s, VkCommandBuffer cmd)
{
    const VkRenderingAttachmentInfo color = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = layer_image(s)->view,
                                             .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRenderingAttachmentInfo depth = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = s->picture.images[HOST_DEPTH].view,
                                             .imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = {{0, 0}, {s->picture.width, s->picture.height}},
                                  .layerCount = 1,
                                  .colorAttachmentCount = 1,
                                  .pColorAttachments = &color,
                                  .pDepthAttachment = s->layer_def.depth_attached ? &depth : NULL};
    host_image_barrier(cmd, layer_image(s), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, 0, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
    begin_rendering(cmd, &info);
    REQUIRE(virga_rain_draw(s->f.rain, cmd, s->layer) == VIRGA_OK);
    end_rendering(cmd);
    host_image_barrier(cmd, layer_image(s), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_TRANSFER_READ_BIT);
}

static inline void record_tested(const shot *s, VkCommandBuffer cmd)
{
    tested_pass_begin(&s->tested, &s->picture, cmd);
    REQUIRE(virga_rain_draw(s->f.rain, cmd, s->layer) == VIRGA_OK);
    vkCmdEndRenderPass(cmd);
}

static inline void record_layer(const shot *s, VkCommandBuffer cmd)
{
    if (s->layer_def.kind == VIRGA_TARGET_DYNAMIC) {
        record_dynamic(s, cmd);
    } else if (s->tested.pass) {
        record_tested(s, cmd);
    } else {
        host_target_begin_layer(&s->picture, cmd);
        REQUIRE(virga_rain_draw(s->f.rain, cmd, s->layer) == VIRGA_OK);
        host_target_end_layer(&s->picture, cmd);
    }
}

/* Prepares and draws the layer, and ends the frame. Its pixels live until the next one. */
static const float *draw_without_step(shot *s, VkCommandBuffer cmd)
{
    record_scene_depth(s, cmd);
    const virga_view view = view_of(s);
    REQUIRE(virga_rain_prepare(s->f.rain, cmd, &view, virga_rain_time(s->f.rain) - s->frame_interval_s) == VIRGA_OK);
    record_prepared(s, cmd);
    record_layer(s, cmd);
    host_target_copy_out(&s->picture, cmd, 1u << HOST_LAYER);
    rain_fixture_end_frame(&s->f);
    const host_buffer *reads[] = {&s->streaks, &s->prepared, &s->slots, &s->f.drops, &s->order};
    for (size_t i = 0; i < 5; i++)
        host_buffer_invalidate(&s->f.gpu.device, reads[i]);
    return host_target_floats(&s->f.gpu.device, &s->picture, HOST_LAYER);
}

/* A frame: steps, prepares and draws the layer. */
static const float *draw_frame(shot *s, double dt_s)
{
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&s->f);
    rain_fixture_record_step(&s->f, cmd, dt_s);
    return draw_without_step(s, cmd);
}

static inline float *draw_copy(shot *s, double dt_s)
{
    const float *pixels = draw_frame(s, dt_s);
    const size_t bytes = (size_t)s->picture.width * s->picture.height * 4 * sizeof(float);
    float *copy = malloc(bytes);
    return memcpy(copy, pixels, bytes);
}

static inline double sum_of(const shot *s, const float *pixels, int channel)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)s->picture.width * s->picture.height; i++)
        sum += (double)pixels[i * 4 + (size_t)channel];
    return sum;
}

static inline uint32_t streak_count(const shot *s)
{
    return ((const virga_prepared_gpu *)s->prepared.mapped)->streaks;
}

static inline const virga_streak_gpu *streak_list(const shot *s)
{
    return s->streaks.mapped;
}

static inline double half_value(uint32_t bits)
{
    const int exponent = (int)(bits >> 10 & 31), mantissa = (int)(bits & 1023);
    const double size = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return bits & 0x8000 ? -size : size;
}

static inline double low_half(uint32_t pair)
{
    return half_value(pair & 0xffff);
}

static inline double high_half(uint32_t pair)
{
    return half_value(pair >> 16);
}

#endif
