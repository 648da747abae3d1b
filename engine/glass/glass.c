/* glass/glass.c - creates and destroys panes, applies settings, and answers queries. */
#include "glass/glass_internal.h"

#include "core/settings.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"

#define EFFECT glass
#include "gpu/effect_rows.h"

#include <virga/shared/impact.h>
#include <virga/shared/particle.h>

#include "shaders/glass_shaders.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define MAX_CELLS 4194304.0

/* ---- defaults */

/* clang-format off */
static const virga_setting_row def_rows[] = {
    DEF(U32, seed, 0, UINT32_MAX, 1),
    DEF(FLOAT, width_m, 0.01, 10, 1.4),
    DEF(FLOAT, height_m, 0.01, 10, 0.75),
    DEF(FLOAT, cell_m, 0.0005, 0.01, 0.002),
    DEF(FLOAT, affinity_size_m, 0.0005, 0.1, 0.006),
    DEF(U32, max_drops, 256, 262144, 32768),
    DEF(U32, max_texels, 64, 4096, 1024, .look = true),
    DEF(U32, texture_columns, 2, 32, 11, .look = true),
    DEF(U32, texture_rows, 2, 32, 11, .look = true),
    DEF(U32, texture_texels, 8, 64, 16, .look = true),
    DEF(BOOL, water, false, true, false),
    DEF(BOOL, condensation, false, true, false),
    DEF(U32, max_views, 1, VIRGA_MAX_VIEWS, 1, .look = true),
    VIRGA_TICK_ROWS,
};
/* clang-format on */

