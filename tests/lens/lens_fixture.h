/* lens_fixture.h - a lens on a device with validation, and pictures that a test paints pixel by pixel.
 *
 * The view has a reversed depth buffer without a far plane that stores 1 / view depth, so a pixel's value is 1 / z. */
#ifndef VIRGA_TESTS_LENS_FIXTURE_H
#define VIRGA_TESTS_LENS_FIXTURE_H

#include "../host/effect_fixture.h"

#include "lens/lens_internal.h"

#include <virga/shared/random.h>
#include <virga/virga.h>

#include <math.h>

#define LENS_COTANGENT 2.0f /* of half the field of view */

typedef struct lens_picture {
    uint32_t width, height;
    float *color; /* RGBA */
    float *depth; /* 1 / view depth (1/m) */
} lens_picture;

typedef struct lens_fixture {
    fixture gpu;
    virga_context *context;
    virga_lens *lens;
    virga_lens_settings settings;
    virga_view view;
    lens_picture scene, layers[VIRGA_LENS_MAX_LAYERS];
    float layer_depths_m[VIRGA_LENS_MAX_LAYERS]; /* 0: by the layer's own depths */
    uint32_t layer_count;
    bool flat; /* the view has no depth */
    double time_s;
    host_buffer download;
    float *result;    /* RGBA of the picture */
    char log[8][256]; /* newest lines */
    uint32_t log_lines;
} lens_fixture;

static inline void lens_fixture_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    lens_fixture *f = user;
    (void)id;
    if (level <= VIRGA_LOG_WARNING)
        snprintf(f->log[f->log_lines++ % 8], sizeof f->log[0], "%s", text);
}

static inline void lens_picture_create(lens_picture *picture, uint32_t width, uint32_t height)
{
    *picture = (lens_picture){width, height, calloc((size_t)width * height * 4, sizeof(float)),
                              calloc((size_t)width * height, sizeof(float))};
    assert_non_null(picture->color);
    assert_non_null(picture->depth);
}

static inline void lens_picture_destroy(lens_picture *picture)
{
    free(picture->color);
    free(picture->depth);
    *picture = (lens_picture){0};
}

static inline float *lens_pixel(const lens_picture *picture, uint32_t x, uint32_t y)
{
    return &picture->color[((size_t)y * picture->width + x) * 4];
}

/* A gray pixel at a view depth; 0: at infinity. */
static inline void lens_paint(const lens_picture *picture, uint32_t x, uint32_t y, float gray, double depth_m)
{
    float *pixel = lens_pixel(picture, x, y);
    pixel[0] = pixel[1] = pixel[2] = gray;
    pixel[3] = 1;
    picture->depth[(size_t)y * picture->width + x] = depth_m > 0 ? (float)(1 / depth_m) : 0;
}

static inline void lens_paint_all(const lens_picture *picture, float gray, double depth_m)
{
    for (uint32_t y = 0; y < picture->height; y++)
        for (uint32_t x = 0; x < picture->width; x++)
            lens_paint(picture, x, y, gray, depth_m);
}

/* A lens of this definition, for pictures of that size. The settings have an aperture whose circle of confusion has a
 * radius of 10 px at 1/m away from the focus. `bytes`: what is read back. */
static inline void lens_fixture_open_with(lens_fixture *f, virga_lens_def def, uint32_t width, uint32_t height,
                                          VkDeviceSize bytes)
{
    memset(f, 0, sizeof *f);
    f->context = effect_fixture_open(&f->gpu, false, lens_fixture_log, f);
    def.max_width = width < 16 ? 16 : width;
    def.max_height = height < 16 ? 16 : height;
    REQUIRE(virga_lens_create(f->context, &def, &f->lens) == VIRGA_OK);
    f->settings = virga_default_lens_settings();
    f->settings.focal_m = 0.05f;
    f->settings.aperture_f = 0.05f / (20 / (0.5f * (float)height * LENS_COTANGENT));
    f->settings.focus_m = 1;
    f->view = virga_default_view();
    memset(f->view.clip_from_view, 0, sizeof f->view.clip_from_view);
    f->view.clip_from_view[0] = LENS_COTANGENT * (float)height / (float)width;
    f->view.clip_from_view[5] = -LENS_COTANGENT;
    f->view.clip_from_view[11] = -1;
    f->view.clip_from_view[14] = 1;
    f->view.reversed_depth = true;
    memcpy(f->view.open_clip_from_view, f->view.clip_from_view, sizeof f->view.clip_from_view);
    f->view.viewport[2] = (float)width;
    f->view.viewport[3] = (float)height;
    lens_picture_create(&f->scene, width, height);
    f->result = calloc((size_t)width * height * 4, sizeof(float));
    assert_non_null(f->result);
    REQUIRE(host_buffer_create(&f->gpu.device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK,
                               "picture down", &f->download, f->gpu.error, sizeof f->gpu.error));
}

static inline void lens_fixture_open(lens_fixture *f, uint32_t width, uint32_t height, bool half_resolution)
{
    virga_lens_def def = virga_default_lens_def();
    def.half_resolution = half_resolution;
    lens_fixture_open_with(f, def, width, height, (VkDeviceSize)width * height * 8);
}

