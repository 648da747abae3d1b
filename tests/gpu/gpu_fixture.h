/* gpu_fixture.h - a device with validation, a context whose Vulkan calls are watched, and rain with all features but
 * few drops. */
#ifndef VIRGA_TESTS_GPU_FIXTURE_H
#define VIRGA_TESTS_GPU_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "../host/effect_fixture.h"
#include "camera.h"
#include "target.h"

#include <virga/virga.h>

#include "watch.h"

enum { LOG_IDS = VIRGA_LOG_ENCODING + 1 };

typedef struct gpu_fixture {
    fixture gpu;
    uint32_t lines[LOG_IDS]; /* number of the library's log lines, by id */
    uint32_t errors;         /* number of those that are errors */
    char last[1024];
} gpu_fixture;

static inline void gpu_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    gpu_fixture *f = user;
    f->errors += level == VIRGA_LOG_ERROR;
    if ((unsigned)id < LOG_IDS)
        f->lines[id]++;
    snprintf(f->last, sizeof f->last, "%s: %s", virga_log_name(id), text);
    if (getenv("VIRGA_TEST_VERBOSE"))
        fprintf(stderr, "%s\n", f->last);
}

static inline void gpu_forget_log(gpu_fixture *f)
{
    memset(f->lines, 0, sizeof f->lines);
    f->errors = 0;
    f->last[0] = 0;
}

/* Since gpu_forget_log there was exactly one log line: an error with that id. */
#define assert_one_error(f, id)                                                                                       \
    do {                                                                                                              \
        if ((f)->errors != 1 || (f)->lines[id] != 1)                                                                  \
            fail_msg("%u errors, %u lines of %s; the last line: %s", (f)->errors, (f)->lines[id], virga_log_name(id), \
                     (f)->last);                                                                                      \
    } while (0)

/* A context definition for the fixture's device, with watched Vulkan calls. */
static inline virga_context_def gpu_context_def(gpu_fixture *f)
{
    virga_context_def def = virga_default_context_def();
    def.instance = f->gpu.instance.instance;
    def.physical_device = f->gpu.device.physical;
    def.device = f->gpu.device.device;
    def.queue_family = f->gpu.device.queue_family;
    def.get_instance_proc_addr = watch_get_instance_proc_addr;
    def.wide_lines = f->gpu.device.wide_lines;
    def.memory_budget = (VkDeviceSize)256 << 20; /* keeps pages of device memory small, and with that quick to make */
    def.log = gpu_log;
    def.log_user = f;
    def.log_repeats = true;
    def.variants = effect_fixture_wanted_variants();
    return def;
}

static inline virga_context *gpu_context_in_mode(gpu_fixture *f, virga_pipeline_build_mode mode)
{
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    def.pipeline_build_mode = mode;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    return context;
}

/* Most tests use few of the pipelines. */
static inline virga_context *gpu_context(gpu_fixture *f)
{
    return gpu_context_in_mode(f, VIRGA_PIPELINES_ON_USE);
}

/* Rain with every feature and very few drops. */
static inline virga_rain_def gpu_rain_def(void)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 1024;
    def.range_m = 4;
    def.max_impacts = 256;
    def.max_streaks = 256;
    def.occlusion_size = 64;
    def.occlusion_cascades = 1;
    def.points = true;
    def.wind_texture = true;
    return def;
}

static inline virga_rain *gpu_rain(virga_context *context)
{
    const virga_rain_def def = gpu_rain_def();
    virga_rain *rain = NULL;
    REQUIRE(virga_rain_create(context, &def, &rain) == VIRGA_OK);
    return rain;
}

static inline VkCommandBuffer gpu_begin_frame(gpu_fixture *f, virga_context *context)
{
    VkCommandBuffer cmd;
    REQUIRE(host_begin_frame(&f->gpu.device, &cmd, f->gpu.error, sizeof f->gpu.error));
    REQUIRE(virga_frame_begin(context, f->gpu.device.frame, f->gpu.device.completed) == VIRGA_OK);
    return cmd;
}

static inline void gpu_submit(gpu_fixture *f)
{
    REQUIRE(host_submit(&f->gpu.device, f->gpu.error, sizeof f->gpu.error));
}