/* Those without a default here have that of VIRGA_GLASS_KIND_PAPER. */
static const virga_setting_row setting_rows[] = {
    SETTING(ENUM, density, 0, VIRGA_GLASS_DENSITY_NISHIMURA, VIRGA_GLASS_DENSITY_GOTO, .look = true),
    SETTING(ENUM, blend, 0, VIRGA_GLASS_BLEND_WEIGHTED, VIRGA_GLASS_BLEND_SUM, .look = true),
    SETTING(ENUM, style, 0, VIRGA_GLASS_STYLE_FRONT, VIRGA_GLASS_STYLE_PHYSICAL, .look = true),
    SETTING(ENUM, texture_shape, 0, VIRGA_GLASS_TEXTURE_HEMISPHERE, VIRGA_GLASS_TEXTURE_CAP, .look = true),
    SETTING(FLOAT, advancing_deg, 5, 175, 0),
    SETTING(FLOAT, receding_deg, 1, 175, 0, .max_member = offsetof(virga_glass_settings, advancing_deg)),
    SETTING(FLOAT, drag, 0.01, 100, 1),
    SETTING(FLOAT, kinetic_hold, 0, 1, 0),
    SETTING(FLOAT, affinity, 0, 2, 0),
    SETTING(FLOAT, meander, 0, 1, 0.1),
    SETTING(FLOAT, path_ease, 0, 1, 0.6),
    SETTING(FLOAT, path_dry_s, 0.1, 600, 8),
    SETTING(FLOAT, merge_distance, 0, 2, 1.2),
    SETTING(FLOAT, tail_spacing_m, 0.001, 1, 0.006),
    SETTING(FLOAT, tail_max_radius_mm, 0, 2, 0),
    SETTING(FLOAT, tail_lifetime_s, 0.1, 3600, 12),
    SETTING(FLOAT, film_um, 0, 100, 0),
    SETTING(FLOAT, film_break_s, 0, 60, 0.8, .look = true),
    SETTING(FLOAT, evaporation_mm_h, 0, 100, 0.5),
    SETTING(FLOAT, mist_max_mm, 0, 1, 0.6),
    SETTING(FLOAT, air_share, 0, 2, 0.4),
    SETTING(FLOAT, air_outward, 0, 2, 0),
    SETTING(ENUM, condensation.side, 0, VIRGA_GLASS_FOG_INSIDE, VIRGA_GLASS_FOG_NONE),
    SETTING(FLOAT, condensation.air_c, -40, 60, 20),
    SETTING(FLOAT, condensation.humidity, 0, 1, 0.5),
    SETTING(FLOAT, condensation.glass_c, -40, 60, 15),
    SETTING(FLOAT, condensation.heat_w_m2_k, 0, 500, 8),
    SETTING(FLOAT, condensation.droplets_per_mm2, 1, 100000, 1000),
    SETTING(FLOAT, condensation.drop_radius_mm, 0.1, 2, 0.5),
    SETTING(FLOAT, condensation.start_um, 0, 500, 0),
    SETTING(FLOAT, condensation.heater_k, 0, 80, 0),
    SETTING(FLOAT, condensation.heater_s, 1, 3600, 300),
    SETTING(U32, condensation.heater_wires, 0, 64, 0),
    SETTING(FLOAT, particle_radius_mm, 0.2, 5, 1.5),
    SETTING(FLOAT, penalty, 0, 1, 0.1),
    SETTING(FLOAT, particle_band, 1, 16, 4),
    SETTING(FLOAT, hold_back_mm, 0, 20, 2.2),
    SETTING(BOOL, compress, false, true, true, .look = true),
    SETTING(FLOAT, compress_from, 0, 2, 0.5, .look = true),
    SETTING(FLOAT, compress_step, 0, 1, 0.1, .look = true),
    SETTING(FLOAT, compress_k, 0, 1, 0.3, .look = true),
    SETTING(FLOAT, threshold, 0.05, 0.95, 0.5, .look = true),
    SETTING(FLOAT, pinning, 0, 1, 0, .look = true),
    SETTING(FLOAT, impact_s, 0, 2, 0.25, .look = true),
    SETTING(FLOAT, paper_shift, 0, 4, 0.35, .look = true),
    SETTING(FLOAT, textured_px, 0, 64, 0, .look = true),
    SETTING(U32, textures_per_frame, 0, 1024, 0, .look = true),
    SETTING(FLOAT, veil, 0, 1, 0, .look = true),
    SETTING(FLOAT, starburst, 0, 1, 0, .look = true),
    SETTING(U32, starburst_rays, 1, 8, 3, .look = true),
    SETTING(FLOAT, starburst_deg, -360, 360, 15, .look = true),
    SETTING(U32, opening_blades, 0, 16, 0, .look = true),
    SETTING(FLOAT, opening_roundness, 0, 1, 0, .look = true),
    SETTING(FLOAT, opening_deg, -360, 360, 0, .look = true),
    SETTING(FLOAT, thickness_mm, 0, 50, 5, .look = true),
    SETTING(FLOAT, tint[0], 0, 1, 1, .look = true),
    SETTING(FLOAT, tint[1], 0, 1, 1, .look = true),
    SETTING(FLOAT, tint[2], 0, 1, 1, .look = true),
    SETTING(FLOAT, gain, 0, 100, 1, .look = true),
    SETTING(U32, hold_back_cells, 0, 8, 3),
    SETTING(U32, compress_steps, 0, 16, 5, .look = true),
    SETTING(U32, wiper_count, 0, VIRGA_GLASS_MAX_WIPERS, 0, .look = true),
};

static void fill_settings(void *given)
{
    virga_glass_settings *settings = given;
    virga_glass_apply_kind(VIRGA_GLASS_KIND_PAPER, settings);
    for (uint32_t i = 0; i < VIRGA_GLASS_MAX_WIPERS; i++)
        settings->wipers[i] = virga_default_glass_wiper();
}

static virga_result check_def(const virga_log *log, void *given)
{
    virga_glass_def *def = given;
    const float min_m = (float)sqrt((double)def->width_m * (double)def->height_m / MAX_CELLS) * 1.01f;
    def->cell_m = virga_clamp_setting_float(log, "glass_def.cell_m", def->cell_m, min_m, 0.01f, NULL);
    def->max_drops = (def->max_drops + VIRGA_GLASS_GROUP - 1) / VIRGA_GLASS_GROUP * VIRGA_GLASS_GROUP;
    def->texture_texels = glass_texture_texels(def->texture_texels);
    return VIRGA_OK;
}

/* ---- resources */

static VkDeviceSize grid_cells(const virga_glass_def *def)
{
    const float side_m = glass_min_grid_m(def);
    return (VkDeviceSize)glass_cells_along(def->width_m, side_m) * glass_cells_along(def->height_m, side_m);
}