/* A lens that writes circles of confusion. */
static inline void lens_fixture_open_circles(lens_fixture *f, uint32_t width, uint32_t height, VkDeviceSize bytes)
{
    virga_lens_def def = virga_default_lens_def();
    def.circles = 1;
    lens_fixture_open_with(f, def, width, height, bytes);
}

/* Adds an empty layer at a depth (m). */
static inline lens_picture *lens_fixture_layer(lens_fixture *f, float depth_m)
{
    lens_picture *layer = &f->layers[f->layer_count];
    lens_picture_create(layer, f->scene.width, f->scene.height);
    f->layer_depths_m[f->layer_count++] = depth_m;
    return layer;
}

static inline virga_image lens_upload(lens_fixture *f, const lens_picture *picture, bool depth, host_image *image)
{
    const uint32_t texel = depth ? 4 : 16;
    const host_image_def def = {.format = depth ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT,
                                .extent = {picture->width, picture->height, 1},
                                .name = depth ? "depth" : "color"};
    REQUIRE(host_image_create_with(&f->gpu.device, &def, depth ? picture->depth : picture->color,
                                   (VkDeviceSize)picture->width * picture->height * texel, texel, image, f->gpu.error,
                                   sizeof f->gpu.error));
    return (virga_image){.image = image->image,
                         .view = image->view,
                         .format = image->format,
                         .before.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

static inline double lens_half_float(uint16_t bits)
{
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double value = exponent ? ldexp(1024 + fraction, exponent - 25) : ldexp(fraction, -24);
    return exponent == 31 ? (fraction ? NAN : INFINITY) : bits >> 15 ? -value : value;
}

static inline void lens_read_picture(lens_fixture *f, VkCommandBuffer cmd, virga_result prepared)
{
    virga_lens_image picture;
    virga_lens_picture(f->lens, &picture);
    if (prepared != VIRGA_OK)
        return;
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {picture.width, picture.height, 1}};
    vkCmdCopyImageToBuffer(cmd, picture.image, VK_IMAGE_LAYOUT_GENERAL, f->download.buffer, 1, &copy);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
}

/* One frame with the pictures as they are. The result is read back if the prepare returned VIRGA_OK. */
static inline virga_result lens_fixture_try(lens_fixture *f)
{
    host_image images[2 * (1 + VIRGA_LENS_MAX_LAYERS)];
    virga_lens_layer layers[VIRGA_LENS_MAX_LAYERS] = {0};
    uint32_t count = 0;
    f->view.color = lens_upload(f, &f->scene, false, &images[count++]);
    f->view.depth = (virga_image){0};
    if (!f->flat)
        f->view.depth = lens_upload(f, &f->scene, true, &images[count++]);
    for (uint32_t i = 0; i < f->layer_count; i++) {
        layers[i].color = lens_upload(f, &f->layers[i], false, &images[count++]);
        layers[i].depth_m = f->layer_depths_m[i];
        if (!(layers[i].depth_m > 0))
            layers[i].depth = lens_upload(f, &f->layers[i], true, &images[count++]);
    }
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    const virga_result result = virga_lens_prepare(f->lens, cmd, &f->view, layers, f->layer_count, f->time_s);
    lens_read_picture(f, cmd, result);
    effect_fixture_complete(&f->gpu, f->context);
    host_buffer_invalidate(&f->gpu.device, &f->download);
    const uint16_t *halves = f->download.mapped;
    for (size_t i = 0; i < (size_t)f->scene.width * f->scene.height * 4; i++)
        f->result[i] = (float)lens_half_float(halves[i]);
    while (count)
        host_image_destroy(&f->gpu.device, &images[--count]);
    return result;
}

static inline void lens_fixture_run(lens_fixture *f)
{
    REQUIRE(virga_lens_set(f->lens, &f->settings) == VIRGA_OK);
    REQUIRE(lens_fixture_try(f) == VIRGA_OK);
}

static inline double lens_result(const lens_fixture *f, uint32_t x, uint32_t y)
{
    return (double)f->result[((size_t)y * f->scene.width + x) * 4];
}

/* The light of a picture, in its first channel. */
static inline double lens_light(const float *color, const lens_fixture *f)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)f->scene.width * f->scene.height; i++)
        sum += (double)color[4 * i];
    return sum;
}

static inline double lens_random(uint32_t *hash)
{
    *hash = virga_hash1(*hash);
    return (double)virga_unit(*hash);
}

static inline void lens_fixture_close(lens_fixture *f)
{
    virga_lens_destroy(&f->lens);
    virga_context_destroy(&f->context);
    lens_picture_destroy(&f->scene);
    for (uint32_t i = 0; i < f->layer_count; i++)
        lens_picture_destroy(&f->layers[i]);
    free(f->result);
    host_buffer *const buffers[] = {&f->download};
    assert_int_equal(effect_fixture_end(&f->gpu, buffers, 1), 0);
}

#endif
