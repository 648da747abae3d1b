/* bench.c - `virga bench`: what each pass of an effect costs, beside what the machine itself can do in the same
 * run. */
#include "bench/bench.h"
#include "commands/commands.h"
#include "options.h"
#include "progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const option_row rows[] = {
    {"--drops", 0, "N", "rain: measure this many drops only. Default: 1000 to 1000000", false},
    {"--splashes", 0, "N", "splash: measure this many live splashes only. Default: 100 to 1000000", false},
    {"--balls", 0, "N", "glass: measure the row of this many metaballs only: 3000, 10000 or 100000", false},
    {"--mode", 0, "paper|physical", "splash: where counts and speeds come from. Default: paper", false},
    {"--style", 0, "paper|film", "splash: how they are drawn. Default: paper, and some in film", false},
    {"--passes", 0, "N", "frames: whole runs of them, of which each frame's least is shown. Default: 3", false},
    {"--device", 0, "N|cpu|gpu|NAME", "which Vulkan device; see virga info. Default: the best", false},
};

void bench_help(void)
{
    printf("virga bench rain|ground|splash|glass|frames [options]\n\n"
           "rain    step, impacts, occlusion, prepare and draw at 10^3 to 10^6 drops, in three picture sizes\n"
           "        and with the shutter open for 1/96 s (the library's default) and 1/48 s (film)\n"
           "ground  landing, flow, ripples, maps and sums at 256^2 to 2048^2 cells in heavy rain\n"
           "splash  step, prepare and draw of 100 to 10^6 live splashes on four kinds of ground, beside the\n"
           "        paper's\n"
           "glass   motion, metaballs, height map, plate and draw of 3000 to 100000 metaballs on a pane with\n"
           "        two wipers\n"
           "frames  start of a scene of all effects, cold and warm, and how even 2000 frames of steady rain are\n\n"
           "Medians of %d runs, beside a buffer copy, a bare kernel that reads and writes the same state, a\n"
           "dispatch and a full fill of the picture in the same run. Absolute times are noisy: compare ratios\n"
           "inside one run.\n\n",
           BENCH_RUNS);
    options_print(rows, sizeof rows / sizeof rows[0]);
}

const uint32_t bench_sizes[BENCH_SIZES][2] = {{640, 360}, {1280, 720}, {1920, 1080}};

bool bench_fail(bench *b, const char *what)
{
    return options_complain("bench", "%s: %s", what, b->error);
}

static bool open_context(bench *b, const void *blob, size_t blob_size, virga_pipelines_when when)
{
    virga_context_def def = virga_default_context_def();
    def.instance = b->instance.instance;
    def.physical_device = b->device.physical;
    def.device = b->device.device;
    def.queue_family = b->device.queue_family;
    def.get_instance_proc_addr = vkGetInstanceProcAddr;
    def.wide_lines = b->device.wide_lines;
    def.pipeline_cache = blob;
    def.pipeline_cache_size = blob_size;
    def.pipelines = when;
    return virga_context_create(&def, &b->context) == VIRGA_OK || options_complain("bench", "the device was refused");
}

bool bench_open(bench *b, const char *device, const void *blob, size_t blob_size, virga_pipelines_when when)
{
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index;
    char *error = b->error;
    const size_t size = sizeof b->error;
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
    return open_context(b, blob, blob_size, when);
}

void bench_close(bench *b)
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
    memset(b, 0, sizeof *b);
}

void bench_view(virga_view *view, uint32_t size)
{
    static const host_camera_key key = {.position_m = {0, 1.7, 0}, .look_at_m = {0, 2.2, -10}};
    const host_camera_path path = {&key, 1, 50, 0.1, 1000};
    host_camera camera;
    host_camera_at(&path, 0, bench_sizes[size][0], bench_sizes[size][1], NULL, &camera);
    *view = virga_default_view();
    host_camera_view(&camera, &camera, 1.0 / 48, view);
}

