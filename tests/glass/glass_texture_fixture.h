/* glass_texture_fixture.h - a small pane whose drops are drawn as textures, and the textures, read back. */
#ifndef VIRGA_TESTS_GLASS_TEXTURE_FIXTURE_H
#define VIRGA_TESTS_GLASS_TEXTURE_FIXTURE_H

#include "glass_ball_fixture.h"

#include "../host/picture_depth.h"
#include "../host/resolve.h"

typedef struct textured {
    shot shot; /* first */
    host_buffer download;
    virga_target *target; /* with the view's depth */
    bool reversed;        /* depth */
    float *texels;        /* RGBA of the newest frame */
    const float *pixels;  /* the same of the picture */
} textured;

static inline size_t texture_texels(const textured *t)
{
    const virga_glass_def *def = &t->shot.glass->def;
    return 2ull * def->texture_columns * def->texture_texels * def->texture_rows * def->texture_texels;
}

static inline size_t texture_bytes(const textured *t)
{
    return texture_texels(t) * 4 * sizeof(float);
}

static inline void open_textures_of(textured *t, const virga_glass_def *given, uint32_t points, uint32_t texels)
{
    virga_glass_def def = *given;
    memset(t, 0, sizeof *t);
    def.texture_columns = def.texture_rows = points;
    def.texture_texels = texels;
    shot_open(&t->shot, &def, WIDTH, HEIGHT, false);
    t->shot.settings.style = VIRGA_GLASS_STYLE_TEXTURES;
    t->texels = malloc(texture_bytes(t));
    REQUIRE(t->texels);
    REQUIRE(host_buffer_create(&t->shot.gpu.device, texture_texels(t) * 8, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "textures down", &t->download, t->shot.gpu.error,
                               sizeof t->shot.gpu.error));
}

static inline void open_textures(textured *t, uint32_t points, uint32_t texels)
{
    const virga_glass_def def = shot_def();
    open_textures_of(t, &def, points, texels);
}

static inline void close_textures(textured *t)
{
    virga_target_destroy(&t->target);
    host_buffer_destroy(&t->shot.gpu.device, &t->download);
    free(t->texels);
    shot_close(&t->shot);
}

static inline void make_target(textured *t)
{
    virga_target_def layer = virga_default_target_def();
    if (t->target)
        return;
    host_target_describe_layer(&t->shot.picture, &layer);
    layer.reversed_depth = t->reversed;
    REQUIRE(virga_target_create(t->shot.context, &layer, &t->target) == VIRGA_OK);
    REQUIRE(virga_glass_attach(t->shot.glass, t->target) == VIRGA_OK);
}

static inline void record_textures(textured *t, VkCommandBuffer cmd)
{
    shot *s = &t->shot;
    const virga_glass_def *def = &s->glass->def;
    const VkBufferImageCopy copy = {
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .imageExtent = {2 * def->texture_columns * def->texture_texels, def->texture_rows * def->texture_texels, 1}};
    virga_view view = shot_view(s);
    if (t->reversed)
        picture_reverse_depth(&view);
    s->scene_depth = t->reversed ? 0 : 1;
    shot_put(s, cmd);
    shot_record_plate(s, cmd);
    REQUIRE(virga_glass_prepare(s->glass, cmd, &view, &s->pose, virga_glass_time(s->glass)) == VIRGA_OK);
    vkCmdCopyImageToBuffer(cmd, s->glass->picture.textures->image, VK_IMAGE_LAYOUT_GENERAL, t->download.buffer, 1,
                           &copy);
    shot_memory(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                VK_ACCESS_HOST_READ_BIT);
    host_target_begin_layer(&s->picture, cmd);
    REQUIRE(virga_glass_draw(s->glass, cmd, t->target) == VIRGA_OK);
    host_target_end_layer(&s->picture, cmd);
    host_target_copy_out(&s->picture, cmd, 1u << HOST_LAYER);
}

static inline float texture_half(uint16_t half)
{
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    const double value = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return (float)(half >> 15 ? -value : value);
}

/* Prepares and draws. The texels, row by row, live until the next frame. */
static inline const float *draw_and_read_textures(textured *t)
{
    shot *s = &t->shot;
    VkCommandBuffer cmd;
    REQUIRE(virga_glass_set(s->glass, &s->settings) == VIRGA_OK);
    make_target(t);
    shot_begin(s, &cmd);
    record_textures(t, cmd);
    shot_submit(s);
    host_buffer_invalidate(&s->gpu.device, &t->download);
    for (size_t i = 0; i < 4 * texture_texels(t); i++)
        t->texels[i] = texture_half(((const uint16_t *)t->download.mapped)[i]);
    t->pixels = host_target_floats(&s->gpu.device, &s->picture, HOST_LAYER);
    return t->texels;
}

static inline float *keep_textures(const textured *t, const float *texels)
{
    float *copy = malloc(texture_bytes(t));
    REQUIRE(copy);
    memcpy(copy, texels, texture_bytes(t));
    return copy;
}

/* Records a frame that the host then throws away. */
static inline void lose_frame(textured *t)
{
    shot *s = &t->shot;
    host_device *device = &s->gpu.device;
    VkCommandBuffer cmd;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    shot_begin(s, &cmd);
    record_textures(t, cmd);
    REQUIRE(vkEndCommandBuffer(cmd) == VK_SUCCESS);
    REQUIRE(vkResetCommandPool(device->device, device->frames[device->frame % HOST_FRAMES].pool, 0) == VK_SUCCESS);
    REQUIRE(vkBeginCommandBuffer(cmd, &begin) == VK_SUCCESS);
    assert_int_equal(virga_frame_dropped(s->context, device->frame), VIRGA_OK);
    shot_submit(s);
}

/* A texel of the texture of a point, in one of its levels. */
static inline const float *texture_texel(const float *texels, uint32_t points, uint32_t side, uint32_t column,
                                         uint32_t row, uint32_t level, int x, int y)
{
    const uint32_t left = 2 * (side - (side >> level));
    return texels + 4 * ((row * side + (uint32_t)y) * 2 * points * side + 2 * column * side + left + (uint32_t)x);
}

#endif