static inline void gpu_wait(gpu_fixture *f)
{
    REQUIRE(host_wait(&f->gpu.device, f->gpu.error, sizeof f->gpu.error));
}

/* ---- a picture to render to */

typedef struct gpu_picture {
    host_target images;
    virga_target *target;
} gpu_picture;

static inline void gpu_picture_open(gpu_fixture *f, virga_context *context, gpu_picture *picture)
{
    virga_target_def def = virga_default_target_def();
    REQUIRE(host_target_create(&f->gpu.device, 16, 16, &picture->images, f->gpu.error, sizeof f->gpu.error));
    host_target_describe_layer(&picture->images, &def);
    REQUIRE(virga_target_create(context, &def, &picture->target) == VIRGA_OK);
}

static inline void gpu_picture_close(gpu_fixture *f, gpu_picture *picture)
{
    virga_target_destroy(&picture->target);
    host_target_destroy(&f->gpu.device, &picture->images);
}

/* A camera that looks level along -Z. */
static inline virga_view gpu_view(const gpu_picture *picture)
{
    virga_view view = virga_default_view();
    const float projection[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1.001f, -1, 0, 0, -0.1001f, 0};
    const float level[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    memcpy(view.view_from_world, level, sizeof level);
    memcpy(view.open_view_from_world, level, sizeof level);
    memcpy(view.clip_from_view, projection, sizeof projection);
    memcpy(view.open_clip_from_view, projection, sizeof projection);
    view.viewport[2] = (float)picture->images.width;
    view.viewport[3] = (float)picture->images.height;
    return view;
}

/* All of rain's passes except those that read occlusion maps from a host: occlusion, step, points, prepare and draw. */
static inline void gpu_record(VkCommandBuffer cmd, virga_rain *rain, const gpu_picture *picture)
{
    const double camera[3] = {0, 1.7, 0};
    const virga_rain_step_info step = {.dt_s = 1.0 / 30, .camera_m = {0, 1.7, 0}};
    virga_view view = gpu_view(picture);
    virga_rain_buffer points;
    uint32_t count;
    double origin[3];
    view.position_m[1] = view.open_position_m[1] = camera[1];
    REQUIRE(virga_rain_draw_occlusion(rain, cmd, camera, NULL, 0) == VIRGA_OK);
    REQUIRE(virga_rain_step(rain, cmd, &step) == VIRGA_OK);
    REQUIRE(virga_rain_write_points(rain, cmd, &points, &count, origin) == VIRGA_OK);
    REQUIRE(virga_rain_prepare(rain, cmd, &view, virga_rain_time(rain)) == VIRGA_OK);
    host_target_begin_layer(&picture->images, cmd);
    REQUIRE(virga_rain_draw(rain, cmd, picture->target) == VIRGA_OK);
    host_target_end_layer(&picture->images, cmd);
}

/* ---- setup and teardown of each test */

/* Exits with 77 if there is no device. */
static inline int gpu_set_up(void **state)
{
    gpu_fixture *f = calloc(1, sizeof *f);
    REQUIRE(f);
    effect_device_lend(&f->gpu);
    memset(&watch, 0, sizeof watch);
    *state = f;
    return 0;
}

/* For cases that do not test how pipelines are created, only how they are used. */
static inline int gpu_set_up_kept(void **state)
{
    gpu_set_up(state);
    watch.keep_pipelines = true;
    return 0;
}

/* Checks that all objects of the library are destroyed and that there are no validation messages. */
static inline int gpu_tear_down(void **state)
{
    gpu_fixture *f = *state;
    const uint32_t alive = watch_sum(watch.live);
    if (alive)
        fprintf(stderr, "alive at the end: %s\n", watch_alive());
    const uint32_t wrong = alive + effect_device_give_back(&f->gpu);
    free(f);
    return wrong ? -1 : 0;
}

#define gpu_test(name)      cmocka_unit_test_setup_teardown(name, gpu_set_up, gpu_tear_down)
#define gpu_kept_test(name) cmocka_unit_test_setup_teardown(name, gpu_set_up_kept, gpu_tear_down)

#endif
