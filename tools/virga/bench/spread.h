/* spread.h - how even frames are, and how much of that is their own. */
#ifndef VIRGA_TOOL_SPREAD_H
#define VIRGA_TOOL_SPREAD_H

#include <stdbool.h>
#include <stdint.h>

typedef struct spread {
    double median, percent_99, percent_99_9, max; /* 99 % and 99.9 % take no longer than the two between */
} spread;

/* Of `count` times, at least one; `sorted` has room for as many. */
spread spread_of(const double *times, uint32_t count, double *sorted);

typedef struct spread_common {
    double seen;  /* standard deviation of a frame from those around it, as a share of them: all runs, all causes */
    double own;   /* the part that runs which do the same frame by frame have in common; 0: none was found */
    double noise; /* an `own` below this may be chance, with so many frames and runs */
} spread_common;

/* `runs` arrays of `count` times each, at least two of SPREAD_AROUND. False: out of memory. */
bool spread_in_common(const double *const *times, uint32_t runs, uint32_t count, spread_common *common);

#define SPREAD_AROUND 41 /* frames: fewer than a phase of a busy machine, many more than a hitch */

#endif
