/* splash_picture_fixture.h - splashes, a camera in front of them, the picture that they are drawn to, and droplets that
 * a test chooses. */
#ifndef VIRGA_TESTS_SPLASH_PICTURE_FIXTURE_H
#define VIRGA_TESTS_SPLASH_PICTURE_FIXTURE_H

#include "splash_fixture.h"

#include <limits.h>
#include <math.h>

#include "../host/picture_depth.h"
#include "camera.h"
#include "target.h"

#define GRAVITY      9.80665
#define FOV_DEG      40.0
#define SECOND_LAYER ((host_output)(HOST_LAYER + 1))
#define HALF_OF_ONE  0x3c00u /* 1 as a half float in the low bits */

enum { SIDE = 128, FEW_SPRITES = 64, BLOB_POSITIONS = 4 };

/* ---- a shot: splashes, a picture, and the output of prepare */

typedef struct shot {
    splash_fixture f;
    host_target picture;
    tested_pass tested; /* with the background's depth attached */
    virga_target *layer;
    virga_target_def layer_def;
    host_camera camera;
    double shutter_s, after_s; /* s, length of the shutter interval; drawn time after the newest tick */
    float scene_depth;         /* depth buffer value */
    bool give_depth, give_color, reversed;
    float even;              /* the whole scene has this light; 0: see record_plate */
    virga_encoding encoding; /* of the scene's picture */
    host_buffer sprites, prepared;
} shot;

static inline void add_picture(shot *s, uint32_t side)
{
    char *error = s->f.gpu.error;
    REQUIRE(host_target_create(&s->f.gpu.device, side, side, &s->picture, error, sizeof s->f.gpu.error));
    host_output second;
    REQUIRE(
        host_target_add_layer(&s->f.gpu.device, &s->picture, "second", false, &second, error, sizeof s->f.gpu.error));
    s->layer_def = virga_default_target_def();
    host_target_describe_layer(&s->picture, &s->layer_def);
    REQUIRE(virga_target_create(s->f.context, &s->layer_def, &s->layer) == VIRGA_OK);
    REQUIRE(virga_splash_attach(s->f.splash, s->layer) == VIRGA_OK);
}

static inline void remove_picture(shot *s)
{
    virga_target_destroy(&s->layer);
    tested_pass_destroy(&s->f.gpu.device, &s->tested);
    host_target_destroy(&s->f.gpu.device, &s->picture);
}

static inline void readback(shot *s, VkDeviceSize size, host_buffer *buffer)
{
    REQUIRE(host_buffer_create(&s->f.gpu.device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "read",
                               buffer, s->f.gpu.error, sizeof s->f.gpu.error));
}

static inline void apply_settings(shot *s)
{
    REQUIRE(virga_splash_set(s->f.splash, &s->f.settings) == VIRGA_OK);
}

/* No near fade, hard edges at the scene, and a shutter interval of 0. */
static inline void open_shot_of(shot *s, const virga_splash_def *def)
{
    memset(s, 0, sizeof *s);
    splash_fixture_open(&s->f, def);
    s->f.settings.near_fade_m = 0;
    s->f.settings.soft_m = 0;
    apply_settings(s);
    readback(s, FEW_SPRITES * sizeof(virga_sprite_gpu), &s->sprites);
    readback(s, sizeof(virga_splash_prepared_gpu), &s->prepared);
    s->scene_depth = 1;
    add_picture(s, SIDE);
}

static inline void open_shot(shot *s)
{
    open_shot_of(s, NULL);
}

static inline void close_shot(shot *s)
{
    remove_picture(s);
    host_buffer_destroy(&s->f.gpu.device, &s->sprites);
    host_buffer_destroy(&s->f.gpu.device, &s->prepared);
    splash_fixture_close(&s->f);
}

static inline void aim(shot *s, const double at[3], const double to[3])
{
    const host_camera_key key = {0, {at[0], at[1], at[2]}, {to[0], to[1], to[2]}, 0, false};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = FOV_DEG, .near_m = 0.02, .far_m = 100};
    host_camera_at(&path, 0, s->picture.width, s->picture.height, NULL, &s->camera);
}

/* From a distance, level, along -Z. */
static inline void aim_from(shot *s, double distance_m)
{
    aim(s, (const double[3]){0, 0, distance_m}, (const double[3]){0, 0, 0});
}

static inline virga_view view_of(const shot *s)
{
    virga_view view = virga_default_view();
    host_camera_view(&s->camera, &s->camera, s->shutter_s, &view);
    if (s->reversed)
        picture_reverse_depth(&view);
    if (s->give_depth)
        view.depth = host_target_depth(&s->picture);
    view.color_encoding = s->encoding;
    if (s->give_color)
        view.color = host_target_color(&s->picture);
    return view;
}