double bench_pass_ms(const bench *b, const char *name)
{
    virga_pass_time times[32];
    const uint32_t count = virga_timings_get(b->context, times, 32);
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(times[i].name, name))
            return times[i].milliseconds;
    return 0;
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
    return (host_begin_frame(&b->device, cmd, b->error, sizeof b->error) || bench_fail(b, "frame")) &&
           virga_frame_begin(b->context, b->device.frame, b->device.completed) == VIRGA_OK;
}

/* Whether the value of an option is the second of its two words; the first where it was not given. */
static bool second_word(const options *parsed, const char *name, const char *first, const char *second, bool *is_second)
{
    const char *value = options_value(parsed, name);
    *is_second = value && !strcmp(value, second);
    return !value || *is_second || !strcmp(value, first) ||
           options_complain("bench", "%s: expected %s or %s, got '%s'", name, first, second, value);
}

static bool parse_splash(const options *parsed, bench_splash_choice *choice)
{
    bool physical, film;
    *choice = (bench_splash_choice){0};
    if (!options_uint(parsed, "--splashes", 1, 1000000, &choice->only) ||
        !second_word(parsed, "--mode", "paper", "physical", &physical) ||
        !second_word(parsed, "--style", "paper", "film", &film))
        return false;
    choice->mode = physical ? VIRGA_SPLASH_MODE_PHYSICAL : VIRGA_SPLASH_MODE_PAPER;
    choice->style = film ? VIRGA_SPLASH_STYLE_FILM : VIRGA_SPLASH_STYLE_PAPER;
    choice->film_too = !choice->only && !options_value(parsed, "--style");
    return true;
}

static bool is_bench(const char *what)
{
    static const char *const all[] = {"rain", "ground", "splash", "glass", "frames"};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (!strcmp(what, all[i]))
            return true;
    return false;
}

int bench_run(int argc, char **argv)
{
    options parsed;
    uint32_t only = 0, balls = 0, passes = 3;
    bench_splash_choice splashes;
    if (!options_parse(&parsed, "bench", rows, sizeof rows / sizeof rows[0], argc, argv) ||
        !options_uint(&parsed, "--drops", 1024, 4194304, &only) ||
        !options_uint(&parsed, "--balls", 3000, 100000, &balls) ||
        !options_uint(&parsed, "--passes", 1, BENCH_MOST_PASSES, &passes) || !parse_splash(&parsed, &splashes))
        return EXIT_USAGE;
    if (balls && balls != 3000 && balls != 10000 && balls != 100000) {
        options_complain("bench", "--balls: expected 3000, 10000 or 100000, got %u", balls);
        return EXIT_USAGE;
    }
    const char *what = parsed.argument_count == 1 ? parsed.arguments[0] : "";
    if (!is_bench(what)) {
        options_complain("bench", "expected what to measure: rain, ground, splash, glass or frames");
        return EXIT_USAGE;
    }
    bench *b = calloc(1, sizeof *b);
    if (!b)
        return EXIT_FAILED;
    bool good = bench_open(b, options_value(&parsed, "--device"), NULL, 0, VIRGA_PIPELINES_AT_ONCE);
    if (good)
        printf("virga %s on %s (%s), medians of %d\n", virga_version(), b->info.name, b->info.driver, BENCH_RUNS);
    if (good)
        good = !strcmp(what, "rain")     ? bench_rain(b, only)
               : !strcmp(what, "ground") ? bench_ground(b)
               : !strcmp(what, "glass")  ? bench_glass(b, balls)
               : !strcmp(what, "frames") ? bench_frames(b, options_value(&parsed, "--device"), passes)
                                         : bench_splash(b, &splashes);
    if (b->instance.messages)
        good = options_complain("bench", "validation: %s", b->instance.first_message);
    bench_close(b);
    free(b);
    return !good ? EXIT_FAILED : interrupt_asked() ? EXIT_INTERRUPTED : EXIT_OK;
}
