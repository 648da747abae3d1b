/* bench_report.c - prints the results: a table that compares them with the paper, and each pass with its limit. */
#include "bench/machine_limits.h"
#include "splash/bench_splash.h"

#include <math.h>
#include <stdio.h>

#define COPY_DROPLETS 262144u /* min number to copy: fewer would fit in a cache */

static const char *const pass_names[BENCH_PASSES] = {"step", "prepare", "draw"};

double splash_bench_frame_ms(const cell *c)
{
    return c->ms[STEP] + c->ms[PREPARE] + c->ms[DRAW];
}

/* 0: the paper has nothing to compare with. */
static double paper_ms(const bench_splash_choice *choice, const cell *c)
{
    for (int i = 0; i < PAPER_COUNTS && choice->mode == VIRGA_SPLASH_MODE_PAPER; i++)
        if (splash_bench_counts[i] == c->wanted)
            return 1e3 / splash_bench_rows[c->row].paper_fps[i];
    return 0;
}

void splash_bench_print_head(const bench_splash_choice *choice)
{
    printf("\nmode %s, style %s, %u x %u; milliseconds, medians of so many ticks; a frame is step, prepare and draw\n",
           choice->mode == VIRGA_SPLASH_MODE_PAPER ? "paper" : "physical",
           choice->style == VIRGA_SPLASH_STYLE_PAPER ? "paper" : "film", bench_sizes[PICTURE][0],
           bench_sizes[PICTURE][1]);
    printf("%10s %-10s %8s %9s %9s %5s %9s %9s %9s %9s %9s  %s\n", "splashes", "row", "live", "droplets", "sprites",
           "ticks", "step", "prepare", "draw", "frame", "frames/s", "the paper's frame");
}

/* What there was no room for. */
static void print_lack(const cell *c)
{
    if (c->stats.sprites == c->max_droplets || c->air.crowns > c->max_droplets / PYRAMIDS)
        printf("%21s %u piles and droplets and %u crowns are there, and a view has room for %u sprites and %u crowns\n",
               "", c->air.piles + c->air.flying, c->air.crowns, c->max_droplets, c->max_droplets / PYRAMIDS);
    if (c->stats.splashes_without_droplets)
        printf(
            "%21s %.1f %% of splashes were crowded: there is room for %u droplets; up to %u more are live as sheets\n",
            "", 100.0 * (double)c->stats.splashes_without_droplets / c->splashes, c->max_droplets,
            c->stats.splashes_alive);
}

void splash_bench_print_cell(const bench_splash_choice *choice, const cell *c)
{
    const double frame = splash_bench_frame_ms(c), paper = paper_ms(choice, c);
    printf("%10u %-10s %8u %9u %9u %5u %9.3f %9.3f %9.3f %9.3f %9.2f", c->wanted, splash_bench_rows[c->row].name,
           c->air.live, c->stats.droplets_alive, c->stats.sprites, c->ticks, c->ms[STEP], c->ms[PREPARE], c->ms[DRAW],
           frame, 1e3 / frame);
    if (paper > 0)
        printf("  %.2f, %s by %.2f", paper, frame <= paper ? "ahead" : "BEHIND",
               frame <= paper ? paper / frame : frame / paper);
    printf("\n");
    print_lack(c);
    fflush(stdout);
}

/* ---- limits */

/* Number of triangles of a draw. An estimate for the paper style, as the sprites that are pyramids are unknown. */
static double triangles_of(const bench_splash_choice *choice, const cell *c)
{
    const air_counts *air = &c->air;
    if (choice->style == VIRGA_SPLASH_STYLE_FILM)
        return 2.0 * c->stats.sprites;
    const double things = fmax(air->flying + air->piles, 1);
    const double crowns = fmin(air->crowns, c->max_droplets / (double)PYRAMIDS);
    return c->stats.sprites * (2.0 * air->flying + 4.0 * air->piles) / things + 4 * PYRAMIDS * crowns;
}

