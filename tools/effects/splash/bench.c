/* bench.c - `virga bench splash`: table 2 of Mizukami et al. (frames a second of splashes by their number and by
 * what they fall on), on from there to a million, and how far each pass is from what the machine can do.
 *
 * A splash is live from its impact until its last droplet has landed. The number of live splashes is rate x mean life
 * (Little 1961). A warm-up measures the mean life for a row, which gives the rate. The number of live splashes is then
 * counted, not assumed. */
#include "effect.h"
#include "options.h"
#include "progress.h"
#include "splash/bench_splash.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_TICKS   60 /* max timed; after ENOUGH_S the usual number is enough, and after PATIENCE_S the min number */
#define USUAL_TICKS 30
#define MIN_TICKS   3
#define ENOUGH_S    2.0
#define PATIENCE_S  10.0

/* ---- timing */

typedef struct tick_times {
    double empty[MAX_TICKS], clear[MAX_TICKS], step[MAX_TICKS], prepare[MAX_TICKS], draw[MAX_TICKS];
} tick_times;

/* A frame with the picture cleared, with or without splashes on it. */
static bool show(run *r, bool draw, bool count, double *ms)
{
    VkCommandBuffer cmd;
    const picture *p = &r->picture;
    if (!bench_begin(r->b, &cmd))
        return false;
    if (count)
        vkCmdResetQueryPool(cmd, p->query, 0, 1);
    if (virga_splash_prepare(r->splash, cmd, &r->view, virga_splash_time(r->splash)) != VIRGA_OK)
        return splash_bench_fail(r->b, "a prepare failed");
    splash_bench_begin_picture(p, cmd);
    if (count)
        vkCmdBeginQuery(cmd, p->query, 0, 0);
    if (draw && virga_splash_draw(r->splash, cmd, p->target) != VIRGA_OK)
        return splash_bench_fail(r->b, "a draw failed");
    if (count)
        vkCmdEndQuery(cmd, p->query, 0);
    vkCmdEndRenderPass(cmd);
    return bench_submit(r->b, ms);
}

/* Timestamps are wrong on software Vulkan. So the time of a pass is that of a whole submission, minus that of a
 * submission without the pass. */
static bool time_tick(run *r, tick_times *t, uint32_t i)
{
    if (!splash_bench_time_frame(r->b, &r->picture, NOTHING, &t->empty[i]) ||
        !splash_bench_step(r, splash_bench_next_spawns(r), &t->step[i]))
        return false;
    return splash_bench_time_frame(r->b, &r->picture, CLEAR, &t->clear[i]) && show(r, false, false, &t->prepare[i]) &&
           show(r, true, false, &t->draw[i]);
}

static bool time_ticks(run *r, cell *c)
{
    tick_times t;
    uint32_t n = 0;
    const double start = progress_now();
    while (n < MAX_TICKS && !interrupt_requested()) {
        if (!time_tick(r, &t, n))
            return false;
        n++;
        const double passed = progress_now() - start;
        if ((n >= USUAL_TICKS && passed > ENOUGH_S) || (n >= MIN_TICKS && passed > PATIENCE_S))
            break;
    }
    const double empty = bench_median(t.empty, n), clear = bench_median(t.clear, n),
                 prepare = bench_median(t.prepare, n);
    c->ticks = n;
    c->clear_ms = clear - empty;
    c->ms[STEP] = bench_median(t.step, n) - empty;
    c->ms[PREPARE] = prepare - clear;
    c->ms[DRAW] = bench_median(t.draw, n) - prepare;
    return true;
}

/* Reads the counts at the end of the timing. */
static bool look_around(run *r, cell *c)
{
    double ms;
    if (!splash_bench_count_air(r, &c->air) || !show(r, true, true, &ms))
        return false;
    if (vkGetQueryPoolResults(r->b->device.device, r->picture.query, 0, 1, sizeof c->pixels, &c->pixels, 8,
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT) != VK_SUCCESS)
        return splash_bench_fail(r->b, "pixels could not be counted");
    virga_splash_stats_get(r->splash, &c->stats);
    c->splashes = r->next_id;
    c->max_droplets = r->max_droplets;
    if (!c->stats.sprites || !c->pixels)
        return splash_bench_fail(r->b, "nothing was drawn");
    return true;
}

static bool measure_cell(run *r, const splash_life *life, cell *c)
{
    double ms;
    const double rate = c->wanted / life->mean;
    r->far_m = c->wanted > 3000 ? 60 : 10;
    /* A view holds as many sprites as max_droplets, and as many crown pyramids. A droplet may also have a pile, which
     * is a second sprite. Add a reserve of one fifth. */
    const double droplets = 1.2 * fmax(2 * life->droplets, PYRAMIDS * life->crown) * rate;
    bool good = splash_bench_open_splash(r, 1.5 * c->wanted, droplets, rate);
    /* The first tick and draw compile the pipelines, with few splashes. */
    good = good && splash_bench_step(r, splash_bench_next_spawns(r), &ms) && show(r, true, true, &ms);
    for (uint32_t i = 0; good && i < life->settled && !interrupt_requested(); i++)
        good = splash_bench_step(r, splash_bench_next_spawns(r), &ms);
    good = good && time_ticks(r, c) && look_around(r, c);
    splash_bench_close_splash(r);
    return good;
}

