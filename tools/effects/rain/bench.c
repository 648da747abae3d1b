/* bench.c - `virga bench rain`. */
#include "bench/bench.h"
#include "effect.h"
#include "options.h"
#include "progress.h"

#include <stdio.h>
#include <string.h>

#define OCCLUSION_INTERVAL 4

/* How long the shutter is open: streaks are as long as drops fall in that time. */
enum { SHUTTER_DEFAULT, SHUTTER_FILM, SHUTTERS };
static const double film_shutter_s = 1.0 / 48; /* 24 frames a second, half of each open */

typedef struct rain_run {
    bench *b;
    virga_rain *rain;
} rain_run;

typedef struct draw_result {
    double prepare_ms, draw_ms[SHUTTERS], fill_ms;
    uint32_t streaks[SHUTTERS];
} draw_result;

/* What one count of drops costs, in milliseconds. */
typedef struct bench_result {
    uint32_t slots;
    double copy, bare, dispatch, step, impacts, occlusion, occlusion_by_interval, shutter_s[SHUTTERS];
    draw_result draws[BENCH_SIZES];
} bench_result;

static bool set_rain(rain_run *r, uint32_t occlusion_interval)
{
    virga_rain_settings settings = virga_default_rain_settings();
    settings.rate_mm_h = 25;
    settings.occlusion_interval = occlusion_interval;
    return virga_rain_set(r->rain, &settings) == VIRGA_OK;
}

static bool open_rain(rain_run *r, uint32_t drops)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = drops;
    def.max_impacts = drops > 65536 ? drops : 65536;
    virga_target_def target = virga_default_target_def();
    host_target_describe_layer(&r->b->targets[0], &target);
    if (virga_rain_create(r->b->context, &def, &r->rain) || virga_target_create(r->b->context, &target, &r->b->layer) ||
        virga_rain_attach(r->rain, r->b->layer))
        return options_complain("bench", "no rain of %u drops could be made", drops);
    return set_rain(r, 1);
}

/* One tick with occlusion, and its passes' times. */
static bool run_step(rain_run *r, double *step, double *impacts, double *occlusion)
{
    VkCommandBuffer cmd;
    double whole;
    const double camera[3] = {0, 1.7, 0};
    const virga_rain_step_info info = {.dt_s = 1.0 / 60, .camera_m = {0, 1.7, 0}};
    if (!bench_begin(r->b, &cmd) || virga_rain_draw_occlusion(r->rain, cmd, camera, &r->b->floor, 1) ||
        virga_rain_step(r->rain, cmd, &info) || !bench_submit(r->b, &whole))
        return options_complain("bench", "a step failed");
    *step = bench_pass_ms(r->b, "rain.step");
    *impacts = bench_pass_ms(r->b, "rain.impacts");
    *occlusion = bench_pass_ms(r->b, "rain.occlusion");
    return true;
}

static bool measure_step(rain_run *r, bench_result *result)
{
    double step[BENCH_RUNS], impacts[BENCH_RUNS], occlusion[BENCH_RUNS], by_interval[BENCH_RUNS], other[2];
    for (int i = -2; i < BENCH_RUNS; i++) {
        const int at = i < 0 ? 0 : i;
        if (!run_step(r, &step[at], &impacts[at], &occlusion[at]))
            return false;
    }
    if (!set_rain(r, OCCLUSION_INTERVAL))
        return false;
    for (int i = 0; i < BENCH_RUNS; i++)
        if (!run_step(r, &other[0], &other[1], &by_interval[i]))
            return false;
    result->step = bench_median(step, BENCH_RUNS);
    result->impacts = bench_median(impacts, BENCH_RUNS);
    result->occlusion = bench_median(occlusion, BENCH_RUNS);
    result->occlusion_by_interval = bench_median(by_interval, BENCH_RUNS);
    return set_rain(r, 1);
}

/* A frame of a prepare, the clear of the picture and, where `drawn`, the draw. */
static bool run_picture(rain_run *r, uint32_t size, const virga_view *view, bool drawn, double *ms)
{
    VkCommandBuffer cmd;
    if (!bench_begin(r->b, &cmd) || virga_rain_prepare(r->rain, cmd, view, virga_rain_time(r->rain)))
        return options_complain("bench", "a prepare failed");
    host_target_begin_layer(&r->b->targets[size], cmd);
    if (drawn && virga_rain_draw(r->rain, cmd, r->b->layer))
        return options_complain("bench", "a draw failed");
    host_target_end_layer(&r->b->targets[size], cmd);
    return bench_submit(r->b, ms);
}

/* Drawing is timed by whole submissions, with and without the draw: timestamps inside rendering mean little on
 * software Vulkan. */
static bool measure_draw(rain_run *r, uint32_t size, const virga_view *view, double *prepare_ms, double *draw_ms,
                         uint32_t *streaks)
{
    double draw[BENCH_RUNS], prepare[BENCH_RUNS], with, without;
    for (int i = -1; i < BENCH_RUNS; i++) {
        const int at = i < 0 ? 0 : i;
        if (!run_picture(r, size, view, false, &without) || !run_picture(r, size, view, true, &with))
            return false;
        draw[at] = with - without;
        prepare[at] = bench_pass_ms(r->b, "rain.prepare");
    }
    virga_rain_stats stats;
    virga_rain_stats_get(r->rain, &stats);
    *draw_ms = bench_median(draw, BENCH_RUNS);
    *prepare_ms = bench_median(prepare, BENCH_RUNS);
    *streaks = stats.streaks;
    return true;
}

