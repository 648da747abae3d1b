/* alone_fixture.h - a host that calls each effect without a scene, on a stand-in for a device. */
#ifndef VIRGA_TESTS_ALONE_FIXTURE_H
#define VIRGA_TESTS_ALONE_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include <virga/virga.h>

#include "stand_in.h"

typedef struct alone {
    virga_context *context;
    VkCommandBuffer cmd;
    uint64_t frame;
    VkBuffer buffer;
    virga_rain *rain;
    virga_ground *ground;
    virga_splash *splash;
    virga_glass *glass;
    virga_water *water;
    virga_fluid *fluid;
    virga_lens *lens;
    virga_environment *environment;
    virga_target *target;
    virga_view view;
    uint32_t errors, lines;
    char last[256];
} alone;

static inline void count_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    alone *a = user;
    (void)id;
    a->errors += level == VIRGA_LOG_ERROR;
    a->lines += level != VIRGA_LOG_INFO;
    snprintf(a->last, sizeof a->last, "%s", text);
}

/* `change` (or NULL) has the last word on the definition. */
static inline void open_context(alone *a, void (*change)(virga_context_def *def))
{
    virga_context_def def = virga_default_context_def();
    memset(a, 0, sizeof *a);
    stand_in_open();
    def.instance = stand_in_instance();
    def.physical_device = stand_in_physical();
    def.device = stand_in_device(0);
    def.get_instance_proc_addr = stand_in_get;
    def.log = count_line;
    def.log_user = a;
    if (change)
        change(&def);
    assert_int_equal(virga_context_create(&def, &a->context), VIRGA_OK);
    a->cmd = stand_in_begin(VK_NULL_HANDLE);
    a->buffer = (VkBuffer)stand_in_object(VK_OBJECT_TYPE_BUFFER);
}

