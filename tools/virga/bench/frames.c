/* frames.c - `virga bench frames`: how long a scene takes to start, with and without pipeline caches, and how even its
 * frame times are. */
#include "bench/frames.h"
#include "bench/spread.h"
#include "options.h"
#include "progress.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define FRAMES  2000
#define CONTROL 1000000 /* elements of 16 bytes that the control kernel reads and writes */
#define WARM_UP 240     /* frames until rings, splashes and drops are in a steady state */

/* ---- a scene of all effects */

static bool make_scene(bench *b, virga_scene **scene)
{
    virga_glass_def pane = virga_default_glass_def();
    virga_scene_def def = virga_default_scene_def();
    pane.max_texels = 256;
    pane.max_drops = 4096;
    def.rain.max_drops = 32768;
    def.rain.max_panes = 1;
    def.ground.cells = 256;
    def.ground.ripple_texels = 256;
    def.splash.max_splashes = 4096;
    def.splash.max_droplets = 16384;
    def.with_ground = def.with_splash = true;
    def.panes = &pane;
    def.pane_count = 1;
    virga_target_def target = virga_default_target_def();
    host_target_describe_layer(&b->targets[0], &target);
    return (virga_scene_create(b->context, &def, scene) >= 0 &&
            virga_target_create(b->context, &target, &b->layer) == VIRGA_OK &&
            virga_scene_attach(*scene, b->layer) == VIRGA_OK) ||
           options_complain("bench", "no scene could be made");
}

static void drop_scene(bench *b, virga_scene **scene)
{
    virga_target_destroy(&b->layer);
    virga_scene_destroy(scene);
}

/* Steady rain on a wet street. */
static bool set_rain(virga_scene *scene)
{
    virga_rain_settings rain = virga_default_rain_settings();
    virga_ground_settings ground = virga_default_ground_settings();
    rain.rate_mm_h = 25;
    rain.transition_s = 0;
    ground.start_wetness = 1;
    ground.start_water_mm = 2;
    return virga_rain_set(virga_scene_rain(scene), &rain) == VIRGA_OK &&
           virga_ground_set(virga_scene_ground(scene), &ground) == VIRGA_OK;
}

/* Times of a frame, in milliseconds. CPU times are those of the recording thread and of all threads of the process,
 * which include those of software Vulkan. CPU time excludes the work of other processes, so it shows whether the work
 * of frames differs. */
typedef struct frame_times {
    double record, whole, record_cpu, whole_cpu;
    double bare; /* a kernel after the frame with the same work every time: it shows how even the machine is */
} frame_times;

