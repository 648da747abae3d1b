/* rain_fixture.h - a device with validation, rain on it, a floor to land on, and read-back of rain's output. */
#ifndef VIRGA_TESTS_RAIN_FIXTURE_H
#define VIRGA_TESTS_RAIN_FIXTURE_H

#include "../host/effect_fixture.h"

#include <virga/shared/drop.h>
#include <virga/virga.h>

typedef struct rain_fixture {
    fixture gpu;
    virga_context *context;
    virga_rain *rain;
    virga_rain_settings settings;
    host_buffer vertices, indices, impacts, drops;
    virga_occluder occluders[8];
    uint32_t occluder_count;
    double camera[3];
    double origin[3]; /* of the newest drops read back */
    uint32_t slots;
    uint32_t errors; /* log lines of the library that are errors */
    virga_log_id last_error;
} rain_fixture;

static inline void rain_fixture_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    rain_fixture *f = user;
    if (level == VIRGA_LOG_ERROR) {
        f->errors++;
        f->last_error = id;
        if (getenv("VIRGA_TEST_VERBOSE"))
            fprintf(stderr, "%s: %s\n", virga_log_name(id), text);
    }
}

/* Device and context, without rain. Exits with 77 if there is no device. */
static inline void rain_fixture_open(rain_fixture *f)
{
    memset(f, 0, sizeof *f);
    f->context = effect_fixture_open(&f->gpu, false, rain_fixture_log, f);
}

/* Quads of four corners each: positions only. */
static inline void rain_fixture_quads(rain_fixture *f, const float (*corners)[4][3], uint32_t count)
{
    uint32_t indices[8 * 6];
    for (uint32_t i = 0; i < count; i++) {
        static const uint32_t pattern[6] = {0, 1, 2, 0, 2, 3};
        for (uint32_t j = 0; j < 6; j++)
            indices[i * 6 + j] = i * 4 + pattern[j];
    }
    REQUIRE(host_buffer_create_with(&f->gpu.device, corners, count * 48, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "quads",
                                    &f->vertices, f->gpu.error, sizeof f->gpu.error));
    REQUIRE(host_buffer_create_with(&f->gpu.device, indices, count * 24, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "indices",
                                    &f->indices, f->gpu.error, sizeof f->gpu.error));
    f->occluder_count = count;
    for (uint32_t i = 0; i < count; i++)
        f->occluders[i] = (virga_occluder){.vertices = f->vertices.buffer,
                                           .vertex_stride = 12,
                                           .indices = f->indices.buffer,
                                           .index_offset = i * 24,
                                           .index_type = VK_INDEX_TYPE_UINT32,
                                           .index_count = 6,
                                           .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                                           .material = i + 1};
}

/* A level floor, 200 m on each side, at height 0. */
static inline void rain_fixture_floor(rain_fixture *f)
{
    static const float floor_quad[1][4][3] = {{{-100, 0, -100}, {100, 0, -100}, {100, 0, 100}, {-100, 0, 100}}};
    rain_fixture_quads(f, floor_quad, 1);
}

static inline void rain_fixture_rain(rain_fixture *f, const virga_rain_def *def)
{
    REQUIRE(virga_rain_create(f->context, def, &f->rain) == VIRGA_OK);
    f->settings = virga_default_rain_settings();
    virga_rain_buffer impacts, drops;
    virga_rain_impacts(f->rain, &impacts);
    virga_rain_drops(f->rain, &drops, &f->slots, NULL);
    REQUIRE(host_buffer_create(&f->gpu.device, impacts.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK,
                               "impacts read", &f->impacts, f->gpu.error, sizeof f->gpu.error));
    REQUIRE(host_buffer_create(&f->gpu.device, drops.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK,
                               "drops read", &f->drops, f->gpu.error, sizeof f->gpu.error));
}

static inline void rain_fixture_copy(VkCommandBuffer cmd, const virga_rain_buffer *from, const host_buffer *to)
{
    effect_fixture_transfers(cmd);
    const VkBufferCopy copy = {from->offset, 0, from->size};
    vkCmdCopyBuffer(cmd, from->buffer, to->buffer, 1, &copy);
}