static inline virga_image some_image(VkFormat format)
{
    return (virga_image){.image = (VkImage)stand_in_object(VK_OBJECT_TYPE_IMAGE),
                         .view = (VkImageView)stand_in_object(VK_OBJECT_TYPE_IMAGE_VIEW),
                         .format = format,
                         .extent = {64, 64, 1},
                         .layers = 1,
                         .before.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

static inline void fill_view(virga_view *view)
{
    static const float lens[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1.001f, -1, 0, 0, -0.1001f, 0};
    *view = virga_default_view();
    memcpy(view->clip_from_view, lens, sizeof lens);
    memcpy(view->open_clip_from_view, lens, sizeof lens);
    view->viewport[2] = view->viewport[3] = 64;
    view->depth = some_image(VK_FORMAT_D32_SFLOAT);
    view->color = some_image(VK_FORMAT_R16G16B16A16_SFLOAT);
}

#define CREATE(name)                                                                              \
    do {                                                                                          \
        const virga_##name##_def name##_def = virga_default_##name##_def();                       \
        if (!only || !strcmp(only, #name))                                                        \
            assert_int_equal(virga_##name##_create(a->context, &name##_def, &a->name), VIRGA_OK); \
    } while (0)

/* One effect, by its name, or all (NULL). */
static inline void open_some(alone *a, const char *only, void (*change)(virga_context_def *def))
{
    virga_target_def def = virga_default_target_def();
    def.kind = VIRGA_TARGET_DYNAMIC;
    def.color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT;
    def.depth_attached = false;
    open_context(a, change);
    fill_view(&a->view);
    CREATE(rain);
    CREATE(ground);
    CREATE(splash);
    CREATE(glass);
    CREATE(water);
    CREATE(fluid);
    CREATE(lens);
    CREATE(environment);
    assert_int_equal(virga_target_create(a->context, &def, &a->target), VIRGA_OK);
    if (a->ground)
        assert_int_equal(virga_ground_attach(a->ground, a->target), VIRGA_OK);
    a->errors = a->lines = 0;
}

static inline void open_all(alone *a)
{
    open_some(a, NULL, NULL);
}

static inline void close_all(alone *a)
{
    virga_rain_destroy(&a->rain);
    virga_ground_destroy(&a->ground);
    virga_splash_destroy(&a->splash);
    virga_glass_destroy(&a->glass);
    virga_water_destroy(&a->water);
    virga_fluid_destroy(&a->fluid);
    virga_lens_destroy(&a->lens);
    virga_environment_destroy(&a->environment);
    virga_target_destroy(&a->target);
    virga_context_destroy(&a->context);
    assert_true(stand_in_close());
}

static inline void begin_frame(alone *a)
{
    if (a->frame) {
        stand_in_submit(a->cmd);
        stand_in_done(stand_in_submitted());
    }
    a->cmd = stand_in_begin(a->cmd);
    a->frame++;
    assert_int_equal(virga_frame_begin(a->context, a->frame, a->frame - 1), VIRGA_OK);
}

/* ---- the calls of each effect */

static inline virga_result step_rain(alone *a)
{
    const virga_rain_step_info info = {.dt_s = 1.0 / 30};
    return virga_rain_step(a->rain, a->cmd, &info);
}

static inline virga_result step_ground(alone *a)
{
    const virga_occluder floor = {.vertices = a->buffer,
                                  .vertex_stride = 12,
                                  .indices = a->buffer,
                                  .index_type = VK_INDEX_TYPE_UINT32,
                                  .index_count = 3,
                                  .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                                  .ground = true};
    const virga_ground_step_info info = {.impacts = a->buffer, .impacts_size = 4096, .meshes = &floor, .mesh_count = 1};
    return virga_ground_step(a->ground, a->cmd, &info);
}

static inline virga_result step_splash(alone *a)
{
    const virga_splash_step_info info = {
        .spawns = a->buffer, .spawns_size = 4096, .first_tick = (uint32_t)a->frame, .ticks = 1};
    return virga_splash_step(a->splash, a->cmd, &info);
}

static inline virga_result step_glass(alone *a)
{
    const virga_glass_step_info info = {.rate_mm_h = 10, .first_tick = (uint32_t)a->frame, .ticks = 1};
    return virga_glass_step(a->glass, a->cmd, &info);
}

static inline virga_result step_water(alone *a)
{
    const virga_water_step_info info = {.particles = a->buffer, .count = 10};
    return virga_water_step(a->water, a->cmd, &info);
}

static inline virga_result step_fluid(alone *a)
{
    const virga_fluid_step_info info = {.dt_s = 1.0 / 60};
    return virga_fluid_step(a->fluid, a->cmd, &info);
}

static inline virga_result step_environment(alone *a)
{
    const virga_environment_info info = {
        .kind = VIRGA_ENVIRONMENT_PICTURE, .image = a->view.color, .width = 64, .height = 64, .view = &a->view};
    return virga_environment_record(a->environment, a->cmd, &info);
}

static inline virga_result prepare_rain(alone *a)
{
    return virga_rain_prepare(a->rain, a->cmd, &a->view, 0);
}

static inline virga_result prepare_splash(alone *a)
{
    return virga_splash_prepare(a->splash, a->cmd, &a->view, 0);
}

static inline virga_result prepare_glass(alone *a)
{
    const virga_glass_pose pose = {.world_from_pane = {0}};
    return virga_glass_prepare(a->glass, a->cmd, &a->view, &pose, 0);
}

static inline virga_result prepare_water(alone *a)
{
    return virga_water_prepare(a->water, a->cmd, &a->view);
}

static inline virga_result prepare_lens(alone *a)
{
    return virga_lens_prepare(a->lens, a->cmd, &a->view, NULL, 0, 0);
}

static inline virga_result draw_wet(alone *a)
{
    const virga_ground_wet wet = virga_default_ground_wet();
    return virga_ground_draw_wet(a->ground, a->cmd, &a->view, &wet, a->target);
}

typedef struct effect_calls {
    const char *name;
    virga_result (*step)(alone *a);    /* NULL: it has none */
    virga_result (*prepare)(alone *a); /* what takes a view; NULL: nothing does */
} effect_calls;

static const effect_calls effects[] = {
    {"rain", step_rain, prepare_rain},
    {"ground", step_ground, draw_wet},
    {"splash", step_splash, prepare_splash},
    {"glass", step_glass, prepare_glass},
    {"water", step_water, prepare_water},
    {"fluid", step_fluid, NULL},
    {"lens", NULL, prepare_lens},
    {"environment", step_environment, NULL},
};

#define EFFECTS (sizeof effects / sizeof effects[0])

#endif
