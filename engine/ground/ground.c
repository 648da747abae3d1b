/* ground/ground.c - create, destroy, settings, and what others read. */
#include "ground/ground_internal.h"

#include "core/settings.h"
#include "gpu/budget.h"
#include "gpu/builds.h"
#include "gpu/checks.h"
#include "gpu/errors.h"

#include "shaders/ground_far_floor_comp.spv.h"
#include "shaders/ground_far_map_comp.spv.h"
#include "shaders/ground_flow_comp.spv.h"
#include "shaders/ground_land_comp.spv.h"
#include "shaders/ground_map_comp.spv.h"
#include "shaders/ground_measure_comp.spv.h"
#include "shaders/ground_ring_comp.spv.h"
#include "shaders/ground_share_comp.spv.h"
#include "shaders/ground_soak_comp.spv.h"
#include "shaders/ground_spawn_mark_comp.spv.h"
#include "shaders/ground_spawn_scan_comp.spv.h"
#include "shaders/ground_tile_discard_comp.spv.h"
#include "shaders/ground_tile_load_comp.spv.h"

#include <math.h>
#include <string.h>

#define DEF_COOKIE      VIRGA_COOKIE(7)
#define SETTINGS_COOKIE VIRGA_COOKIE(8)

/* ---- defaults */

virga_ground_def virga_default_ground_def(void)
{
    return (virga_ground_def){.size = sizeof(virga_ground_def),
                              .cookie = DEF_COOKIE,
                              .seed = 1,
                              .cells = 1024,
                              .cell_m = 0.05f,
                              .kept_tiles = 1024,
                              .far_cells = 512,
                              .tick_s = 1.0 / 60,
                              .flow_ticks = 4,
                              .ripple_texels = 1024,
                              .ripple_texel_m = 0.005f,
                              .max_impacts = 65536,
                              .max_spawns = 65536,
                              .max_returns = 131072,
                              .max_ticks_per_step = 16,
                              .occluder_strides = {12, 32}};
}

virga_ground_settings virga_default_ground_settings(void)
{
    virga_ground_settings settings = {
        .size = sizeof settings, .cookie = SETTINGS_COOKIE, .evaporation_mm_h = 0.2f, .measure = true};
    ground_default_materials(settings.materials);
    return settings;
}

/* All of the window twice: a cut of the camera and back loses nothing. */
static uint32_t least_kept(uint32_t tiles, uint32_t asked)
{
    return asked > 2 * tiles * tiles ? asked : 2 * tiles * tiles;
}

/* Whole groups of cells, and twice as wide as the window. */
static uint32_t fit_far(uint32_t cells, uint32_t asked)
{
    const uint32_t least = 2 * cells / VIRGA_GROUND_FAR_CELL > 128 ? 2 * cells / VIRGA_GROUND_FAR_CELL : 128;
    return !asked ? 0 : asked < least ? least : asked / VIRGA_GROUND_TILE * VIRGA_GROUND_TILE;
}