/* One frame: occlusion, a step of dt, and read-back. */
static inline void rain_fixture_step(rain_fixture *f, double dt_s)
{
    virga_rain_buffer impacts, drops;
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    if (f->occluder_count)
        REQUIRE(virga_rain_draw_occlusion(f->rain, cmd, f->camera, f->occluders, f->occluder_count) == VIRGA_OK);
    const virga_rain_step_info info = {.dt_s = dt_s, .camera_m = {f->camera[0], f->camera[1], f->camera[2]}};
    REQUIRE(virga_rain_step(f->rain, cmd, &info) >= 0); /* may skip ticks */
    virga_rain_impacts(f->rain, &impacts);
    virga_rain_drops(f->rain, &drops, NULL, f->origin);
    rain_fixture_copy(cmd, &impacts, &f->impacts);
    rain_fixture_copy(cmd, &drops, &f->drops);
    effect_fixture_submit(&f->gpu);
    host_buffer_invalidate(&f->gpu.device, &f->impacts);
    host_buffer_invalidate(&f->gpu.device, &f->drops);
}

static inline const virga_impacts_gpu *rain_fixture_impacts(const rain_fixture *f, const virga_impact_gpu **list)
{
    *list = (const virga_impact_gpu *)((const char *)f->impacts.mapped + sizeof(virga_impacts_gpu));
    return f->impacts.mapped;
}

static inline const virga_drop_gpu *rain_fixture_drops(const rain_fixture *f)
{
    return f->drops.mapped;
}

/* 64-bit FNV-1a. */
static inline uint64_t rain_fixture_hash(const void *data, size_t size, uint64_t hash)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * UINT64_C(0x100000001b3);
    return hash;
}

#define HASH_START UINT64_C(0xcbf29ce484222325)

/* ---- frames that a test records itself */

static inline VkCommandBuffer rain_fixture_begin_frame(rain_fixture *f)
{
    return effect_fixture_begin(&f->gpu, f->context);
}

/* Submits the frame and waits for it. */
static inline void rain_fixture_end_frame(rain_fixture *f)
{
    effect_fixture_submit(&f->gpu);
}

static inline void rain_fixture_record_step(rain_fixture *f, VkCommandBuffer cmd, double dt_s)
{
    const virga_rain_step_info info = {.dt_s = dt_s, .camera_m = {f->camera[0], f->camera[1], f->camera[2]}};
    REQUIRE(virga_rain_step(f->rain, cmd, &info) == VIRGA_OK);
    virga_rain_drops(f->rain, NULL, NULL, f->origin);
}

static inline void rain_fixture_readback(rain_fixture *f, VkDeviceSize size, host_buffer *buffer)
{
    REQUIRE(host_buffer_create(&f->gpu.device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "read",
                               buffer, f->gpu.error, sizeof f->gpu.error));
}

/* A step without occlusion, and all drops in full; `read` is made at the first call. Needs def.points. */
static inline const virga_point_gpu *rain_fixture_points_step(rain_fixture *f, double dt_s, host_buffer *read)
{
    virga_rain_buffer points;
    const VkCommandBuffer cmd = rain_fixture_begin_frame(f);
    rain_fixture_record_step(f, cmd, dt_s);
    REQUIRE(virga_rain_write_points(f->rain, cmd, &points, &f->slots, f->origin) == VIRGA_OK);
    if (!read->buffer)
        rain_fixture_readback(f, points.size, read);
    rain_fixture_copy(cmd, &points, read);
    rain_fixture_end_frame(f);
    host_buffer_invalidate(&f->gpu.device, read);
    return read->mapped;
}

/* Destroys everything and checks that all objects are gone and that there are no validation messages. */
static inline void rain_fixture_close(rain_fixture *f)
{
    virga_rain_destroy(&f->rain);
    virga_memory_stats stats;
    virga_context_destroy(&f->context);
    virga_memory_get(f->context, &stats);
    host_buffer *const buffers[] = {&f->vertices, &f->indices, &f->impacts, &f->drops};
    assert_int_equal(effect_fixture_end(&f->gpu, buffers, sizeof buffers / sizeof buffers[0]), 0);
}

#endif
