/* bench.h - what the benches of effects share: a device, a floor to rain on, and targets to draw into. */
#ifndef VIRGA_BENCH_BENCH_H
#define VIRGA_BENCH_BENCH_H

#include "bench/machine_limits.h"
#include "bench/model/model.h"
#include "host.h"

#include <virga/virga.h>

#define BENCH_SIZES 3

extern const uint32_t bench_sizes[BENCH_SIZES][2];

typedef struct bench {
    host_instance instance;
    host_device_info info;
    host_device device;
    host_target targets[BENCH_SIZES];
    host_buffer vertices, indices;
    virga_occluder floor;
    virga_context *context;
    virga_target *layer;
    virga_pass_variants variants; /* of the context; set before bench_open */
    const model_card *model; /* set before bench_open: passes are counted, and bench_print_model prints their times */
    char error[512];
} bench;

/* Opens a device, and creates a floor, targets, and a context with this pipeline cache. *b must be all zero but for its
 * model and variants. With a model the variants are those for a GPU, unless they are chosen. */
bool bench_open(bench *b, const char *device, const void *blob, size_t blob_size, virga_pipeline_build_mode when);

/* Destroys all of it; *b is all zero afterwards but for its model and variants. */
void bench_close(bench *b);

/* For a further context on the device: with the counting, if there is a model. */
virga_context_def bench_context_def(const bench *b);

bool bench_fail(bench *b, const char *what);

/* Begins a frame, for the host and for Virga. */
bool bench_begin(bench *b, VkCommandBuffer *cmd);

/* Submits, waits, and returns the time of both. */
bool bench_submit(bench *b, double *milliseconds);

/* Time of a pass of the newest frame; 0 if it was not recorded. */
double bench_pass_ms(const bench *b, const char *name);

/* Time (ms) that all threads of the program have worked, which other programs on the machine hardly change. */
double bench_worked_ms(void);

/* Time of a draw in the newest frame, which took `frame_ms` with all that was recorded. A software device does not time
 * draws: there it is what the frame's timed passes leave. */
double bench_draw_ms(const bench *b, const char *name, double frame_ms);

/* With a model: an image of the bench's own that passes read counts with its bytes. */
void bench_know_image(const bench *b, const host_image *image);

/* With a model: forgets the passes so far, e.g. those of a first frame. */
void bench_forget_model(const bench *b);

/* With a model: the modelled times of the passes since the last call, each in its newest frame. Returns
 * their sum in milliseconds. Else nothing, and 0. */
double bench_print_model(const bench *b);

/* A camera at eye level, with one of bench_sizes. */
void bench_view(virga_view *view, uint32_t size);

#endif
