/* ground_fixture.h - ground on a device with validation, with floors, drops and water that a test chooses. */
#ifndef VIRGA_TESTS_GROUND_FIXTURE_H
#define VIRGA_TESTS_GROUND_FIXTURE_H

#include "../host/effect_fixture.h"

#include "ground/ground_internal.h"
#include "splash/splash_internal.h"

#include <virga/virga.h>

#define MAX_DROPS 16384

typedef struct ground_fixture {
    fixture gpu;
    virga_context *context;
    virga_ground *ground;
    virga_ground_settings settings;
    virga_splash *splash;       /* NULL: no splashes */
    bool flying;                /* droplets fly, and their water returns */
    VkBuffer returned_droplets; /* replaces the buffer of returns */
    host_buffer vertices, indices, impacts, upload, download;
    virga_occluder meshes[8];
    uint32_t mesh_count;
    virga_ground_material_map materials; /* overrides the materials of meshes */
    char logged[512];                    /* the last error */
    virga_impact_gpu drops[MAX_DROPS];   /* of the next step */
    uint32_t drop_count;
    float origin[3];          /* of their positions, in the world */
    VkDeviceSize list_offset; /* offset of the drops in their buffer, which then has exactly their size */
    uint32_t list_count;      /* drops according to the list's head; 0: the actual number */
    double camera[3];
    float open_rain_mm_h, open_drop_m; /* rain on ground where no drops are counted */
    float impacts_reach_m;
    const virga_wheel *wheels; /* of the next steps */
    uint32_t wheel_count;
    const virga_foot *feet;
    uint32_t foot_count;
    VkBuffer handed; /* where they throw droplets */
    VkBuffer water;  /* particles of simulated water */
    uint32_t water_count;
    float water_spacing_m;
    float handed_late_s;
    bool is_unseen;
    uint32_t tick;
    virga_cell_gpu *cells;   /* read back */
    virga_floor_gpu *floors; /* read back */
    virga_landing_gpu *landings;
    virga_spawns_gpu *spawns_head;
    virga_spawn_gpu *spawns;
} ground_fixture;

static inline void ground_fixture_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    ground_fixture *f = user;
    if (level != VIRGA_LOG_ERROR)
        return;
    snprintf(f->logged, sizeof f->logged, "%s", text);
    fprintf(stderr, "%s: %s\n", virga_log_name(id), text);
}

static inline void ground_fixture_open(ground_fixture *f)
{
    memset(f, 0, sizeof *f);
    f->context = effect_fixture_open(&f->gpu, false, ground_fixture_log, f);
}

/* Quads of ground: four corners and a material each. */
static inline void ground_fixture_quads(ground_fixture *f, const float (*corners)[4][3], const uint32_t *materials,
                                        uint32_t count)
{
    static const uint32_t pattern[6] = {0, 1, 2, 0, 2, 3};
    uint32_t indices[8 * 6];
    for (uint32_t i = 0; i < count * 6; i++)
        indices[i] = i / 6 * 4 + pattern[i % 6];
    REQUIRE(host_buffer_create_with(&f->gpu.device, corners, count * 48, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "quads",
                                    &f->vertices, f->gpu.error, sizeof f->gpu.error));
    REQUIRE(host_buffer_create_with(&f->gpu.device, indices, count * 24, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "indices",
                                    &f->indices, f->gpu.error, sizeof f->gpu.error));
    f->mesh_count = count;
    for (uint32_t i = 0; i < count; i++)
        f->meshes[i] = (virga_occluder){.vertices = f->vertices.buffer,
                                        .vertex_stride = 12,
                                        .indices = f->indices.buffer,
                                        .index_offset = i * 24,
                                        .index_type = VK_INDEX_TYPE_UINT32,
                                        .index_count = 6,
                                        .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                                        .material = materials ? materials[i] : VIRGA_MATERIAL_CUSTOM,
                                        .ground = true};
}

/* A level floor, 100 m on each side, at height 0. */
static inline void ground_fixture_floor(ground_fixture *f, uint32_t material)
{
    static const float quad[1][4][3] = {{{-50, 0, -50}, {50, 0, -50}, {50, 0, 50}, {-50, 0, 50}}};
    ground_fixture_quads(f, quad, &material, 1);
}

