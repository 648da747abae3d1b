/* splash_fixture.h - splashes on a device with validation, with spawns and droplets that a test chooses. */
#ifndef VIRGA_TESTS_SPLASH_FIXTURE_H
#define VIRGA_TESTS_SPLASH_FIXTURE_H

#include "../host/effect_fixture.h"

#include "splash/splash_internal.h"

#include <virga/shared/random.h>
#include <virga/virga.h>

/* fraction of a tick: a drop that falls then leaves its droplets no time to move */
#define JUST_BELOW_1 0x1.fffffep-1f

typedef struct splash_fixture {
    fixture gpu;
    virga_context *context;
    virga_splash *splash;
    virga_splash_settings settings; /* mode paper, all of the wind */
    host_buffer spawns, upload, download;
    uint32_t spawn_count; /* of the next step */
    double camera[3];
    float wind[3];
    float rain_mm_h;
    uint32_t tick;
    /* Read back. */
    const virga_splash_state_gpu *state;
    const virga_droplet_gpu *droplets;
    const virga_splash_gpu *splashes;
    const virga_impacts_gpu *returns_head;
    const virga_impact_gpu *returned_droplets;
    const virga_drip_gpu *drips; /* NULL without def.max_drips */
} splash_fixture;

/* Small rings, and ticks of the default length. */
static inline virga_splash_def splash_fixture_def(void)
{
    virga_splash_def def = virga_default_splash_def();
    def.max_splashes = 4096;
    def.max_droplets = 16384;
    def.max_spawns = 4096;
    def.max_returned_droplets = 16384;
    return def;
}

static inline void splash_fixture_buffers(splash_fixture *f)
{
    const virga_splash *splash = f->splash;
    const VkDeviceSize state = splash->state->size, droplets = splash_droplets(splash)->size;
    const VkDeviceSize drips = splash->drip_waters ? splash->drip_waters->size : 0;
    char *error = f->gpu.error;
    const size_t size = sizeof f->gpu.error;
    REQUIRE(host_buffer_create(&f->gpu.device,
                               sizeof(virga_spawns_gpu) + splash->def.max_spawns * sizeof(virga_spawn_gpu),
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                               HOST_BUFFER_UPLOAD, "spawns", &f->spawns, error, size));
    REQUIRE(host_buffer_create(&f->gpu.device, state + droplets, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD,
                               "droplets up", &f->upload, error, size));
    REQUIRE(host_buffer_create(
        &f->gpu.device, state + droplets + splash->splashes->size + splash->returned_droplets->size + drips,
        VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "droplets down", &f->download, error, size));
}

static inline void splash_fixture_open(splash_fixture *f, const virga_splash_def *given)
{
    memset(f, 0, sizeof *f);
    f->context = effect_fixture_open(&f->gpu, false, effect_fixture_log, NULL);
    const virga_splash_def small = splash_fixture_def();
    REQUIRE(virga_splash_create(f->context, given ? given : &small, &f->splash) == VIRGA_OK);
    f->settings = virga_default_splash_settings();
    f->settings.mode = VIRGA_SPLASH_MODE_PAPER;
    f->settings.wind_share = 1; /* as in the paper */
    REQUIRE(virga_splash_set(f->splash, &f->settings) == VIRGA_OK);
    splash_fixture_buffers(f);
}

/* Adds a splash to the next step: a drop of 2 mm that falls vertically at the origin, at the start of the step's first
 * tick, on level ground of a material in a state. */
static inline virga_spawn_gpu *splash_fixture_spawn(splash_fixture *f, uint32_t material, uint32_t state)
{
    static const float depths_m[VIRGA_GROUND_STATES] = {0, 0, 0.5e-3f, 4e-3f, 7e-3f, 20e-3f};
    REQUIRE(f->spawn_count < f->splash->def.max_spawns);
    virga_spawn_gpu *spawn = (virga_spawn_gpu *)((virga_spawns_gpu *)f->spawns.mapped + 1) + f->spawn_count;
    const uint32_t model = f->settings.rules[material][state].model;
    *spawn = (virga_spawn_gpu){.velocity = {0, -6.5f, 0},
                               .diameter_m = 2e-3f,
                               .normal = {0, 1, 0},
                               .depth_m = depths_m[state],
                               .weight = 1,
                               .drops = 1,
                               .id = f->spawn_count,
                               .tick = f->tick,
                               .water_nl = model == VIRGA_SPLASH_DISK ? 0 : 400,
                               .random = virga_hash2(f->tick, f->spawn_count),
                               .kind = state | material << 8 | model << 16};
    f->spawn_count++;
    return spawn;
}

static inline VkCommandBuffer splash_fixture_begin(splash_fixture *f)
{
    return effect_fixture_begin(&f->gpu, f->context);
}