/* A step reads and writes 64 bytes a droplet; a prepare reads them and writes 64 a sprite. */
bool splash_bench_measure_limits(run *r, const cell *c, cell_limits *l)
{
    bench *b = r->b;
    limits *machine = NULL;
    const uint32_t droplets = c->stats.droplets_alive ? c->stats.droplets_alive : 1;
    const uint32_t copied = droplets > COPY_DROPLETS ? droplets : COPY_DROPLETS;
    /* The speed of a machine varies over time, so its limits are measured again. */
    if (!splash_bench_measure_picture(b, &r->picture) ||
        !limits_create(&b->device, &b->targets[PICTURE], 4 * copied, &machine, b->error, sizeof b->error))
        return splash_bench_fail(b, "limits");
    l->copy_ms = limits_copy_ms(&b->device, machine) * droplets / copied;
    l->bare_ms = limits_bare_ms(&b->device, machine) * droplets / copied;
    l->dispatch_ms = limits_dispatch_ms(&b->device, machine);
    limits_destroy(&b->device, &machine);
    l->triangles = triangles_of(r->choice, c);
    const double pixels = (double)bench_sizes[PICTURE][0] * bench_sizes[PICTURE][1];
    const double hits = fmin((double)c->pixels, l->triangles); /* max number of triangles that cover a pixel */
    const double corners_ms = hits * r->picture.triangle_ms + (l->triangles - hits) * r->picture.missing_ms;
    const double pixels_ms = (double)c->pixels / pixels * r->picture.fill_ms;
    l->by_triangles = corners_ms > pixels_ms;
    l->ms[STEP] = l->copy_ms;
    l->ms[PREPARE] = l->copy_ms * (1 + c->stats.sprites / (double)droplets) / 2;
    l->ms[DRAW] = fmax(corners_ms, pixels_ms);
    return true;
}

static void print_limits(const cell *c, const cell_limits *l)
{
    const double droplets = fmax(c->stats.droplets_alive, 1);
    printf("  %s, %u droplets, %u sprites, about %.0f triangles, %llu pixels\n", splash_bench_rows[c->row].name,
           c->stats.droplets_alive, c->stats.sprites, l->triangles, (unsigned long long)c->pixels);
    printf(
        "    step     %10.3f ms %7.2f x a copy of its droplets (%.3f ms), %.2f x a bare kernel's; %.1f ns a droplet\n",
        c->ms[STEP], c->ms[STEP] / l->ms[STEP], l->ms[STEP], c->ms[STEP] / l->bare_ms, c->ms[STEP] * 1e6 / droplets);
    printf("    prepare  %10.3f ms %7.2f x a read of droplets and a write of sprites (%.3f ms); %.1f ns a droplet\n",
           c->ms[PREPARE], c->ms[PREPARE] / l->ms[PREPARE], l->ms[PREPARE], c->ms[PREPARE] * 1e6 / droplets);
    printf("    draw     %10.3f ms %7.2f x the least for its %s (%.3f ms); %.0f ns a sprite\n", c->ms[DRAW],
           c->ms[DRAW] / l->ms[DRAW], l->by_triangles ? "triangles" : "pixels", l->ms[DRAW],
           c->ms[DRAW] * 1e6 / fmax(c->stats.sprites, 1));
}

/* The pass with the largest possible gain over all rows. */
static void print_next(const cell cells[ROWS], const cell_limits limits[ROWS])
{
    double gain[BENCH_PASSES] = {0}, all = 0;
    int next = STEP;
    for (int i = 0; i < ROWS; i++) {
        all += splash_bench_frame_ms(&cells[i]);
        for (int pass = 0; pass < BENCH_PASSES; pass++)
            gain[pass] += fmax(cells[i].ms[pass] - limits[i].ms[pass], 0);
    }
    for (int pass = 0; pass < BENCH_PASSES; pass++)
        if (gain[pass] > gain[next])
            next = pass;
    printf(
        "  next to improve: %s. Time above the limits, of all frames': step %.0f %%, prepare %.0f %%, draw %.0f %%\n",
        pass_names[next], 100 * gain[STEP] / all, 100 * gain[PREPARE] / all, 100 * gain[DRAW] / all);
}

void splash_bench_compare(const picture *p, const cell cells[ROWS], const cell_limits limits[ROWS])
{
    const double pixels = (double)bench_sizes[PICTURE][0] * bench_sizes[PICTURE][1];
    printf("limits at %u splashes: copy %.2f GB/s read and written; triangles of a pixel %.2f, of none %.2f million a "
           "second;\n"
           "  %.0f million blended pixels a second; a clear of the picture %.3f ms; a dispatch %.3f ms\n",
           cells[0].wanted, fmax(cells[0].stats.droplets_alive, 1) * 128 / (limits[0].copy_ms * 1e6),
           1e-3 / p->triangle_ms, 1e-3 / p->missing_ms, pixels * 1e-3 / p->fill_ms, p->clear_ms, limits[0].dispatch_ms);
    for (int i = 0; i < ROWS; i++)
        print_limits(&cells[i], &limits[i]);
    print_next(cells, limits);
    fflush(stdout);
}
