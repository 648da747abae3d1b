/* bench.c - `virga bench glass`: a pane in the rain with two wipers, pass by pass, beside the machine's limits
 * and the 30 to 40 frames a second of Goto, Tanaka and Sagawa 2009 (3,000 metaballs, 1024 x 1024). */
#include "bench/bench.h"
#include "bench_facade.h"
#include "bench_textures.h"
#include "camera.h"
#include "effect.h"
#include "options.h"
#include "progress.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define MAX_WARMUP 600 /* ticks in which a pane gets wet enough */
#define AIM_WARMUP 60  /* ticks after which it has to rain harder for that */
#define MIN_MM_H   1.0f
#define PAPER_LOW  30
#define PAPER_HIGH 40

enum { MOTION, FILM, BALLS, SPLAT, PLATE, DRAW, CLEAR, FOG, PASSES };

static const char *const names[PASSES] = {
    "motion", "film", "balls", "splat, compression, normals", "plate", "draw (compose)", "fog taken by drops",
    "fog map"};
static const char *const passes[PASSES] = {
    NULL,         "glass.film", "glass.balls",  "glass.height_map", "glass.plate_copy",
    "glass.draw", "glass.fog",  "glass.fog_map"};

/* Drops that are large enough to have a shape with texels of 1 mm. Their relative numbers are those of a shower of
 * 10 mm/h (Marshall and Palmer). These are the paper's metaballs, without thousands of fine drops that would become
 * film and mist. */
static const double shaped_m[] = {0.0012, 0.002, 0.003, 0.004}, shaped_number[] = {1, 0.132, 0.0105, 0.0008};
static const virga_sizes shaped = {VIRGA_SIZES_TABLE, shaped_m, shaped_number, 4};

/* Panes of about a texel a pixel. `bare`: metaballs alone, as the paper has them, all with a shape, without film
 * and mist. `fog`: fogged all over, and fogging, on the side of the rain. */
static const struct row {
    uint32_t balls, side;
    float width_m;
    bool bare, fog;
} rows[] = {{3000, 1024, 1, true, false},
            {3000, 1024, 1, false, false},
            {10000, 1024, 1, false, false},
            {100000, 2560, 2.5f, false, false}},
  fog_rows[] = {{3000, 1024, 1, false, false}, {3000, 1024, 1, false, true}};

typedef struct pane {
    virga_glass *glass;
    virga_glass_settings settings;
    virga_target *layer;
    host_target picture;
    host_camera camera;
    virga_glass_pose pose;
    uint32_t tick;
    float rate_mm_h;
    double frame_ms; /* of the newest frame */
    const virga_sizes *sizes;
    VkDeviceSize bytes;
} pane;

static bool open_pane(bench *b, const struct row *row, pane *p)
{
    virga_glass_def def = virga_default_glass_def();
    virga_target_def layer = virga_default_target_def();
    def.width_m = def.height_m = row->width_m;
    def.max_texels = row->side;
    def.max_drops = row->balls > 50000 ? 262144 : 32768;
    def.condensation = row->fog;
    p->tick = 1;
    p->sizes = row->bare ? &shaped : NULL;
    p->bytes = virga_glass_estimate(&def);
    if (!host_target_create(&b->device, row->side, row->side, &p->picture, b->error, sizeof b->error))
        return bench_fail(b, "picture");
    host_target_describe_layer(&p->picture, &layer);
    if (virga_glass_create(b->context, &def, &p->glass) < 0 || virga_target_create(b->context, &layer, &p->layer) < 0 ||
        virga_glass_attach(p->glass, p->layer) < 0)
        return options_complain("bench", "no pane of %u x %u texels could be made", row->side, row->side);
    const double middle = 0.5 * (double)row->width_m, away = middle / tan(M_PI / 9);
    const host_camera_key key = {0, {middle, middle, -away}, {middle, middle, 0}, 0, false};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 40, .near_m = 0.01, .far_m = 100};
    host_camera_at(&path, 0, row->side, row->side, NULL, &p->camera);
    return true;
}

