/* model_frame.h - `virga bench frames --model CARD`: what a game's frame of rain would take on a card. */
#ifndef VIRGA_TOOL_MODEL_FRAME_H
#define VIRGA_TOOL_MODEL_FRAME_H

#include "bench/bench.h"

bool bench_model_frames(bench *b, const char *device);

#endif
