/* ground/ground.c - creates and destroys the ground, checks its settings, and returns its maps and statistics. */
#include "ground/ground_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"

#define EFFECT ground
#include "gpu/effect_rows.h"

#include "shaders/ground_shaders.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* ---- defaults */

static const virga_setting_row def_rows[] = {
    DEF(U32, seed, 0, UINT32_MAX, 1),
    DEF(U32, cells, 128, 4096, 1024),
    DEF(FLOAT, cell_m, 0.01, 0.1, 0.05),
    DEF(U32, cached_tiles, 0, 60000, 1024),
    DEF(U32, far_cells, 0, 2048, 512),
    DEF(U32, ripple_texels, 64, 4096, 1024, .look = true),
    DEF(FLOAT, ripple_texel_m, 0.002, 0.05, 0.005, .look = true),
    VIRGA_TICK_ROWS,
    DEF(U32, flow_ticks, 1, 60, 4),
    DEF(U32, max_impacts, 256, 4194240, 65536),
    DEF(U32, max_spawns, 0, 1048576, 65536),
    DEF(U32, max_returned_droplets, 0, 4194240, 131072),
    DEF(U32, occluder_strides[0], 0, UINT32_MAX, 12),
    DEF(U32, occluder_strides[1], 0, UINT32_MAX, 32),
};

static const virga_setting_row setting_rows[] = {
    SETTING(FLOAT, evaporation_mm_h, 0, 100, 0.2),
    SETTING(FLOAT, start_wetness, 0, 1, 0),
    SETTING(FLOAT, start_water_mm, 0, 50, 0),
    SETTING(U32, contact_droplets, 0, 64, 12),
    SETTING(FLOAT, stream_waves, 0, 4, 1, .look = true),
    SETTING(FLOAT, wake_waves, 0, 4, 1, .look = true),
    SETTING(BOOL, measure, false, true, true, .look = true),
};

static void fill_settings(void *settings)
{
    ground_default_materials(((virga_ground_settings *)settings)->materials);
}

/* Adjusts the sizes that depend on the size of the window. The cache holds at least twice the tiles of the window, so
 * that no tile is lost when the camera cuts away and back. The distant map is at least twice the side of the window,
 * and its side is a multiple of a tile. */
static void fit_to_cells(virga_ground_def *def)
{
    const uint32_t tiles = def->cells / VIRGA_GROUND_TILE, min_kept = 2 * tiles * tiles;
    const uint32_t twice = 2 * def->cells / VIRGA_GROUND_FAR_CELL, min_far = twice > 128 ? twice : 128;
    def->cached_tiles = def->cached_tiles > min_kept ? def->cached_tiles : min_kept;
    if (def->far_cells)
        def->far_cells = def->far_cells < min_far ? min_far : def->far_cells / VIRGA_GROUND_TILE * VIRGA_GROUND_TILE;
}

static virga_result check_def(const virga_log *log, void *given)
{
    virga_ground_def *def = given;
    if (def->cells & (def->cells - 1))
        return virga_wrong_argument(log, "ground_def.cells: expected a power of two, got %u", def->cells);
    fit_to_cells(def);
    return virga_mesh_map_check_strides(log, "ground_def.occluder_strides", def->occluder_strides);
}

/* ---- pools, buffers and bindings */

enum {
    COUNT_CELLS = 1,
    COUNT_SIDE,
    COUNT_TWO_SIDES,
    COUNT_KEPT,
    COUNT_KEPT_TILES,
    COUNT_LANDINGS,
    COUNT_SPAWNS,
    COUNT_FAR_CELLS,
    COUNT_FAR_WIDTH,
    COUNT_FAR_HEIGHT,
    COUNT_TICKS,
    COUNT_VIEWS,
    COUNT_STREAMS,
    COUNT_FLOORS,
};

