/* gpu/timers.h - labels and timestamps around passes. Internal. */
#ifndef VIRGA_GPU_TIMERS_H
#define VIRGA_GPU_TIMERS_H

#include <virga/vulkan.h>

#include <stdbool.h>
#include <stdint.h>

#define VIRGA_MAX_PASSES  64   /* different pass names with a time each */
#define VIRGA_MAX_QUERIES 4096 /* timestamps per frame; passes beyond this number are not timed */

/* The timestamps of one frame in flight. */
typedef struct virga_timer_slot {
    VkQueryPool pool;
    uint64_t frame_index;
    uint32_t count;                       /* queries written */
    uint8_t names[VIRGA_MAX_QUERIES / 2]; /* index into pass_times, for each pair of queries */
    bool reset;                           /* the pool was reset in this frame */
    VkCommandBuffer reset_in;             /* ... last in this command buffer */
} virga_timer_slot;

typedef struct virga_timers {
    bool enabled;
    bool multiview; /* the next draw is in a pass of several views, where a timestamp takes a query for each of them */
    double timestamp_ns;
    uint64_t timestamp_mask;
    virga_timer_slot slots[VIRGA_MAX_FRAMES_IN_FLIGHT];
    virga_pass_time pass_times[VIRGA_MAX_PASSES];
    uint32_t pass_count;
} virga_timers;

/* `valid_bits`: valid timestamp bits of the queue family. 0: it has no timestamps, and no pass is timed. */
virga_result virga_timers_create(virga_context *context, uint32_t valid_bits);
void virga_timers_destroy(virga_context *context);

/* Begins a frame: reads the times of the frame that used this slot before. VIRGA_DEGRADED if they can not be read,
 * VIRGA_ERROR_DEVICE_LOST if the device is lost. */
virga_result virga_timers_begin_frame(virga_context *context);

/* Reads the times of all completed frames. Returns the same as virga_timers_begin_frame. */
virga_result virga_timers_collect(virga_context *context);

/* Forgets the times of a frame that the device never executes. */
void virga_timers_drop(virga_context *context, uint64_t frame_index);

/* Called before the passes of every call that records outside rendering: the first in a frame resets the queries. */
void virga_timers_reset(virga_context *context, VkCommandBuffer cmd);

/* A pass between its label and timestamps; `name` is static, e.g. "rain.step". */
typedef struct virga_pass_scope {
    uint32_t query; /* of the end; 0: not timed */
} virga_pass_scope;

virga_pass_scope virga_pass_begin(virga_context *context, VkCommandBuffer cmd, const char *name);

/* What kind of pass the next draw is in. Draws in passes of several views are not timed. */
void virga_timers_expect(virga_context *context, bool multiview);

/* The same inside a host's rendering, where barriers are not allowed. Not timed on a software device. */
virga_pass_scope virga_draw_begin(virga_context *context, VkCommandBuffer cmd, const char *name);
void virga_pass_end(virga_context *context, VkCommandBuffer cmd, virga_pass_scope scope);

#endif
