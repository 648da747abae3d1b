/* bench_plate.h - `virga bench plate`. */
#ifndef VIRGA_EFFECTS_GROUND_BENCH_PLATE_H
#define VIRGA_EFFECTS_GROUND_BENCH_PLATE_H

#include "effect.h"

extern const tool_bench plate_bench;

#endif
