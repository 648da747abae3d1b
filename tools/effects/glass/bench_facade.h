/* bench_facade.h - declares the bench of a facade, for bench.c. */
#ifndef VIRGA_EFFECTS_GLASS_BENCH_FACADE_H
#define VIRGA_EFFECTS_GLASS_BENCH_FACADE_H

#include "bench/bench.h"

/* Measures and prints the rows of `virga bench glass --facade`. False: an error was printed, or interrupted. */
bool glass_bench_facade(bench *b);

#endif