static virga_result check_def(const virga_log *log, const virga_ground_def *given, virga_ground_def *def)
{
    const virga_result result =
        virga_settings_check(log, "ground_def", given->size, sizeof *given, given->cookie, DEF_COOKIE);
    if (result)
        return result;
    if (virga_settings_finite(log, "ground_def.cell_m", &given->cell_m, 1) ||
        virga_settings_finite_double(log, "ground_def.tick_s", &given->tick_s, 1))
        return VIRGA_ERROR_INVALID;
    *def = *given;
    def->cells = virga_clamp_setting_u32(log, "ground_def.cells", def->cells, 128, 4096, NULL);
    if (def->cells & (def->cells - 1))
        return virga_wrong_argument(log, "ground_def.cells: expected a power of two, got %u", def->cells);
    def->cell_m = virga_clamp_setting_float(log, "ground_def.cell_m", def->cell_m, 0.01f, 0.1f, NULL);
    def->kept_tiles = virga_clamp_setting_u32(log, "ground_def.kept_tiles", def->kept_tiles, 0, 60000, NULL);
    def->kept_tiles = least_kept(def->cells / VIRGA_GROUND_TILE, def->kept_tiles);
    def->far_cells = virga_clamp_setting_u32(log, "ground_def.far_cells", def->far_cells, 0, 2048, NULL);
    def->far_cells = fit_far(def->cells, def->far_cells);
    if (virga_settings_finite(log, "ground_def.ripple_texel_m", &def->ripple_texel_m, 1))
        return VIRGA_ERROR_INVALID;
    def->ripple_texels = virga_clamp_setting_u32(log, "ground_def.ripple_texels", def->ripple_texels, 64, 4096, NULL);
    def->ripple_texel_m =
        virga_clamp_setting_float(log, "ground_def.ripple_texel_m", def->ripple_texel_m, 0.002f, 0.05f, NULL);
    def->tick_s = virga_clamp_setting(log, "ground_def.tick_s", def->tick_s, 1e-3, 0.05, NULL);
    def->flow_ticks = virga_clamp_setting_u32(log, "ground_def.flow_ticks", def->flow_ticks, 1, 60, NULL);
    def->max_impacts = virga_clamp_setting_u32(log, "ground_def.max_impacts", def->max_impacts, 256, 4194240, NULL);
    def->max_spawns = virga_clamp_setting_u32(log, "ground_def.max_spawns", def->max_spawns, 0, 1048576, NULL);
    def->max_returns = virga_clamp_setting_u32(log, "ground_def.max_returns", def->max_returns, 0, 4194240, NULL);
    def->max_ticks_per_step =
        virga_clamp_setting_u32(log, "ground_def.max_ticks_per_step", def->max_ticks_per_step, 1, 64, NULL);
    for (int i = 0; i < 4; i++)
        if (def->occluder_strides[i] && (def->occluder_strides[i] < 12 || def->occluder_strides[i] % 4))
            return virga_wrong_argument(log, "ground_def.occluder_strides: expected multiples of 4 from 12, got %u",
                                        def->occluder_strides[i]);
    return VIRGA_OK;
}

VkDeviceSize virga_ground_estimate(const virga_ground_def *given)
{
    virga_ground_def def;
    if (!given || check_def(NULL, given, &def))
        return 0;
    const VkDeviceSize cells = (VkDeviceSize)def.cells * def.cells;
    const VkDeviceSize a_cell = sizeof(virga_floor_gpu) + sizeof(virga_cell_gpu) + sizeof(virga_arrivals_gpu) +
                                8 /* spots */ + 8 /* stirs, swings */ + 16 /* maps */ + 8 /* survey */;
    return cells * a_cell + (VkDeviceSize)def.kept_tiles * VIRGA_GROUND_TILE_CELLS * 16 +
           ((VkDeviceSize)def.max_impacts + def.max_returns) * sizeof(virga_landing_gpu) + sizeof(virga_spawns_gpu) +
           (VkDeviceSize)def.max_spawns * sizeof(virga_spawn_gpu) + sizeof(virga_splash_rules_gpu) +
           ground_far_estimate(&def) + (VkDeviceSize)def.ripple_texels * def.ripple_texels * 4 +
           VIRGA_RINGS * sizeof(virga_ring_gpu) + 8ull * VIRGA_RING_DEPTHS * VIRGA_RING_TIMES * VIRGA_RING_RADII +
           (VkDeviceSize)VIRGA_MAX_FRAMES_IN_FLIGHT *
               ((def.max_ticks_per_step + 1) * ground_tick_bytes() + ground_list_bytes());
}

/* ---- creating */

