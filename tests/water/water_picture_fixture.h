/* water_picture_fixture.h - water before a camera, over a scene that is traced on the CPU: a floor and a sky. */
#ifndef VIRGA_TESTS_WATER_PICTURE_FIXTURE_H
#define VIRGA_TESTS_WATER_PICTURE_FIXTURE_H

#include "water_fixture.h"

#include "../host/picture_depth.h"
#include "camera.h"
#include "png.h"
#include "target.h"

#define FOV_DEG 40.0

typedef struct shot {
    water_fixture f;
    uint32_t width, height;
    host_target picture; /* its first layer is drawn into */
    virga_target *layer;
    virga_target_def layer_def;
    tested_pass tested; /* with the scene's depth attached */
    host_image color, depth;
    host_buffer extra;                                       /* for after_step */
    void (*after_step)(struct shot *s, VkCommandBuffer cmd); /* (optional) changes what the step made */
    host_camera camera, before;                              /* of this frame and of the one before */
    double frame_interval_s, fov_deg;                        /* 0: FOV_DEG */
    double open_shutter_s;                                   /* 0: pictures of a moment */
    bool reversed, no_color, no_depth;
    /* The scene: radiance and distance from the eye in a direction; INFINITY is the sky. NULL: a checkered floor. */
    double (*scene)(const struct shot *s, const double eye[3], const double direction[3], double rgb[3]);
    double floor_y;
    float *pixels, *plate; /* of the newest frame */
} shot;

/* A sky that is bright above and at the horizon, and squares of 0.1 m. */
static inline double shot_checkers(const shot *s, const double eye[3], const double direction[3], double rgb[3])
{
    const double up = direction[1], distance = up < -1e-4 ? (s->floor_y - eye[1]) / up : INFINITY;
    const double zenith[3] = {0.12, 0.25, 0.6}, horizon[3] = {0.6, 0.7, 0.8};
    const double x = floor((eye[0] + distance * direction[0]) / 0.1),
                 z = floor((eye[2] + distance * direction[2]) / 0.1);
    for (int i = 0; i < 3; i++) {
        const double sky = horizon[i] + (zenith[i] - horizon[i]) * sqrt(fmax(up, 0));
        const double far = exp(-distance / 8);
        const double floor_rgb = fmod(fabs(x + z), 2) < 0.5 ? 0.35 : (i == 0 ? 0.09 : 0.05);
        rgb[i] = isfinite(distance) ? far * floor_rgb + (1 - far) * horizon[i] : sky;
    }
    return distance > 0 ? distance : INFINITY;
}

static inline void shot_target(shot *s, uint32_t width, uint32_t height)
{
    char *error = s->f.gpu.error;
    s->width = width;
    s->height = height;
    REQUIRE(host_target_create(&s->f.gpu.device, width, height, &s->picture, error, sizeof s->f.gpu.error));
    s->layer_def = virga_default_target_def();
    host_target_describe_layer(&s->picture, &s->layer_def);
    REQUIRE(virga_target_create(s->f.context, &s->layer_def, &s->layer) == VIRGA_OK);
    REQUIRE(virga_water_attach(s->f.water, s->layer) == VIRGA_OK);
    s->pixels = calloc((size_t)width * height, 16);
    s->plate = calloc((size_t)width * height, 16);
    REQUIRE(s->pixels && s->plate);
}

static inline void shot_open_with(shot *s, const virga_water_def *def, uint32_t width, uint32_t height, bool timings)
{
    memset(s, 0, sizeof *s);
    water_fixture_open_with(&s->f, def, timings);
    s->scene = shot_checkers;
    REQUIRE(host_buffer_create(&s->f.gpu.device, 1 << 20, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD, "extra",
                               &s->extra, s->f.gpu.error, sizeof s->f.gpu.error));
    shot_target(s, width, height);
}

static inline void shot_open(shot *s, uint32_t width, uint32_t height)
{
    virga_water_def def = water_fixture_def();
    def.max_width = width;
    def.max_height = height;
    shot_open_with(s, &def, width, height, false);
}

static inline void shot_drop_scene(shot *s)
{
    if (s->color.image)
        host_image_destroy(&s->f.gpu.device, &s->color);
    if (s->depth.image)
        host_image_destroy(&s->f.gpu.device, &s->depth);
    s->color = s->depth = (host_image){0};
}

static inline void shot_close_target(shot *s)
{
    shot_drop_scene(s);
    virga_target_destroy(&s->layer);
    tested_pass_destroy(&s->f.gpu.device, &s->tested);
    host_target_destroy(&s->f.gpu.device, &s->picture);
    free(s->pixels);
    free(s->plate);
}

static inline void shot_close(shot *s)
{
    shot_close_target(s);
    host_buffer_destroy(&s->f.gpu.device, &s->extra);
    water_fixture_close(&s->f);
}

/* The ray of a pixel, as long as one metre of view depth. */
static inline void shot_ray(const shot *s, double x, double y, double ray[3])
{
    const float *m = s->camera.view_from_world, *p = s->camera.clip_from_view;
    const double v[3] = {(2 * x / s->width - 1) / (double)p[0], (2 * y / s->height - 1) / (double)p[5], -1};
    for (int i = 0; i < 3; i++)
        ray[i] = (double)m[4 * i] * v[0] + (double)m[4 * i + 1] * v[1] + (double)m[4 * i + 2] * v[2];
}

static inline double shot_trace(const shot *s, const double eye[3], const double ray[3], double rgb[3])
{
    const double length = sqrt(ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2]);
    const double direction[3] = {ray[0] / length, ray[1] / length, ray[2] / length};
    return s->scene(s, eye, direction, rgb) / length;
}

