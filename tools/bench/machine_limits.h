/* machine_limits.h - measures the speed of the machine, for comparison with the passes of a bench. */
#ifndef VIRGA_TOOL_LIMITS_H
#define VIRGA_TOOL_LIMITS_H

#include "host.h"

#define BENCH_RUNS 9

typedef struct limits limits; /* opaque: pipelines and buffers for the measurements */

bool limits_create(host_device *device, const host_target *target, uint32_t drops, limits **made, char *error,
                   size_t error_size);
void limits_destroy(host_device *device, limits **made);

/* Milliseconds, medians of BENCH_RUNS; negative on failure. */
double limits_copy_ms(host_device *device, limits *l);      /* vkCmdCopyBuffer of drops x 16 bytes */
double limits_bare_ms(host_device *device, limits *l);      /* a kernel that reads and writes drops x 16 bytes */
double limits_bare_once_ms(host_device *device, limits *l); /* the same, once */
double limits_dispatch_ms(host_device *device, limits *l);  /* one empty dispatch among many */
double limits_fill_ms(host_device *device, limits *l, const host_target *target); /* each pixel of the layer once */

/* Median of values, which are sorted in place. */
double bench_median(double *values, size_t count);

#endif