static virga_result create_buffers(virga_ground *ground)
{
    const VkDeviceSize cells = (VkDeviceSize)ground->def.cells * ground->def.cells;
    const VkDeviceSize kept = (VkDeviceSize)ground->def.kept_tiles * VIRGA_GROUND_TILE_CELLS;
    const uint32_t frames = ground->context->frames_in_flight;
    const VkBufferUsageFlags storage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const VkBufferUsageFlags texels = storage | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    const virga_buffer_row wanted[] = {
        {&ground->floors, cells * sizeof(virga_floor_gpu), texels, VIRGA_HEAP_DEVICE, "ground.floors"},
        {&ground->cells, cells * sizeof(virga_cell_gpu), texels, VIRGA_HEAP_DEVICE, "ground.cells"},
        {&ground->arrivals, cells * sizeof(virga_arrivals_gpu), storage, VIRGA_HEAP_DEVICE, "ground.arrivals"},
        {&ground->stirs, cells * sizeof(uint32_t), storage, VIRGA_HEAP_DEVICE, "ground.stirs"},
        {&ground->swings, cells * sizeof(uint32_t), storage, VIRGA_HEAP_DEVICE, "ground.swings"},
        {&ground->spots, cells * 8, storage, VIRGA_HEAP_DEVICE, "ground.spots"},
        {&ground->kept_cells, kept * sizeof(virga_cell_gpu), storage, VIRGA_HEAP_DEVICE, "ground.kept_cells"},
        {&ground->kept_spots, kept * 8, storage, VIRGA_HEAP_DEVICE, "ground.kept_spots"},
        {&ground->counts, sizeof(ground_readback), storage, VIRGA_HEAP_DEVICE, "ground.counts"},
        {&ground->landings,
         ((VkDeviceSize)ground->def.max_impacts + ground->def.max_returns) * sizeof(virga_landing_gpu), storage,
         VIRGA_HEAP_DEVICE, "ground.landings"},
        {&ground->spawns, sizeof(virga_spawns_gpu) + (VkDeviceSize)ground->def.max_spawns * sizeof(virga_spawn_gpu),
         storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, VIRGA_HEAP_DEVICE, "ground.spawns"},
        {&ground->no_rules, sizeof(virga_splash_rules_gpu),
         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, VIRGA_HEAP_DEVICE, "ground.no_rules"},
        {&ground->rings, sizeof(virga_rings_gpu) + VIRGA_RINGS * sizeof(virga_ring_gpu), storage, VIRGA_HEAP_DEVICE,
         "ground.rings"},
        {&ground->tick_ring, (VkDeviceSize)frames * (ground->def.max_ticks_per_step + 1) * ground_tick_bytes(),
         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, VIRGA_HEAP_UPLOAD, "ground.ticks"},
        {&ground->list_ring, (VkDeviceSize)frames * ground_list_bytes(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
         VIRGA_HEAP_UPLOAD, "ground.lists"},
        {&ground->readback_ring, frames * sizeof(ground_readback), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
         VIRGA_HEAP_READBACK, "ground.readback"},
    };
    return virga_buffers_create(ground->context, wanted, sizeof wanted / sizeof wanted[0]);
}

static virga_result create_images(virga_ground *ground)
{
    virga_result result = VIRGA_OK;
    const uint32_t cells = ground->def.cells;
    const VkImageUsageFlags usage =
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    TRY(virga_image_create(ground->context, VK_FORMAT_R16G16B16A16_SFLOAT, (VkExtent2D){cells, cells}, 1, usage,
                           VK_IMAGE_ASPECT_COLOR_BIT, "ground.wet_map", &ground->wet_map));
    TRY(virga_image_create(ground->context, VK_FORMAT_R32_UINT, (VkExtent2D){2 * cells, cells}, 1, usage,
                           VK_IMAGE_ASPECT_COLOR_BIT, "ground.spot_map", &ground->spot_map));
    TRY(virga_image_create(ground->context, VK_FORMAT_R8_UINT, (VkExtent2D){1, 1}, 1, VK_IMAGE_USAGE_SAMPLED_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, "ground.blank_materials", &ground->blank_materials));
    TRY(virga_mesh_map_create(ground->context, cells, 1, ground->def.occluder_strides, "ground.survey", &ground->needed,
                              &ground->survey));
    TRY(ground_far_create(ground));
error:
    return result;
}

#define COMPUTE VK_SHADER_STAGE_COMPUTE_BIT

/* As in shaders/ground: what each file declares. */
static const virga_binding_kind kinds[] = {
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VIRGA_ALL_STAGES},             /* 0 tick */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, COMPUTE},                      /* 1 lists of tiles */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 2 impacts */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 3 floors */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 4 cells */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 5 stirs */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 6 arrivals */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 7 spots */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 8 kept cells */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 9 counts */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 10 landings */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, COMPUTE},                      /* 11 survey: depth */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, COMPUTE},                      /* 12 survey: surface */
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, COMPUTE},                               /* 13 wet map */
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, COMPUTE},                               /* 14 spot map */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE | VK_SHADER_STAGE_VERTEX_BIT}, /* 15 rings */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT}, /* 16 waves */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, COMPUTE},                      /* 17 material map */
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, COMPUTE},                              /* 18 rules of splashes */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 19 spawns */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 20 swings */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, COMPUTE},                        /* 21 floors as texels */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, COMPUTE},                        /* 22 cells as texels */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 23 far floors */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, COMPUTE},                      /* 24 far survey: depth */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, COMPUTE},                      /* 25 far survey: surface */
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, COMPUTE},                               /* 26 far map */
};

