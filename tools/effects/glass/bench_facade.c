/* bench_facade.c - `virga bench glass --facade`: the wet windows of a facade, as 1, 10 and 100 panes whose drops are
 * textures, and as one pane over the whole front. Shows which part of the cost grows with the number of panes. */
#include "bench_facade.h"
#include "bench/bench.h"
#include "camera.h"
#include "options.h"
#include "progress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH     1280u
#define HEIGHT    720u
#define MAX_PANES 100u
#define ACROSS    10 /* windows in a row */
#define WIDE_M    1.2
#define HIGH_M    1.5
#define PITCH_M   2.0
#define RATE_MM_H 30.0f
#define WARMUP    2  /* frames before the timing */
#define TICKS     16 /* of rain in each of them */
#define RUNS      5

enum { MOTION, FILM, PLATE, TEXTURES, PARTS };

static const char *const part_names[PARTS] = {"motion", "film", "plate", "textures"};
static const char *const part_passes[PARTS] = {NULL, "glass.film", "glass.plate_copy", "glass.textures"};

static const struct row {
    uint32_t panes;
    bool whole; /* one pane as large as 100 windows with the wall between them */
    bool apart; /* prepared by a call each: each pane makes copies of the plate */
} rows[] = {{1, false, false}, {10, false, false}, {100, false, true}, {100, false, false}, {1, true, false}};

typedef struct facade {
    virga_glass *panes[MAX_PANES];
    virga_glass_pose poses[MAX_PANES];
    uint32_t count;
    bool apart;
    virga_target *layer;
    host_target picture;
    host_camera camera;
    uint32_t tick;
} facade;

/* As assets/README.md has it for far windows. */
static virga_glass_def def_of(const struct row *row)
{
    virga_glass_def def = virga_default_glass_def();
    def.width_m = row->whole ? 10 : (float)WIDE_M;
    def.height_m = row->whole ? 10 : (float)HIGH_M;
    def.cell_m = 0.005f;
    def.max_drops = row->whole ? 131072 : 2048;
    def.max_texels = 64;
    def.texture_columns = def.texture_rows = row->whole ? 11 : 5;
    return def;
}

static bool open_pane(bench *b, facade *f, const virga_glass_def *def, uint32_t index)
{
    virga_glass_settings settings = virga_default_glass_settings();
    virga_glass_pose *pose = &f->poses[index];
    settings.style = VIRGA_GLASS_STYLE_TEXTURES;
    pose->position_m[0] = PITCH_M * (index % ACROSS);
    pose->position_m[1] = PITCH_M * (index / ACROSS);
    memcpy(pose->previous_position_m, pose->position_m, sizeof pose->position_m);
    return virga_glass_create(b->context, def, &f->panes[index]) >= 0 &&
           virga_glass_set(f->panes[index], &settings) >= 0 && virga_glass_attach(f->panes[index], f->layer) >= 0;
}

static bool open_facade(bench *b, const struct row *row, facade *f)
{
    virga_target_def layer = virga_default_target_def();
    const virga_glass_def def = def_of(row);
    f->tick = 1;
    f->apart = row->apart;
    if (!host_target_create(&b->device, WIDTH, HEIGHT, &f->picture, b->error, sizeof b->error))
        return bench_fail(b, "picture");
    host_target_describe_layer(&f->picture, &layer);
    if (virga_target_create(b->context, &layer, &f->layer) < 0)
        return options_complain("bench", "no target could be made");
    const host_camera_key key = {0, {9.6, 9.75, 28}, {9.6, 9.75, 0}, 0, false};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 40, .near_m = 0.1, .far_m = 100};
    host_camera_at(&path, 0, WIDTH, HEIGHT, NULL, &f->camera);
    const double start = progress_now(), worked = bench_worked_ms();
    while (f->count < row->panes && open_pane(b, f, &def, f->count))
        f->count++;
    if (f->count < row->panes)
        return options_complain("bench", "pane %u could not be made", f->count);
    printf("%u pane%s of %g x %g m%s, %.1f MiB each at most; made in %.0f ms, processors %.0f ms\n", f->count,
           f->count > 1 ? "s" : "", (double)def.width_m, (double)def.height_m, f->apart ? ", prepared one by one" : "",
           (double)virga_glass_estimate(&def) / 1048576, (progress_now() - start) * 1e3, bench_worked_ms() - worked);
    return true;
}

