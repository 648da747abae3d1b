/* bench_drips.c - `virga bench splash --drips`: edges that drip, in tens. */
#include "options.h"
#include "progress.h"
#include "splash/bench_splash.h"

#include <virga/shared/random.h>

#include <stdio.h>
#include <stdlib.h>

#define DRIP_ROWS   4
#define DRIP_TICKS  90 /* until drops land, from 3 m */
#define TIMED_TICKS 30
#define RAIN_MM_H   20.0f

static const uint32_t drip_counts[DRIP_ROWS] = {0, 250, 2500, 25000};

/* Pieces of edges 3 m up, in a square of 20 m, with a surface of 0.05 square metres each. */
static void fill_sites(virga_drip_site *sites, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const float x = virga_unit(virga_hash2(i, 1)), z = virga_unit(virga_hash2(i, 2));
        sites[i] = (virga_drip_site){.position_m = {20 * (double)x - 10, 3, 20 * (double)z - 10},
                                     .catch_m2 = 0.05f,
                                     .width_m = 0.05f,
                                     .slope = 0.2f,
                                     .moves = true};
    }
}

static bool open_drips(run *r, uint32_t count)
{
    virga_splash_def def = virga_default_splash_def();
    def.max_drips = count;
    def.max_handed = 65536;
    def.max_droplets = 524288;
    r->tick = r->next_id = 0;
    r->settings = virga_default_splash_settings();
    return (virga_splash_create(r->b->context, &def, &r->splash) >= 0 && !virga_splash_set(r->splash, &r->settings)) ||
           splash_bench_fail(r->b, "no edges of that many could be made");
}

/* As where all of them move: they are given anew in each step. `given_ms`: how long that took. */
static bool step_drips(run *r, const virga_drip_site *sites, uint32_t count, double *ms, double *given_ms)
{
    VkCommandBuffer cmd;
    const virga_splash_step_info info = {
        .spawns = r->spawns.buffer, .first_tick = r->tick++, .ticks = 1, .rain_mm_h = RAIN_MM_H};
    if (!bench_begin(r->b, &cmd))
        return false;
    const double start = progress_now();
    const bool given = virga_splash_set_drips(r->splash, sites, count) == VIRGA_OK;
    *given_ms = 1e3 * (progress_now() - start);
    return (given && virga_splash_step(r->splash, cmd, &info) == VIRGA_OK && bench_submit(r->b, ms)) ||
           splash_bench_fail(r->b, "a step of edges that drip failed");
}

static bool measure_drips(run *r, const virga_drip_site *sites, uint32_t count, double *without_ms)
{
    double ms[TIMED_TICKS], given[TIMED_TICKS], any;
    virga_splash_stats stats = {.drips = 0};
    bool good = open_drips(r, count);
    for (uint32_t i = 0; good && i < DRIP_TICKS; i++)
        good = step_drips(r, sites, count, &any, &any);
    for (uint32_t i = 0; good && i < TIMED_TICKS; i++)
        good = step_drips(r, sites, count, &ms[i], &given[i]);
    if (good)
        virga_splash_stats_get(r->splash, &stats);
    virga_splash_destroy(&r->splash);
    if (!good)
        return false;
    const double step_ms = bench_median(ms, TIMED_TICKS);
    if (!count)
        *without_ms = step_ms;
    else
        printf("  %6u  %9u  %8.3f  %8.3f\n", count, stats.droplets_alive, step_ms - *without_ms,
               bench_median(given, TIMED_TICKS));
    bench_print_model(r->b);
    return true;
}

bool splash_bench_drips(bench *b)
{
    run r = {.b = b};
    virga_drip_site *sites = calloc(drip_counts[DRIP_ROWS - 1], sizeof *sites);
    const struct {
        virga_spawns_gpu head;
        virga_spawn_gpu spawns[64];
    } none = {.head = {.group_count = {0, 1, 1}, .capacity = 64, .ticks = 1}};
    double without_ms = 0;
    bool good =
        sites && host_buffer_create_with(&b->device, &none, sizeof none,
                                         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                                         "no spawns", &r.spawns, b->error, sizeof b->error);
    printf("edges that drip, all of them moving, in %g mm/h; ms of a tick, medians of %d\n"
           "   edges   droplets      tick  to give\n",
           (double)RAIN_MM_H, TIMED_TICKS);
    if (good)
        fill_sites(sites, drip_counts[DRIP_ROWS - 1]);
    for (uint32_t i = 0; good && i < DRIP_ROWS && !interrupt_requested(); i++)
        good = measure_drips(&r, sites, drip_counts[i], &without_ms);
    if (r.spawns.buffer)
        host_buffer_destroy(&b->device, &r.spawns);
    free(sites);
    return good;
}