enum { BINDINGS = sizeof kinds / sizeof kinds[0] };

static virga_bound whole(const virga_buffer *buffer)
{
    return (virga_bound){.buffer = buffer->buffer};
}

/* A host's impacts or returns. */
static virga_bound host_list(const virga_ground *ground, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size,
                             uint32_t entries)
{
    const VkDeviceSize most = sizeof(virga_impacts_gpu) + (VkDeviceSize)entries * sizeof(virga_impact_gpu);
    return (virga_bound){
        .buffer = buffer, .offset = offset, .range = virga_host_list_range(ground->context, size, most)};
}

static void write_set(virga_ground *ground, uint32_t source)
{
    const VkImageLayout read_only = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, general = VK_IMAGE_LAYOUT_GENERAL;
    const VkSampler nearest = ground->context->nearest;
    const virga_ground_step_info *info = &ground->info;
    const bool returns = source == GROUND_RETURNS, mapped = info->materials.image.view != VK_NULL_HANDLE;
    const virga_bound rules = {
        .buffer = info->splash_rules, .offset = info->splash_rules_offset, .range = sizeof(virga_splash_rules_gpu)};
    const virga_bound bound[BINDINGS] = {
        {.buffer = ground->tick_ring->buffer, .range = sizeof(virga_ground_tick_gpu)},
        {.buffer = ground->list_ring->buffer, .range = sizeof(ground_lists)},
        returns ? host_list(ground, info->returns, info->returns_offset, info->returns_size, ground->def.max_returns)
                : host_list(ground, info->impacts, info->impacts_offset, info->impacts_size, ground->def.max_impacts),
        whole(ground->floors),
        whole(ground->cells),
        whole(ground->stirs),
        whole(ground->arrivals),
        whole(ground->spots),
        whole(ground->kept_cells),
        whole(ground->counts),
        whole(ground->landings),
        {.sampler = nearest, .view = ground->survey->depth->view, .image_layout = read_only},
        {.sampler = nearest, .view = ground->survey->surface->view, .image_layout = read_only},
        {.view = ground->wet_map->view, .image_layout = general},
        {.view = ground->spot_map->view, .image_layout = general},
        whole(ground->rings),
        {.sampler = ground->context->nearest, .view = ground->ripples->waves->view, .image_layout = read_only},
        {.sampler = nearest,
         .view = mapped ? info->materials.image.view : ground->blank_materials->layer_views[0],
         .image_layout = mapped ? info->materials.image.before.layout : read_only},
        info->splash_rules ? rules : whole(ground->no_rules),
        whole(ground->spawns),
        whole(ground->swings),
        {.texels = ground->floors->texels},
        {.texels = ground->cells->texels},
        whole(ground->far.floors),
        {.sampler = nearest, .view = ground->far.survey->depth->view, .image_layout = read_only},
        {.sampler = nearest, .view = ground->far.survey->surface->view, .image_layout = read_only},
        {.view = ground->far.map->view, .image_layout = general}};
    ground->sets[source] = virga_bindings_write(ground->context, ground->bindings, source, bound);
}