enum {
    COUNT_CELLS = 1,
    COUNT_OCCUPANTS,
    COUNT_FILM,
    COUNT_SLOTS,
    COUNT_SELECTION_BYTES,
    COUNT_FILM_BLOCKS,
    COUNT_SEEDS,
    COUNT_GRID,
    COUNT_MOVED_WORDS,
    COUNT_TICKS,
    COUNT_BALLS,
    COUNT_TILES,
    COUNT_ENTRIES,
    COUNT_MIST,
    COUNT_WORK,
    COUNT_CORNERS,
    COUNT_VIEWS,
    COUNT_MAP_COLUMNS,
    COUNT_MAP_ROWS,
    COUNT_COPY_COLUMNS,
    COUNT_COPY_ROWS,
    COUNT_MIST_COLUMNS,
    COUNT_MIST_ROWS,
    COUNT_TEXTURE_COLUMNS,
    COUNT_TEXTURE_ROWS,
    COUNT_FOG_COLUMNS,
    COUNT_FOG_ROWS,
};

static void count_picture(const virga_glass_def *def, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    struct glass_picture sizes;
    glass_picture_fill_sizes(def, &sizes);
    const VkDeviceSize tiles = (VkDeviceSize)sizes.max_tile_columns * sizes.max_tile_rows;
    const VkDeviceSize mist = (VkDeviceSize)sizes.max_mist.width * sizes.max_mist.height;
    const VkDeviceSize blocks = mist / (VIRGA_GLASS_MIST_BLOCK * VIRGA_GLASS_MIST_BLOCK);
    counts[COUNT_BALLS] = (VkDeviceSize)def->max_drops * VIRGA_GLASS_DROP_BALLS;
    counts[COUNT_TILES] = tiles;
    counts[COUNT_ENTRIES] = sizes.max_entries;
    counts[COUNT_MIST] = mist;
    counts[COUNT_WORK] = 3 * tiles + 2 * blocks;
    counts[COUNT_CORNERS] = glass_fog_offset(&sizes, def) + (def->condensation ? blocks * 12 : 0);
    counts[COUNT_FOG_COLUMNS] = def->condensation ? sizes.max_mist.width : 1;
    counts[COUNT_FOG_ROWS] = def->condensation ? sizes.max_mist.height : 1;
    counts[COUNT_VIEWS] = VIRGA_GLASS_MAX_VIEWS;
    counts[COUNT_MAP_COLUMNS] = sizes.max_columns;
    counts[COUNT_MAP_ROWS] = sizes.max_rows;
    counts[COUNT_COPY_COLUMNS] = VIRGA_GLASS_COPY_WIDTH;
    counts[COUNT_COPY_ROWS] = VIRGA_GLASS_COPY;
    counts[COUNT_MIST_COLUMNS] = sizes.max_mist.width;
    counts[COUNT_MIST_ROWS] = sizes.max_mist.height;
    counts[COUNT_TEXTURE_COLUMNS] = 2ull * def->texture_columns * glass_texture_texels(def->texture_texels);
    counts[COUNT_TEXTURE_ROWS] = (VkDeviceSize)def->texture_rows * glass_texture_texels(def->texture_texels);
}

static void count(const void *given, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    const virga_glass_def *def = given;
    const VkDeviceSize columns = glass_cells_along(def->width_m, def->cell_m);
    counts[COUNT_CELLS] = columns * glass_cells_along(def->height_m, def->cell_m);
    counts[COUNT_OCCUPANTS] = counts[COUNT_CELLS] + (def->water ? counts[COUNT_CELLS] + glass_film_blocks(def) : 0);
    counts[COUNT_FILM] = (def->condensation ? 2 : 1) * counts[COUNT_CELLS];
    counts[COUNT_SLOTS] = def->max_drops;
    counts[COUNT_SELECTION_BYTES] = VIRGA_SELECTION_BYTES((VkDeviceSize)def->max_drops);
    counts[COUNT_FILM_BLOCKS] = glass_film_blocks(def);
    counts[COUNT_SEEDS] = GLASS_MAX_ARRIVALS + GLASS_MAX_IMPACTS + (VkDeviceSize)def->max_drops +
                          VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS + glass_max_sites(def) + glass_fog_sites(def);
    counts[COUNT_GRID] = grid_cells(def) + def->max_drops;
    counts[COUNT_MOVED_WORDS] = 2 * 3 * (VkDeviceSize)def->max_drops + 1 + grid_cells(def);
    counts[COUNT_TICKS] = def->max_ticks_per_step;
    count_picture(def, counts);
}