/* ---- all of it */

static bool measure_table(run *r, const uint32_t *counts, uint32_t count)
{
    splash_life lives[ROWS];
    cell cells[ROWS];
    cell_limits limits[ROWS]; /* of the last count */
    r->settings = virga_default_splash_settings();
    r->settings.mode = r->choice->mode;
    r->settings.style = r->choice->style;
    splash_bench_print_head(r->choice);
    for (r->row = 0; r->row < ROWS; r->row++) {
        r->far_m = 10;
        if (!splash_bench_measure_life(r, &lives[r->row]))
            return false;
    }
    for (uint32_t i = 0; i < count; i++)
        for (r->row = 0; r->row < ROWS; r->row++) {
            cell *c = &cells[r->row];
            *c = (cell){.row = r->row, .wanted = counts[i]};
            if (!measure_cell(r, &lives[r->row], c))
                return false;
            if (interrupt_requested())
                return true;
            splash_bench_print_cell(r->choice, c);
            bench_print_model(r->b);
            if (i + 1 == count && !splash_bench_measure_limits(r, c, &limits[r->row]))
                return false;
        }
    splash_bench_compare(&r->picture, cells, limits);
    return true;
}

static bool measure_tables(bench *b, const bench_splash_choice *choice)
{
    static const uint32_t film_counts[] = {1000, 3000};
    bench_splash_choice film = *choice;
    run r = {.b = b, .choice = choice};
    splash_bench_fill_view(&r.view);
    bool good = splash_bench_open_picture(b, &r.picture);
    good =
        good && (choice->only ? measure_table(&r, &choice->only, 1) : measure_table(&r, splash_bench_counts, COUNTS));
    if (good && choice->film_too && !interrupt_requested()) {
        film.style = VIRGA_SPLASH_STYLE_FILM;
        r.choice = &film;
        good = measure_table(&r, film_counts, 2);
    }
    splash_bench_close_picture(b, &r.picture);
    return good;
}

/* Fences time whole submissions here. Timestamps would be in them: on software Vulkan a pair costs as much as a pass of
 * a hundred splashes. */
static bool open_untimed(bench *b, virga_context **context)
{
    virga_context_def def = bench_context_def(b);
    def.timings = false;
    return virga_context_create(&def, context) == VIRGA_OK || splash_bench_fail(b, "the device was refused");
}

/* Whether the value of an option is the second of its two keywords; the first where it was not given. */
static bool is_second_keyword(const options *parsed, const char *name, const char *first, const char *second,
                              bool *is_second)
{
    const char *value = options_value(parsed, name);
    *is_second = value && !strcmp(value, second);
    return !value || *is_second || !strcmp(value, first) ||
           options_complain("bench", "%s: expected %s or %s, got '%s'", name, first, second, value);
}

static bool read_choice(const options *parsed, bench_splash_choice *choice)
{
    bool physical, film;
    *choice = (bench_splash_choice){0};
    if (!options_uint(parsed, "--splashes", 1, 1000000, &choice->only) ||
        !is_second_keyword(parsed, "--mode", "paper", "physical", &physical) ||
        !is_second_keyword(parsed, "--style", "paper", "film", &film))
        return false;
    choice->mode = physical ? VIRGA_SPLASH_MODE_PHYSICAL : VIRGA_SPLASH_MODE_PAPER;
    choice->style = film ? VIRGA_SPLASH_STYLE_FILM : VIRGA_SPLASH_STYLE_PAPER;
    choice->film_too = !choice->only && !options_value(parsed, "--style");
    return true;
}

static bool check(const options *parsed)
{
    bench_splash_choice choice;
    return read_choice(parsed, &choice);
}

static bool run_bench(bench *b, const options *parsed)
{
    bench_splash_choice choice;
    virga_context *timed = b->context, *untimed = NULL;
    if (!read_choice(parsed, &choice) || !open_untimed(b, &untimed))
        return false;
    b->context = untimed;
    const bool good = options_value(parsed, "--drips") ? splash_bench_drips(b) : measure_tables(b, &choice);
    b->context = timed;
    virga_context_destroy(&untimed);
    return good;
}

static const option_row option_rows[] = {
    {"--splashes", 0, "N", "splash: measure this many live splashes only. Default: 100 to 1000000", false},
    {"--mode", 0, "paper|physical", "splash: where counts and speeds come from. Default: paper", false},
    {"--drips", 0, NULL, "splash: measure 250 to 25000 edges that drip only", false},
    {"--style", 0, "paper|film", "splash: how they are drawn. Default: paper, and some in film", false},
};

const tool_bench splash_bench = {
    .help = "step, prepare and draw of 100 to 10^6 live splashes on four kinds of ground, beside the\n"
            "paper's\n",
    TOOL_BENCH(check, run_bench),
};