void ground_write_sets(virga_ground *ground)
{
    write_set(ground, GROUND_DROPS);
    if (ground->info.returns)
        write_set(ground, GROUND_RETURNS);
}

static virga_result create_pipelines(virga_ground *ground)
{
    const virga_compute_row passes[] = {
        {&ground->adopt, VIRGA_SPIRV(ground_tile_load_comp), "ground.tile_load"},
        {&ground->forget, VIRGA_SPIRV(ground_tile_discard_comp), "ground.tile_discard"},
        {&ground->spawn_find, VIRGA_SPIRV(ground_spawn_mark_comp), "ground.spawn_mark"},
        {&ground->spawn_scan, VIRGA_SPIRV(ground_spawn_scan_comp), "ground.spawn_scan"},
        {&ground->land, VIRGA_SPIRV(ground_land_comp), "ground.land"},
        {&ground->share, VIRGA_SPIRV(ground_share_comp), "ground.share"},
        {&ground->soak, VIRGA_SPIRV(ground_soak_comp), "ground.soak"},
        {&ground->flow, VIRGA_SPIRV(ground_flow_comp), "ground.flow"},
        {&ground->ring, VIRGA_SPIRV(ground_ring_comp), "ground.ring"},
        {&ground->measure, VIRGA_SPIRV(ground_measure_comp), "ground.measure"},
        {&ground->map, VIRGA_SPIRV(ground_map_comp), "ground.map"},
        {&ground->far.find_floors, VIRGA_SPIRV(ground_far_floor_comp), "ground.far_floor"},
        {&ground->far.draw, VIRGA_SPIRV(ground_far_map_comp), "ground.far_map"},
    };
    const virga_compute_def kept = {.shader = VIRGA_SPIRV(ground_measure_comp),
                                    .layout = ground->bindings->layout,
                                    .constant = VK_TRUE,
                                    .group = &ground->needed,
                                    .name = "ground.measure_kept"};
    virga_result result = VIRGA_OK;
    TRY(virga_compute_pipelines_create(ground->context, ground->bindings->layout, 0, &ground->needed, passes,
                                       sizeof passes / sizeof passes[0]));
    TRY(virga_compute_pipeline_create(ground->context, &kept, &ground->measure_kept));
error:
    return result;
}

static virga_result init(virga_ground *ground)
{
    virga_result result = VIRGA_OK;
    ground->window.tiles = ground->def.cells / VIRGA_GROUND_TILE;
    ground->window.kept_capacity = ground->def.kept_tiles;
    ground->window.kept =
        virga_alloc_array(&ground->context->heap, ground->def.kept_tiles, sizeof ground->window.kept[0]);
    if (!ground->window.kept)
        return virga_out_of_host_memory(ground->context, "the tiles of the ground");
    TRY(create_buffers(ground));
    TRY(create_images(ground));
    TRY(virga_bindings_create(ground->context, kinds, BINDINGS, GROUND_SOURCES, sizeof(uint32_t), &ground->bindings));
    TRY(ground_ripples_create(ground->context, ground->def.ripple_texels, (double)ground->def.ripple_texel_m,
                              ground->bindings->layout, &ground->needed, &ground->ripples));
    TRY(create_pipelines(ground));
error:
    return result;
}

static virga_result make(virga_context *context, const void *def, void **ground)
{
    virga_ground *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, "ground");
    made->context = context;
    made->def = *(const virga_ground_def *)def;
    const uint32_t tiles = made->def.cells / VIRGA_GROUND_TILE;
    made->def.kept_tiles = least_kept(tiles, made->def.kept_tiles);
    made->def.far_cells = fit_far(made->def.cells, made->def.far_cells);
    made->settings = virga_default_ground_settings(); /* dry: as memory of zeros is */
    context->effects++;
    const virga_result result = init(made);
    if (result < 0)
        virga_ground_destroy(&made);
    *ground = made;
    return result;
}

