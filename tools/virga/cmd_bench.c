/* cmd_bench.c - `virga bench`: what each pass of rain costs, beside what the machine itself can do in the same run. */
#include "commands.h"
#include "machine_limits.h"
#include "options.h"
#include "progress.h"

#include "host.h"

#include <virga/virga.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const option_row rows[] = {
    {"--drops", 0, "N", "measure this many drops only. Default: 1000, 10000, 100000 and 1000000", false},
    {"--device", 0, "N|cpu|gpu|NAME", "which Vulkan device; see virga info. Default: the best", false},
};

void bench_help(void)
{
    printf("virga bench rain [options]\n\n"
           "Measures step, impacts, occlusion, prepare and draw at 10^3 to 10^6 drops and three picture sizes, medians of\n"
           "%d runs, beside a buffer copy, a bare kernel that reads and writes the same state, a dispatch and a full\n"
           "fill of the picture in the same run. Absolute times are noisy: compare ratios inside one run.\n\n", BENCH_RUNS);
    options_print(rows, sizeof rows / sizeof rows[0]);
}

static const uint32_t sizes[3][2] = {{640, 360}, {1280, 720}, {1920, 1080}};

typedef struct bench {
    host_instance instance;
    host_device_info info;
    host_device device;
    host_target targets[3];
    host_buffer vertices, indices;
    virga_occluder floor;
    virga_context *context;
    virga_rain *rain;
    virga_target *layer;
    char error[512];
} bench;

/* What one count of drops costs, in milliseconds. */
typedef struct bench_result {
    uint32_t slots;
    double copy, bare, dispatch, step, impacts, occlusion, prepare[3], draw[3], fill[3];
    uint32_t streaks[3];
} bench_result;

static bool fail(bench *b, const char *what)
{
    return options_complain("bench", "%s: %s", what, b->error);
}

static bool open_context(bench *b)
{
    virga_context_def def = virga_default_context_def();
    def.instance = b->instance.instance;
    def.physical_device = b->device.physical;
    def.device = b->device.device;
    def.queue_family = b->device.queue_family;
    def.get_instance_proc_addr = vkGetInstanceProcAddr;
    return virga_context_create(&def, &b->context) == VIRGA_OK || options_complain("bench", "the device was refused");
}

static bool open_bench(bench *b, const char *device)
{
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index;
    char *error = b->error;
    const size_t size = sizeof b->error;
    if (!host_instance_create(&b->instance, false, error, size))
        return fail(b, "Vulkan");
    const uint32_t count = host_devices_list(&b->instance, infos, HOST_MAX_DEVICES);
    if (!host_device_pick(infos, count, device, &index, error, size) ||
        !host_device_create(&b->device, &b->instance, &infos[index], error, size))
        return fail(b, "device");
    b->info = infos[index];
    static const float corners[4][3] = {{-200, 0, -200}, {200, 0, -200}, {200, 0, 200}, {-200, 0, 200}};
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    if (!host_buffer_create_with(&b->device, corners, sizeof corners, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "floor",
                                 &b->vertices, error, size) ||
        !host_buffer_create_with(&b->device, order, sizeof order, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "floor indices",
                                 &b->indices, error, size))
        return fail(b, "floor");
    b->floor = (virga_occluder){.vertices = b->vertices.buffer,
                                .vertex_stride = 12,
                                .indices = b->indices.buffer,
                                .index_type = VK_INDEX_TYPE_UINT32,
                                .index_count = 6,
                                .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    for (int i = 0; i < 3; i++)
        if (!host_target_create(&b->device, sizes[i][0], sizes[i][1], &b->targets[i], error, size))
            return fail(b, "picture");
    return open_context(b);
}

static void close_bench(bench *b)
{
    virga_target_destroy(&b->layer);
    virga_rain_destroy(&b->rain);
    virga_context_destroy(&b->context);
    if (b->device.device) {
        for (int i = 0; i < 3; i++)
            if (b->targets[i].width)
                host_target_destroy(&b->device, &b->targets[i]);
        host_buffer_destroy(&b->device, &b->vertices);
        host_buffer_destroy(&b->device, &b->indices);
        host_device_destroy(&b->device);
    }
    if (b->instance.instance)
        host_instance_destroy(&b->instance);
}

static bool open_rain(bench *b, uint32_t drops)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = drops;
    def.max_impacts = drops > 65536 ? drops : 65536;
    virga_target_def target = virga_default_target_def();
    host_target_describe_layer(&b->targets[0], &target);
    if (virga_rain_create(b->context, &def, &b->rain) || virga_target_create(b->context, &target, &b->layer) ||
        virga_rain_attach(b->rain, b->layer))
        return options_complain("bench", "no rain of %u drops could be made", drops);
    virga_rain_settings settings = virga_default_rain_settings();
    settings.rate_mm_h = 25;
    return virga_rain_set(b->rain, &settings) == VIRGA_OK;
}

