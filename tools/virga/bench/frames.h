/* frames.h - `virga bench frames`. */
#ifndef VIRGA_TOOL_BENCH_FRAMES_H
#define VIRGA_TOOL_BENCH_FRAMES_H

#include "bench/bench.h"

#define BENCH_MAX_PASSES 20

/* Measures and prints. Opens *b anew several times. `passes`: whole runs of all frames, 1 to BENCH_MAX_PASSES. */
bool bench_frames(bench *b, const char *device, uint32_t passes);

#endif