#define LIST_HEAD  sizeof(virga_list_gpu)
#define NODE_BYTES (VIRGA_GLASS_NODES * VIRGA_GLASS_NODES * sizeof(virga_glass_node_gpu))

_Static_assert(NODE_BYTES <= 16 * VIRGA_GUARANTEED_TEXELS, "nodes are texels on every device");
_Static_assert(VIRGA_MAX_FRAMES_IN_FLIGHT *VIRGA_GLASS_MAX_VIEWS *VIRGA_RING_BYTES(glass_view_block) <=
                   16 * VIRGA_GUARANTEED_TEXELS,
               "views are texels on every device");

static const virga_effect_buffer buffers[] = {
    /* The state of the pane. */
    {"glass.state", AT(state), VIRGA_USE_INDIRECT, DEVICE, sizeof(virga_glass_state_gpu), .first = FILL},
    {"glass.drops", AT(drops), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_glass_drop_gpu), COUNT_SLOTS, FILL},
    {"glass.selection", AT(selection), VIRGA_USE_STORAGE, DEVICE, 0, 1, COUNT_SELECTION_BYTES},
    /* A step without a tick shows what it lists. */
    {"glass.list", AT(list), VIRGA_USE_INDIRECT, DEVICE, LIST_HEAD, 4, COUNT_SLOTS, FILL},
    {"glass.active", AT(active), VIRGA_USE_STORAGE, DEVICE, LIST_HEAD, 4, COUNT_SLOTS},
    {"glass.claims", AT(claims), VIRGA_USE_STORAGE, DEVICE, 0, 8, COUNT_CELLS, FILL, VIRGA_GLASS_NONE},
    {"glass.occupants", AT(occupants), VIRGA_USE_STORAGE, DEVICE, 0, 4, COUNT_OCCUPANTS, FILL},
    {"glass.film", AT(film), VIRGA_USE_STORAGE, DEVICE, 0, 4, COUNT_FILM, FILL},
    {"glass.passed", AT(passed), VIRGA_USE_STORAGE, DEVICE, 0, 4, COUNT_CELLS, FILL},
    {"glass.film_blocks", AT(film_blocks), VIRGA_USE_STORAGE, DEVICE, 0, 8, COUNT_FILM_BLOCKS, FILL},
    {"glass.seeds", AT(seeds), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_glass_seed_gpu), COUNT_SEEDS, FILL},
    {"glass.ranks", AT(ranks), VIRGA_USE_STORAGE, DEVICE, 0, 4, COUNT_SEEDS},
    {"glass.grid", AT(grid), VIRGA_USE_STORAGE, DEVICE, 0, 4, COUNT_GRID, FILL},
    {"glass.moved", AT(moved), VIRGA_USE_STORAGE, DEVICE, 0, 4, COUNT_MOVED_WORDS, FILL},
    /* The surface of the pane. */
    {"glass.surface", AT(surface), VIRGA_USE_STORAGE, DEVICE, 0, 4, COUNT_CELLS},
    {"glass.nodes", AT(nodes), VIRGA_USE_TEXELS, DEVICE, NODE_BYTES},
    /* The height map and the draws. */
    {"glass.balls", AT(picture.balls), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_glass_ball_gpu), COUNT_BALLS},
    {"glass.tiles", AT(picture.tiles), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_glass_tile_gpu), COUNT_TILES},
    {"glass.entries", AT(picture.entries), VIRGA_USE_STORAGE, DEVICE, 0, 4, COUNT_ENTRIES},
    {"glass.mist", AT(picture.mist), VIRGA_USE_STORAGE, DEVICE, 0, 1, COUNT_MIST},
    {"glass.written", AT(picture.written), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_glass_written_gpu), COUNT_TILES,
     .per_view = true},
    {"glass.work", AT(picture.work), VIRGA_USE_INDIRECT, DEVICE, sizeof(virga_glass_work_gpu), 4, COUNT_WORK,
     .per_view = true},
    {"glass.corners", AT(picture.corners), VIRGA_USE_INDEX, DEVICE, 0, 4, COUNT_CORNERS, .per_view = true},
};