/* Two in tandem, as on a car. */
static bool set_pane(pane *p, const struct row *row, virga_glass_style style)
{
    p->settings = virga_default_glass_settings();
    p->settings.style = style;
    if (row->bare)
        p->settings.film_um = p->settings.mist_max_mm = 0;
    if (row->fog) {
        p->settings.condensation.side = VIRGA_GLASS_FOG_OUTSIDE;
        p->settings.condensation.glass_c = 8;
        p->settings.condensation.humidity = 0.8f;
        p->settings.condensation.start_um = 6;
        p->settings.condensation.heat_w_m2_k = 100;
    }
    p->settings.wiper_count = 2;
    for (int i = 0; i < 2; i++) {
        virga_glass_wiper *w = &p->settings.wipers[i];
        *w = virga_default_glass_wiper();
        w->pivot_m[0] = (i ? 0.55f : 0.05f) * row->width_m;
        w->pivot_m[1] = -0.05f * row->width_m;
        w->reach_m = 0.62f * row->width_m;
        w->blade_m = 0.55f * row->width_m;
        w->low_deg = 5;
        w->high_deg = 100;
    }
    return virga_glass_set(p->glass, &p->settings) >= 0;
}

static bool record_picture(pane *p, VkCommandBuffer cmd)
{
    virga_view view = virga_default_view();
    host_camera_view(&p->camera, &p->camera, 0, &view);
    view.color = host_target_color(&p->picture);
    host_target_begin_plate(&p->picture, cmd);
    host_target_end_plate(&p->picture, cmd);
    const bool prepared = virga_glass_prepare(p->glass, cmd, &view, &p->pose, virga_glass_time(p->glass)) == VIRGA_OK;
    host_target_begin_layer(&p->picture, cmd);
    const bool drawn = virga_glass_draw(p->glass, cmd, p->layer) == VIRGA_OK;
    host_target_end_layer(&p->picture, cmd);
    return prepared && drawn;
}

static bool frame(bench *b, pane *p)
{
    VkCommandBuffer cmd;
    const virga_glass_step_info info = {.first_tick = p->tick++,
                                        .ticks = 1,
                                        .rate_mm_h = p->rate_mm_h,
                                        .sizes = p->sizes,
                                        .velocity_m_s = {0, 0, 20},
                                        .air_density = 1.2f};
    return (bench_begin(b, &cmd) && virga_glass_step(p->glass, cmd, &info) >= 0 && record_picture(p, cmd) &&
            bench_submit(b, &p->frame_ms)) ||
           options_complain("bench", "a frame failed");
}

/* Reads the pass times of the newest frame. Motion is the sum of all glass passes that do not render. */
static void read_times(const bench *b, const pane *p, double ms[PASSES])
{
    virga_pass_time times[64];
    const uint32_t count = virga_timings_get(b->context, times, 64);
    ms[MOTION] = 0;
    for (int j = 1; j < PASSES; j++)
        ms[j] = strcmp(passes[j], "glass.draw") ? bench_pass_ms(b, passes[j]) : 0;
    for (uint32_t i = 0; i < count && i < 64; i++)
        if (!strncmp(times[i].name, "glass.", 6))
            ms[MOTION] += times[i].milliseconds;
    for (int j = 1; j < PASSES; j++) {
        ms[MOTION] -= ms[j];
        if (!strcmp(passes[j], "glass.draw"))
            ms[j] = bench_draw_ms(b, passes[j], p->frame_ms);
    }
}

/* Rains until the pane has the requested number of metaballs. The rain is as light as possible, for two reasons: the
 * number must not grow much during the timing, and the pane must have drops of all ages. A drop that has just landed
 * has four metaballs. */
static bool get_wet(bench *b, pane *p, uint32_t balls, virga_glass_stats *stats)
{
    bool good = true;
    p->rate_mm_h = balls > 50000 ? 100 : MIN_MM_H;
    for (int i = 1; good && i <= MAX_WARMUP && stats->balls < balls && !interrupt_requested(); i++) {
        good = frame(b, p);
        virga_glass_stats_get(p->glass, stats);
        if (i % AIM_WARMUP == 0)
            p->rate_mm_h = fminf(1.5f * p->rate_mm_h, 200);
    }
    return good;
}

static bool measure_limits(bench *b, const struct row *row, const pane *p, double *fill)
{
    limits *machine = NULL;
    const bool good =
        limits_create(&b->device, &p->picture, row->side * row->side, &machine, b->error, sizeof b->error) ||
        bench_fail(b, "limits");
    if (good) {
        *fill = limits_fill_ms(&b->device, machine, &p->picture);
        printf("  machine: copy of 16 bytes a texel %.2f ms, bare kernel over them %.2f ms, dispatch %.3f ms, fill "
               "%.2f ms\n",
               limits_copy_ms(&b->device, machine), limits_bare_ms(&b->device, machine),
               limits_dispatch_ms(&b->device, machine), *fill);
    }
    limits_destroy(&b->device, &machine);
    return good;
}

