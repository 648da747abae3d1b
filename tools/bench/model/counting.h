/* counting.h - a Vulkan device as a context sees it, which counts what each of the context's passes does.
 *
 * It stands between the context and the driver as the host's vkGetInstanceProcAddr: shaders are replaced by copies that
 * count how often each block runs (spirv_count.h), and calls are counted on their way through. Results stay the same.
 * What is counted takes several times as long, so most frames are not: a pass is counted in the 1st, 2nd, 4th, 8th, ...
 * of the frames that use it. One at a time, on one thread, and only on software Vulkan with one thread of its own:
 * counting_prepare. */
#ifndef VIRGA_BENCH_MODEL_COUNTING_H
#define VIRGA_BENCH_MODEL_COUNTING_H

#include "bench/model/block_cost.h"
#include "host.h"

typedef struct counted_stage {
    block_costs costs;
    uint32_t first, room;                /* its numbers in counting_numbers() */
    double texel_share[BLOCK_RESOURCES]; /* bytes of a texel of the bound image, of those that block_cost.c takes */
    double sizes[BLOCK_RESOURCES];       /* bytes of the bound buffer or image; 0: none was bound */
} counted_stage;

#define COUNTED_TIMES 9

/* A pipeline, and the newest of its frames that was counted. */
typedef struct counted_pass {
    char name[64]; /* of the pass, e.g. "rain.step" */
    counted_stage stages[2];
    uint32_t stage_count;                /* 1: compute; 2: vertex and fragment */
    uint32_t calls;                      /* dispatches or draws in that frame; 0: none since counting_forget */
    uint32_t waits;                      /* of these, behind a barrier */
    uint32_t times;                      /* of calls, those without a barrier between them counted once */
    uint32_t calls_so_far, waits_so_far; /* of a frame that has not ended */
    uint32_t times_so_far;
    uint32_t last_barrier; /* number of barriers before the last call */
    uint32_t frames;       /* that used it since counting_forget */
    bool counts;           /* in this frame */
    bool ended;            /* its pipeline was destroyed */
    float target_bytes;    /* that a fragment reads and writes of its attachments */
    char row[64];          /* with times: the pass whose times have its own in them: the first of its render pass */
    double seconds[COUNTED_TIMES]; /* with times: of all its calls in frames that used it and did not count it */
    uint32_t time_count;           /* of those so far; the newest are kept */
    double seconds_so_far;
} counted_pass;

/* An image of the host's, which passes read: its bytes count from now on. */
void counting_know_image(VkImageView view, VkFormat format, VkExtent3D extent);

/* Before the device is created. */
void counting_prepare(void);

/* Takes the place of vkGetInstanceProcAddr in virga_context_def. False, with the
 * reason. */
bool counting_open(host_device *device, char *error, size_t error_size);
void counting_close(host_device *device);
PFN_vkVoidFunction VKAPI_CALL counting_get(VkInstance instance, const char *name);

/* From now on the calls of passes that are not counted in a frame are timed, each behind what is before it. */
bool counting_time_calls(char *error, size_t error_size);

/* With times: around a render pass of the host's in which passes draw; they are timed together, as `name`. */
void counting_begin_draws(VkCommandBuffer cmd, const char *name);
void counting_end_draws(VkCommandBuffer cmd);

/* A frame has ended: the passes that were counted in it have their numbers from now on. No submission may be
 * running. */
void counting_end_frame(void);

/* Counts all passes of the frame that begins. */
void counting_all_of_next(void);

/* Forgets the frames until now. */
void counting_forget(void);

uint32_t counting_pass_count(void);
const counted_pass *counting_pass(uint32_t index);

/* Lanes and subgroups of 8 that ran each block in the newest counted frame of its pass, see spirv_count.h. */
const uint32_t *counting_numbers(void);

/* Bytes that copies and fills moved in the newest frame. */
double counting_moved_bytes(void);

#endif