static void count(const void *given, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    const virga_ground_def *def = given;
    const uint32_t far_cells = def->far_cells;
    counts[COUNT_CELLS] = (VkDeviceSize)def->cells * def->cells;
    /* Behind the floors, the list of blocks: its head, and two words for each block, which are as long as a floor. */
    counts[COUNT_FLOORS] = counts[COUNT_CELLS] + counts[COUNT_CELLS] / VIRGA_GROUND_BLOCK +
                           sizeof(virga_ground_blocks_gpu) / sizeof(virga_floor_gpu);
    counts[COUNT_SIDE] = def->cells;
    counts[COUNT_TWO_SIDES] = 2 * def->cells;
    counts[COUNT_KEPT] = (VkDeviceSize)def->cached_tiles * VIRGA_GROUND_TILE_CELLS;
    counts[COUNT_KEPT_TILES] = def->cached_tiles;
    counts[COUNT_LANDINGS] = (VkDeviceSize)def->max_impacts + def->max_returned_droplets;
    counts[COUNT_SPAWNS] = def->max_spawns;
    counts[COUNT_FAR_CELLS] = far_cells ? (VkDeviceSize)far_cells * far_cells : 1;
    counts[COUNT_FAR_WIDTH] = far_cells > VIRGA_GROUND_MATERIALS ? far_cells : VIRGA_GROUND_MATERIALS;
    counts[COUNT_FAR_HEIGHT] = far_cells + 1;
    counts[COUNT_VIEWS] = VIRGA_MAX_VIEWS;
    const VkDeviceSize stream_side = (VkDeviceSize)ground_streams_blocks(def) * VIRGA_STREAM_BLOCK;
    counts[COUNT_STREAMS] = stream_side * stream_side;
    counts[COUNT_TICKS] =
        def->max_ticks_per_step + 4; /* where the window moves, for the far map, and two for simulated water */
}

#define FIRST_NEAR_M 0x40400000u /* 3 m, as a float */
#define MAP_USE      (VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT)
#define KEPT_USE     (MAP_USE | VK_IMAGE_USAGE_TRANSFER_DST_BIT)

static const virga_effect_buffer buffers[] = {
    {"ground.floors", AT(floors), VIRGA_USE_TEXELS | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, DEVICE, 0,
     sizeof(virga_floor_gpu), COUNT_FLOORS, FILL, GROUND_NO_MATERIAL},
    {"ground.cells", AT(cells), VIRGA_USE_TEXELS, DEVICE, 0, sizeof(virga_cell_gpu), COUNT_CELLS, FILL},
    {"ground.arrivals", AT(arrivals), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_arrivals_gpu), COUNT_CELLS, FILL},
    {"ground.stirs", AT(stirs), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(uint32_t), COUNT_CELLS, FILL},
    {"ground.swings", AT(swings), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(uint32_t), COUNT_CELLS, FILL},
    {"ground.spots", AT(spots), VIRGA_USE_STORAGE, DEVICE, 0, 8, COUNT_CELLS, FILL},
    {"ground.cached_cells", AT(cached_cells), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_cell_gpu), COUNT_KEPT, FILL},
    {"ground.cached_spots", AT(cached_spots), VIRGA_USE_STORAGE, DEVICE, 0, 8, COUNT_KEPT, .keeps = true},
    {"ground.counts", AT(counts), VIRGA_USE_STORAGE, DEVICE, sizeof(ground_readback), .first = FILL},
    {"ground.landings", AT(landings), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_landing_gpu), COUNT_LANDINGS, FILL},
    {"ground.spawns", AT(spawns), VIRGA_USE_INDIRECT, DEVICE, sizeof(virga_spawns_gpu), sizeof(virga_spawn_gpu),
     COUNT_SPAWNS, FILL, .word = offsetof(virga_spawns_gpu, near_m) / sizeof(uint32_t), .word_value = FIRST_NEAR_M},
    {"ground.no_rules", AT(no_rules), VIRGA_USE_UNIFORM | VK_BUFFER_USAGE_TRANSFER_DST_BIT, DEVICE,
     sizeof(virga_splash_rules_gpu), .first = FILL, .scratch = true},
    {"ground.rings", AT(rings), VIRGA_USE_INDIRECT, DEVICE, GROUND_STREAMS_OFFSET + sizeof(virga_streams_gpu),
     sizeof(virga_stream_gpu), COUNT_STREAMS, FILL},
    {"ground.far_floors", AT(far.floors), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_far_floor_gpu), COUNT_FAR_CELLS,
     .keeps = true},
};

