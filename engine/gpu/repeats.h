/* gpu/repeats.h - log lines that repeat frame after frame are counted, and not passed on each time. Internal. */
#ifndef VIRGA_GPU_REPEATS_H
#define VIRGA_GPU_REPEATS_H

#include "core/log.h"

#define VIRGA_REPEATS 64 /* different lines that are remembered */

/* A line that was logged. */
typedef struct virga_repeat {
    uint64_t key; /* hash of its id and its text; 0: none */
    uint64_t count, first_frame, last_frame;
} virga_repeat;

/* The log function of a context, which is `user`. Passes a line on to the host's log function if it is new, or if it
 * was logged 10, 100, ... times, with any numbers in it. */
void virga_repeats_log(void *user, virga_log_level level, virga_log_id id, const char *text);

#endif