static double now_ms(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static bool record_frame(bench *b, virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    if (virga_scene_record(scene, cmd, frame) < 0)
        return false;
    host_target_begin_layer(&b->targets[0], cmd);
    const bool drawn = virga_scene_draw(scene, cmd, b->layer) >= 0;
    host_target_end_layer(&b->targets[0], cmd);
    return drawn;
}

/* Measures one frame: the time of recording, and of the whole frame. */
static bool run_frame(bench *b, virga_scene *scene, const virga_view *view, frame_times *times)
{
    VkCommandBuffer cmd;
    const virga_scene_pane pane = {.pose = {.position_m = {0, 1.7, -1}}};
    const virga_scene_frame frame = {.dt_s = 1.0 / 60,
                                     .camera_m = {0, 1.7, 0},
                                     .occluders = &b->floor,
                                     .occluder_count = 1,
                                     .view = view,
                                     .panes = &pane};
    const double start = now_ms(CLOCK_MONOTONIC), start_cpu = now_ms(CLOCK_PROCESS_CPUTIME_ID);
    if (!bench_begin(b, &cmd))
        return false;
    const double begun = now_ms(CLOCK_MONOTONIC), begun_cpu = now_ms(CLOCK_THREAD_CPUTIME_ID);
    const bool recorded = record_frame(b, scene, cmd, &frame);
    times->record = now_ms(CLOCK_MONOTONIC) - begun;
    times->record_cpu = now_ms(CLOCK_THREAD_CPUTIME_ID) - begun_cpu;
    double submitted;
    if (!recorded || !bench_submit(b, &submitted))
        return options_complain("bench", "a frame failed");
    times->whole = now_ms(CLOCK_MONOTONIC) - start;
    times->whole_cpu = now_ms(CLOCK_PROCESS_CPUTIME_ID) - start_cpu;
    return true;
}

/* ---- starting */

typedef struct start_case {
    const char *name;
    bool driver_cache, blob;
} start_case;

static void *blob;
static size_t blob_size;

static bool keep_blob(bench *b)
{
    free(blob);
    blob = NULL;
    if (virga_pipeline_cache_get(b->context, &blob_size, NULL) != VIRGA_OK)
        return false;
    blob = malloc(blob_size);
    return blob && virga_pipeline_cache_get(b->context, &blob_size, blob) == VIRGA_OK;
}

/* Opens the device again, because drivers read these variables then. The result is that of a new process. */
static bool reopen(bench *b, const char *device, const start_case *one)
{
    setenv("MESA_SHADER_CACHE_DISABLE", one->driver_cache ? "false" : "true", 1);
    setenv("__GL_SHADER_DISK_CACHE", one->driver_cache ? "1" : "0", 1);
    bench_close(b);
    return bench_open(b, device, one->blob ? blob : NULL, one->blob ? blob_size : 0, VIRGA_PIPELINES_IMMEDIATE);
}

static bool measure_start(bench *b, const char *device, const start_case *one)
{
    virga_scene *scene = NULL;
    if (!reopen(b, device, one))
        return false;
    frame_times first = {0}, second = {0};
    virga_view view;
    const double start = progress_now();
    bool good = make_scene(b, &scene);
    const double create = (progress_now() - start) * 1e3;
    bench_view(&view, 0);
    good = good && run_frame(b, scene, &view, &first) && run_frame(b, scene, &view, &second);
    if (good && one->name)
        printf("  %-42s create and attach %8.1f ms, first frame %8.1f, second %8.1f\n", one->name, create, first.whole,
               second.whole);
    fflush(stdout);
    const bool kept = good && (one->blob || keep_blob(b));
    drop_scene(b, &scene);
    return kept;
}

/* Deferred pipelines: the time of create and attach without them, and the longest build. */
static bool measure_steps(bench *b, const char *device)
{
    virga_scene *scene = NULL;
    double longest = 0, create;
    uint32_t left = 0, count = 0;
    bench_close(b);
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    setenv("__GL_SHADER_DISK_CACHE", "0", 1);
    if (!bench_open(b, device, NULL, 0, VIRGA_PIPELINES_DEFERRED))
        return false;
    const double start = progress_now();
    bool good = make_scene(b, &scene);
    create = (progress_now() - start) * 1e3;
    good = good && virga_pipelines_build(b->context, 0, &left) >= 0;
    for (count = left; good && left;) {
        const double before = progress_now();
        good = virga_pipelines_build(b->context, 1, &left) >= 0;
        const double ms = (progress_now() - before) * 1e3;
        longest = ms > longest ? ms : longest;
    }
    if (good)
        printf("  %-42s create and attach %8.1f ms, then %u pipelines one by one, the longest %.1f ms\n",
               "in steps, nothing remembered", create, count, longest);
    drop_scene(b, &scene);
    return good;
}

static bool measure_starts(bench *b, const char *device)
{
    static const start_case cases[] = {
        {"nothing remembered", false, false},
        {"Virga's blob (virga_pipeline_cache_get)", false, true},
        {NULL, true, false}, /* fills the driver's cache */
        {"the driver's own cache on disk", true, false},
        {"the driver's own cache and the blob", true, true},
    };
    bool good = true;
    printf("start of a scene of all effects\n");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0] && good; i++)
        good = measure_start(b, device, &cases[i]);
    good = good && measure_steps(b, device);
    free(blob);
    blob = NULL;
    return good;
}

/* ---- steady frames */

typedef struct quantity {
    const char *name;
    size_t offset; /* in frame_times */
} quantity;

static const quantity recording = {"recording", offsetof(frame_times, record)};
static const quantity recording_cpu = {"recording, of the processor", offsetof(frame_times, record_cpu)};
static const quantity frame = {"frame", offsetof(frame_times, whole)};
static const quantity frame_cpu = {"frame, of all processors", offsetof(frame_times, whole_cpu)};
static const quantity bare = {"the same kernel every time", offsetof(frame_times, bare)};

static double time_of(const frame_times *times, const quantity *q)
{
    return *(const double *)((const char *)times + q->offset);
}

static void print_spread(const quantity *q, const double *times)
{
    static double sorted[FRAMES];
    const spread s = spread_of(times, FRAMES, sorted);
    printf("  %-28s median %8.3f ms  99 %% %8.3f  99.9 %% %8.3f  max %8.3f: %.2f of the median\n", q->name, s.median,
           s.percent_99, s.percent_99_9, s.max, s.max / s.median);
}

