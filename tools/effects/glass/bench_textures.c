/* bench_textures.c - `virga bench glass --textures`: the case of Sato, Dobashi and Yamamoto 2002 without focus, 1,000
 * drops on 320 x 240 pixels before a photo, drawn as textures and in the other ways. */
#include "bench_textures.h"
#include "bench/bench.h"
#include "camera.h"
#include "options.h"
#include "progress.h"

#include <math.h>
#include <stdio.h>

#define WIDTH      320u
#define HEIGHT     240u
#define DROPS      1000u
#define RATE_MM_H  20.0f
#define MAX_WARMUP 1200 /* ticks in which that many drops land */
#define RUNS       31
#define TICK_HZ    60
#define PAPER_FPS  55 /* on a GeForce 3 */

/* Drops with a shape, as in a shower, without film and mist: the paper has neither. */
static const double sizes_m[] = {0.0012, 0.002, 0.003, 0.004}, numbers[] = {1, 0.132, 0.0105, 0.0008};
static const virga_sizes sizes = {VIRGA_SIZES_TABLE, sizes_m, numbers, 4};

static const struct way {
    const char *name;
    virga_glass_style style;
    virga_glass_texture_shape shape;
    float textured_px;
    uint32_t per_frame;
    bool still;
} ways[] = {
    {"textures, hemispheres, a photo behind", VIRGA_GLASS_STYLE_TEXTURES, VIRGA_GLASS_TEXTURE_HEMISPHERE, 0, 0, true},
    {"the same before a film: all 121 anew", VIRGA_GLASS_STYLE_TEXTURES, VIRGA_GLASS_TEXTURE_HEMISPHERE, 0, 0, false},
    {"the same, 11 in each frame", VIRGA_GLASS_STYLE_TEXTURES, VIRGA_GLASS_TEXTURE_HEMISPHERE, 0, 11, false},
    {"textures, caps, all anew", VIRGA_GLASS_STYLE_TEXTURES, VIRGA_GLASS_TEXTURE_CAP, 0, 0, false},
    {"by Snell, below 8 px as textures", VIRGA_GLASS_STYLE_PHYSICAL, VIRGA_GLASS_TEXTURE_CAP, 8, 0, false},
    {"by Snell", VIRGA_GLASS_STYLE_PHYSICAL, VIRGA_GLASS_TEXTURE_CAP, 0, 0, false},
    {"as Goto et al.", VIRGA_GLASS_STYLE_PAPER, VIRGA_GLASS_TEXTURE_CAP, 0, 0, false},
};

typedef struct pane {
    virga_glass *glass;
    virga_target *layer;
    host_target picture;
    host_camera camera;
    uint32_t tick;
} pane;

static bool open_pane(bench *b, pane *p)
{
    virga_glass_def def = virga_default_glass_def();
    virga_target_def layer = virga_default_target_def();
    def.width_m = 0.4f;
    def.height_m = 0.3f;
    def.max_texels = WIDTH;
    def.max_drops = 4096;
    p->tick = 1;
    if (!host_target_create(&b->device, WIDTH, HEIGHT, &p->picture, b->error, sizeof b->error))
        return bench_fail(b, "picture");
    host_target_describe_layer(&p->picture, &layer);
    if (virga_glass_create(b->context, &def, &p->glass) < 0 || virga_target_create(b->context, &layer, &p->layer) < 0 ||
        virga_glass_attach(p->glass, p->layer) < 0)
        return options_complain("bench", "no pane could be made");
    const host_camera_key key = {0, {0.2, 0.15, -0.15 / tan(M_PI / 9)}, {0.2, 0.15, 0}, 0, false};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 40, .near_m = 0.01, .far_m = 100};
    host_camera_at(&path, 0, WIDTH, HEIGHT, NULL, &p->camera);
    return true;
}

static bool set_way(pane *p, const struct way *way)
{
    virga_glass_settings settings = virga_default_glass_settings();
    settings.film_um = settings.mist_max_mm = 0;
    settings.style = way->style;
    settings.texture_shape = way->shape;
    settings.textured_px = way->textured_px;
    settings.textures_per_frame = way->per_frame;
    settings.still_behind = way->still;
    return virga_glass_set(p->glass, &settings) >= 0;
}