/* Its window, what it keeps beyond that, and the map of ripples. What it shares with rain and splashes stays. */
static virga_result make_in_budget(virga_context *context, virga_ground_def *def, virga_ground **ground)
{
    const virga_pool pools[] = {
        {"cells", &def->cells, 128, 0},
        {"kept_tiles", &def->kept_tiles, 0, 1},
        {"ripple_texels", &def->ripple_texels, 64, 1},
        {"far_cells", &def->far_cells, 0, VIRGA_GROUND_TILE},
    };
    void *made = NULL;
    const virga_result result = virga_make_in_budget(context, "the ground", pools, 4, make, def, &made);
    *ground = made;
    return result;
}

virga_result virga_ground_create(virga_context *context, const virga_ground_def *given, virga_ground **ground)
{
    if (ground)
        *ground = NULL;
    if (!context || !given || !ground)
        return virga_wrong_argument(context ? &context->log : NULL, "virga_ground_create: NULL argument");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    virga_ground_def def;
    virga_result result = check_def(&context->log, given, &def);
    if (result)
        return result;
    virga_ground *made = NULL;
    result = make_in_budget(context, &def, &made);
    if (result < 0)
        return result;
    virga_log_say(&context->log, VIRGA_LOG_INFO, VIRGA_LOG_CREATED,
                  "ground: %u x %u cells of %g m, %u tiles kept, %.1f MB of device memory in use", made->def.cells,
                  made->def.cells, (double)made->def.cell_m, made->def.kept_tiles, (double)context->device_used * 1e-6);
    *ground = made;
    return result;
}

void virga_ground_destroy(virga_ground **ground)
{
    if (!ground || !*ground)
        return;
    virga_ground *dying = *ground;
    virga_context *context = dying->context;
    virga_pipeline **pipelines[] = {&dying->adopt,           &dying->forget,     &dying->land,
                                    &dying->share,           &dying->soak,       &dying->flow,
                                    &dying->measure,         &dying->map,        &dying->ring,
                                    &dying->spawn_find,      &dying->spawn_scan, &dying->measure_kept,
                                    &dying->far.find_floors, &dying->far.draw};
    for (size_t i = 0; i < sizeof pipelines / sizeof pipelines[0]; i++)
        VIRGA_RETIRE(context, *pipelines[i]);
    virga_buffer **buffers[] = {&dying->floors,     &dying->cells,         &dying->arrivals, &dying->spots,
                                &dying->kept_cells, &dying->kept_spots,    &dying->counts,   &dying->landings,
                                &dying->rings,      &dying->stirs,         &dying->swings,   &dying->tick_ring,
                                &dying->list_ring,  &dying->readback_ring, &dying->spawns,   &dying->no_rules};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        VIRGA_RETIRE(context, *buffers[i]);
    VIRGA_RETIRE(context, dying->wet_map);
    VIRGA_RETIRE(context, dying->spot_map);
    VIRGA_RETIRE(context, dying->blank_materials);
    virga_mesh_map_retire(context, &dying->survey);
    ground_far_retire(dying);
    ground_ripples_retire(context, &dying->ripples);
    VIRGA_RETIRE(context, dying->bindings);
    virga_free(&context->heap, dying->window.kept);
    context->effects--;
    virga_free(&context->heap, dying);
    *ground = NULL;
}

virga_result virga_ground_ready(const virga_ground *ground)
{
    return !ground                 ? VIRGA_ERROR_INVALID
           : ground->context->lost ? VIRGA_ERROR_DEVICE_LOST
                                   : virga_group_ready(&ground->needed);
}