/* 128 x 128 cells of 5 cm around the origin. VIRGA_MATERIAL_CUSTOM is smooth and takes up nothing, nothing dries. */
static inline void ground_fixture_ground(ground_fixture *f, const virga_ground_def *given)
{
    virga_ground_def def = virga_default_ground_def();
    def.cells = 128;
    def.far_cells = 0;
    def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    if (given)
        def = *given;
    REQUIRE(virga_ground_create(f->context, &def, &f->ground) == VIRGA_OK);
    f->settings = virga_default_ground_settings();
    f->settings.evaporation_mm_h = 0;
    f->settings.materials[VIRGA_MATERIAL_CUSTOM] = (virga_ground_material){.manning_n = 0.013f, .bump_width_m = 1};
    REQUIRE(virga_ground_set(f->ground, &f->settings) == VIRGA_OK);
    const size_t cells = (size_t)def.cells * def.cells;
    char *error = f->gpu.error;
    const size_t size = sizeof f->gpu.error;
    REQUIRE(host_buffer_create(&f->gpu.device, 512 + sizeof(virga_impacts_gpu) + sizeof f->drops,
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                               HOST_BUFFER_UPLOAD, "drops", &f->impacts, error, size));
    memset(f->impacts.mapped, 0xff, f->impacts.size); /* what follows the list's drops belongs to no tick */
    REQUIRE(host_buffer_create(&f->gpu.device, cells * sizeof(virga_cell_gpu), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                               HOST_BUFFER_UPLOAD, "cells up", &f->upload, error, size));
    REQUIRE(host_buffer_create(
        &f->gpu.device,
        cells * (sizeof(virga_cell_gpu) + sizeof(virga_floor_gpu)) +
            ((VkDeviceSize)def.max_impacts + def.max_returned_droplets) * sizeof(virga_landing_gpu) +
            f->ground->spawns->size,
        VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "cells down", &f->download, error, size));
}

/* Splashes by the paper's table, on ground that is there. */
static inline void ground_fixture_splash(ground_fixture *f, bool flying)
{
    virga_splash_def def = virga_default_splash_def();
    virga_splash_settings settings = virga_default_splash_settings();
    settings.mode = VIRGA_SPLASH_MODE_PAPER;
    settings.droplet_range_m = 12;
    settings.dot_min_mm = 0.3f;
    def.max_spawns = f->ground->def.max_spawns > 256 ? f->ground->def.max_spawns : 256;
    def.max_returned_droplets = f->ground->def.max_returned_droplets;
    REQUIRE(virga_splash_create(f->context, &def, &f->splash) == VIRGA_OK);
    REQUIRE(virga_splash_set(f->splash, &settings) == VIRGA_OK);
    f->flying = flying;
}

/* A drop that falls vertically on the centre of a cell (cell numbers of the world). */
static inline virga_impact_gpu *ground_fixture_drop(ground_fixture *f, int x, int z, double height_m, uint32_t water_nl)
{
    REQUIRE(f->drop_count < MAX_DROPS);
    virga_impact_gpu *drop = &f->drops[f->drop_count];
    const double cell = (double)f->ground->def.cell_m;
    *drop = (virga_impact_gpu){.position = {(float)((x + 0.5) * cell), (float)height_m, (float)((z + 0.5) * cell)},
                               .velocity = {0, -6, 0},
                               .diameter_m = 2e-3f,
                               .normal = {0, 1, 0},
                               .weight = 1,
                               .id = f->drop_count,
                               .water_nl = water_nl};
    f->drop_count++;
    return drop;
}

static inline void ground_fixture_copy(VkCommandBuffer cmd, VkBuffer from, VkDeviceSize from_offset, VkBuffer to,
                                       VkDeviceSize to_offset, VkDeviceSize size)
{
    effect_fixture_transfers(cmd);
    const VkBufferCopy copy = {from_offset, to_offset, size};
    vkCmdCopyBuffer(cmd, from, to, 1, &copy);
}

static inline void ground_fixture_submit(ground_fixture *f)
{
    effect_fixture_complete(&f->gpu, f->context);
}

static inline void ground_fixture_read(ground_fixture *f, VkCommandBuffer cmd)
{
    const VkDeviceSize cells = f->ground->cells->size, landings = f->ground->landings->size;
    char *there = f->download.mapped;
    ground_fixture_copy(cmd, f->ground->cells->buffer, 0, f->download.buffer, 0, cells);
    ground_fixture_copy(cmd, f->ground->floors->buffer, 0, f->download.buffer, cells, cells);
    ground_fixture_copy(cmd, f->ground->landings->buffer, 0, f->download.buffer, 2 * cells, landings);
    ground_fixture_copy(cmd, f->ground->spawns->buffer, 0, f->download.buffer, 2 * cells + landings,
                        f->ground->spawns->size);
    f->cells = f->download.mapped;
    f->floors = (virga_floor_gpu *)(there + cells);
    f->landings = (virga_landing_gpu *)(there + 2 * cells);
    f->spawns_head = (virga_spawns_gpu *)(there + 2 * cells + landings);
    f->spawns = (virga_spawn_gpu *)(f->spawns_head + 1);
}