static double pass_ms(const bench *b, const char *name)
{
    virga_pass_time times[32];
    const uint32_t count = virga_timings_get(b->context, times, 32);
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(times[i].name, name))
            return times[i].milliseconds;
    return 0;
}

static bool submit(bench *b, double *milliseconds)
{
    const double start = progress_now();
    if (!host_submit(&b->device, b->error, sizeof b->error) || !host_wait(&b->device, b->error, sizeof b->error))
        return fail(b, "submit");
    *milliseconds = (progress_now() - start) * 1e3;
    return virga_frame_completed(b->context, b->device.completed) == VIRGA_OK;
}

static bool begin(bench *b, VkCommandBuffer *cmd)
{
    return (host_begin_frame(&b->device, cmd, b->error, sizeof b->error) || fail(b, "frame")) &&
           virga_frame_begin(b->context, b->device.frame, b->device.completed) == VIRGA_OK;
}

/* One tick with occlusion. */
static bool measure_step(bench *b, bench_result *result)
{
    double step[BENCH_RUNS], impacts[BENCH_RUNS], occlusion[BENCH_RUNS], whole;
    const double camera[3] = {0, 1.7, 0};
    for (int i = -2; i < BENCH_RUNS; i++) {
        VkCommandBuffer cmd;
        const virga_rain_step_info info = {.dt_s = 1.0 / 60, .camera_m = {0, 1.7, 0}};
        if (!begin(b, &cmd) || virga_rain_occlusion(b->rain, cmd, camera, &b->floor, 1) ||
            virga_rain_step(b->rain, cmd, &info) || !submit(b, &whole))
            return options_complain("bench", "a step failed");
        const int at = i < 0 ? 0 : i;
        step[at] = pass_ms(b, "rain.step");
        impacts[at] = pass_ms(b, "rain.impacts");
        occlusion[at] = pass_ms(b, "rain.occlusion");
    }
    result->step = bench_median(step, BENCH_RUNS);
    result->impacts = bench_median(impacts, BENCH_RUNS);
    result->occlusion = bench_median(occlusion, BENCH_RUNS);
    return true;
}

static void fill_view(virga_view *view, uint32_t size)
{
    static const host_camera_key key = {.position_m = {0, 1.7, 0}, .look_at_m = {0, 2.2, -10}};
    const host_camera_path path = {&key, 1, 50, 0.1, 1000};
    host_camera camera;
    host_camera_at(&path, 0, sizes[size][0], sizes[size][1], NULL, &camera);
    *view = virga_default_view();
    host_camera_view(&camera, &camera, 1.0 / 48, view);
}

/* Drawing is timed by whole submissions, with and without the draw: timestamps inside rendering mean little on
 * software Vulkan. */
static bool measure_draw(bench *b, uint32_t size, bench_result *result)
{
    double draw[BENCH_RUNS], prepare[BENCH_RUNS];
    virga_view view;
    fill_view(&view, size);
    for (int i = -1; i < BENCH_RUNS; i++) {
        double with[2];
        for (int pass = 0; pass < 2; pass++) {
            VkCommandBuffer cmd;
            if (!begin(b, &cmd) || virga_rain_prepare(b->rain, cmd, &view, virga_rain_time(b->rain)))
                return options_complain("bench", "a prepare failed");
            host_target_begin_layer(&b->targets[size], cmd);
            if (pass && virga_rain_draw(b->rain, cmd, b->layer))
                return options_complain("bench", "a draw failed");
            host_target_end_layer(&b->targets[size], cmd);
            if (!submit(b, &with[pass]))
                return false;
        }
        draw[i < 0 ? 0 : i] = with[1] - with[0];
        prepare[i < 0 ? 0 : i] = pass_ms(b, "rain.prepare");
    }
    virga_rain_stats stats;
    virga_rain_stats_get(b->rain, &stats);
    result->draw[size] = bench_median(draw, BENCH_RUNS);
    result->prepare[size] = bench_median(prepare, BENCH_RUNS);
    result->streaks[size] = stats.streaks;
    result->slots = stats.slots;
    return true;
}