static inline void splash_fixture_submit(splash_fixture *f)
{
    effect_fixture_complete(&f->gpu, f->context);
}

static inline const void *splash_fixture_copy(const splash_fixture *f, VkCommandBuffer cmd, const virga_buffer *from,
                                              VkDeviceSize *offset)
{
    return effect_fixture_copy(cmd, from->buffer, from->size, &f->download, offset);
}

static inline void splash_fixture_read(splash_fixture *f, VkCommandBuffer cmd)
{
    VkDeviceSize offset = 0;
    effect_fixture_transfers(cmd);
    f->state = splash_fixture_copy(f, cmd, f->splash->state, &offset);
    f->droplets = splash_fixture_copy(f, cmd, splash_droplets(f->splash), &offset);
    f->splashes = splash_fixture_copy(f, cmd, f->splash->splashes, &offset);
    f->returns_head = splash_fixture_copy(f, cmd, f->splash->returned_droplets, &offset);
    f->returned_droplets = (const virga_impact_gpu *)(f->returns_head + 1);
    f->drips = f->splash->drip_waters ? splash_fixture_copy(f, cmd, f->splash->drip_waters, &offset) : NULL;
}

/* One frame of `ticks` ticks with the spawns set. Reads back everything. */
static inline void splash_fixture_step(splash_fixture *f, uint32_t ticks)
{
    *(virga_spawns_gpu *)f->spawns.mapped = (virga_spawns_gpu){.count = f->spawn_count,
                                                               .capacity = f->splash->def.max_spawns,
                                                               .group_count = {(f->spawn_count + 63) / 64, 1, 1},
                                                               .tick_s = (float)f->splash->def.tick_s,
                                                               .first_tick = f->tick,
                                                               .ticks = ticks};
    const VkCommandBuffer cmd = splash_fixture_begin(f);
    const virga_splash_step_info info = {.camera_m = {f->camera[0], f->camera[1], f->camera[2]},
                                         .spawns = f->spawns.buffer,
                                         .first_tick = f->tick,
                                         .ticks = ticks,
                                         .wind_m_s = {f->wind[0], f->wind[1], f->wind[2]},
                                         .rain_mm_h = f->rain_mm_h};
    REQUIRE(virga_splash_step(f->splash, cmd, &info) == VIRGA_OK);
    splash_fixture_read(f, cmd);
    splash_fixture_submit(f);
    host_buffer_invalidate(&f->gpu.device, &f->download);
    f->tick += ticks;
    f->spawn_count = 0;
}

/* Exactly these droplets are in the air; all counts are reset. */
static inline void splash_fixture_put(splash_fixture *f, const virga_droplet_gpu *droplets, uint32_t count)
{
    if (!f->splash->base.contents)
        splash_fixture_step(f, 0);
    const VkDeviceSize state_size = f->splash->state->size, size = splash_droplets(f->splash)->size;
    virga_splash_state_gpu *state = f->upload.mapped;
    memset(f->upload.mapped, 0, state_size + size);
    state->staying = count;
    if (count)
        memcpy((char *)f->upload.mapped + state_size, droplets, count * sizeof *droplets);
    const VkCommandBuffer cmd = splash_fixture_begin(f);
    effect_fixture_transfers(cmd);
    const VkBufferCopy copies[2] = {{0, 0, state_size}, {state_size, 0, size}};
    vkCmdCopyBuffer(cmd, f->upload.buffer, f->splash->state->buffer, 1, &copies[0]);
    vkCmdCopyBuffer(cmd, f->upload.buffer, splash_droplets(f->splash)->buffer, 1, &copies[1]);
    splash_fixture_submit(f);
}

static inline void splash_fixture_clear(splash_fixture *f)
{
    splash_fixture_put(f, NULL, 0);
}

static inline uint64_t splash_fixture_count(const splash_fixture *f, uint32_t index)
{
    return (uint64_t)f->state->counts[index].high << 32 | f->state->counts[index].low;
}

/* Water of all droplets in the air. */
static inline uint64_t splash_fixture_water(const splash_fixture *f)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < f->state->staying; i++)
        sum += f->droplets[i].water_nl;
    return sum;
}

/* Returns the number of validation messages plus the number of live objects: 0 if all is correct. */
static inline uint32_t splash_fixture_end(splash_fixture *f)
{
    virga_splash_destroy(&f->splash);
    virga_context_destroy(&f->context);
    host_buffer *const buffers[] = {&f->spawns, &f->upload, &f->download};
    return effect_fixture_end(&f->gpu, buffers, sizeof buffers / sizeof buffers[0]);
}

static inline void splash_fixture_close(splash_fixture *f)
{
    assert_int_equal(splash_fixture_end(f), 0);
}

#endif