static const virga_effect_ring rings[] = {
    {"glass.ticks", AT(tick_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(virga_glass_tick_gpu), COUNT_TICKS},
    {"glass.views", AT(picture.view_ring), VIRGA_USE_UNIFORM | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
     VIRGA_RING_BYTES(glass_view_block), COUNT_VIEWS},
};

#define SAMPLED_USE VK_IMAGE_USAGE_SAMPLED_BIT
#define CLEARED_USE (VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT)
#define WRITTEN_USE (VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT)
#define READ_BACK   VK_IMAGE_USAGE_TRANSFER_SRC_BIT

/* Images that draws filter are cleared first. The filter also reads texels next to those that a view writes. If such a
 * texel were NaN, the result would be NaN even with a weight of 0. */
static const virga_effect_image images[] = {
    {"glass.relief", AT(picture.relief), VK_FORMAT_R32G32B32A32_SFLOAT, COLOR, CLEARED_USE | WRITTEN_USE | READ_BACK,
     COUNT_MAP_COLUMNS, COUNT_MAP_ROWS, 1, FILL, .per_view = true},
    {"glass.map", AT(picture.map), VK_FORMAT_R32G32B32A32_SFLOAT, COLOR, WRITTEN_USE | READ_BACK, COUNT_MAP_COLUMNS,
     COUNT_MAP_ROWS, 1, VIRGA_FIRST_STORAGE, .per_view = true},
    {"glass.paper_map", AT(picture.paper_map), VK_FORMAT_R32_UINT, COLOR, WRITTEN_USE, COUNT_MAP_COLUMNS,
     COUNT_MAP_ROWS, 1, VIRGA_FIRST_STORAGE, .per_view = true},
    {"glass.copies", AT(picture.copies), VK_FORMAT_R16G16B16A16_SFLOAT, COLOR, CLEARED_USE | WRITTEN_USE | READ_BACK,
     COUNT_COPY_COLUMNS, COUNT_COPY_ROWS, 1, FILL, .per_view = true},
    {"glass.mist_map", AT(picture.mist_map), VK_FORMAT_R8_UNORM, COLOR, CLEARED_USE, COUNT_MIST_COLUMNS,
     COUNT_MIST_ROWS, 1, VIRGA_FIRST_STORAGE, .per_view = true},
    {"glass.textures", AT(picture.textures), VK_FORMAT_R16G16B16A16_SFLOAT, COLOR,
     CLEARED_USE | WRITTEN_USE | READ_BACK, COUNT_TEXTURE_COLUMNS, COUNT_TEXTURE_ROWS, 1, FILL, .per_view = true},
    {"glass.fog_map", AT(picture.fog_map), VK_FORMAT_R16G16B16A16_SFLOAT, COLOR, CLEARED_USE | WRITTEN_USE | READ_BACK,
     COUNT_FOG_COLUMNS, COUNT_FOG_ROWS, 1, FILL, .per_view = true},
    BLANK_DEPTH("glass.blank_depth", picture.blank_depth),
    BLANK_COLOR("glass.blank_color", picture.blank_color),
};

enum { BIND_IMPACTS = 14 };

/* The same bindings as in shaders/glass, where each file declares those it uses. */
static const virga_binding_kind bindings[] = {
    RING(COMPUTE, tick_ring, virga_glass_tick_gpu), /* 0 */
    BUFFER(state),                                  /* 1 */
    BUFFER(drops),                                  /* 2 */
    BUFFER(selection),                              /* 3 */
    BUFFER(list),                                   /* 4 */
    BUFFER(claims),                                 /* 5 */
    BUFFER(occupants),                              /* 6 */
    BUFFER(film),                                   /* 7 */
    BUFFER(passed),                                 /* 8 */
    BUFFER(seeds),                                  /* 9 */
    BUFFER(ranks),                                  /* 10 */
    BUFFER(grid),                                   /* 11 */
    BUFFER(surface),                                /* 12 */
    TEXEL_BUFFER(nodes),                            /* 13 */
    [BIND_IMPACTS] = {STORAGE, COMPUTE},            /* 14; or particles of water */
    BUFFER(moved),                                  /* 15 */
    BUFFER(active),                                 /* 16 */
    BUFFER(film_blocks),                            /* 17 */
};

enum { LAYOUT_STEP, LAYOUT_PICTURE };

static const virga_effect_layout layouts[] = {
    [LAYOUT_STEP] = {AT(bindings), bindings, VIRGA_ROWS(bindings), 2, 5 * sizeof(uint32_t)},
    [LAYOUT_PICTURE] = {AT(picture.bindings), glass_picture_bindings, GLASS_PICTURE_BINDINGS, VIRGA_GLASS_MAX_VIEWS, 0},
};

#define PICTURE(pass, member, ...) PASS_AT(draw, pass, picture.member, .layout = LAYOUT_PICTURE, __VA_ARGS__)

static const virga_effect_pass passes[] = {
    STEP(live_mark),
    STEP(live_scan),
    STEP(live_compact),
    STEP(begin_tick),
    STEP(active_scan),
    STEP(active_compact),
    STEP(choose_cell),
    STEP(enter_cell),
    STEP(move_drops),
    STEP(capture_mark),
    STEP(capture),
    STEP(wipe_film),
    STEP(lay_film),
    STEP(split_drops),
    STEP(empty_bins),
    STEP(particle_grid),
    STEP(particle_starts),
    STEP(particle_sort),
    STEP(push_particles),
    STEP(merge_particles),
    STEP(to_drops_claim),
    STEP(to_drops),
    STEP(spawn_claim),
    STEP(spawn_scan),
    STEP(spawn),
    STEP(end_tick),
    STEP(dry_film),
    STEP(film_compact),
    STEP(measure),
    STEP(flood),
    STEP(recede),
    STEP(break_film),
    STEP(fog_begin),
    STEP(fog_grow),
    STEP(fog_wipe),
    STEP(fog_claim),
    STEP(fog_take),
    PICTURE(balls, ball_passes, .forms = 2),
    PICTURE(mist_blocks, mist_blocks),
    PICTURE(film_tiles, film_tiles),
    PICTURE(tile_list, tile_list),
    PICTURE(tile_fill, tile_fill),
    PICTURE(tile_quads, tile_quads),
    PICTURE(plate_copy, plate_copy),
    PICTURE(plate_shrink, plate_shrink),
    PICTURE(mist, mist_passes, .forms = GLASS_MIST_FORMS),
    PICTURE(texture, texture_passes, .forms = 2),
    PICTURE(drop_quads, drop_quads),
    PICTURE(front_quads, front_quads),
    PICTURE(fog_map, fog_map_pass),
};

/* The sizes that may shrink to fit the memory budget: the number of drops and the resolution of the height map. The
 * number of cells is fixed, because cells define where drops can be. */
static const virga_effect_pool pools[] = {
    POOL(max_drops, VIRGA_GLASS_GROUP, VIRGA_GLASS_GROUP),
    POOL(max_texels, 64, 1),
};

/* Size of the upload buffers of the shape. */
static VkDeviceSize extra_bytes(const void *given)
{
    const virga_glass_def *def = given;
    const VkDeviceSize columns = glass_cells_along(def->width_m, def->cell_m);
    return columns * glass_cells_along(def->height_m, def->cell_m) * 4 + NODE_BYTES;
}

static virga_result init(void *object)
{
    virga_glass *glass = object;
    glass->columns = glass_cells_along(glass->def.width_m, glass->def.cell_m);
    glass->rows = glass_cells_along(glass->def.height_m, glass->def.cell_m);
    return VIRGA_OK;
}

static virga_result create(void *object)
{
    virga_glass *glass = object;
    const virga_result result = glass_picture_create(glass);
    return result < 0 ? result : glass_shape_init(glass); /* this also creates the gather passes */
}

static void destroy(void *object)
{
    virga_glass *glass = object;
    glass_picture_destroy(glass);
    VIRGA_RETIRE(glass->base.context, glass->surface_upload);
    VIRGA_RETIRE(glass->base.context, glass->nodes_upload);
}

static void describe(const void *object, char *line, size_t size)
{
    const virga_glass *glass = object;
    snprintf(line, size, "glass: %u x %u cells, up to %u drops", glass->columns, glass->rows, glass->def.max_drops);
}

static virga_result check_settings(const void *object, void *given, bool *changed)
{
    const virga_glass *glass = object;
    virga_glass_settings *settings = given;
    for (uint32_t i = 0; i < settings->wiper_count; i++)
        if (glass_check_wiper(&glass->base.context->log, &settings->wipers[i], changed))
            return VIRGA_ERROR_INVALID;
    return glass_check_condensation(glass, settings);
}

static virga_result apply_settings(void *object, void *settings)
{
    return glass_picture_need(object, settings);
}

/* ---- state */

static const virga_effect_state_row state_rows[] = {
    STATE(ticks),          STATE(last_tick),     STATE(host_deg),  STATE(host_known),
    STATE(particles_ever), STATE(flooded_until), STATE(fog_since), STATE(fog_begun),
    STATE(heat_k),         STATE(heat_before_k), STATE(breaths),   STATE(breath_count),
};

/* The height map is of the state before the load. */
static void state_loaded(void *object)
{
    glass_picture_forget(object);
}

VIRGA_EFFECT_FUNCTIONS(glass)
VIRGA_EFFECT_STATE_FUNCTIONS(glass)
VIRGA_EFFECT_DRAW_FUNCTIONS(glass)
VIRGA_EFFECT_STATISTICS_FUNCTION(glass)

const virga_effect_type glass_type = {
    VIRGA_EFFECT_TYPE(glass, "a pane", "glass_settings"),
    VIRGA_EFFECT_DRAWS(glass),
    .draw_layout = LAYOUT_PICTURE,
    VIRGA_CALLBACKS(extra_bytes, init, create, destroy, fill_settings, check_settings, apply_settings, state_loaded),
    .draw_constant = glass_draw_constant,
    .wanted_draws = glass_wanted_draws,
    .lost = glass_lost,
    VIRGA_TABLE(state_row),
    .check_state = glass_check_state,
};

void glass_write_sets(virga_glass *glass, const virga_glass_step_info *info)
{
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&glass->base, glass->bindings, bound);
    bound[BIND_IMPACTS] = (virga_bound){.buffer = info->impacts ? info->impacts : glass->state->buffer,
                                        .offset = info->impacts ? info->impacts_offset : 0};
    glass->step_set = virga_bindings_write(glass->base.context, glass->bindings, 0, bound);
    if (!info->water || !info->water_count)
        return;
    bound[BIND_IMPACTS] = (virga_bound){.buffer = info->water,
                                        .offset = info->water_offset,
                                        .range = (VkDeviceSize)info->water_count * sizeof(virga_particle_gpu)};
    glass->water_set = virga_bindings_write(glass->base.context, glass->bindings, 1, bound);
}