/* A frame with so many ticks; the time of recording it is counted, too. */
static bool frame(bench *b, pane *p, uint32_t ticks, float rate_mm_h, double *milliseconds)
{
    VkCommandBuffer cmd;
    double waited;
    const double start = progress_now();
    const virga_glass_pose pose = {.position_m = {0, 0, 0}};
    const virga_glass_step_info info = {.first_tick = p->tick,
                                        .ticks = ticks,
                                        .rate_mm_h = rate_mm_h,
                                        .sizes = &sizes,
                                        .velocity_m_s = {0, 0, 20},
                                        .air_density = 1.2f};
    virga_view view = virga_default_view();
    host_camera_view(&p->camera, &p->camera, 0, &view);
    view.color = host_target_color(&p->picture);
    p->tick += ticks;
    if (!bench_begin(b, &cmd) || virga_glass_step(p->glass, cmd, &info) < 0 ||
        virga_glass_prepare(p->glass, cmd, &view, &pose, virga_glass_time(p->glass)) < 0)
        return options_complain("bench", "a frame failed");
    host_target_begin_layer(&p->picture, cmd);
    const bool drawn = virga_glass_draw(p->glass, cmd, p->layer) == VIRGA_OK;
    host_target_end_layer(&p->picture, cmd);
    if (!drawn || !bench_submit(b, &waited))
        return options_complain("bench", "a frame failed");
    *milliseconds = (progress_now() - start) * 1e3;
    return true;
}

/* The photo is black: what it shows costs nothing. */
static bool draw_photo(bench *b, pane *p)
{
    VkCommandBuffer cmd;
    double ms;
    if (!bench_begin(b, &cmd))
        return false;
    host_target_begin_plate(&p->picture, cmd);
    host_target_end_plate(&p->picture, cmd);
    return bench_submit(b, &ms);
}

static bool get_wet(bench *b, pane *p, uint32_t *drops)
{
    virga_glass_stats stats = {0};
    double ms;
    bool good = true;
    for (int i = 0; good && i < MAX_WARMUP && stats.drops < DROPS && !interrupt_requested(); i++) {
        good = frame(b, p, 1, RATE_MM_H, &ms);
        virga_glass_stats_get(p->glass, &stats);
    }
    *drops = stats.drops;
    return good && !interrupt_requested();
}

static bool measure(bench *b, pane *p, const struct way *way)
{
    double still[RUNS], moved[RUNS], worked[RUNS], textures[RUNS], draw[RUNS];
    bool good = set_way(p, way);
    for (int i = -2; good && i < RUNS && !interrupt_requested(); i++) {
        const int at = i < 0 ? 0 : i;
        good = frame(b, p, 1, 0, &moved[at]);
        const double start = bench_worked_ms();
        good = good && frame(b, p, 0, 0, &still[at]);
        worked[at] = bench_worked_ms() - start;
        textures[at] =
            way->style == VIRGA_GLASS_STYLE_TEXTURES || way->textured_px > 0 ? bench_pass_ms(b, "glass.textures") : 0;
        draw[at] = bench_draw_ms(b, "glass.draw", still[at]);
    }
    if (!good || interrupt_requested())
        return false;
    /* A frame without a tick takes `none`, one with a tick `one`: n frames and 60 ticks fill a second. */
    const double none = bench_median(still, RUNS), one = bench_median(moved, RUNS);
    const double with_ticks = 1000 / none - TICK_HZ * (one - none) / none;
    printf("  %-38s %7.2f ms  %7.2f ms  %7.2f ms  %7.2f ms  %8.2f ms  %7.0f\n", way->name, bench_median(textures, RUNS),
           bench_median(draw, RUNS), bench_median(worked, RUNS), none, one, fmax(with_ticks, 1000 / one));
    fflush(stdout);
    return true;
}

bool glass_bench_textures(bench *b)
{
    pane p = {0};
    uint32_t drops = 0;
    bool good = open_pane(b, &p) && draw_photo(b, &p) && set_way(&p, &ways[0]) && get_wet(b, &p, &drops);
    if (good) {
        printf("%u drops on %u x %u pixels, a pane of 0.4 x 0.3 m, medians of %d; the paper: %d frames a second\n",
               drops, WIDTH, HEIGHT, RUNS, PAPER_FPS);
        printf("  %-38s %10s  %10s  %10s  %10s  %11s  %8s\n", "", "textures", "draw", "processors", "a frame",
               "with a tick", "a second");
    }
    for (size_t i = 0; good && i < sizeof ways / sizeof ways[0]; i++)
        good = measure(b, &p, &ways[i]);
    virga_target_destroy(&p.layer);
    virga_glass_destroy(&p.glass);
    if (p.picture.width)
        host_target_destroy(&b->device, &p.picture);
    return good;
}
