/* spread.h - the spread of frame times, and how much of it the frames themselves cause. */
#ifndef VIRGA_TOOL_SPREAD_H
#define VIRGA_TOOL_SPREAD_H

#include <stdbool.h>
#include <stdint.h>

typedef struct spread {
    double median, percent_99, percent_99_9, max; /* percent_99: 99 % of the times are not longer */
} spread;

/* Of `count` times, at least one; `sorted` has room for as many. */
spread spread_of(const double *times, uint32_t count, double *sorted);

typedef struct spread_common {
    double seen;  /* relative standard deviation of a frame from the frames around it, in all runs, from all causes */
    double own;   /* the part that all runs have in common; 0: none was found */
    double noise; /* a value of `own` below this is not significant for this number of frames and runs */
} spread_common;

/* `runs` arrays of `count` times each, at least two of SPREAD_AROUND. False: out of memory. */
bool spread_in_common(const double *const *times, uint32_t runs, uint32_t count, spread_common *common);

#define SPREAD_AROUND \
    41 /* frames: shorter than a busy phase of the machine, and much longer than a single slow frame */

#endif