static inline void ground_fixture_ask_splash(ground_fixture *f, virga_ground_step_info *info)
{
    virga_splash_buffer rules = {0}, returned_droplets = {0};
    if (f->splash) {
        virga_splash_rules(f->splash, &rules);
        virga_splash_returned_droplets(f->splash, &returned_droplets);
    }
    info->splash_rules = rules.buffer;
    info->splash_rules_offset = rules.offset;
    info->returned_droplets = f->returned_droplets ? f->returned_droplets : returned_droplets.buffer;
    info->returned_droplets_offset = f->returned_droplets ? 0 : returned_droplets.offset;
}

static inline void ground_fixture_fly(ground_fixture *f, VkCommandBuffer cmd, uint32_t ticks)
{
    virga_splash_step_info info = {
        .camera_m = {f->camera[0], f->camera[1], f->camera[2]}, .first_tick = f->tick, .ticks = ticks};
    virga_ground_spawns(f->ground, &info.spawns, NULL);
    REQUIRE(virga_splash_step(f->splash, cmd, &info) == VIRGA_OK);
}

/* One frame of `ticks` ticks. The drops belong to its first tick, or to a later one by their `tick`. Reads back cells,
 * floors, landings and spawns. */
static inline void ground_fixture_step(ground_fixture *f, uint32_t ticks)
{
    virga_impacts_gpu *head = (virga_impacts_gpu *)((char *)f->impacts.mapped + f->list_offset);
    memset(head, 0, sizeof *head);
    head->count = f->list_count ? f->list_count : f->drop_count;
    head->group_count[0] = (f->drop_count + 63) / 64;
    head->group_count[1] = head->group_count[2] = 1;
    for (uint32_t i = 0; i < f->drop_count; i++)
        f->drops[i].tick += f->tick;
    memcpy(head->origin, f->origin, sizeof head->origin);
    memcpy(head + 1, f->drops, f->drop_count * sizeof f->drops[0]);
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    virga_ground_step_info info = {.camera_m = {f->camera[0], f->camera[1], f->camera[2]},
                                   .meshes = f->meshes,
                                   .mesh_count = f->mesh_count,
                                   .materials = f->materials,
                                   .impacts = f->impacts.buffer,
                                   .impacts_offset = f->list_offset,
                                   .impacts_size = f->list_offset ? sizeof *head + sizeof f->drops : 0,
                                   .first_tick = f->tick,
                                   .ticks = ticks,
                                   .open_rain_mm_h = f->open_rain_mm_h,
                                   .open_drop_m = f->open_drop_m,
                                   .impacts_reach_m = f->impacts_reach_m,
                                   .wheels = f->wheels,
                                   .wheel_count = f->wheel_count,
                                   .feet = f->feet,
                                   .foot_count = f->foot_count,
                                   .water = f->water,
                                   .water_count = f->water_count,
                                   .water_spacing_m = f->water_spacing_m,
                                   .handed = f->handed,
                                   .handed_late_s = f->handed_late_s,
                                   .is_unseen = f->is_unseen};
    ground_fixture_ask_splash(f, &info);
    REQUIRE(virga_ground_step(f->ground, cmd, &info) == VIRGA_OK);
    if (f->flying)
        ground_fixture_fly(f, cmd, ticks);
    ground_fixture_read(f, cmd);
    ground_fixture_submit(f);
    host_buffer_invalidate(&f->gpu.device, &f->download);
    f->tick += ticks;
    f->drop_count = 0;
}

/* Copies f->upload's contents into the cells. */
static inline void ground_fixture_put(ground_fixture *f)
{
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    ground_fixture_copy(cmd, f->upload.buffer, 0, f->ground->cells->buffer, 0, f->upload.size);
    ground_fixture_submit(f);
}

/* Index of a cell of the world in the buffers of a window of `tiles`. */
static inline uint32_t ground_fixture_index(const ground_fixture *f, int x, int z)
{
    const uint32_t mask = f->ground->window.tiles - 1;
    const uint32_t tile = (((uint32_t)z >> 6) & mask) * f->ground->window.tiles + (((uint32_t)x >> 6) & mask);
    return tile << 12 | ((uint32_t)z & 63) << 6 | ((uint32_t)x & 63);
}

static inline uint32_t ground_fixture_free(const ground_fixture *f, int x, int z)
{
    return f->cells[ground_fixture_index(f, x, z)].free_nl;
}

/* All water in the window. */
static inline uint64_t ground_fixture_sum(const ground_fixture *f)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < f->ground->def.cells * f->ground->def.cells; i++)
        sum += (uint64_t)f->cells[i].free_nl + f->cells[i].held_nl;
    return sum;
}

static inline void ground_fixture_close(ground_fixture *f)
{
    virga_splash_destroy(&f->splash);
    virga_ground_destroy(&f->ground);
    virga_context_destroy(&f->context);
    host_buffer *const buffers[] = {&f->vertices, &f->indices, &f->impacts, &f->upload, &f->download};
    assert_int_equal(effect_fixture_end(&f->gpu, buffers, sizeof buffers / sizeof buffers[0]), 0);
}

#endif