virga_result virga_ground_set(virga_ground *ground, const virga_ground_settings *settings)
{
    if (!ground)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &ground->context->log;
    if (!settings)
        return virga_wrong_argument(log, "virga_ground_set: NULL argument");
    if (ground->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    virga_result result = virga_settings_check(log, "ground_settings", settings->size, sizeof *settings,
                                               settings->cookie, SETTINGS_COOKIE);
    if (result)
        return result;
    virga_ground_settings taken = *settings;
    result = ground_check_settings(log, &taken);
    if (result < 0)
        return result;
    const bool other = taken.start_wetness != ground->settings.start_wetness ||
                       taken.start_water_mm != ground->settings.start_water_mm;
    ground->settings = taken;
    if (other || !ground->started) {
        virga_soil_gpu soils[VIRGA_GROUND_MATERIALS];
        ground_fill_soils(&taken, (double)ground->def.cell_m, soils);
        ground_standing_start(ground->standing, &taken, soils);
    }
    return result;
}

void virga_ground_get(const virga_ground *ground, virga_ground_settings *settings)
{
    if (ground && settings)
        *settings = ground->settings;
}

void virga_ground_survey(virga_ground *ground)
{
    if (ground)
        ground->survey_all = true;
}

/* ---- what others read */

void virga_ground_maps_get(const virga_ground *ground, virga_ground_maps *maps)
{
    if (!maps)
        return;
    memset(maps, 0, sizeof *maps);
    if (!ground)
        return;
    const double tile_m = VIRGA_GROUND_TILE * (double)ground->def.cell_m;
    *maps = (virga_ground_maps){.wet = ground->wet_map->layer_views[0],
                                .spots = ground->spot_map->layer_views[0],
                                .cells = ground->def.cells,
                                .cell_m = ground->def.cell_m,
                                .base_m = (float)ground->base_m};
    maps->ripples = ground->ripples->map->layer_views[0];
    maps->ripple_texels = ground->def.ripple_texels;
    maps->ripple_texel_m = ground->def.ripple_texel_m;
    maps->reach_m = fmaxf((float)((0.5 * ground->window.tiles - 1.5) * tile_m), 0); /* none of two tiles */
    if (ground->info.impacts_reach_m > 0 && ground->info.impacts_reach_m < maps->reach_m)
        maps->reach_m = ground->info.impacts_reach_m;
    ground_far_maps(ground, maps);
    for (int axis = 0; axis < 2; axis++) {
        maps->ripple_low_m[axis] = ground->ripple_low_m[axis];
        maps->low_m[axis] = ground->window.low[axis] * tile_m;
        maps->high_m[axis] = (ground->window.low[axis] + (int32_t)ground->window.tiles) * tile_m;
    }
}

uint32_t ground_nl_per_um(const virga_ground *ground)
{
    const double cell_m = (double)ground->def.cell_m;
    return (uint32_t)floor(cell_m * cell_m * 1e6 + 0.5);
}

void virga_ground_cells_get(const virga_ground *ground, virga_ground_cells *cells)
{
    if (!cells)
        return;
    memset(cells, 0, sizeof *cells);
    if (!ground)
        return;
    *cells = (virga_ground_cells){.floors = ground->floors->buffer,
                                  .cells = ground->cells->buffer,
                                  .size = ground->cells->size,
                                  .tiles = ground->window.tiles,
                                  .low_tile = {ground->window.low[0], ground->window.low[1]},
                                  .nl_per_um = ground_nl_per_um(ground),
                                  .base_m = (float)ground->base_m};
}

void virga_ground_landings(const virga_ground *ground, VkBuffer *buffer, VkDeviceSize *size)
{
    if (buffer)
        *buffer = ground ? ground->landings->buffer : VK_NULL_HANDLE;
    if (size)
        *size = ground ? ground->landings->size : 0;
}

void virga_ground_spawns(const virga_ground *ground, VkBuffer *buffer, VkDeviceSize *size)
{
    if (buffer)
        *buffer = ground ? ground->spawns->buffer : VK_NULL_HANDLE;
    if (size)
        *size = ground ? ground->spawns->size : 0;
}

void virga_ground_stats_get(virga_ground *ground, virga_ground_stats *stats)
{
    if (!stats)
        return;
    memset(stats, 0, sizeof *stats);
    if (!ground)
        return;
    ground_take_statistics(ground);
    *stats = ground->stats;
    stats->tiles_kept = ground->window.kept_count;
}
