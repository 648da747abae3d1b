/* model.c - see model.h. */
#include "bench/model/model.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define GROUP 8.0 /* lanes of the subgroups that were counted */

static const char *const model_work_names[MODEL_WORKS] = {
    [MODEL_FULL] = "arithmetic",   [MODEL_SLOW] = "functions",      [MODEL_LOADS] = "loads and stores",
    [MODEL_SHARED] = "shared",     [MODEL_FETCH] = "texels",        [MODEL_SAMPLE] = "filtered texels",
    [MODEL_ATOMIC] = "atomics",    [MODEL_UNIFORM] = "loads alike", [MODEL_CONSTANT] = "constants",
    [MODEL_BRANCH] = "branches",   [MODEL_BARRIER] = "barriers",    [MODEL_START] = "starts",
    [MODEL_FRAGMENT] = "fragments"};

const char *const model_bound_names[MODEL_BOUNDS] = {"arithmetic", "memory", "cache", "pixels", "latency", "calls"};

/* Units, clocks and bandwidths: the makers' data sheets. Rates of instructions: AMD's "RDNA 2 Instruction Set
 * Architecture" (2020) and "RDNA Architecture" (2019). A SIMD issues 32 lanes a cycle, and transcendental functions at
 * a quarter of that. Two SIMDs share a texture unit, which takes 32 addresses in two cycles, or filters four texels a
 * cycle. Bandwidths of caches, the latency of memory, and what a barrier costs are usual figures and not of a card. */
#define RDNA2_ISSUE                                                                                              \
    {                                                                                                            \
        [MODEL_FULL] = 1, [MODEL_SLOW] = 4, [MODEL_LOADS] = 4, [MODEL_SHARED] = 2, [MODEL_FETCH] = 8,            \
        [MODEL_SAMPLE] = 16, [MODEL_ATOMIC] = 16, [MODEL_UNIFORM] = 1, [MODEL_CONSTANT] = 1, [MODEL_BRANCH] = 3, \
        [MODEL_BARRIER] = 16                                                                                     \
    }

const model_card model_desktop = {
    .name = "desktop",
    .what = "Radeon RX 6800 XT: 144 SIMDs of 32 lanes at 2.25 GHz, 512 GB/s",
    .lanes = 32,
    .simds = 144,
    .clock_hz = 2.25e9,
    .waves_per_simd = 16,
    .memory_bytes_s = 512e9,
    .cache_bytes_s = 1900e9,
    .pixels_s = 128 * 2.25e9,
    .latency_s = 500e-9,
    .call_s = 1e-6,
    .wait_s = 6e-6,
    .issue = RDNA2_ISSUE,
};

const model_card model_handheld = {
    .name = "handheld",
    .what = "Steam Deck: 16 SIMDs of 32 lanes at 1.6 GHz, 88 GB/s",
    .lanes = 32,
    .simds = 16,
    .clock_hz = 1.6e9,
    .waves_per_simd = 16,
    .memory_bytes_s = 88e9,
    .cache_bytes_s = 400e9,
    .pixels_s = 32 * 1.6e9,
    .latency_s = 500e-9,
    .call_s = 1e-6,
    .wait_s = 8e-6,
    .issue = RDNA2_ISSUE,
};

/* What loads were measured to take has the cache's bytes, and the loads that wait for each other, in it. */
model_card model_here = {
    .name = "here",
    .what = "this device, with one thread",
    .lanes = GROUP,
    .simds = 1,
    .clock_hz = 1e9,
    .waves_per_simd = 1e9,
    .memory_bytes_s = 1e30,
    .cache_bytes_s = 1e30,
    .pixels_s = 1e30,
    .adds_up = true,
};

const model_card *model_card_find(const char *name)
{
    const model_card *const cards[] = {&model_desktop, &model_handheld, &model_here};
    for (size_t i = 0; i < sizeof cards / sizeof cards[0]; i++)
        if (!strcmp(cards[i]->name, name))
            return cards[i];
    return NULL;
}

/* ---- a stage */

/* Waves that run a block, of those that start. Subgroups of 8 were counted, and a wave has several. A block that not
 * all of them run is taken to be run by each with the same chance; how often a loop runs, to be the same in all. */
static double waves_of(const model_card *card, double groups, double lanes, double started)
{
    const double parts = card->lanes / GROUP;
    const double waves = groups < started ? started / parts * (1 - pow(1 - groups / started, parts)) : groups / parts;
    return fmax(waves, lanes / card->lanes);
}

/* Adds `waves` runs of a block. */
static void add_block(double work[MODEL_WORKS], const block_cost *b, double waves)
{
    const double each[MODEL_WORKS] = {
        [MODEL_FULL] = b->full,     [MODEL_SLOW] = b->slow,       [MODEL_LOADS] = b->memory,
        [MODEL_SHARED] = b->shared, [MODEL_FETCH] = b->fetch,     [MODEL_SAMPLE] = b->sample,
        [MODEL_ATOMIC] = b->atomic, [MODEL_UNIFORM] = b->uniform, [MODEL_CONSTANT] = b->constant,
        [MODEL_BRANCH] = b->branch, [MODEL_BARRIER] = b->barrier};
    for (int i = 0; i < MODEL_WORKS; i++)
        work[i] += waves * each[i];
}

