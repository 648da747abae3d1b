/* here.h - how long this device takes for each kind of work, by kernels that do little else. */
#ifndef VIRGA_BENCH_MODEL_HERE_H
#define VIRGA_BENCH_MODEL_HERE_H

#include "bench/model/model.h"

/* Fills model_here. After counting_open and counting_time_calls, before any other pass; these kernels are forgotten.
 * Prints nothing. Takes a second or two. `target`: a picture to fill. */
bool model_here_measure(host_device *device, const host_target *target, char *error, size_t error_size);

#endif