/* Color and depth of the scene from the camera, as images of a host. */
static inline void shot_make_scene(shot *s)
{
    const size_t count = (size_t)s->width * s->height;
    float *depth = malloc(count * sizeof *depth);
    REQUIRE(depth);
    for (size_t i = 0; i < count; i++) {
        double ray[3], rgb[3];
        shot_ray(s, (double)(i % s->width) + 0.5, (double)(i / s->width) + 0.5, ray);
        const double distance = shot_trace(s, s->camera.position_m, ray, rgb);
        for (int k = 0; k < 3; k++)
            s->plate[4 * i + (size_t)k] = (float)rgb[k];
        s->plate[4 * i + 3] = 1;
        depth[i] = isfinite(distance) ? picture_stored_depth(&s->camera, s->reversed, distance) : s->reversed ? 0 : 1;
    }
    const host_image_def color_def = {VK_FORMAT_R32G32B32A32_SFLOAT, {s->width, s->height, 1}, 0, 0, 0, "scene"};
    const host_image_def depth_def = {VK_FORMAT_R32_SFLOAT, {s->width, s->height, 1}, 0, 0, 0, "scene depth"};
    char *error = s->f.gpu.error;
    shot_drop_scene(s);
    REQUIRE(host_image_create_with(&s->f.gpu.device, &color_def, s->plate, count * 16, 16, &s->color, error,
                                   sizeof s->f.gpu.error));
    REQUIRE(host_image_create_with(&s->f.gpu.device, &depth_def, depth, count * 4, 4, &s->depth, error,
                                   sizeof s->f.gpu.error));
    free(depth);
}

static inline void shot_aim(shot *s, const double at[3], const double to[3])
{
    const host_camera_key key = {0, {at[0], at[1], at[2]}, {to[0], to[1], to[2]}, 0, false};
    const double fov = s->fov_deg > 0 ? s->fov_deg : FOV_DEG;
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = fov, .near_m = 0.02, .far_m = 100};
    host_camera_at(&path, 0, s->width, s->height, NULL, &s->camera);
    s->before = s->camera;
    shot_make_scene(s);
}

static inline virga_image shot_image(const host_image *image)
{
    return (virga_image){.image = image->image,
                         .view = image->view,
                         .format = image->format,
                         .before = {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}};
}

static inline virga_view shot_view(const shot *s)
{
    virga_view view = virga_default_view();
    host_camera_view(&s->camera, &s->before, s->frame_interval_s, &view);
    if (s->reversed)
        picture_reverse_depth(&view);
    view.shutter_s = s->open_shutter_s;
    if (!s->no_depth)
        view.depth = shot_image(&s->depth);
    if (!s->no_color)
        view.color = shot_image(&s->color);
    return view;
}

static inline void shot_record_draw(const shot *s, VkCommandBuffer cmd)
{
    if (s->tested.pass)
        tested_pass_begin(&s->tested, &s->picture, cmd);
    else
        host_target_begin_layer(&s->picture, cmd);
    REQUIRE(virga_water_draw(s->f.water, cmd, s->layer) == VIRGA_OK);
    vkCmdEndRenderPass(cmd);
}

/* One frame: step, prepare, draw. The pixels are premultiplied. */
static inline const float *shot_draw(shot *s)
{
    REQUIRE(virga_water_set(s->f.water, &s->f.settings) == VIRGA_OK);
    const VkCommandBuffer cmd = effect_fixture_begin(&s->f.gpu, s->f.context);
    virga_water_step_info info = {.particles = s->f.particle_buffer.buffer, .count = s->f.count};
    memcpy(info.origin_m, s->f.origin_m, sizeof info.origin_m);
    REQUIRE(virga_water_step(s->f.water, cmd, &info) == VIRGA_OK);
    if (s->after_step)
        s->after_step(s, cmd);
    const virga_view view = shot_view(s);
    REQUIRE(virga_water_prepare(s->f.water, cmd, &view) == VIRGA_OK);
    shot_record_draw(s, cmd);
    host_target_copy_out(&s->picture, cmd, 1u << HOST_LAYER);
    effect_fixture_complete(&s->f.gpu, s->f.context);
    virga_water_stats_get(s->f.water, &s->f.stats);
    memcpy(s->pixels, host_target_floats(&s->f.gpu.device, &s->picture, HOST_LAYER), (size_t)s->width * s->height * 16);
    return s->pixels;
}

static inline double shot_covered(const shot *s)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)s->width * s->height; i++)
        sum += (double)s->pixels[4 * i + 3];
    return sum;
}

static inline const float *shot_pixel(const shot *s, uint32_t x, uint32_t y)
{
    return &s->pixels[4 * ((size_t)y * s->width + x)];
}

/* The water over the scene, as a PNG file in VIRGA_TEST_PICTURES. */
static inline void shot_save(const shot *s, const char *name)
{
    const char *folder = getenv("VIRGA_TEST_PICTURES");
    const size_t count = (size_t)s->width * s->height;
    char path[512], error[512];
    if (!folder)
        return;
    float *over = malloc(count * 16);
    uint8_t *rgb = malloc(count * 3);
    REQUIRE(over && rgb);
    for (size_t i = 0; i < 4 * count; i++)
        over[i] = s->pixels[i] + (1 - s->pixels[i / 4 * 4 + 3]) * s->plate[i];
    png_from_linear(over, count, 0, PNG_CURVE_SHOULDER, rgb);
    snprintf(path, sizeof path, "%s/%s.png", folder, name);
    if (!png_write(path, s->width, s->height, 3, rgb, error, sizeof error))
        fail_msg("%s", error);
    free(over);
    free(rgb);
}

#endif