static double issues_of(const model_card *card, const double work[MODEL_WORKS])
{
    double issues = 0;
    for (int i = 0; i < MODEL_WORKS; i++)
        issues += work[i] * card->issue[i];
    return issues;
}

typedef struct stage_work {
    double lanes, waves, chain; /* chain: loads of a wave that wait for each other */
    double work[MODEL_WORKS];
    double most;                   /* lanes that ran the busiest block */
    double asked[BLOCK_RESOURCES]; /* bytes */
} stage_work;

static stage_work work_of(const model_card *card, const counted_stage *stage, const uint32_t *numbers)
{
    stage_work work = {0};
    const double started = numbers[stage->first + 1];
    work.lanes = numbers[stage->first];
    work.waves = started ? waves_of(card, started, work.lanes, started) : 0;
    for (uint32_t i = 0; i < stage->costs.block_count && started; i++) {
        const block_cost *b = &stage->costs.blocks[i];
        const uint32_t *runs = numbers + stage->first + 2 * (size_t)b->runs_as;
        const double lanes = runs[0], waves = waves_of(card, runs[1], lanes, started);
        work.most = fmax(work.most, lanes);
        add_block(work.work, b, waves);
        work.chain += b->waits ? waves / work.waves : 0;
        for (uint32_t k = 0; k < stage->costs.resource_count; k++)
            work.asked[k] += lanes * (double)(b->bytes_read[k] + b->bytes_written[k]) * stage->texel_share[k];
    }
    return work;
}

/* ---- a pass */

static void add_stage(const model_card *card, const counted_pass *pass, const counted_stage *stage,
                      const uint32_t *numbers, model_pass *sum)
{
    stage_work work = work_of(card, stage, numbers);
    if (work.lanes <= 0)
        return;
    const bool is_fragment = stage == &pass->stages[1];
    work.work[is_fragment ? MODEL_FRAGMENT : MODEL_START] = work.waves;
    const double issues = issues_of(card, work.work);
    /* Calls without a barrier between them run at the same time. */
    const double calls = pass->calls, waves_at_once = work.waves / pass->times;
    const double simds = fmin(card->simds, fmax(1, waves_at_once));
    const double rounds = fmax(1, waves_at_once / (card->simds * card->waves_per_simd));
    double memory = 0, cache = 0;
    for (uint32_t k = 0; k < stage->costs.resource_count; k++) {
        cache += work.asked[k];
        memory += stage->sizes[k] > 0 ? fmin(work.asked[k], stage->sizes[k] * calls) : work.asked[k];
    }
    if (is_fragment) {
        memory += work.lanes * (double)pass->target_bytes;
        sum->pixels += work.lanes;
        sum->seconds[MODEL_PIXELS] += work.lanes / card->pixels_s;
    }
    sum->lanes += work.lanes;
    sum->issues += issues;
    for (int i = 0; i < MODEL_WORKS; i++)
        sum->work[i] += work.work[i];
    sum->trips = fmax(sum->trips, work.most / work.lanes);
    sum->memory_bytes += memory;
    sum->cache_bytes += cache;
    sum->seconds[MODEL_ARITHMETIC] += issues / (simds * card->clock_hz);
    sum->seconds[MODEL_MEMORY] += memory / card->memory_bytes_s;
    sum->seconds[MODEL_CACHE] += cache / card->cache_bytes_s;
    sum->seconds[MODEL_LATENCY] += pass->times * rounds * work.chain * card->latency_s;
}

static void finish(const model_card *card, model_pass *pass)
{
    double longest = 0, sum = 0;
    pass->seconds[MODEL_CALLS] = pass->calls * card->call_s + pass->waits * card->wait_s;
    for (int i = 0; i < MODEL_CALLS; i++) {
        sum += pass->seconds[i];
        if (pass->seconds[i] > longest) {
            longest = pass->seconds[i];
            pass->bound = (model_bound)i;
        }
    }
    if (pass->seconds[MODEL_CALLS] > longest)
        pass->bound = MODEL_CALLS;
    pass->total_s = (card->adds_up ? sum : longest) + pass->seconds[MODEL_CALLS];
}

static model_pass *pass_of(model_pass passes[MODEL_MAX_PASSES], uint32_t *count, const char *name)
{
    for (uint32_t i = 0; i < *count; i++)
        if (!strcmp(passes[i].name, name))
            return &passes[i];
    if (*count == MODEL_MAX_PASSES)
        return NULL;
    passes[*count] = (model_pass){0};
    snprintf(passes[*count].name, sizeof passes[0].name, "%s", name);
    return &passes[(*count)++];
}

/* The least: other programs on the machine only lengthen it. */
static double least_time(const counted_pass *pass)
{
    const uint32_t count = pass->time_count < COUNTED_TIMES ? pass->time_count : COUNTED_TIMES;
    double least = count ? pass->seconds[0] : 0;
    for (uint32_t i = 1; i < count; i++)
        least = fmin(least, pass->seconds[i]);
    return least;
}

