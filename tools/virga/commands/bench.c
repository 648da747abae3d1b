/* bench.c - `virga bench`: what each pass of an effect costs, beside what the machine itself can do in the same
 * run. */
#include "bench/bench.h"
#include "bench/frames.h"
#include "bench/model_frame.h"
#include "commands/commands.h"
#include "effect.h"
#include "options.h"
#include "progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const option_row own_rows[] = {
    {"--passes", 0, "N", "frames: runs of all frames; the minimum of each frame is shown. Default: 3", false},
    {"--model", 0, "CARD",
     "desktop, handheld or here: after each measurement, the time that each pass would take on such "
     "a card, modelled from what it was counted to do; times that are measured beside it are of no "
     "use. here: on this device, with one thread, beside what its passes take. Without a name of a "
     "bench: frames",
     false},
    {"--variants", 0, "software|gpu",
     "run the variants of passes for software Vulkan or for GPUs. Default: by the device, and gpu with --model of a "
     "card",
     false},
    {"--device", 0, "N|cpu|gpu|NAME", "the Vulkan device, see virga info. Default: the best", false},
};

static option_row rows[OPTIONS_MAX];

/* A bench with its name, by index over all effects. False after the last. */
static bool bench_at(uint32_t index, const tool_bench **bench, const char **name)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        for (*bench = tool_effects[i]->bench; *bench; *bench = (*bench)->next)
            if (!index--) {
                *name = (*bench)->name ? (*bench)->name : tool_effects[i]->name;
                return true;
            }
    return false;
}

/* Options of all benches, and the command's own. */
static size_t list_rows(void)
{
    const tool_bench *bench;
    const char *name;
    size_t count = 0;
    for (uint32_t i = 0; bench_at(i, &bench, &name); i++)
        for (size_t k = 0; k < bench->row_count; k++)
            rows[count++] = bench->rows[k];
    for (size_t i = 0; i < sizeof own_rows / sizeof own_rows[0]; i++)
        rows[count++] = own_rows[i];
    return count;
}

/* The names of all benches: "rain|ground|frames", or "rain, ground or frames". */
static void print_names(char *text, size_t size, const char *separator, const char *last)
{
    const tool_bench *bench;
    const char *name;
    size_t used = 0;
    for (uint32_t i = 0; bench_at(i, &bench, &name); i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", used ? separator : "", name);
    snprintf(text + used, size - used, "%sframes", last);
}

/* A name, and beside it the lines of its help. */
static void print_lines(const char *name, const char *lines)
{
    for (const char *end; (end = strchr(lines, '\n')); lines = end + 1, name = "")
        printf("%-7s %.*s\n", name, (int)(end - lines), lines);
}

void bench_help(void)
{
    const tool_bench *bench;
    const char *name;
    char names[256];
    print_names(names, sizeof names, "|", "|");
    printf("virga bench %s [options]\n\n", names);
    for (uint32_t i = 0; bench_at(i, &bench, &name); i++)
        print_lines(name, bench->help);
    print_lines("frames",
                "start of a scene of all effects, cold and warm, and how even 2000 frames of steady rain are\n");
    printf("\nMedians of %d runs, beside a buffer copy, a bare kernel that reads and writes the same state, a\n"
           "dispatch and a full fill of the picture in the same run. Absolute times are noisy: compare ratios\n"
           "inside one run.\n\n",
           BENCH_RUNS);
    options_print(rows, list_rows());
}

/* The bench of a name; NULL: that of frames, or none. */
static const tool_bench *find_bench(const char *wanted)
{
    const tool_bench *bench;
    const char *name;
    for (uint32_t i = 0; bench_at(i, &bench, &name); i++)
        if (!strcmp(name, wanted))
            return bench;
    return NULL;
}

/* NULL where the option was not given. False, with the reason, for a card that is not known. */
static bool find_model(const options *parsed, const model_card **card)
{
    const char *name = options_value(parsed, "--model");
    *card = name ? model_card_find(name) : NULL;
    return !name || *card || options_complain("bench", "--model: expected desktop, handheld or here, got '%s'", name);
}

static bool find_variants(const options *parsed, virga_pass_variants *variants)
{
    const char *name = options_value(parsed, "--variants");
    *variants = !name                       ? VIRGA_VARIANTS_OF_DEVICE
                : !strcmp(name, "software") ? VIRGA_VARIANTS_SOFTWARE
                                            : VIRGA_VARIANTS_GPU;
    return !name || !strcmp(name, "software") || !strcmp(name, "gpu") ||
           options_complain("bench", "--variants: expected software or gpu, got '%s'", name);
}

static bool check_options(const options *parsed, uint32_t *passes)
{
    const model_card *card;
    virga_pass_variants variants;
    if (!find_model(parsed, &card) || !find_variants(parsed, &variants))
        return false;
    if (!options_uint(parsed, "--passes", 1, BENCH_MAX_PASSES, passes))
        return false;
    const tool_bench *bench;
    const char *name;
    for (uint32_t i = 0; bench_at(i, &bench, &name); i++)
        if (bench->check && !bench->check(parsed))
            return false;
    return true;
}

static bool run_bench(bench *b, const tool_bench *found, const options *parsed, uint32_t passes)
{
    const char *device = options_value(parsed, "--device");
    if (!bench_open(b, device, NULL, 0, VIRGA_PIPELINES_IMMEDIATE))
        return false;
    printf("virga %s on %s (%s), medians of %d\n", virga_version(), b->info.name, b->info.driver, BENCH_RUNS);
    if (found)
        return found->run(b, parsed);
    return b->model ? bench_model_frames(b) : bench_frames(b, device, passes);
}

int bench_run(int argc, char **argv)
{
    options parsed;
    uint32_t passes = 3;
    char names[256];
    if (!options_parse(&parsed, "bench", rows, list_rows(), argc, argv) || !check_options(&parsed, &passes))
        return EXIT_USAGE;
    const char *what = parsed.argument_count == 1          ? parsed.arguments[0]
                       : options_value(&parsed, "--model") ? "frames"
                                                           : "";
    const tool_bench *found = find_bench(what);
    if (!found && strcmp(what, "frames")) {
        print_names(names, sizeof names, ", ", " or ");
        options_complain("bench", "expected what to measure: %s", names);
        return EXIT_USAGE;
    }
    bench *b = calloc(1, sizeof *b);
    if (!b)
        return EXIT_FAILED;
    bool good =
        find_model(&parsed, &b->model) && find_variants(&parsed, &b->variants) && run_bench(b, found, &parsed, passes);
    if (b->instance.messages)
        good = options_complain("bench", "validation: %s", b->instance.first_message);
    bench_close(b);
    free(b);
    return !good ? EXIT_FAILED : interrupt_requested() ? EXIT_INTERRUPTED : EXIT_OK;
}
