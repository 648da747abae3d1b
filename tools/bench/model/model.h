/* model.h - the time that a pass would take on a card, from what it was counted to do (counting.h). A model: nothing
 * here was measured on such a card. */
#ifndef VIRGA_BENCH_MODEL_MODEL_H
#define VIRGA_BENCH_MODEL_MODEL_H

#include "bench/model/counting.h"

/* What waves do: instructions by the kinds of block_cost.h, and their starts. */
typedef enum model_work {
    MODEL_FULL,
    MODEL_SLOW,
    MODEL_LOADS, /* block_cost.memory */
    MODEL_SHARED,
    MODEL_FETCH,
    MODEL_SAMPLE,
    MODEL_ATOMIC,
    MODEL_UNIFORM,
    MODEL_CONSTANT,
    MODEL_BRANCH,
    MODEL_BARRIER,
    MODEL_START,    /* of vertices and of compute shaders */
    MODEL_FRAGMENT, /* start of a wave of fragments, and the end of it: what is drawn is blended */
    MODEL_WORKS,
} model_work;

typedef struct model_card {
    const char *name; /* of the command line */
    const char *what;
    double lanes; /* of a wave */
    double simds; /* that issue at the same time */
    double clock_hz;
    double waves_per_simd;     /* that wait for memory at the same time */
    double memory_bytes_s;     /* bandwidth of memory */
    double cache_bytes_s;      /* of the last cache */
    double pixels_s;           /* that fill a target */
    double latency_s;          /* of a load from memory */
    double call_s, wait_s;     /* of a dispatch or draw; more if it is behind a barrier */
    double issue[MODEL_WORKS]; /* cycles that each takes of a SIMD; one for an addition */
    bool adds_up; /* it does one thing after another: a pass takes the sum, and not the longest; calls are timed, too */
} model_card;

extern const model_card model_desktop, model_handheld;

/* The device that runs the bench, as software Vulkan with one thread. model_here_measure fills it (here.h). */
extern model_card model_here;

typedef enum model_bound {
    MODEL_ARITHMETIC,
    MODEL_MEMORY,
    MODEL_CACHE,
    MODEL_PIXELS,
    MODEL_LATENCY,
    MODEL_CALLS,
    MODEL_BOUNDS,
} model_bound;

extern const char *const model_bound_names[MODEL_BOUNDS];

/* All pipelines of one name together. */
typedef struct model_pass {
    char name[64];
    double calls, waits;
    double lanes;  /* invocations of all stages */
    double pixels; /* of these, fragments */
    double issues; /* cycles of waves */
    double work[MODEL_WORKS];
    double trips;        /* runs of its busiest block by a lane, on average: of its longest loop */
    double memory_bytes; /* distinct, as far as sizes of buffers and images tell */
    double cache_bytes;  /* asked for */
    double seconds[MODEL_BOUNDS];
    double total_s; /* the longest of the first five, and the calls */
    model_bound bound;
    double measured_s; /* the least of some frames; 0: it was not timed */
} model_pass;

#define MODEL_MAX_PASSES 128

/* Fills the passes that were called since counting_forget, each in its newest frame, in the order of their first
 * pipelines. Returns how many. With times, passes that draw in the same render pass are one. */
uint32_t model_passes(const model_card *card, model_pass passes[MODEL_MAX_PASSES]);

/* Prints them as a table, with their sum, which is returned: milliseconds. */
double model_print(const model_card *card);

/* Milliseconds of writing so many pixels of a target of four halves: what a card can do at best. */
double model_fill_ms(const model_card *card, double pixels);

/* The card of a name; NULL: there is none. */
const model_card *model_card_find(const char *name);

#endif