virga_glass_pane_gpu glass_describe_pane(const virga_glass *glass)
{
    return (virga_glass_pane_gpu){.columns = glass->columns,
                                  .rows = glass->rows,
                                  .cell_m = glass->def.cell_m,
                                  .width_m = glass->def.width_m,
                                  .height_m = glass->def.height_m,
                                  .max_drops = glass->def.max_drops,
                                  .seed = glass->def.seed};
}

/* ---- queries */

double virga_glass_time(const virga_glass *glass)
{
    return glass ? (double)glass->last_tick * glass->def.tick_s : 0;
}

void virga_glass_drops(const virga_glass *glass, virga_glass_buffer *drops, uint32_t *count)
{
    if (drops)
        *drops = glass ? (virga_glass_buffer){glass->drops->buffer, 0, glass->drops->size} : (virga_glass_buffer){0};
    if (count)
        *count = glass ? glass->def.max_drops : 0;
}

void virga_glass_surface(const virga_glass *glass, virga_glass_buffer *surface, uint32_t *columns, uint32_t *rows)
{
    if (surface)
        *surface =
            glass ? (virga_glass_buffer){glass->surface->buffer, 0, glass->surface->size} : (virga_glass_buffer){0};
    if (columns)
        *columns = glass ? glass->columns : 0;
    if (rows)
        *rows = glass ? glass->rows : 0;
}
