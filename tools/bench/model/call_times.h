/* call_times.h - how long calls take: a timestamp before and one behind each.
 *
 * For software Vulkan, which runs one call after another: a pipeline barrier on both sides of a timestamp makes it wait
 * for what is before it. Render passes are timed from outside, as they are drawn when they end. */
#ifndef VIRGA_BENCH_MODEL_CALL_TIMES_H
#define VIRGA_BENCH_MODEL_CALL_TIMES_H

#include "host.h"

#define CALL_TIMES_MAX 1024 /* calls of a frame; later ones are not timed */

typedef struct call_times {
    host_device *device;
    VkQueryPool pool; /* VK_NULL_HANDLE: nothing is timed */
    uint32_t count;   /* calls of the frame */
    double seconds[CALL_TIMES_MAX];
} call_times;

bool call_times_open(call_times *times, host_device *device, char *error, size_t error_size);
void call_times_close(call_times *times);

/* Outside of render passes. Returns the index of the call: CALL_TIMES_MAX: it is not timed. */
uint32_t call_times_begin(call_times *times, VkCommandBuffer cmd);
void call_times_end(call_times *times, VkCommandBuffer cmd, uint32_t call);

/* Fills `seconds` for the calls of the frame, which must have completed, and returns their number. The next frame
 * begins with call 0. */
uint32_t call_times_read(call_times *times);

#endif
