/* test_spread.c - the measure of how even frame times are does not depend on what else the machine does. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "bench/spread.h"

#define FRAMES 2000
#define RUNS   5

static double times[RUNS][FRAMES];

static double random_share(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

/* Runs with noise of their own: slow phases of up to twice the time, and in each frame up to a third more. */
static void make_runs(double (*own)(uint32_t frame))
{
    uint32_t state = 7;
    for (uint32_t run = 0; run < RUNS; run++) {
        const double start = 1000 * random_share(&state);
        for (uint32_t i = 0; i < FRAMES; i++) {
            const double phase = 1.5 + 0.5 * sin((start + i) / 150), noise = 1 + 0.33 * random_share(&state);
            times[run][i] = 50 * phase * noise * (1 + own(i));
        }
    }
}

static spread_common find_common(uint32_t runs)
{
    const double *of[RUNS];
    spread_common common;
    for (uint32_t run = 0; run < RUNS; run++)
        of[run] = times[run];
    assert_true(spread_in_common(of, runs, FRAMES, &common));
    return common;
}

static double nothing(uint32_t frame)
{
    (void)frame;
    return 0;
}

/* A tenth more in every fourth frame: a standard deviation of 0.1 sqrt(1/4 * 3/4). */
static double every_fourth(uint32_t frame)
{
    return frame % 4 == 0 ? 0.1 : 0;
}

static double few_hitches(uint32_t frame)
{
    return frame % 100 == 50 ? 0.3 : 0;
}

static void quantiles_of_a_row_of_numbers(void **state)
{
    double sorted[FRAMES];
    (void)state;
    for (uint32_t i = 0; i < FRAMES; i++)
        times[0][i] = (i * 7 + 3) % FRAMES; /* 0 to 1999 in a mixed order */
    const spread s = spread_of(times[0], FRAMES, sorted);
    assert_true(s.median == 1000 && s.percent_99 == 1980 && s.percent_99_9 == 1998 && s.max == 1999);
}

static void noise_of_the_machine_is_not_the_frames_own(void **state)
{
    (void)state;
    make_runs(nothing);
    const spread_common common = find_common(RUNS);
    assert_true(common.seen > 0.06);
    assert_true(common.own < common.noise);
}

static void what_every_fourth_frame_has_more_is_found(void **state)
{
    (void)state;
    make_runs(every_fourth);
    for (uint32_t runs = 2; runs <= RUNS; runs++) {
        const spread_common common = find_common(runs);
        assert_true(fabs(common.own - 0.1 * sqrt(3) / 4) < 0.1 * 0.1);
        assert_true(common.own > 2 * common.noise);
    }
}

static void rare_hitches_are_found(void **state)
{
    (void)state;
    make_runs(few_hitches);
    const spread_common common = find_common(RUNS);
    assert_true(fabs(common.own - 0.3 * sqrt(0.01 * 0.99)) < 0.005);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantiles_of_a_row_of_numbers),
        cmocka_unit_test(noise_of_the_machine_is_not_the_frames_own),
        cmocka_unit_test(what_every_fourth_frame_has_more_is_found),
        cmocka_unit_test(rare_hitches_are_found),
    };
    return cmocka_run_group_tests_name("virga/spread", tests, NULL, NULL);
}
