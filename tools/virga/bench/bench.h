/* bench.h - what the benches of effects share: a device, a floor to rain on, pictures to draw into. */
#ifndef VIRGA_TOOL_BENCH_H
#define VIRGA_TOOL_BENCH_H

#include "bench/machine_limits.h"
#include "host.h"

#include <virga/virga.h>

#define BENCH_SIZES       3
#define BENCH_MOST_PASSES 20

extern const uint32_t bench_sizes[BENCH_SIZES][2];

typedef struct bench {
    host_instance instance;
    host_device_info info;
    host_device device;
    host_target targets[BENCH_SIZES];
    host_buffer vertices, indices;
    virga_occluder floor;
    virga_context *context;
    virga_rain *rain;
    virga_target *layer;
    char error[512];
} bench;

/* A device, what there is to rain on and into, and a context with those caches; *b is all zero before. */
bool bench_open(bench *b, const char *device, const void *blob, size_t blob_size, virga_pipelines_when when);

/* All zero again. */
void bench_close(bench *b);

bool bench_fail(bench *b, const char *what);

/* Begins a frame, for the host and for Virga. */
bool bench_begin(bench *b, VkCommandBuffer *cmd);

/* Submits, waits, and tells how long that took. */
bool bench_submit(bench *b, double *milliseconds);

/* Time of a pass of the newest frame; 0 if it was not recorded. */
double bench_pass_ms(const bench *b, const char *name);

/* A camera at eye level, with one of bench_sizes. */
void bench_view(virga_view *view, uint32_t size);

/* What bench_splash measures. */
typedef struct bench_splash_choice {
    uint32_t only; /* splashes; 0: the usual numbers */
    virga_splash_mode mode;
    virga_splash_style style;
    bool film_too; /* a short table in that style after the other */
} bench_splash_choice;

/* Measure and print. `only` 0: the usual sizes. */
bool bench_rain(bench *b, uint32_t only);
bool bench_ground(bench *b);
bool bench_glass(bench *b, uint32_t only);

/* Opens *b anew several times; `passes`: whole runs of all frames, 1 to BENCH_MOST_PASSES. */
bool bench_frames(bench *b, const char *device, uint32_t passes);
bool bench_splash(bench *b, const bench_splash_choice *choice);

#endif