static bool record(facade *f, VkCommandBuffer cmd, uint32_t ticks)
{
    bool good = true;
    virga_view view = virga_default_view();
    host_camera_view(&f->camera, &f->camera, 0, &view);
    view.color = host_target_color(&f->picture);
    for (uint32_t i = 0; good && i < f->count; i++) {
        const virga_glass_step_info info = {
            .first_tick = f->tick, .ticks = ticks, .rate_mm_h = RATE_MM_H, .wind_m_s = {0, 0, -6}, .air_density = 1.2f};
        good = virga_glass_step(f->panes[i], cmd, &info) >= 0;
    }
    host_target_begin_plate(&f->picture, cmd);
    host_target_end_plate(&f->picture, cmd);
    virga_glass_pane shown[MAX_PANES];
    for (uint32_t i = 0; i < f->count; i++)
        shown[i] =
            (virga_glass_pane){.glass = f->panes[i], .pose = f->poses[i], .time_s = virga_glass_time(f->panes[i])};
    for (uint32_t i = 0; good && i < f->count; i += f->apart ? 1 : f->count)
        good = virga_glass_prepare_panes(cmd, &view, shown + i, f->apart ? 1 : f->count) >= 0;
    host_target_begin_layer(&f->picture, cmd);
    for (uint32_t i = 0; good && i < f->count; i++)
        good = virga_glass_draw(f->panes[i], cmd, f->layer) == VIRGA_OK;
    host_target_end_layer(&f->picture, cmd);
    f->tick += ticks;
    return good;
}

/* A frame; times of recording it, of waiting for it, and of all threads. */
static bool frame(bench *b, facade *f, uint32_t ticks, double times[3])
{
    VkCommandBuffer cmd;
    const double worked = bench_worked_ms();
    if (!bench_begin(b, &cmd))
        return false;
    const double start = progress_now();
    const bool good = record(f, cmd, ticks);
    times[0] = (progress_now() - start) * 1e3;
    if (!bench_submit(b, &times[1]) || !good)
        return options_complain("bench", "a frame failed");
    times[2] = bench_worked_ms() - worked;
    return true;
}

static void read_parts(const bench *b, double ms[PARTS])
{
    virga_pass_time times[64];
    const uint32_t count = virga_timings_get(b->context, times, 64);
    ms[MOTION] = 0;
    for (uint32_t i = 0; i < count && i < 64; i++)
        if (!strncmp(times[i].name, "glass.", 6))
            ms[MOTION] += bench_pass_ms(b, times[i].name);
    for (int j = 1; j < PARTS; j++) {
        ms[j] = bench_pass_ms(b, part_passes[j]);
        ms[MOTION] -= ms[j];
    }
}

static bool measure(bench *b, facade *f)
{
    double times[3], one[PARTS], parts[PARTS][RUNS], recorded[RUNS], waited[RUNS], worked[RUNS];
    bool good = true;
    for (int i = 0; good && i < WARMUP && !interrupt_requested(); i++)
        good = frame(b, f, TICKS, times);
    for (int i = 0; good && i < RUNS && !interrupt_requested(); i++) {
        good = frame(b, f, 1, times);
        read_parts(b, one);
        for (int j = 0; j < PARTS; j++)
            parts[j][i] = one[j];
        recorded[i] = times[0], waited[i] = times[1], worked[i] = times[2];
    }
    if (!good || interrupt_requested())
        return false;
    uint64_t drops = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        virga_glass_stats stats;
        virga_glass_stats_get(f->panes[i], &stats);
        drops += stats.drops;
    }
    printf("  %llu drops; a frame with a tick:", (unsigned long long)drops);
    for (int j = 0; j < PARTS; j++)
        printf(" %s %.2f,", part_names[j], bench_median(parts[j], RUNS));
    printf(" in all %.1f ms; recording it %.2f ms; processors %.1f ms\n", bench_median(waited, RUNS),
           bench_median(recorded, RUNS), bench_median(worked, RUNS));
    fflush(stdout);
    return true;
}

bool glass_bench_facade(bench *b)
{
    bool good = true;
    printf("wet windows of %g x %g m whose drops are textures, %u x %u pixels, rain of %g mm/h, medians of %d\n",
           WIDE_M, HIGH_M, WIDTH, HEIGHT, (double)RATE_MM_H, RUNS);
    for (size_t i = 0; good && i < sizeof rows / sizeof rows[0] && !interrupt_requested(); i++) {
        facade *f = calloc(1, sizeof *f);
        good = f && open_facade(b, &rows[i], f) && measure(b, f);
        for (uint32_t k = 0; f && k < MAX_PANES; k++)
            virga_glass_destroy(&f->panes[k]);
        if (f)
            virga_target_destroy(&f->layer);
        if (f && f->picture.width)
            host_target_destroy(&b->device, &f->picture);
        free(f);
    }
    return good;
}