static const virga_effect_ring rings[] = {
    {"ground.ticks", AT(tick_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(virga_ground_tick_gpu), COUNT_TICKS},
    {"ground.lists", AT(list_ring), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, VIRGA_RING_BYTES(ground_lists),
     VIRGA_COUNT_ONE},
    {"ground.wet_views", AT(wet_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(ground_wet_block), COUNT_VIEWS},
};

static const virga_effect_image images[] = {
    {"ground.wet_map", AT(wet_map), VK_FORMAT_R16G16B16A16_SFLOAT, COLOR, MAP_USE, COUNT_SIDE, COUNT_SIDE, 1,
     VIRGA_FIRST_STORAGE},
    {"ground.spot_map", AT(spot_map), VK_FORMAT_R32_UINT, COLOR, MAP_USE, COUNT_TWO_SIDES, COUNT_SIDE, 1,
     VIRGA_FIRST_STORAGE},
    {"ground.far_map", AT(far.map), VK_FORMAT_R16G16B16A16_SFLOAT, COLOR, KEPT_USE, COUNT_FAR_WIDTH, COUNT_FAR_HEIGHT,
     1, VIRGA_FIRST_STORAGE, .keeps = true},
    {"ground.blank_materials", AT(blank_materials), VK_FORMAT_R8_UINT, COLOR, VK_IMAGE_USAGE_SAMPLED_BIT,
     VIRGA_COUNT_ONE, VIRGA_COUNT_ONE, 1, VIRGA_FIRST_SAMPLED},
};

enum {
    BIND_IMPACTS = 2,
    BIND_DEPTH = 11,
    BIND_SURFACE,
    BIND_WET_MAP,
    BIND_SPOT_MAP,
    BIND_WAVES = 16,
    BIND_MATERIALS,
    BIND_RULES,
    BIND_FAR_DEPTH = 24,
    BIND_FAR_SURFACE,
    BIND_FAR_MAP,
    BIND_WATER,
    BIND_EXCHANGE,
    BIND_STREAM_TILE,
};

/* The bindings as the files in shaders/ground declare them. */
static const virga_binding_kind bindings[] = {
    RING(VIRGA_ALL_STAGES, tick_ring, virga_ground_tick_gpu),                           /* 0 */
    {DYNAMIC_STORAGE, COMPUTE, VIRGA_SOURCE_RING, AT(list_ring), sizeof(ground_lists)}, /* 1 tile lists */
    [BIND_IMPACTS] = {STORAGE, COMPUTE},      /* 2 impacts or returned droplets */
    BUFFER(floors),                           /* 3 and the list of blocks */
    BUFFER(cells),                            /* 4 */
    BUFFER(stirs),                            /* 5 */
    BUFFER(arrivals),                         /* 6 */
    BUFFER(spots),                            /* 7 */
    BUFFER(cached_cells),                     /* 8 */
    BUFFER(counts),                           /* 9 */
    BUFFER(landings),                         /* 10 */
    [BIND_DEPTH] = {SAMPLED, COMPUTE},        /* 11 */
    [BIND_SURFACE] = {SAMPLED, COMPUTE},      /* 12 */
    [BIND_WET_MAP] = {IMAGE, COMPUTE},        /* 13 */
    [BIND_SPOT_MAP] = {IMAGE, COMPUTE},       /* 14 */
    BUFFER_IN(COMPUTE | VERTEX, rings),       /* 15 */
    [BIND_WAVES] = {SAMPLED, FRAGMENT},       /* 16 */
    [BIND_MATERIALS] = {SAMPLED, COMPUTE},    /* 17 */
    [BIND_RULES] = {UNIFORM, COMPUTE},        /* 18 rules of the splashes */
    BUFFER(spawns),                           /* 19 */
    BUFFER(swings),                           /* 20 */
    TEXEL_BUFFER(floors),                     /* 21 */
    TEXEL_BUFFER(cells),                      /* 22 */
    BUFFER(far.floors),                       /* 23 */
    [BIND_FAR_DEPTH] = {SAMPLED, COMPUTE},    /* 24 */
    [BIND_FAR_SURFACE] = {SAMPLED, COMPUTE},  /* 25 */
    [BIND_FAR_MAP] = {IMAGE, COMPUTE},        /* 26 */
    [BIND_WATER] = {STORAGE, COMPUTE},        /* 27 particles of simulated water, or droplets that are thrown */
    [BIND_EXCHANGE] = {STORAGE, COMPUTE},     /* 28 water that becomes particles, and comes back */
    [BIND_STREAM_TILE] = {SAMPLED, FRAGMENT}, /* 29 */
};

static const virga_effect_layout layouts[] = {
    {AT(bindings), bindings, VIRGA_ROWS(bindings), GROUND_SOURCES, sizeof(uint32_t)},
    {AT(wet_bindings), ground_wet_bindings, GROUND_WET_BINDINGS, VIRGA_MAX_VIEWS, sizeof(uint32_t)},
};

static const virga_effect_pass passes[] = {
    PASS(tile_load),
    PASS(tile_discard),
    PASS(block_mark),
    PASS(block_list),
    PASS(touch),
    PASS(contact),
    PASS(contact_soak),
    PASS(receive),
    PASS(receive_soak),
    PASS(take),
    PASS(spawn_mark),
    PASS(spawn_scan),
    PASS(land),
    PASS(share),
    PASS(soak),
    PASS(flow),
    PASS(ring),
    PASS(stream),
    PASS(stream_list),
    PASS(measure),
    {"ground.measure_cached", AT(measure_cached), VIRGA_SPIRV(ground_measure_comp), .constant = VK_TRUE},
    PASS(map),
    {"ground.far_floor", AT(far.floor_pass), VIRGA_SPIRV(ground_far_floor_comp)},
    {"ground.far_map", AT(far.draw), VIRGA_SPIRV(ground_far_map_comp)},
};

/* What shrinks to fit the memory budget: the window, the tile cache, the ripple map and the distant map. Sizes shared
 * with rain and splashes stay. */
static const virga_effect_pool pools[] = {
    POOL(cells, 128, 0),
    POOL(cached_tiles, 0, 1),
    POOL(ripple_texels, 64, 1),
    POOL(far_cells, 0, VIRGA_GROUND_TILE),
};

/* The window may have become smaller, so the sizes that depend on it are adjusted again. */
static virga_result fit_device(const virga_context *context, void *def)
{
    (void)context;
    fit_to_cells(def);
    return VIRGA_OK;
}

/* Height maps of the window (one layer) and of the distant map (two layers), and the ripple map. */
static VkDeviceSize extra_bytes(const void *given)
{
    const virga_ground_def *def = given;
    return virga_mesh_map_bytes(def->cells, 1) + virga_mesh_map_bytes(def->far_cells, 2) +
           ground_ripples_bytes(def->ripple_texels) + ground_streams_bytes();
}

static virga_result init(void *object)
{
    virga_ground *ground = object;
    ground->window.tiles = ground->def.cells / VIRGA_GROUND_TILE;
    ground->window.cache_capacity = ground->def.cached_tiles;
    ground->window.cache =
        virga_alloc_array(&ground->base.context->heap, ground->def.cached_tiles, sizeof ground->window.cache[0]);
    ground->window.cache_before =
        virga_alloc_array(&ground->base.context->heap, ground->def.cached_tiles, sizeof ground->window.cache[0]);
    return ground->window.cache && ground->window.cache_before
               ? VIRGA_OK
               : virga_out_of_host_memory(ground->base.context, "the tiles of the ground");
}

static virga_result create(void *object)
{
    virga_ground *ground = object;
    virga_context *context = ground->base.context;
    const virga_ground_def *def = &ground->def;
    virga_pipeline_group *group = &ground->base.passes;
    virga_result result = VIRGA_OK;
    TRY(virga_mesh_map_create(context, def->cells, 1, false, def->occluder_strides, "ground.height_map", group,
                              &ground->height_map));
    TRY(virga_mesh_map_create(context, def->far_cells, 2, false, def->occluder_strides, "ground.far_height_map", group,
                              &ground->far.height_map));
    TRY(ground_ripples_create(context, def->ripple_texels, ground->bindings->shared, group, &ground->ripples));
    TRY(ground_streams_create(context, ground->ripples.map, ground->bindings->shared, group, &ground->streams));
error:
    return result;
}

static virga_result fill(void *object)
{
    virga_ground *ground = object;
    virga_context *context = ground->base.context;
    virga_result result = VIRGA_OK;
    TRY(ground_ripples_fill(context, (double)ground->def.ripple_texel_m, &ground->ripples));
    TRY(ground_streams_fill_tile(context, &ground->streams));
error:
    return result;
}

static void destroy(void *object)
{
    virga_ground *ground = object;
    virga_context *context = ground->base.context;
    virga_mesh_map_retire(context, &ground->height_map);
    virga_mesh_map_retire(context, &ground->far.height_map);
    ground_ripples_retire(context, &ground->ripples);
    ground_streams_retire(context, &ground->streams);
    virga_free(&context->heap, ground->window.cache);
    virga_free(&context->heap, ground->window.cache_before);
}

static void describe(const void *object, char *line, size_t size)
{
    const virga_ground_def *def = &((const virga_ground *)object)->def;
    snprintf(line, size, "ground: %u x %u cells of %g m, %u tiles kept", def->cells, def->cells, (double)def->cell_m,
             def->cached_tiles);
}

static virga_result check_settings(const void *object, void *settings, bool *changed)
{
    const virga_ground *ground = object;
    return ground_check_materials(&ground->base.context->log, ((virga_ground_settings *)settings)->materials, changed);
}

static virga_result apply_settings(void *object, void *given)
{
    virga_ground *ground = object;
    const virga_ground_settings *next = given, *old = &ground->settings;
    virga_soil_gpu soils[VIRGA_GROUND_MATERIALS];
    const bool same_start = next->start_wetness == old->start_wetness && next->start_water_mm == old->start_water_mm;
    if (same_start && ground->base.contents)
        return VIRGA_OK;
    ground_fill_soils(next, (double)ground->def.cell_m, soils);
    ground_standing_start(ground->standing, next, soils);
    return VIRGA_OK;
}

/* ---- state */

static const virga_effect_state_row state_rows[] = {
    {"ground_settings.materials", AT(settings.materials), sizeof((virga_ground *)0)->settings.materials,
     .must_match = true},
    STATE(window.low),
    STATE(window.is_placed),
    STATE(window.moves),
    STATE(window.cached_count),
    {"window.cache", AT(window.cache), sizeof(ground_cached_tile), COUNT_KEPT_TILES, .pointed = true},
    STATE(base_m),
    STATE(has_base),
    STATE(redraw_heights),
    STATE(ticks),
    STATE(last_tick),
    STATE(standing),
    STATE(ripple_low_m),
    STATE(far.low),
    STATE(far.is_placed),
    STATE(far.drawn),
    STATE(far.drawn_at),
};

VIRGA_EFFECT_FUNCTIONS(ground)
VIRGA_EFFECT_STATE_FUNCTIONS(ground)
VIRGA_EFFECT_STATISTICS_FUNCTION(ground)

const virga_effect_type ground_type = {
    VIRGA_EFFECT_TYPE(ground, "the ground", "ground_settings"),
    VIRGA_TABLE(image),
    VIRGA_CALLBACKS(fit_device, extra_bytes, init, create, fill, destroy, fill_settings, check_settings,
                    apply_settings),
    .draws = ground_draws,
    .draw_count = 1,
    .draw_layout = 1,
    .lost = ground_lost,
    VIRGA_TABLE(state_row),
    .check_state = ground_check_state,
    .state_loaded = ground_state_loaded,
};

/* ---- descriptors */

/* The host's list of impacts or returned droplets. */
static virga_bound host_list(const virga_ground *ground, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size,
                             uint32_t entries)
{
    const VkDeviceSize max_bytes = sizeof(virga_impacts_gpu) + (VkDeviceSize)entries * sizeof(virga_impact_gpu);
    return (virga_bound){
        .buffer = buffer, .offset = offset, .range = virga_host_list_range(ground->base.context, size, max_bytes)};
}

static virga_bound sampled(const virga_ground *ground, const virga_image_2d *image)
{
    return (virga_bound){.sampler = ground->base.context->nearest,
                         .view = image->view,
                         .image_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

static virga_bound written(const virga_image_2d *image)
{
    return (virga_bound){.view = image->view, .image_layout = VK_IMAGE_LAYOUT_GENERAL};
}

/* Simulated water, or where contacts throw droplets. */
static virga_bound water_list(const virga_ground *ground, uint32_t source)
{
    const virga_ground_step_info *info = &ground->info;
    if (source == GROUND_CONTACTS && info->handed)
        return (virga_bound){.buffer = info->handed,
                             .offset = info->handed_offset,
                             .range = virga_host_list_range(ground->base.context, info->handed_size, UINT32_MAX)};
    if (source != GROUND_CONTACTS && info->water)
        return (virga_bound){.buffer = info->water,
                             .offset = info->water_offset,
                             .range = (VkDeviceSize)info->water_count * sizeof(virga_particle_gpu)};
    return (virga_bound){.buffer = ground->counts->buffer}; /* not read */
}

static void write_set(virga_ground *ground, uint32_t source)
{
    virga_context *context = ground->base.context;
    const virga_ground_def *def = &ground->def;
    const virga_ground_step_info *info = &ground->info;
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&ground->base, ground->bindings, bound);
    bound[BIND_IMPACTS] =
        source == GROUND_RETURNS
            ? host_list(ground, info->returned_droplets, info->returned_droplets_offset, info->returned_droplets_size,
                        def->max_returned_droplets)
            : host_list(ground, info->impacts, info->impacts_offset, info->impacts_size, def->max_impacts);
    bound[BIND_DEPTH] = sampled(ground, virga_mesh_map_depth(ground->height_map));
    bound[BIND_SURFACE] = sampled(ground, virga_mesh_map_surface(ground->height_map));
    bound[BIND_WET_MAP] = written(ground->wet_map);
    bound[BIND_SPOT_MAP] = written(ground->spot_map);
    bound[BIND_WAVES] = sampled(ground, ground->ripples.waves);
    bound[BIND_STREAM_TILE] = sampled(ground, ground->streams.tile);
    bound[BIND_STREAM_TILE].sampler = context->linear;
    bound[BIND_MATERIALS] = virga_bound_or_blank(&info->materials.image, ground->blank_materials, context->nearest);
    bound[BIND_RULES] = info->splash_rules ? (virga_bound){.buffer = info->splash_rules,
                                                           .offset = info->splash_rules_offset,
                                                           .range = sizeof(virga_splash_rules_gpu)}
                                           : (virga_bound){.buffer = ground->no_rules->buffer};
    bound[BIND_FAR_DEPTH] = sampled(ground, virga_mesh_map_depth(ground->far.height_map));
    bound[BIND_FAR_SURFACE] = sampled(ground, virga_mesh_map_surface(ground->far.height_map));
    bound[BIND_FAR_MAP] = written(ground->far.map);
    bound[BIND_WATER] = water_list(ground, source);
    bound[BIND_EXCHANGE] = info->exchange.buffer
                               ? (virga_bound){.buffer = info->exchange.buffer,
                                               .offset = info->exchange.offset,
                                               .range = virga_host_list_range(context, info->exchange.size, UINT32_MAX)}
                               : (virga_bound){.buffer = ground->counts->buffer}; /* not read */
    ground->sets[source] = virga_bindings_write(context, ground->bindings, source, bound);
}

void ground_write_sets(virga_ground *ground)
{
    write_set(ground, GROUND_DROPS);
    if (ground->info.returned_droplets)
        write_set(ground, GROUND_RETURNS);
    if (ground->info.wheel_count || ground->info.foot_count)
        write_set(ground, GROUND_CONTACTS);
}

void virga_ground_refresh_heights(virga_ground *ground)
{
    if (ground)
        ground->redraw_heights = true;
}

/* ---- maps and statistics */

static virga_ground_maps describe_maps(const virga_ground *ground)
{
    const virga_ground_def *def = &ground->def;
    const double tile_m = VIRGA_GROUND_TILE * (double)def->cell_m;
    virga_ground_maps maps = {.wetness = ground->wet_map->layer_views[0],
                              .spots = ground->spot_map->layer_views[0],
                              .cells = def->cells,
                              .cell_m = def->cell_m,
                              .base_m = (float)ground->base_m,
                              .ripples = ground->ripples.map->colors[0]->layer_views[0],
                              .ripple_texels = def->ripple_texels,
                              .ripple_texel_m = def->ripple_texel_m};
    /* No reach in a window of two tiles. */
    maps.reach_m = fmaxf((float)((0.5 * ground->window.tiles - 1.5) * tile_m), 0);
    if (ground->info.impacts_reach_m > 0 && ground->info.impacts_reach_m < maps.reach_m)
        maps.reach_m = ground->info.impacts_reach_m;
    ground_far_maps(ground, &maps);
    for (int axis = 0; axis < 2; axis++) {
        maps.ripple_low_m[axis] = ground->ripple_low_m[axis];
        maps.low_m[axis] = ground->window.low[axis] * tile_m;
        maps.high_m[axis] = (ground->window.low[axis] + (int32_t)ground->window.tiles) * tile_m;
    }
    return maps;
}

void virga_ground_maps_get(const virga_ground *ground, virga_ground_maps *maps)
{
    if (maps)
        *maps = ground ? describe_maps(ground) : (virga_ground_maps){0};
}

uint32_t ground_nl_per_um(const virga_ground *ground)
{
    const double cell_m = (double)ground->def.cell_m;
    return (uint32_t)floor(cell_m * cell_m * 1e6 + 0.5);
}

void virga_ground_cells_get(const virga_ground *ground, virga_ground_cells *cells)
{
    if (cells)
        *cells = ground ? (virga_ground_cells){.floors = ground->floors->buffer,
                                               .cells = ground->cells->buffer,
                                               .size = ground->cells->size,
                                               .tiles = ground->window.tiles,
                                               .low_tile = {ground->window.low[0], ground->window.low[1]},
                                               .nl_per_um = ground_nl_per_um(ground),
                                               .base_m = (float)ground->base_m}
                        : (virga_ground_cells){0};
}

static void get_buffer(const virga_buffer *from, VkBuffer *buffer, VkDeviceSize *size)
{
    if (buffer)
        *buffer = from ? from->buffer : VK_NULL_HANDLE;
    if (size)
        *size = from ? from->size : 0;
}

void virga_ground_landings(const virga_ground *ground, VkBuffer *buffer, VkDeviceSize *size)
{
    get_buffer(ground ? ground->landings : NULL, buffer, size);
}

void virga_ground_spawns(const virga_ground *ground, VkBuffer *buffer, VkDeviceSize *size)
{
    get_buffer(ground ? ground->spawns : NULL, buffer, size);
}
