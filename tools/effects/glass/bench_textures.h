/* bench_textures.h - declares the bench of drops as textures, for bench.c. */
#ifndef VIRGA_EFFECTS_GLASS_BENCH_TEXTURES_H
#define VIRGA_EFFECTS_GLASS_BENCH_TEXTURES_H

#include "bench/bench.h"

/* Measures and prints the rows of `virga bench glass --textures`. False: an error was printed, or interrupted. */
bool glass_bench_textures(bench *b);

#endif
