/* bench_fluid.c - `virga bench fluid`: the solver, on a column of water that collapses in the tank of Iwasaki et al.
 * 2006, section 6: 1.23 x 0.72 x 0.57 m. */
#include "bench/bench.h"
#include "options.h"
#include "progress.h"
#include "water/bench_water.h"

#include <math.h>
#include <stdio.h>

#define STEP_S    0.01f /* as the paper's */
#define ENOUGH_S  60.0  /* fewer runs are enough after it */
#define MIN_RUNS  3
#define SETTLE    5   /* steps, in which the column begins to fall */
#define SPEED_M_S 4.0 /* more than the column reaches: sqrt(2 g h) is 3.1 m/s */

#define FRAME_SIZE 1

/* Particles of the column along each axis. It is as wide as the tank along z, and 0.4 m along x. */
static const uint32_t rows[][3] = {{15, 18, 27}, {22, 27, 40}, {46, 55, 82}, {77, 93, 139}};
static const char *const passes[] = {"fluid.sort", "fluid.neighbours", "fluid.solve", "fluid.advance"};

enum { PASSES = sizeof passes / sizeof passes[0] };

/* Sets *recorded to the substeps that each step records. */
static bool make_fluid(bench *b, const uint32_t counts[3], virga_fluid **fluid, uint32_t *recorded)
{
    static const float tank_m[3] = {1.23f, 0.57f, 0.72f};
    virga_fluid_def def = virga_default_fluid_def();
    virga_fluid_settings settings = virga_default_fluid_settings();
    const double d = (double)tank_m[2] / counts[2];
    virga_fluid_block column = {.low_m = {0}};
    double cells = 1;
    def.max_particles = counts[0] * counts[1] * counts[2];
    for (int axis = 0; axis < 3; axis++) {
        settings.low_m[axis] = 0;
        settings.high_m[axis] = tank_m[axis];
        column.high_m[axis] = (float)(d * counts[axis]);
        cells *= (double)tank_m[axis] / (2 * d) + 6;
    }
    def.max_cells = (uint32_t)fmin(fmax(cells, 4096), 16777216);
    settings.spacing_m = (float)d;
    /* As many as settings.cfl asks for at this speed. */
    def.max_substeps = (uint32_t)ceil(SPEED_M_S * (double)STEP_S / ((double)settings.cfl * d));
    *recorded = def.max_substeps;
    return (virga_fluid_create(b->context, &def, fluid) >= 0 && virga_fluid_set(*fluid, &settings) == VIRGA_OK &&
            virga_fluid_add(*fluid, &column) == VIRGA_OK) ||
           options_complain("bench", "no solver of %u particles could be made", def.max_particles);
}

/* One row of measurements: what a step took, and what the solver did in it. */
typedef struct run_of_steps {
    double pass_ms[PASSES][BENCH_RUNS], whole_ms[BENCH_RUNS], substeps[BENCH_RUNS], iterations[BENCH_RUNS];
    uint32_t runs;
    virga_fluid_stats stats;
} run_of_steps;

static bool time_steps(bench *b, virga_fluid *fluid, run_of_steps *out)
{
    const double start = progress_now();
    bool good = true;
    out->runs = 0;
    for (int i = -SETTLE; good && i < BENCH_RUNS && !interrupt_requested(); i++) {
        if (i >= MIN_RUNS && progress_now() - start > ENOUGH_S)
            break;
        const int run = i < 0 ? 0 : i;
        const virga_fluid_step_info info = {.dt_s = STEP_S};
        VkCommandBuffer cmd;
        good = (bench_begin(b, &cmd) && virga_fluid_step(fluid, cmd, &info) >= 0 &&
                bench_submit(b, &out->whole_ms[run])) ||
               options_complain("bench", "a step failed");
        virga_fluid_stats_get(fluid, &out->stats);
        out->runs = i < 0 ? 0 : out->runs + 1;
        out->substeps[run] = out->stats.substeps;
        out->iterations[run] = out->stats.iterations;
        for (int j = 0; j < PASSES; j++)
            out->pass_ms[j][run] = bench_pass_ms(b, passes[j]);
    }
    return good && !interrupt_requested();
}

static bool measure(bench *b, const uint32_t counts[3])
{
    run_of_steps result;
    bench_water_limits machine;
    virga_fluid *fluid = NULL;
    uint32_t recorded = 0;
    const bool good = make_fluid(b, counts, &fluid, &recorded) && time_steps(b, fluid, &result);
    virga_fluid_destroy(&fluid);
    if (!good)
        return interrupt_requested();
    const double substeps = bench_median(result.substeps, result.runs);
    const double whole = bench_median(result.whole_ms, result.runs);
    printf(
        "%u particles, %u steps: calls of virga_fluid_step with %g s, each with %.0f substeps and %.0f iterations in "
        "all, and up to %u substeps recorded\n",
        result.stats.particles, result.runs, (double)STEP_S, substeps, bench_median(result.iterations, result.runs),
        recorded);
    if (!bench_water_measure_limits(b, result.stats.particles, FRAME_SIZE, &machine))
        return false;
    for (int j = 0; j < PASSES; j++)
        bench_water_print_pass(passes[j], bench_median(result.pass_ms[j], result.runs), &machine,
                               result.stats.particles);
    printf("  %-26s %9.3f ms, by its fence; %.3f ms a substep\n", "a whole step", whole, whole / fmax(substeps, 1));
    fflush(stdout);
    bench_print_model(b);
    return true;
}

static bool run(bench *b, const options *parsed)
{
    uint32_t most;
    bool good = bench_water_read_particles(parsed, &most);
    for (size_t i = 0; good && !interrupt_requested() && i < sizeof rows / sizeof rows[0]; i++)
        if (rows[i][0] * rows[i][1] * rows[i][2] <= most)
            good = measure(b, rows[i]);
    return good;
}

const tool_bench fluid_bench = {
    .name = "fluid",
    .help = "the solver of water: a collapsing column of 7290 to 995379 particles\n",
    .run = run,
};
