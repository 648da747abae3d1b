/* model_frame.h - `virga bench frames --model CARD`: what a game's frame of rain would take on a card. */
#ifndef VIRGA_TOOL_MODEL_FRAME_H
#define VIRGA_TOOL_MODEL_FRAME_H

#include "bench/bench.h"

/* Runs the frames on the bench's device, which counts them, and prints the table of each. False: it said why. */
bool bench_model_frames(bench *b);

#endif
