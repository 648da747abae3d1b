/* spread.c - the spread of frame times, and how much of it the frames themselves cause. */
#include "bench/spread.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

spread spread_of(const double *times, uint32_t count, double *sorted)
{
    memcpy(sorted, times, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, by_size);
    return (spread){.median = sorted[count / 2],
                    .percent_99 = sorted[(uint64_t)count * 99 / 100],
                    .percent_99_9 = sorted[(uint64_t)count * 999 / 1000],
                    .max = sorted[count - 1]};
}

/* Relative deviation of each frame from the median of the frames around it. */
static void find_deviations(const double *times, uint32_t count, double *deviations)
{
    double sorted[SPREAD_AROUND];
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t half = SPREAD_AROUND / 2, max = count - SPREAD_AROUND;
        const uint32_t first = i < half ? 0 : i - half > max ? max : i - half;
        const double around = spread_of(times + first, SPREAD_AROUND, sorted).median;
        deviations[i] = around > 0 ? times[i] / around - 1 : 0;
    }
}

static double covariance(const double *a, const double *b, uint32_t count)
{
    double mean_a = 0, mean_b = 0, sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        mean_a += a[i] / count;
        mean_b += b[i] / count;
    }
    for (uint32_t i = 0; i < count; i++)
        sum += (a[i] - mean_a) * (b[i] - mean_b);
    return sum / count;
}

/* In run a, frame i deviates from the frames around it by own(i) + noise(a, i). The noise comes from other work of the
 * machine and does not depend on i. So the noises of two runs are independent. The mean product of their deviations is
 *     E[(own + noise_a) (own + noise_b)] = E[own^2],
 * the variance of the frames themselves, for any noise. The mean of n products, each of variance seen^4, over p pairs
 * of runs has a standard error of seen^2 / sqrt(n p). Values above twice this error are significant. */
bool spread_in_common(const double *const *times, uint32_t runs, uint32_t count, spread_common *common)
{
    double *deviations = malloc((size_t)runs * count * sizeof *deviations), seen = 0, own = 0;
    uint32_t pairs = 0;
    if (!deviations)
        return false;
    for (uint32_t a = 0; a < runs; a++) {
        double *of_a = deviations + (size_t)a * count;
        find_deviations(times[a], count, of_a);
        seen += covariance(of_a, of_a, count) / runs;
        for (uint32_t b = 0; b < a; b++, pairs++)
            own += covariance(of_a, deviations + (size_t)b * count, count);
    }
    free(deviations);
    *common = (spread_common){
        .seen = sqrt(seen), .own = sqrt(fmax(own / pairs, 0)), .noise = sqrt(2 * seen / sqrt((double)count * pairs))};
    return true;
}