static bool measure_style(bench *b, const struct row *row, pane *p, virga_glass_style style, double fill)
{
    double times[PASSES][BENCH_RUNS], one[PASSES], sum = 0;
    bool good = set_pane(p, row, style);
    for (int i = -2; good && i < BENCH_RUNS; i++) {
        good = frame(b, p);
        read_times(b, p, one);
        for (int j = 0; j < PASSES && i >= 0; j++)
            times[j][i] = one[j];
    }
    if (!good)
        return false;
    virga_glass_stats stats;
    virga_glass_stats_get(p->glass, &stats);
    printf("  %s, %u metaballs at the end\n",
           style == VIRGA_GLASS_STYLE_PAPER ? "in the paper's style" : "by Snell and Fresnel", stats.balls);
    for (int j = 0; j < (row->fog ? PASSES : CLEAR); j++) {
        const double ms = bench_median(times[j], BENCH_RUNS);
        sum += ms;
        printf("    %-28s %8.2f ms  %6.1f x fill\n", names[j], ms, ms / fill);
    }
    printf("    all in %24s %8.2f ms  %6.1f frames a second (the paper: %d to %d)\n", "", sum, 1000 / sum, PAPER_LOW,
           PAPER_HIGH);
    fflush(stdout);
    return true;
}

static bool measure(bench *b, const struct row *row)
{
    pane p = {0};
    virga_glass_stats stats = {0};
    double fill = 1;
    bool good =
        open_pane(b, row, &p) && set_pane(&p, row, VIRGA_GLASS_STYLE_PAPER) && get_wet(b, &p, row->balls, &stats);
    if (good && interrupt_requested())
        good = false;
    if (good)
        printf("%u metaballs%s asked for: %u, of %u drops and %u particles after %u ticks, in rain of %.1f mm/h at 20 "
               "m/s; %u x %u picture, %.1f m pane, %.0f MiB at most\n",
               row->balls,
               row->bare  ? " without film and mist"
               : row->fog ? " on fogged glass"
                          : "",
               stats.balls, stats.drops, stats.particles, p.tick - 1, (double)p.rate_mm_h, row->side, row->side,
               (double)row->width_m, (double)p.bytes / 1048576);
    good = good && measure_limits(b, row, &p, &fill) && measure_style(b, row, &p, VIRGA_GLASS_STYLE_PAPER, fill) &&
           (row->bare || measure_style(b, row, &p, VIRGA_GLASS_STYLE_PHYSICAL, fill));
    if (good)
        bench_print_model(b);
    virga_target_destroy(&p.layer);
    virga_glass_destroy(&p.glass);
    if (p.picture.width)
        host_target_destroy(&b->device, &p.picture);
    return good;
}

static const option_row option_rows[] = {
    {"--balls", 0, "N", "glass: measure the row of this many metaballs only: 3000, 10000 or 100000", false},
    {"--textures", 0, NULL, "glass: measure 1000 drops as textures on 320 x 240 pixels, and other ways, only", false},
    {"--fog", 0, NULL, "glass: measure 3000 metaballs on dry and on fogged glass only", false},
    {"--facade", 0, NULL, "glass: measure 1, 10 and 100 windows of a facade only", false},
};

static bool read_balls(const options *parsed, uint32_t *balls)
{
    *balls = 0;
    if (!options_uint(parsed, "--balls", 3000, 100000, balls))
        return false;
    return !*balls || *balls == 3000 || *balls == 10000 || *balls == 100000 ||
           options_complain("bench", "--balls: expected 3000, 10000 or 100000, got %u", *balls);
}

static bool check(const options *parsed)
{
    uint32_t balls;
    return read_balls(parsed, &balls);
}

static bool run(bench *b, const options *parsed)
{
    uint32_t only;
    bool good = read_balls(parsed, &only);
    if (good && options_value(parsed, "--textures"))
        return glass_bench_textures(b);
    if (good && options_value(parsed, "--facade"))
        return glass_bench_facade(b);
    if (good && options_value(parsed, "--fog"))
        return measure(b, &fog_rows[0]) && measure(b, &fog_rows[1]);
    for (size_t i = 0; good && !interrupt_requested() && i < sizeof rows / sizeof rows[0]; i++)
        if (!only || rows[i].balls == only)
            good = measure(b, &rows[i]);
    return good;
}

const tool_bench glass_bench = {
    .help = "motion, metaballs, height map, plate and draw of 3000 to 100000 metaballs on a pane with\n"
            "two wipers\n",
    TOOL_BENCH(check, run),
};