static bool measure_draws(rain_run *r, bench_result *result)
{
    bool good = true;
    for (uint32_t size = 0; size < BENCH_SIZES && good; size++)
        for (uint32_t shutter = 0; shutter < SHUTTERS && good; shutter++) {
            draw_result *to = &result->draws[size];
            virga_view view;
            bench_view(&view, size);
            view.shutter_s = shutter == SHUTTER_FILM ? film_shutter_s : virga_default_view().shutter_s;
            result->shutter_s[shutter] = view.shutter_s;
            good = measure_draw(r, size, &view, &to->prepare_ms, &to->draw_ms[shutter], &to->streaks[shutter]);
        }
    virga_rain_stats stats;
    virga_rain_stats_get(r->rain, &stats);
    result->slots = stats.slots;
    return good;
}

static bool measure(rain_run *r, uint32_t drops, bench_result *result)
{
    limits *machine = NULL;
    bool good = open_rain(r, drops) && measure_step(r, result) && measure_draws(r, result);
    if (good &&
        !limits_create(&r->b->device, &r->b->targets[0], result->slots, &machine, r->b->error, sizeof r->b->error))
        good = bench_fail(r->b, "limits");
    if (good) {
        result->copy = limits_copy_ms(&r->b->device, machine);
        result->bare = limits_bare_ms(&r->b->device, machine);
        result->dispatch = limits_dispatch_ms(&r->b->device, machine);
    }
    limits_destroy(&r->b->device, &machine);
    for (uint32_t size = 0; size < BENCH_SIZES && good; size++) {
        good = limits_create(&r->b->device, &r->b->targets[size], 256, &machine, r->b->error, sizeof r->b->error);
        if (good)
            result->draws[size].fill_ms = limits_fill_ms(&r->b->device, machine, &r->b->targets[size]);
        limits_destroy(&r->b->device, &machine);
    }
    virga_target_destroy(&r->b->layer);
    virga_rain_destroy(&r->rain);
    return good;
}

static void print_result(const bench_result *r)
{
    const double bytes = r->slots * 32.0;
    printf("%u drops\n", r->slots);
    if (r->copy > 0.002)
        printf("  machine    copy %.3f ms (%.2f GB/s)", r->copy, bytes / (r->copy * 1e6));
    else
        printf("  machine    copy within noise");
    printf("  bare kernel %.3f ms  dispatch %.4f ms\n", r->bare, r->dispatch);
    printf("  step       %8.3f ms  %6.2f x bare kernel  %6.2f ns a drop\n", r->step, r->step / r->bare,
           r->step * 1e6 / r->slots);
    printf("  impacts    %8.3f ms  %6.2f x bare kernel  %6.2f ns a drop\n", r->impacts, r->impacts / r->bare,
           r->impacts * 1e6 / r->slots);
    printf("  occlusion  %8.3f ms  (4 maps of 1024 x 1024, a floor)  %8.3f a frame over %d frames\n", r->occlusion,
           r->occlusion_by_interval, OCCLUSION_INTERVAL);
    for (int i = 0; i < BENCH_SIZES; i++) {
        const draw_result *d = &r->draws[i];
        printf("  %4u x %-4u prepare %8.3f ms %6.2f ns a drop;  fill of the picture %.3f ms\n", bench_sizes[i][0],
               bench_sizes[i][1], d->prepare_ms, d->prepare_ms * 1e6 / r->slots, d->fill_ms);
        for (int k = 0; k < SHUTTERS; k++)
            printf("      draw, shutter 1/%.0f s %8.3f ms, %u streaks, %.0f ns a streak\n", 1 / r->shutter_s[k],
                   d->draw_ms[k], d->streaks[k], d->streaks[k] ? d->draw_ms[k] * 1e6 / d->streaks[k] : 0);
    }
    fflush(stdout);
}

static const option_row option_rows[] = {
    {"--drops", 0, "N", "rain: measure this many drops only. Default: 1000 to 1000000", false},
};

static bool check(const options *parsed)
{
    uint32_t only;
    return options_uint(parsed, "--drops", 1024, 4194304, &only);
}

static bool run(bench *b, const options *parsed)
{
    static const uint32_t usual[] = {1000, 10000, 100000, 576000, 1000000}; /* 576,000: 25,000 of 1280 x 720 */
    rain_run r = {.b = b};
    uint32_t only = 0;
    bool good = options_uint(parsed, "--drops", 1024, 4194304, &only);
    for (size_t i = 0; good && !interrupt_requested() && i < (only ? 1 : sizeof usual / sizeof usual[0]); i++) {
        bench_result result;
        memset(&result, 0, sizeof result);
        good = measure(&r, only ? only : usual[i], &result);
        if (good) {
            print_result(&result);
            bench_print_model(b);
        }
    }
    return good;
}

const tool_bench rain_bench = {
    .help = "step, impacts, occlusion, prepare and draw at 10^3 to 10^6 drops, in three picture sizes\n"
            "and with the shutter open for 1/96 s (the library's default) and 1/48 s (film)\n",
    TOOL_BENCH(check, run),
};