static inline float stored_depth(const shot *s, double distance_m)
{
    return picture_stored_depth(&s->camera, s->reversed, distance_m);
}

/* Width of a pixel in metres, at a distance along the camera's axis. */
static inline double pixel_m(const shot *s, double distance_m)
{
    return 2 * tan(FOV_DEG * M_PI / 360) / s->picture.height * distance_m;
}

/* Pixels right and down, of a position in the world. */
static inline double to_pixels(const shot *s, const double position[3], double pixel[2])
{
    const float *m = s->camera.view_from_world, *p = s->camera.clip_from_view;
    double v[3];
    for (int row = 0; row < 3; row++) {
        v[row] = 0;
        for (int i = 0; i < 3; i++)
            v[row] += (double)m[4 * i + row] * (position[i] - s->camera.position_m[i]);
    }
    pixel[0] = (0.5 + 0.5 * (double)p[0] * v[0] / -v[2]) * s->picture.width;
    pixel[1] = (0.5 + 0.5 * (double)p[5] * v[1] / -v[2]) * s->picture.height;
    return -v[2];
}

/* ---- drawing a frame */

static inline void clear_part(VkCommandBuffer cmd, VkRect2D part, float r, float g, float b)
{
    const VkClearAttachment clear = {VK_IMAGE_ASPECT_COLOR_BIT, HOST_COLOR, {.color = {.float32 = {r, g, b, 1}}}};
    const VkClearRect rect = {part, 0, 1};
    vkCmdClearAttachments(cmd, 1, &clear, 1, &rect);
}

/* The scene: a constant depth; `even`, or red on the left and green on the right, with blue in the upper half. */
static inline void record_plate(const shot *s, VkCommandBuffer cmd)
{
    const uint32_t w = s->picture.width / 2, h = s->picture.height / 2;
    const VkClearAttachment clear = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {s->scene_depth, 0}}};
    const VkClearRect all = {{{0, 0}, {s->picture.width, s->picture.height}}, 0, 1};
    host_target_begin_plate(&s->picture, cmd);
    vkCmdClearAttachments(cmd, 1, &clear, 1, &all);
    const float low = s->even, light = low > 0 ? low : 1;
    clear_part(cmd, (VkRect2D){{0, 0}, {w, h}}, light, low, light);
    clear_part(cmd, (VkRect2D){{(int32_t)w, 0}, {w, h}}, low, light, light);
    clear_part(cmd, (VkRect2D){{0, (int32_t)h}, {w, h}}, light, low, low);
    clear_part(cmd, (VkRect2D){{(int32_t)w, (int32_t)h}, {w, h}}, low, light, low);
    host_target_end_plate(&s->picture, cmd);
}

static inline virga_result prepare(const shot *s, VkCommandBuffer cmd)
{
    const virga_view view = view_of(s);
    return virga_splash_prepare(s->f.splash, cmd, &view, virga_splash_time(s->f.splash) + s->after_s);
}

static inline void record_prepared(shot *s, VkCommandBuffer cmd)
{
    const VkBufferCopy sprites = {0, 0, FEW_SPRITES * sizeof(virga_sprite_gpu)},
                       draws = {0, 0, sizeof(virga_splash_prepared_gpu)};
    effect_fixture_transfers(cmd);
    vkCmdCopyBuffer(cmd, s->f.splash->sprites->buffer, s->sprites.buffer, 1, &sprites);
    vkCmdCopyBuffer(cmd, s->f.splash->prepared_buffer->buffer, s->prepared.buffer, 1, &draws);
}

static inline virga_result record_tested(const shot *s, VkCommandBuffer cmd)
{
    tested_pass_begin(&s->tested, &s->picture, cmd);
    const virga_result result = virga_splash_draw(s->f.splash, cmd, s->layer);
    vkCmdEndRenderPass(cmd);
    return result;
}

static inline virga_result record_layer(const shot *s, VkCommandBuffer cmd, host_output output)
{
    if (s->tested.pass)
        return record_tested(s, cmd);
    host_target_begin_output(&s->picture, cmd, output);
    const virga_result result = virga_splash_draw(s->f.splash, cmd, s->layer);
    host_target_end_layer(&s->picture, cmd);
    return result;
}

static const float *finish_frame(shot *s, VkCommandBuffer cmd)
{
    host_target_copy_out(&s->picture, cmd, 1u << HOST_LAYER | 1u << SECOND_LAYER);
    splash_fixture_submit(&s->f);
    host_buffer_invalidate(&s->f.gpu.device, &s->sprites);
    host_buffer_invalidate(&s->f.gpu.device, &s->prepared);
    return host_target_floats(&s->f.gpu.device, &s->picture, HOST_LAYER);
}

/* Both layers are empty. */
static inline void record_empty(const shot *s, VkCommandBuffer cmd)
{
    host_target_begin_layer(&s->picture, cmd);
    host_target_end_layer(&s->picture, cmd);
    host_target_begin_output(&s->picture, cmd, SECOND_LAYER);
    host_target_end_layer(&s->picture, cmd);
}

