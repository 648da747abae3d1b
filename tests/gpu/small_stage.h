/* small_stage.h - a context with attached rain and a picture, and a check that all memory is freed. */
#ifndef VIRGA_TESTS_SMALL_STAGE_H
#define VIRGA_TESTS_SMALL_STAGE_H

#include "gpu_fixture.h"

typedef struct stage {
    virga_context *context;
    virga_rain *rain;
    gpu_picture picture;
    virga_memory_stats empty; /* of the context alone */
} stage;

static inline void stage_open(gpu_fixture *f, const virga_context_def *def, stage *s)
{
    memset(s, 0, sizeof *s);
    REQUIRE(virga_context_create(def, &s->context) == VIRGA_OK);
    virga_memory_get(s->context, &s->empty);
    s->rain = gpu_rain(s->context);
    gpu_picture_open(f, s->context, &s->picture);
    REQUIRE(virga_rain_attach(s->rain, s->picture.target) == VIRGA_OK);
}

static inline void stage_close(gpu_fixture *f, stage *s)
{
    virga_rain_destroy(&s->rain);
    gpu_picture_close(f, &s->picture);
    virga_context_destroy(&s->context);
}

static inline void run_frame(gpu_fixture *f, stage *s)
{
    gpu_record(gpu_begin_frame(f, s->context), s->rain, &s->picture);
    gpu_submit(f);
}

static inline void check_empty(const stage *s)
{
    virga_memory_stats stats;
    virga_memory_get(s->context, &stats);
    assert_int_equal(stats.device_bytes, 0);
    assert_int_equal(stats.device_used, 0);
    assert_int_equal(stats.device_allocations, 0);
    assert_int_equal(stats.objects, s->empty.objects);
    assert_int_equal(stats.host_allocations, s->empty.host_allocations);
    assert_int_equal(stats.host_bytes, s->empty.host_bytes);
}

#endif
