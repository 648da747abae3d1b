/* bench.c - the device of a bench, and its measurements. */
#include "bench/bench.h"

#include "bench/model/here.h"
#include "options.h"
#include "progress.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

const uint32_t bench_sizes[BENCH_SIZES][2] = {{640, 360}, {1280, 720}, {1920, 1080}};

bool bench_fail(bench *b, const char *what)
{
    return options_complain("bench", "%s: %s", what, b->error);
}

/* What is clamped or switched off is not what the rows say that is measured. */
static void say_warning(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user;
    (void)id;
    if (level != VIRGA_LOG_INFO)
        fprintf(stderr, "virga bench: %s\n", text);
}

virga_context_def bench_context_def(const bench *b)
{
    virga_context_def def = host_context_def(&b->device);
    def.variants = b->variants;
    def.log = say_warning;
    if (b->model) {
        def.get_instance_proc_addr = counting_get;
        def.timings = false; /* on software Vulkan they come with barriers of their own, which no card has */
        if (b->model != &model_here && !b->variants)
            def.variants = VIRGA_VARIANTS_GPU;
    }
    return def;
}

static bool open_context(bench *b, const void *blob, size_t blob_size, virga_pipeline_build_mode when)
{
    virga_context_def def = bench_context_def(b);
    def.pipeline_cache = blob;
    def.pipeline_cache_size = blob_size;
    def.pipeline_build_mode = when;
    return virga_context_create(&def, &b->context) == VIRGA_OK || options_complain("bench", "the device was refused");
}

bool bench_open(bench *b, const char *device, const void *blob, size_t blob_size, virga_pipeline_build_mode when)
{
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index;
    char *error = b->error;
    const size_t size = sizeof b->error;
    if (b->model)
        counting_prepare();
    if (!host_instance_create(&b->instance, false, error, size))
        return bench_fail(b, "Vulkan");
    const uint32_t count = host_devices_list(&b->instance, infos, HOST_MAX_DEVICES);
    if (!host_device_pick(infos, count, device, &index, error, size) ||
        !host_device_create(&b->device, &b->instance, &infos[index], error, size))
        return bench_fail(b, "device");
    b->info = infos[index];
    static const float corners[4][3] = {{-200, 0, -200}, {200, 0, -200}, {200, 0, 200}, {-200, 0, 200}};
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    if (!host_buffer_create_with(&b->device, corners, sizeof corners, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "floor",
                                 &b->vertices, error, size) ||
        !host_buffer_create_with(&b->device, order, sizeof order, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "floor indices",
                                 &b->indices, error, size))
        return bench_fail(b, "floor");
    b->floor = (virga_occluder){.vertices = b->vertices.buffer,
                                .vertex_stride = 12,
                                .indices = b->indices.buffer,
                                .index_type = VK_INDEX_TYPE_UINT32,
                                .index_count = 6,
                                .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    for (int i = 0; i < 3; i++)
        if (!host_target_create(&b->device, bench_sizes[i][0], bench_sizes[i][1], &b->targets[i], error, size))
            return bench_fail(b, "picture");
    if (b->model && !counting_open(&b->device, error, size))
        return bench_fail(b, "counting");
    if (b->model == &model_here &&
        (!counting_time_calls(error, size) || !model_here_measure(&b->device, &b->targets[1], error, size)))
        return bench_fail(b, "this device");
    return open_context(b, blob, blob_size, when);
}

void bench_close(bench *b)
{
    const model_card *model = b->model;
    const virga_pass_variants variants = b->variants;
    virga_target_destroy(&b->layer);
    virga_context_destroy(&b->context);
    if (b->device.device) {
        if (model)
            counting_close(&b->device);
        for (int i = 0; i < 3; i++)
            if (b->targets[i].width)
                host_target_destroy(&b->device, &b->targets[i]);
        host_buffer_destroy(&b->device, &b->vertices);
        host_buffer_destroy(&b->device, &b->indices);
        host_device_destroy(&b->device);
    }
    if (b->instance.instance)
        host_instance_destroy(&b->instance);
    memset(b, 0, sizeof *b);
    b->model = model;
    b->variants = variants;
}

void bench_view(virga_view *view, uint32_t size)
{
    static const host_camera_key key = {.position_m = {0, 1.7, 0}, .look_at_m = {0, 2.2, -10}};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 50, .near_m = 0.1, .far_m = 1000};
    host_camera camera;
    host_camera_at(&path, 0, bench_sizes[size][0], bench_sizes[size][1], NULL, &camera);
    *view = virga_default_view();
    host_camera_view(&camera, &camera, 1.0 / 48, view);
}

#define MAX_TIMES 64

/* Times of the newest frame that has any. */
static uint32_t newest_times(const bench *b, virga_pass_time times[MAX_TIMES])
{
    uint32_t count = virga_timings_get(b->context, times, MAX_TIMES), newest = 0;
    uint64_t frame = 0;
    count = count < MAX_TIMES ? count : MAX_TIMES;
    for (uint32_t i = 0; i < count; i++)
        frame = times[i].frame_index > frame ? times[i].frame_index : frame;
    for (uint32_t i = 0; i < count; i++)
        if (times[i].frame_index == frame)
            times[newest++] = times[i];
    return newest;
}

double bench_worked_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

double bench_pass_ms(const bench *b, const char *name)
{
    virga_pass_time times[MAX_TIMES];
    const uint32_t count = newest_times(b, times);
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(times[i].name, name))
            return times[i].milliseconds;
    return 0;
}

double bench_draw_ms(const bench *b, const char *name, double frame_ms)
{
    virga_pass_time times[MAX_TIMES];
    const uint32_t count = newest_times(b, times);
    for (uint32_t i = 0; i < count; i++) {
        if (!strcmp(times[i].name, name))
            return times[i].milliseconds;
        frame_ms -= times[i].milliseconds;
    }
    return frame_ms > 0 ? frame_ms : 0;
}

bool bench_submit(bench *b, double *milliseconds)
{
    const double start = progress_now();
    if (!host_submit(&b->device, b->error, sizeof b->error) || !host_wait(&b->device, b->error, sizeof b->error))
        return bench_fail(b, "submit");
    *milliseconds = (progress_now() - start) * 1e3;
    return virga_frame_completed(b->context, b->device.completed) == VIRGA_OK;
}

bool bench_begin(bench *b, VkCommandBuffer *cmd)
{
    if (!host_begin_frame(&b->device, cmd, b->error, sizeof b->error))
        return bench_fail(b, "frame");
    if (b->model)
        counting_end_frame();
    return virga_frame_begin(b->context, b->device.frame, b->device.completed) == VIRGA_OK;
}

void bench_know_image(const bench *b, const host_image *image)
{
    if (b->model)
        counting_know_image(image->view, image->format, image->extent);
}

void bench_forget_model(const bench *b)
{
    if (!b->model)
        return;
    counting_end_frame();
    counting_forget();
}

double bench_print_model(const bench *b)
{
    if (!b->model)
        return 0;
    counting_end_frame();
    const double total_ms = model_print(b->model);
    counting_forget();
    return total_ms;
}
