/* bench_water.h - what `virga bench water` and `virga bench fluid` share. */
#ifndef VIRGA_EFFECTS_BENCH_WATER_H
#define VIRGA_EFFECTS_BENCH_WATER_H

#include "bench/bench.h"
#include "effect.h"

typedef struct bench_water_limits {
    double bare_ms, fill_ms; /* a kernel over 16 bytes a particle, and a fill of the picture */
} bench_water_limits;

/* Measures and prints a line. `size`: of bench_sizes. */
bool bench_water_measure_limits(bench *b, uint32_t particles, uint32_t size, bench_water_limits *out);

/* Prints a pass of a step beside the bare kernel. */
void bench_water_print_pass(const char *name, double ms, const bench_water_limits *machine, uint32_t particles);

/* The option --particles: the most particles of the rows that are measured. */
bool bench_water_read_particles(const options *parsed, uint32_t *most);

extern const tool_bench water_bench, fluid_bench;

#endif