uint32_t model_passes(const model_card *card, model_pass passes[MODEL_MAX_PASSES])
{
    const uint32_t *numbers = counting_numbers();
    uint32_t count = 0;
    for (uint32_t i = 0; i < counting_pass_count(); i++) {
        const counted_pass *from = counting_pass(i);
        model_pass *to = from->calls ? pass_of(passes, &count, from->row[0] ? from->row : from->name) : NULL;
        if (!to)
            continue;
        to->calls += from->calls;
        to->waits += from->waits;
        to->measured_s += least_time(from);
        for (uint32_t k = 0; k < from->stage_count; k++)
            add_stage(card, from, &from->stages[k], numbers, to);
    }
    for (uint32_t i = 0; i < count; i++)
        finish(card, &passes[i]);
    return count;
}

/* ---- the table */

static void print_row(const model_pass *pass)
{
    printf("    %-26s %5.0f %6.0f %11.0f %8.1f %9.2f %9.2f %9.4f ms  %s\n", pass->name, pass->calls, pass->waits,
           pass->lanes, pass->trips, pass->issues / 1e6, pass->memory_bytes / 1e6, pass->total_s * 1e3,
           model_bound_names[pass->bound]);
}

/* Milliseconds of all passes. */
static double print_card(const model_card *card, const model_pass *passes, uint32_t count)
{
    double total = counting_moved_bytes() / card->memory_bytes_s;
    printf("  modelled, not measured: %s\n", card->what);
    printf("    %-26s %5s %6s %11s %8s %9s %9s %12s  %s\n", "pass", "calls", "waits", "lanes", "trips", "Mcycles", "MB",
           "modelled", "bound by");
    for (uint32_t i = 0; i < count; i++) {
        print_row(&passes[i]);
        total += passes[i].total_s;
    }
    printf("    all passes and %.2f MB of copies: %.4f ms modelled\n", counting_moved_bytes() / 1e6, total * 1e3);
    return total * 1e3;
}

/* The work that takes the most of a pass here, or memory, or calls. */
static const char *longest_work(const model_card *card, const model_pass *pass)
{
    double longest = pass->seconds[MODEL_MEMORY];
    const char *name = "memory";
    for (int i = 0; i < MODEL_WORKS; i++)
        if (pass->work[i] * card->issue[i] / card->clock_hz > longest) {
            longest = pass->work[i] * card->issue[i] / card->clock_hz;
            name = model_work_names[i];
        }
    return pass->seconds[MODEL_CALLS] > longest ? "calls" : name;
}

/* What is measured in less is not compared: a timestamp takes some microseconds itself. */
#define COMPARED_S 50e-6

/* What kernels took here for each kind of work. */
static void print_costs(const model_card *card)
{
    printf("    nanoseconds of %g lanes:", card->lanes);
    for (int i = 0; i < MODEL_WORKS; i++)
        printf("%s %s %.3g", i ? "," : "", model_work_names[i], card->issue[i] / card->clock_hz * 1e9);
    printf("; a call %.0f; memory %.1f GB/s\n", card->call_s * 1e9, card->memory_bytes_s * 1e-9);
}

static double print_here(const model_card *card, const model_pass *passes, uint32_t count)
{
    double total = 0, compared_s = 0, good_s = 0;
    int compared = 0, good = 0;
    printf("  modelled from counts, and measured: %s\n", card->what);
    print_costs(card);
    printf("    %-26s %5s %11s %8s %12s %12s %7s  %s\n", "pass", "calls", "lanes", "trips", "modelled", "measured",
           "ratio", "most of it");
    for (uint32_t i = 0; i < count; i++) {
        const model_pass *p = &passes[i];
        const double ratio = p->measured_s > 0 ? p->total_s / p->measured_s : 0;
        const bool is_compared = p->measured_s >= COMPARED_S, is_good = ratio >= 0.5 && ratio <= 2;
        printf("    %-26s %5.0f %11.0f %8.1f %9.4f ms %9.4f ms %7.2f%s %s\n", p->name, p->calls, p->lanes, p->trips,
               p->total_s * 1e3, p->measured_s * 1e3, ratio, is_compared && !is_good ? "!" : " ",
               longest_work(card, p));
        total += p->total_s;
        compared += is_compared;
        good += is_compared && is_good;
        compared_s += is_compared ? p->measured_s : 0;
        good_s += is_compared && is_good ? p->measured_s : 0;
    }
    printf("    of %d passes of %.2f ms and more %d are within a factor of two; they take %.0f %% of the time\n",
           compared, COMPARED_S * 1e3, good, compared_s > 0 ? 100 * good_s / compared_s : 0);
    return total * 1e3;
}

double model_print(const model_card *card)
{
    static model_pass passes[MODEL_MAX_PASSES];
    const uint32_t count = model_passes(card, passes);
    const double total_ms = card->adds_up ? print_here(card, passes, count) : print_card(card, passes, count);
    fflush(stdout);
    return total_ms;
}

double model_fill_ms(const model_card *card, double pixels)
{
    return 1e3 * (fmax(pixels / card->pixels_s, pixels * 8 / card->memory_bytes_s) + card->call_s);
}
