/* bench_splash.h - what the files of `virga bench splash` share. */
#ifndef VIRGA_BENCH_SPLASH_H
#define VIRGA_BENCH_SPLASH_H

#include "bench/bench.h"

/* What is measured. */
typedef struct bench_splash_choice {
    uint32_t only; /* splashes; 0: the usual numbers */
    virga_splash_mode mode;
    virga_splash_style style;
    bool film_too; /* a short table in that style after the other */
} bench_splash_choice;

#define PICTURE      1 /* of bench_sizes */
#define PAPER_COUNTS 4
#define ROWS         4
#define PYRAMIDS     12 /* that a crown of the paper's style is made of, and room for which droplets make */

enum { STEP, PREPARE, DRAW, BENCH_PASSES };
enum { COUNTS = 7 };

/* What is in the air, read back. */
typedef struct air_counts {
    uint32_t live;                  /* splashes with a droplet that is not down */
    uint32_t flying, piles, crowns; /* droplets; piles and crowns that stand, about */
} air_counts;

/* Lifetimes of a splash of one row, in ticks: its mean life, the sum over its droplets, and that of its crown.
 * `settled` is the time until the number of live splashes is constant to within 1/50. */
typedef struct splash_life {
    double mean, droplets, crown;
    uint32_t settled;
} splash_life;

/* A number of splashes of one row. */
typedef struct cell {
    uint32_t row, wanted, ticks;
    double ms[BENCH_PASSES], clear_ms;
    air_counts air;
    uint64_t pixels;   /* that the draw blended */
    uint32_t splashes; /* since the start */
    uint32_t max_droplets;
    virga_splash_stats stats;
} cell;

/* What splashes are drawn into: half floats and depth, both cleared. */
typedef struct picture {
    host_image color, depth;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkQueryPool query;
    VkPipelineLayout layout;
    VkPipeline fill;
    host_buffer quads;
    double clear_ms, fill_ms, triangle_ms, missing_ms; /* the last two of a triangle that covers a pixel, and none */
    virga_target *target;
} picture;

/* One splash object at work. */
typedef struct run {
    bench *b;
    const bench_splash_choice *choice;
    picture picture;
    virga_splash *splash;
    virga_splash_settings settings;
    virga_view view;
    host_buffer upload, spawns, readback;
    uint32_t row, max_droplets, max_spawns, tick, next_id;
    float far_m;
    double rate, owed; /* splashes per tick; the remaining fraction of a splash */
} run;

/* The min time that this machine needs for the work of each pass. */
typedef struct cell_limits {
    double ms[BENCH_PASSES];
    double copy_ms, bare_ms, dispatch_ms, triangles;
    bool by_triangles; /* draw time is limited by triangles; false: by pixels */
} cell_limits;

/* A row of the paper's table 2. */
typedef struct splash_bench_row {
    const char *name;
    uint32_t state;
    float depth_m;
    double paper_fps[PAPER_COUNTS];
} splash_bench_row;

/* ---- bench_rows.c */

extern const splash_bench_row splash_bench_rows[ROWS];
extern const uint32_t splash_bench_counts[COUNTS]; /* of splashes; the first are the paper's */

/* Prints the bench's error. Returns false. */
bool splash_bench_fail(const bench *b, const char *what);

/* ---- bench_picture.c: the picture, and what the machine does with it at best */

bool splash_bench_open_picture(bench *b, picture *p);
void splash_bench_close_picture(bench *b, picture *p);
bool splash_bench_measure_picture(bench *b, picture *p);

/* A frame that does so much and no more. */
enum { NOTHING, CLEAR, FILL, TINY, MISSING, FRAMES };
bool splash_bench_time_frame(bench *b, const picture *p, int what, double *ms);
void splash_bench_begin_picture(const picture *p, VkCommandBuffer cmd);

/* ---- bench_run.c: splashes at a rate, and counts of those that are live */

void splash_bench_fill_view(virga_view *view);
bool splash_bench_open_splash(run *r, double splashes, double droplets, double rate);
void splash_bench_close_splash(run *r);

/* Number of splashes that spawn in the next tick; and running that tick. */
uint32_t splash_bench_next_spawns(run *r);
bool splash_bench_step(run *r, uint32_t spawns, double *ms);
bool splash_bench_count_air(run *r, air_counts *air);
bool splash_bench_measure_life(run *r, splash_life *life);

/* ---- bench_drips.c: edges that drip */

bool splash_bench_drips(bench *b);

/* ---- bench_report.c: prints results, compared with the paper and the machine's limits */

double splash_bench_frame_ms(const cell *c);
void splash_bench_print_head(const bench_splash_choice *choice);
void splash_bench_print_cell(const bench_splash_choice *choice, const cell *c);
bool splash_bench_measure_limits(run *r, const cell *c, cell_limits *l);
void splash_bench_compare(const picture *p, const cell cells[ROWS], const cell_limits limits[ROWS]);

#endif
