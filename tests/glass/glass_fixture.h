/* glass_fixture.h - a pane on a device with validation, with rain and drops that a test chooses. */
#ifndef VIRGA_TESTS_GLASS_FIXTURE_H
#define VIRGA_TESTS_GLASS_FIXTURE_H

#include "../host/effect_fixture.h"

#include "glass/glass_internal.h"

#include <virga/shared/impact.h>
#include <virga/shared/random.h>
#include <virga/virga.h>

typedef struct glass_fixture {
    fixture gpu;
    virga_context *context;
    virga_glass *glass;
    virga_glass_settings settings;
    virga_glass_step_info info; /* of the next step; the fixture sets its ticks */
    host_buffer upload, download, impacts;
    uint32_t impact_count; /* of the next step */
    uint32_t tick;
    /* Read back. */
    const virga_glass_state_gpu *state;
    const virga_glass_drop_gpu *drops;
    const uint32_t *occupants, *film, *claims, *passed, *grid, *film_blocks, *list, *active, *moved;
} glass_fixture;

/* A small pane. */
static inline virga_glass_def glass_fixture_def(void)
{
    virga_glass_def def = virga_default_glass_def();
    def.width_m = 0.16f;
    def.height_m = 0.12f;
    def.max_drops = 1024;
    def.max_texels = 256;
    def.max_ticks_per_step = 64;
    return def;
}

static inline void glass_fixture_buffers(glass_fixture *f)
{
    const virga_glass *g = f->glass;
    const VkDeviceSize size = g->state->size + g->drops->size + g->occupants->size + g->film->size + g->claims->size +
                              g->passed->size + g->grid->size + g->film_blocks->size + g->list->size + g->active->size +
                              g->moved->size;
    char *error = f->gpu.error;
    REQUIRE(host_buffer_create(&f->gpu.device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK,
                               "pane down", &f->download, error, sizeof f->gpu.error));
    REQUIRE(host_buffer_create(&f->gpu.device, g->drops->size + g->passed->size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                               HOST_BUFFER_UPLOAD, "pane up", &f->upload, error, sizeof f->gpu.error));
    REQUIRE(host_buffer_create(&f->gpu.device, sizeof(virga_impacts_gpu) + GLASS_MAX_IMPACTS * sizeof(virga_impact_gpu),
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_UPLOAD, "impacts", &f->impacts, error,
                               sizeof f->gpu.error));
}

static inline void glass_fixture_open(glass_fixture *f, const virga_glass_def *given)
{
    memset(f, 0, sizeof *f);
    f->context = effect_fixture_open(&f->gpu, false, effect_fixture_log, NULL);
    const virga_glass_def small = glass_fixture_def();
    REQUIRE(virga_glass_create(f->context, given ? given : &small, &f->glass) == VIRGA_OK);
    f->settings = virga_default_glass_settings();
    f->tick = 1;
    glass_fixture_buffers(f);
}

static inline VkCommandBuffer glass_fixture_begin(glass_fixture *f)
{
    return effect_fixture_begin(&f->gpu, f->context);
}

static inline void glass_fixture_submit(glass_fixture *f)
{
    effect_fixture_complete(&f->gpu, f->context);
}

static inline const void *glass_fixture_copy(const glass_fixture *f, VkCommandBuffer cmd, const virga_buffer *from,
                                             VkDeviceSize *offset)
{
    return effect_fixture_copy(cmd, from->buffer, from->size, &f->download, offset);
}