/* The times of one run, or for each frame the min of several runs. */
static void print_minima(const quantity *q, const frame_times *runs, uint32_t count)
{
    static double minima[FRAMES];
    for (uint32_t i = 0; i < FRAMES; i++) {
        minima[i] = time_of(&runs[i], q);
        for (uint32_t run = 1; run < count; run++)
            minima[i] = fmin(minima[i], time_of(&runs[run * FRAMES + i], q));
    }
    print_spread(q, minima);
}

static bool print_common(const quantity *q, const frame_times *runs, uint32_t count)
{
    const double *of[BENCH_MAX_PASSES];
    spread_common common;
    double *times = malloc((size_t)count * FRAMES * sizeof *times);
    for (uint32_t i = 0; times && i < count * FRAMES; i++)
        times[i] = time_of(&runs[i], q);
    for (uint32_t run = 0; times && run < count; run++)
        of[run] = times + (size_t)run * FRAMES;
    const bool good = times && spread_in_common(of, count, FRAMES, &common);
    if (good)
        printf("  %-28s off those around it by %5.2f %%, of which all runs share %5.2f %% (%.2f %% could be chance)\n",
               q->name, common.seen * 100, common.own * 100, common.noise * 100);
    free(times);
    return good || options_complain("bench", "out of memory");
}

/* Other processes can only add to a frame's time, and to different frames in each run. The cost of the frame itself is
 * the same in all runs. */
static bool print_frames(const frame_times *runs, uint32_t count)
{
    printf("%d frames of steady rain, %u x %u, after %d to warm up\n", FRAMES, bench_sizes[0][0], bench_sizes[0][1],
           WARM_UP);
    print_minima(&recording, runs, 1);
    print_minima(&frame, runs, 1);
    print_minima(&frame_cpu, runs, 1);
    print_minima(&bare, runs, 1);
    if (count == 1)
        return true;
    printf("each frame's least of %u such runs, which do the same frame by frame\n", count);
    print_minima(&recording, runs, count);
    print_minima(&recording_cpu, runs, count);
    print_minima(&frame, runs, count);
    print_minima(&frame_cpu, runs, count);
    print_minima(&bare, runs, count);
    printf("a frame's own: what it has in all runs more or less than the %d around it (standard deviations)\n",
           SPREAD_AROUND);
    return print_common(&frame, runs, count) && print_common(&frame_cpu, runs, count) &&
           print_common(&bare, runs, count);
}

/* Measures all frames from the first, on a new device. */
static bool run_frames(bench *b, const char *device, frame_times *frames)
{
    limits *machine = NULL;
    virga_scene *scene = NULL;
    virga_view view;
    virga_memory_stats before, after;
    const start_case usual = {NULL, true, false};
    bool good = reopen(b, device, &usual) && make_scene(b, &scene) && set_rain(scene) &&
                (limits_create(&b->device, &b->targets[0], CONTROL, &machine, b->error, sizeof b->error) ||
                 bench_fail(b, "limits"));
    bench_view(&view, 0);
    virga_memory_get(b->context, &before);
    for (int i = -WARM_UP; i < FRAMES && good && !interrupt_requested(); i++) {
        frame_times *times = &frames[i < 0 ? 0 : i];
        good = run_frame(b, scene, &view, times);
        times->bare = limits_bare_once_ms(&b->device, machine);
    }
    limits_destroy(&b->device, &machine);
    virga_memory_get(b->context, &after);
    if (good && after.device_bytes != before.device_bytes)
        printf("  memory: %+lld bytes since the start\n",
               (long long)after.device_bytes - (long long)before.device_bytes);
    drop_scene(b, &scene);
    return good && !interrupt_requested();
}

static bool measure_frames(bench *b, const char *device, uint32_t passes)
{
    frame_times *runs = calloc((size_t)passes * FRAMES, sizeof *runs);
    bool good = runs || options_complain("bench", "out of memory");
    for (uint32_t pass = 0; pass < passes && good; pass++)
        good = run_frames(b, device, runs + (size_t)pass * FRAMES);
    good = good ? print_frames(runs, passes) : interrupt_requested();
    free(runs);
    return good;
}

bool bench_frames(bench *b, const char *device, uint32_t passes)
{
    return measure_starts(b, device) && measure_frames(b, device, passes);
}