static bool measure(bench *b, uint32_t drops, bench_result *result)
{
    limits *machine = NULL;
    bool good = open_rain(b, drops) && measure_step(b, result);
    for (uint32_t size = 0; size < 3 && good; size++)
        good = measure_draw(b, size, result);
    if (good && !limits_create(&b->device, &b->targets[0], result->slots, &machine, b->error, sizeof b->error))
        good = fail(b, "limits");
    if (good) {
        result->copy = limits_copy_ms(&b->device, machine);
        result->bare = limits_bare_ms(&b->device, machine);
        result->dispatch = limits_dispatch_ms(&b->device, machine);
    }
    limits_destroy(&b->device, &machine);
    for (uint32_t size = 0; size < 3 && good; size++) {
        good = limits_create(&b->device, &b->targets[size], 256, &machine, b->error, sizeof b->error);
        if (good)
            result->fill[size] = limits_fill_ms(&b->device, machine, &b->targets[size]);
        limits_destroy(&b->device, &machine);
    }
    virga_target_destroy(&b->layer);
    virga_rain_destroy(&b->rain);
    return good;
}

static void print_result(const bench_result *r)
{
    const double bytes = r->slots * 32.0;
    printf("%u drops\n", r->slots);
    printf("  machine    copy %.3f ms (%.2f GB/s)  bare kernel %.3f ms  dispatch %.4f ms\n", r->copy,
           bytes / (r->copy * 1e6), r->bare, r->dispatch);
    printf("  step       %8.3f ms  %6.2f x bare kernel  %6.2f ns a drop\n", r->step, r->step / r->bare,
           r->step * 1e6 / r->slots);
    printf("  impacts    %8.3f ms  %6.2f x bare kernel  %6.2f ns a drop\n", r->impacts, r->impacts / r->bare,
           r->impacts * 1e6 / r->slots);
    printf("  occlusion  %8.3f ms  (4 maps of 1024 x 1024, a floor)\n", r->occlusion);
    for (int i = 0; i < 3; i++)
        printf("  %4u x %-4u prepare %8.3f ms %6.2f ns a drop;  draw %8.3f ms, %u streaks, %.0f ns a streak;  fill of "
               "the picture %.3f ms\n",
               sizes[i][0], sizes[i][1], r->prepare[i], r->prepare[i] * 1e6 / r->slots, r->draw[i], r->streaks[i],
               r->streaks[i] ? r->draw[i] * 1e6 / r->streaks[i] : 0, r->fill[i]);
    fflush(stdout);
}

int bench_run(int argc, char **argv)
{
    static const uint32_t usual[] = {1000, 10000, 100000, 1000000};
    options parsed;
    uint32_t only = 0;
    if (!options_parse(&parsed, "bench", rows, sizeof rows / sizeof rows[0], argc, argv) ||
        !options_uint(&parsed, "--drops", 1024, 4194304, &only))
        return EXIT_USAGE;
    if (parsed.argument_count != 1 || strcmp(parsed.arguments[0], "rain")) {
        options_complain("bench", "expected what to measure: rain");
        return EXIT_USAGE;
    }
    bench *b = calloc(1, sizeof *b);
    if (!b)
        return EXIT_FAILED;
    bool good = open_bench(b, options_value(&parsed, "--device"));
    if (good)
        printf("virga %s on %s (%s), medians of %d\n", virga_version(), b->info.name, b->info.driver, BENCH_RUNS);
    for (size_t i = 0; good && i < (only ? 1 : sizeof usual / sizeof usual[0]); i++) {
        bench_result result;
        memset(&result, 0, sizeof result);
        good = measure(b, only ? only : usual[i], &result);
        if (good)
            print_result(&result);
        if (interrupt_asked())
            break;
    }
    close_bench(b);
    free(b);
    return !good ? EXIT_FAILED : interrupt_asked() ? EXIT_INTERRUPTED : EXIT_OK;
}