static inline void glass_fixture_read(glass_fixture *f, VkCommandBuffer cmd)
{
    VkDeviceSize offset = 0;
    effect_fixture_transfers(cmd);
    f->state = glass_fixture_copy(f, cmd, f->glass->state, &offset);
    f->drops = glass_fixture_copy(f, cmd, f->glass->drops, &offset);
    f->occupants = glass_fixture_copy(f, cmd, f->glass->occupants, &offset);
    f->film = glass_fixture_copy(f, cmd, f->glass->film, &offset);
    f->claims = glass_fixture_copy(f, cmd, f->glass->claims, &offset);
    f->passed = glass_fixture_copy(f, cmd, f->glass->passed, &offset);
    f->grid = glass_fixture_copy(f, cmd, f->glass->grid, &offset);
    f->film_blocks = glass_fixture_copy(f, cmd, f->glass->film_blocks, &offset);
    f->list = glass_fixture_copy(f, cmd, f->glass->list, &offset);
    f->active = glass_fixture_copy(f, cmd, f->glass->active, &offset);
    f->moved = glass_fixture_copy(f, cmd, f->glass->moved, &offset);
}

/* Adds a drop to the next step. It lands in the step's first tick. */
static inline virga_impact_gpu *glass_fixture_land(glass_fixture *f, double u, double v, uint32_t water_nl)
{
    REQUIRE(f->impact_count < GLASS_MAX_IMPACTS);
    virga_impact_gpu *impact = (virga_impact_gpu *)((virga_impacts_gpu *)f->impacts.mapped + 1) + f->impact_count;
    *impact = (virga_impact_gpu){.position = {(float)u, (float)v, 0},
                                 .weight = 1,
                                 .id = virga_hash2(f->tick, f->impact_count),
                                 .water_nl = water_nl,
                                 .tick = f->tick};
    f->impact_count++;
    return impact;
}

/* One frame of `ticks` ticks. Reads back everything if `read`. */
static inline void glass_fixture_step(glass_fixture *f, uint32_t ticks, bool read)
{
    REQUIRE(virga_glass_set(f->glass, &f->settings) == VIRGA_OK);
    *(virga_impacts_gpu *)f->impacts.mapped =
        (virga_impacts_gpu){.count = f->impact_count, .first_tick = f->tick, .ticks = ticks};
    const VkCommandBuffer cmd = glass_fixture_begin(f);
    f->info.first_tick = f->tick;
    f->info.ticks = ticks;
    f->info.impacts = f->impact_count ? f->impacts.buffer : VK_NULL_HANDLE;
    REQUIRE(virga_glass_step(f->glass, cmd, &f->info) == VIRGA_OK);
    if (read)
        glass_fixture_read(f, cmd);
    glass_fixture_submit(f);
    if (read)
        host_buffer_invalidate(&f->gpu.device, &f->download);
    f->tick += ticks;
    f->impact_count = 0;
}

static inline uint64_t glass_fixture_count(const glass_fixture *f, uint32_t index)
{
    return (uint64_t)f->state->counts[index].high << 32 | f->state->counts[index].low;
}

static inline uint32_t glass_fixture_kind(const virga_glass_drop_gpu *drop)
{
    return drop->kind & VIRGA_GLASS_KIND;
}

/* Returns the number of validation messages plus the number of live objects: 0 if all is correct. */
static inline uint32_t glass_fixture_end(glass_fixture *f)
{
    virga_glass_destroy(&f->glass);
    virga_context_destroy(&f->context);
    host_buffer *const buffers[] = {&f->upload, &f->download, &f->impacts};
    return effect_fixture_end(&f->gpu, buffers, sizeof buffers / sizeof buffers[0]);
}

static inline void glass_fixture_close(glass_fixture *f)
{
    assert_int_equal(glass_fixture_end(f), 0);
}

/* Water on the pane, by what was read back: drops, film, and what blades carry. Free slots have none. */
static inline uint64_t glass_fixture_water(const glass_fixture *f)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < f->glass->def.max_drops; i++)
        if (glass_fixture_kind(&f->drops[i]) != VIRGA_GLASS_FREE)
            sum += f->drops[i].water_nl + f->drops[i].merged_nl;
        else
            REQUIRE(f->drops[i].water_nl == 0 && f->drops[i].merged_nl == 0);
    for (uint32_t i = 0; i < f->glass->columns * f->glass->rows; i++)
        sum += f->film[i];
    for (uint32_t i = 0; i < VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS; i++)
        sum += f->state->bins_nl[i];
    return sum;
}

#endif