/* Prepares and draws the newest tick. Its pixels live until the next frame. */
static const float *draw_frame(shot *s)
{
    const VkCommandBuffer cmd = splash_fixture_begin(&s->f);
    record_empty(s, cmd);
    record_plate(s, cmd);
    REQUIRE(prepare(s, cmd) == VIRGA_OK);
    record_prepared(s, cmd);
    REQUIRE(record_layer(s, cmd, HOST_LAYER) == VIRGA_OK);
    return finish_frame(s, cmd);
}

static inline size_t pixel_count(const shot *s)
{
    return (size_t)s->picture.width * s->picture.height;
}

static inline float *copy_of(const shot *s, const float *pixels)
{
    float *copy = malloc(pixel_count(s) * 16);
    return memcpy(copy, pixels, pixel_count(s) * 16);
}

static inline double sum_of(const shot *s, const float *pixels, int channel)
{
    double sum = 0;
    for (size_t i = 0; i < pixel_count(s); i++)
        sum += (double)pixels[i * 4 + (size_t)channel];
    return sum;
}

static inline double drawn_alpha(shot *s)
{
    return sum_of(s, draw_frame(s), 3);
}

static const virga_splash_prepared_gpu *prepared(const shot *s)
{
    return s->prepared.mapped;
}

static inline void assert_near(double value, double expected, double share)
{
    if (!(fabs(value - expected) <= share * fabs(expected)))
        fail_msg("%g is not within %g %% of %g", value, share * 100, expected);
}

/* ---- droplets that a test chooses */

/* A droplet that flies high above its ground and has left its pile. After a tick it is near the chosen position and has
 * the chosen velocity. */
static inline virga_droplet_gpu flying(double diameter_m, const double position[3], const double velocity[3])
{
    const double tick_s = 1.0 / 60, up = velocity[1] + GRAVITY * tick_s;
    return (virga_droplet_gpu){.position = {(float)(position[0] - velocity[0] * tick_s),
                                            (float)(position[1] - up * tick_s + 0.5 * GRAVITY * tick_s * tick_s),
                                            (float)(position[2] - velocity[2] * tick_s)},
                               .age_s = 1,
                               .velocity = {(float)velocity[0], (float)up, (float)velocity[2]},
                               .diameter_m = (float)diameter_m,
                               .base = {0, -1000, 0},
                               .kind = VIRGA_SPLASH_SCATTERING | VIRGA_DROPLET_ALIVE | VIRGA_DROPLET_FREE,
                               .water_nl = 1,
                               .weight_free = HALF_OF_ONE};
}

static const double nowhere[3], at_rest[3];

static inline void put_flying(shot *s, double diameter_m, const double position[3], const double velocity[3])
{
    const virga_droplet_gpu droplet = flying(diameter_m, position, velocity);
    splash_fixture_put(&s->f, &droplet, 1);
    splash_fixture_step(&s->f, 1);
    REQUIRE(s->f.state->staying == 1);
}

/* Position of the droplet at a time after the newest tick. */
static inline void droplet_at(const shot *s, double time_s, double position[3])
{
    const virga_droplet_gpu *droplet = &s->f.droplets[0];
    for (int i = 0; i < 3; i++)
        position[i] = (double)droplet->position[i] + (double)droplet->velocity[i] * time_s -
                      (i == 1 ? 0.5 * GRAVITY * time_s * time_s : 0);
}

/* A droplet whose pile rises from 20 mm below the picture's centre. */
static inline virga_droplet_gpu rising(float age_s)
{
    return (virga_droplet_gpu){.position = {0, -0.02f, 0},
                               .age_s = age_s,
                               .velocity = {0, 1, 0},
                               .diameter_m = 2e-3f,
                               .base = {0, -0.02f, 0},
                               .kind = VIRGA_SPLASH_SCATTERING | VIRGA_DROPLET_ALIVE,
                               .water_nl = 4,
                               .weight_free = HALF_OF_ONE};
}

static inline void put_pile(shot *s, float age_s)
{
    const virga_droplet_gpu droplet = rising(age_s);
    splash_fixture_put(&s->f, &droplet, 1);
    splash_fixture_step(&s->f, 1);
}

/* A drop of 2 mm on deep water, at the start of the newest tick. It releases no droplets. */
static inline void put_crowns(shot *s, float weight)
{
    splash_fixture_clear(&s->f);
    virga_spawn_gpu *spawn = splash_fixture_spawn(&s->f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_10);
    spawn->water_nl = 0;
    spawn->weight = weight;
    splash_fixture_step(&s->f, 1);
}

static inline void put_crown(shot *s)
{
    put_crowns(s, 1);
}

#endif
