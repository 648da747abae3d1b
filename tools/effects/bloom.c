/* bloom.c - the keys camera.bloom*, a layer, and `virga bench bloom`: droplets in the air spread light, see
 * host/bloom.h.
 *
 * What is spread is the light of the scene with splashes and water. The haze and the streaks of the rain lie over it:
 * haze attenuates both, and streaks are mostly too near for it. The haze is of rain, and of what it scatters by more
 * than some degrees (shaders/rain/draw/glow.glsl leaves the diffracted half in the lamp's image); this is of droplets
 * that are no rain, and of the half that they diffract. So no light is counted twice. */
#include "bloom.h"

#include "effect.h"
#include "rain.h"

#include "bench/bench.h"
#include "progress.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct bloom_state {
    const shot *of; /* NULL: not open */
    host_bloom bloom;
} bloom_state;

static bool is_used(const scene_file *scene)
{
    return scene->camera.bloom;
}

static bool open_bloom(shot *s, void *state, char *error, size_t error_size)
{
    bloom_state *b = state;
    (void)error;
    (void)error_size;
    b->of = s;
    return true;
}

static bool resize(shot *s, void *state, char *error, size_t error_size)
{
    bloom_state *b = state;
    host_bloom_destroy(&b->bloom);
    if (!is_used(s->scene))
        return true;
    const host_bloom_def def = {.width = s->target.width,
                                .height = s->target.height,
                                .color = s->target.behind.view,
                                .depth = s->target.images[HOST_DEPTH].view,
                                .pass = s->target.layer_pass};
    return host_bloom_create(&s->device, &def, &b->bloom, error, error_size);
}

static void close_bloom(shot *s, void *state)
{
    bloom_state *b = state;
    (void)s;
    host_bloom_destroy(&b->bloom);
    b->of = NULL;
}

static bool prepare(shot *s, void *state, VkCommandBuffer cmd, const tool_moment *at, char *error, size_t error_size)
{
    bloom_state *b = state;
    const scene_camera *camera = &s->scene->camera;
    const host_bloom_air air = {.visibility_m = camera->bloom_visibility_m,
                                .drop_m = 1e-6 * camera->bloom_drop_um,
                                .sky_m = scene_rain_of(s->scene)->haze_sky_m};
    (void)error;
    (void)error_size;
    if (is_used(s->scene))
        host_bloom_record(&b->bloom, cmd, &air, at->jittered->clip_from_view);
    return true;
}

/* The pass for velocities has none of it: air does not move the picture. */
static virga_result draw(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    const bloom_state *b = state;
    if (target == b->of->layer_target)
        host_bloom_draw(&b->bloom, cmd);
    return VIRGA_OK;
}

static const tool_layer layers[] = {
    {TOOL_COLOR_LAYER("bloom", draw, 18, "bloom", "light that droplets in the air spread"), .shared_from = 8,
     .depth = TOOL_DEPTH_FOCUS},
};

static void print(const scene_file *scene)
{
    const scene_camera *camera = &scene->camera;
    if (camera->bloom)
        printf("  bloom        air with droplets of %g um, visibility %g m\n", camera->bloom_drop_um,
               camera->bloom_visibility_m);
}

/* ---- virga bench ---------------------------------------------------------------------------------------------- */

#define RUNS 21

typedef struct frame_times {
    double waited[RUNS]; /* ms, of submitting and waiting */
    double worked[RUNS]; /* ms, that all threads worked, which other programs on the machine hardly change */
} frame_times;

/* A frame that clears the plate and a layer, with the bloom or without it. What is in the picture changes no time. */
static bool time_frame(bench *b, const host_target *target, host_bloom *bloom, frame_times *times, size_t run)
{
    static const host_bloom_air air = {.visibility_m = 500, .drop_m = 15e-6, .sky_m = 400};
    VkCommandBuffer cmd;
    virga_view view = virga_default_view();
    bench_view(&view, 0);
    if (!bench_begin(b, &cmd))
        return false;
    host_target_begin_plate(target, cmd);
    host_target_end_plate(target, cmd);
    if (bloom)
        host_bloom_record(bloom, cmd, &air, view.clip_from_view);
    host_target_begin_layer(target, cmd);
    if (bloom)
        host_bloom_draw(bloom, cmd);
    host_target_end_layer(target, cmd);
    const double start = bench_worked_ms();
    const bool good = bench_submit(b, &times->waited[run]);
    times->worked[run] = bench_worked_ms() - start;
    return good;
}

static bool measure(bench *b, const host_target *target, double fill_ms)
{
    const host_bloom_def def = {.width = target->width,
                                .height = target->height,
                                .color = target->images[HOST_COLOR].view,
                                .depth = target->images[HOST_DEPTH].view,
                                .pass = target->layer_pass};
    host_bloom bloom = {.device = NULL};
    frame_times with, without;
    bool good = host_bloom_create(&b->device, &def, &bloom, b->error, sizeof b->error) &&
                time_frame(b, target, &bloom, &with, 0) && time_frame(b, target, NULL, &without, 0);
    for (size_t run = 0; good && run < RUNS; run++)
        good = time_frame(b, target, NULL, &without, run) && time_frame(b, target, &bloom, &with, run);
    good = good && host_wait(&b->device, b->error, sizeof b->error);
    host_bloom_destroy(&bloom);
    if (!good)
        return bench_fail(b, "bloom");
    const double ms = bench_median(with.waited, RUNS) - bench_median(without.waited, RUNS);
    const double worked = bench_median(with.worked, RUNS) - bench_median(without.worked, RUNS);
    printf("  %4u x %-4u %10.3f ms %8.1f x a fill, processors %10.3f ms, median of %d\n", target->width, target->height,
           ms, ms / fill_ms, worked, RUNS);
    return true;
}

static bool run(bench *b, const options *parsed)
{
    (void)parsed;
    printf("bloom of wet air: a frame with it, less one without\n");
    for (int i = 0; i < BENCH_SIZES && !interrupt_requested(); i++) {
        limits *l;
        if (!limits_create(&b->device, &b->targets[i], 1024, &l, b->error, sizeof b->error))
            return bench_fail(b, "fill");
        limits_fill_ms(&b->device, l, &b->targets[i]); /* the first compiles */
        const double fill_ms = limits_fill_ms(&b->device, l, &b->targets[i]);
        limits_destroy(&b->device, &l);
        if (fill_ms <= 0 || !measure(b, &b->targets[i], fill_ms))
            return false;
    }
    return true;
}

static const tool_bench bloom_bench = {.help = "light that droplets in the air spread, three sizes\n", .run = run};

const tool_effect bloom_effect = {
    .name = "bloom",
    .is_used = is_used,
    .missing = "bloom; expected camera.bloom: true",
    .print = print,
    .state_size = sizeof(bloom_state),
    .open = open_bloom,
    .resize = resize,
    .close = close_bloom,
    .layers = layers,
    .layer_count = sizeof layers / sizeof *layers,
    .shows_behind = true,
    .in_air = true,
    .prepare = prepare,
    .bench = &bloom_bench,
};
