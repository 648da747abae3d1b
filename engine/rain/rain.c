/* rain/rain.c - creates and destroys a field of rain, and applies its settings. */
#include "rain/rain_internal.h"

#include "core/settings.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"

#define EFFECT rain
#include "gpu/effect_rows.h"

#include "shaders/rain_shaders.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define REAL_DROPS_PER_M3 3200.0 /* in a cloudburst, from 0.2 mm up: limits the size of the innermost box */
/* Share of the largest box's half side with full density, see FADE_FROM in field.glsl. */
#define RANGE_SHARE 0.75

/* ---- defaults */

/* Log lines name them "rain". */
#define RAIN(...) VIRGA_SETTING_ROW(rain, virga_rain_settings, __VA_ARGS__)

/* clang-format off */
static const virga_setting_row def_rows[] = {
    DEF(U32, seed, 0, UINT32_MAX, 1),
    DEF(U32, max_drops, 1024, 4194304, 131072),
    DEF(FLOAT, range_m, 4, 512, 32),
    DEF(U32, max_impacts, 256, 4194240, 65536),
    DEF(U32, max_panes, 0, VIRGA_RAIN_MAX_PANES, 0, .look = true),
    DEF(U32, max_views, 1, VIRGA_MAX_VIEWS, 1, .look = true),
    VIRGA_TICK_ROWS,
    DEF(U32, occlusion_size, 0, 8192, 1024),
    DEF(U32, occlusion_cascades, 1, 4, 2),
    DEF(U32, occlusion_slants, 1, 4, 2),
    DEF(BOOL, occlusion_keeps, false, true, false),
    DEF(U32, occluder_strides[0], 0, UINT32_MAX, 12),
    DEF(U32, occluder_strides[1], 0, UINT32_MAX, 32),
};
/* clang-format on */

static const virga_setting_row setting_rows[] = {
    RAIN(FLOAT, rate_mm_h, 0, 200, 10),
    RAIN(FLOAT, air_density, 0.3, 2, VIRGA_AIR_DENSITY),
    RAIN(FLOAT, transition_s, 0, 60, 0.5),
    RAIN(FLOAT, wind_m_s[0], -60, 60, 0),
    RAIN(FLOAT, wind_m_s[1], -60, 60, 0),
    RAIN(FLOAT, wind_m_s[2], -60, 60, 0),
    RAIN(FLOAT, gust_m_s, 0, 30, 0),
    RAIN(FLOAT, gust_time_s, 0.1, 600, 4),
    RAIN(FLOAT, streak_gain, 0, 100, 1, .look = true),
    RAIN(FLOAT, light_gain, 0, 100, 1, .look = true),
    RAIN(FLOAT, min_width_px, 0.5, 4, 1, .look = true),
    RAIN(FLOAT, soft_m, 0, 1, 0.05, .look = true),
    RAIN(FLOAT, near_fade_m, 0, 5, 0.15, .look = true),
    RAIN(FLOAT, oscillation, 0, 4, 1, .look = true),
    RAIN(FLOAT, haze, 0, 8, 1, .look = true),
    RAIN(FLOAT, haze_sky_m, 0, 1e5, 400, .look = true),
    RAIN(FLOAT, glow, 0, 100, 1, .look = true),
    RAIN(FLOAT, streak_min_mm, 0.2, 2, 0.4, .look = true),
    RAIN(FLOAT, streak_group_mm, 0.2, 100, 100, .look = true),
    RAIN(U32, default_material, 0, 255, 0),
    RAIN(U32, occlusion_interval, 1, 16, 1),
    RAIN(FLOAT, occlusion_tolerance, 0, 16, 4),
    RAIN(BOOL, walls.on, false, true, true),
    RAIN(FLOAT, walls.share, 0, 2, 0.5),
    RAIN(FLOAT, walls.evaporation_mm_h, 0, 100, 0.2),
    RAIN(FLOAT, walls.start_h, 0, 240, 0),
};

static void fill_settings(void *settings)
{
    rain_walls_default(((virga_rain_settings *)settings)->walls.materials);
}

/* ---- the sizes that follow from a definition */

static virga_result check_def(const virga_log *log, void *given)
{
    virga_rain_def *def = given;
    if (def->max_streaks)
        def->max_streaks = virga_clamp_setting_u32(log, "rain_def.max_streaks", def->max_streaks, 256, 4194304, NULL);
    else
        def->max_streaks = def->max_drops;
    if (def->occlusion_size)
        def->occlusion_size =
            virga_clamp_setting_u32(log, "rain_def.occlusion_size", def->occlusion_size, 64, 8192, NULL);
    return virga_mesh_map_check_strides(log, "rain_def.occluder_strides", def->occluder_strides);
}

/* Each box has twice the side of the next inner one. The outermost holds the range. In the innermost there are enough
 * slots for each drop of a cloudburst. */
static void plan_levels(const virga_rain_def *def, uint32_t *levels, uint32_t *groups_per_level, double *side_m)
{
    const double widest = 2 * (double)def->range_m / RANGE_SHARE;
    *levels = 1;
    for (;;) {
        const double side = ldexp(widest, 1 - (int)*levels);
        const double slots = (double)def->max_drops / *levels;
        if (slots >= side * side * side * REAL_DROPS_PER_M3 || *levels == VIRGA_RAIN_MAX_LEVELS ||
            slots < 2.0 * VIRGA_RAIN_GROUP)
            break;
        ++*levels;
    }
    *groups_per_level = (def->max_drops + *levels * VIRGA_RAIN_GROUP - 1) / (*levels * VIRGA_RAIN_GROUP);
    /* The index of a slot must fit into the bits of an id. */
    const uint32_t max = (1u << VIRGA_RAIN_ID_SLOT_BITS) / (VIRGA_RAIN_GROUP * *levels);
    *groups_per_level = *groups_per_level < max ? *groups_per_level : max;
    *side_m = widest;
}

/* ---- buffers, passes and pools */

enum {
    COUNT_SLOTS = 1,
    COUNT_SELECTION_BYTES,
    COUNT_IMPACTS,
    COUNT_STREAKS,
    COUNT_ORDER,
    COUNT_PANES,
    COUNT_HIT_SLOTS,
    COUNT_SWAYS,
    COUNT_POINTS,
    COUNT_TICKS,
    COUNT_VIEWS,
};

static void count(const void *given, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    const virga_rain_def *def = given;
    uint32_t levels, groups_per_level;
    double side_m;
    plan_levels(def, &levels, &groups_per_level, &side_m);
    const VkDeviceSize slots = (VkDeviceSize)levels * groups_per_level * VIRGA_RAIN_GROUP;
    const VkDeviceSize streak_groups = (def->max_streaks + VIRGA_RAIN_GROUP - 1) / VIRGA_RAIN_GROUP;
    counts[COUNT_SLOTS] = slots;
    counts[COUNT_SELECTION_BYTES] = VIRGA_SELECTION_BYTES(slots);
    counts[COUNT_IMPACTS] = def->max_impacts;
    counts[COUNT_STREAKS] = def->max_streaks;
    /* Six indices per streak, and one count per bucket and workgroup, see shaders/rain/order.glsl. */
    counts[COUNT_ORDER] = 6 * (VkDeviceSize)def->max_streaks + VIRGA_RAIN_BUCKETS * (1 + streak_groups);
    counts[COUNT_PANES] = def->max_panes;
    counts[COUNT_HIT_SLOTS] = def->max_panes ? slots : 0;
    counts[COUNT_SWAYS] = def->wind_texture ? slots : 0;
    counts[COUNT_POINTS] = def->points ? slots : 0;
    counts[COUNT_TICKS] = def->max_ticks_per_step + 1; /* one more for a view without a step */
    counts[COUNT_VIEWS] = VIRGA_RAIN_MAX_VIEWS;
}

static const virga_effect_buffer buffers[] = {
    {"rain.slots", AT(slot_buffer), VIRGA_USE_TEXELS, DEVICE, 0, sizeof(virga_slot_gpu), COUNT_SLOTS},
    {"rain.drops", AT(drop_buffer), VIRGA_USE_TEXELS, DEVICE, 0, sizeof(virga_drop_gpu), COUNT_SLOTS},
    {"rain.impacts", AT(impact_buffer), VIRGA_USE_INDIRECT, DEVICE, sizeof(virga_impacts_gpu), sizeof(virga_impact_gpu),
     COUNT_IMPACTS, FILL},
    {"rain.selection", AT(selection_buffer), VIRGA_USE_STORAGE, DEVICE, 0, 1, COUNT_SELECTION_BYTES},
    {"rain.list", AT(list_buffer), VIRGA_USE_INDIRECT, DEVICE, sizeof(virga_list_gpu), sizeof(uint32_t), COUNT_SLOTS},
    {"rain.streaks", AT(streak_buffer), VIRGA_USE_TEXELS, DEVICE, 0, RAIN_STREAK_BYTES, COUNT_STREAKS,
     .per_view = true},
    {"rain.total", AT(total_buffer), VIRGA_USE_STORAGE, DEVICE, sizeof(virga_rain_total_gpu), .first = FILL},
    {"rain.prepared", AT(prepared_buffer), VIRGA_USE_INDIRECT, DEVICE, sizeof(virga_prepared_gpu), .first = FILL,
     .per_view = true},
    {"rain.order", AT(order_buffer), VIRGA_USE_INDEX, DEVICE, 0, sizeof(uint32_t), COUNT_ORDER, .per_view = true},
    {"rain.hits", AT(hit_buffer), VIRGA_USE_STORAGE, DEVICE, 0, RAIN_HITS_BYTES, COUNT_PANES, FILL, .scratch = true},
    {"rain.hit_offsets", AT(hit_offset_buffer), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(uint32_t), COUNT_HIT_SLOTS},
    {"rain.sways", AT(sway_buffer), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_sway_gpu), COUNT_SWAYS, FILL},
    {"rain.points", AT(point_buffer), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_point_gpu), COUNT_POINTS},
    {"rain.slot_upload", AT(slot_upload), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, VIRGA_HEAP_UPLOAD, 0,
     sizeof(virga_slot_gpu), COUNT_SLOTS},
};

static const virga_effect_ring rings[] = {
    {"rain.ticks", AT(tick_ring), VIRGA_USE_UNIFORM | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
     VIRGA_RING_BYTES(rain_tick_block), COUNT_TICKS},
    {"rain.views", AT(view_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(rain_view_block), COUNT_VIEWS},
};

/* Bound if a view has no scene depth, or the host gave no wind. */
static const virga_effect_image images[] = {
    BLANK_DEPTH("rain.blank", blank),
    {"rain.blank_wind", AT(blank_wind), VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_ASPECT_COLOR_BIT,
     VK_IMAGE_USAGE_SAMPLED_BIT, VIRGA_COUNT_ONE, VIRGA_COUNT_ONE, 0, VIRGA_FIRST_SAMPLED},
};

static const virga_effect_layout layouts[] = {
    {AT(bindings), rain_bindings, RAIN_BINDINGS, RAIN_SETS, sizeof(virga_rain_pane_gpu)},
};

static const virga_effect_pass passes[] = {
    STEP(move),         STEP(sway),        STEP(impact_near_mark), STEP(impact_near_scan), STEP(impact_mark),
    PASS(compact),      STEP(impact_scan), STEP(impact_write),     DRAW(streak_mark),      DRAW(streak_scan),
    DRAW(streak_write), DRAW(order_count), DRAW(order_scan),       DRAW(order_indices),    STEP(hit_mark),
    STEP(hit_scan),     STEP(hit_count),   STEP(hit_offsets),      STEP(hit_write),        STEP(points),
};

/* What shrinks to fit the memory budget: drops, streaks, impacts and occlusion maps. */
static const virga_effect_pool pools[] = {
    POOL(max_drops, 1024, 1),
    POOL(max_streaks, 256, 1),
    POOL(max_impacts, 256, 1),
    POOL(occlusion_size, 64, 1),
};

static VkDeviceSize extra_bytes(const void *given)
{
    const virga_rain_def *def = given;
    const uint32_t maps = def->occlusion_cascades * def->occlusion_slants;
    return virga_mesh_map_bytes(def->occlusion_size, def->occlusion_keeps ? 2 * maps : maps);
}

static virga_result init(void *object)
{
    virga_rain *rain = object;
    double side_m;
    plan_levels(&rain->def, &rain->levels, &rain->groups_per_level, &side_m);
    rain->groups = rain->levels * rain->groups_per_level;
    rain->slots = rain->groups * VIRGA_RAIN_GROUP;
    rain->classes = virga_alloc(&rain->base.context->heap, sizeof *rain->classes);
    if (!rain->classes)
        return virga_out_of_host_memory(rain->base.context, "the size classes of rain");
    rain_classes_init(rain->classes, rain->levels, rain->groups_per_level * VIRGA_RAIN_GROUP, side_m);
    const virga_rain_settings *settings = &rain->settings;
    rain_classes_set_rain(rain->classes, &settings->sizes, (double)settings->rate_mm_h, (double)settings->air_density,
                          0);
    rain_wind_at(&rain->wind, settings, rain->def.seed, rain->wind_now);
    rain_classes_settle(rain->classes, rain->wind_now);
    return VIRGA_OK;
}

static virga_result create(void *object)
{
    virga_rain *rain = object;
    rain_classes_fill_slots(rain->classes, rain->def.seed, rain->slot_upload->memory.block.mapped);
    virga_buffer_flush(rain->base.context, rain->slot_upload, 0, rain->slot_upload->size);
    return rain_occlusion_create(rain);
}

static void destroy(void *object)
{
    virga_rain *rain = object;
    virga_host_heap *heap = &rain->base.context->heap;
    virga_mesh_map_retire(rain->base.context, &rain->map);
    virga_free(heap, rain->classes);
    virga_free(heap, rain->table_diameter_m);
    virga_free(heap, rain->table_number);
}

static void describe(const void *object, char *line, size_t size)
{
    const virga_rain *rain = object;
    snprintf(line, size, "rain: %u slots in %u levels, the largest %.4g m wide", rain->slots, rain->levels,
             rain->classes->side_m);
}

static uint32_t pass_constant(const void *object)
{
    const virga_rain_def *def = &((const virga_rain *)object)->def;
    return VIRGA_RAIN_FORM(def->occlusion_cascades, def->occlusion_slants, def->wind_texture);
}

/* ---- settings */

static virga_result check_settings(const void *object, void *given, bool *changed)
{
    const virga_rain *rain = object;
    virga_rain_settings *settings = given;
    const virga_log *log = &rain->base.context->log;
    if (rain_walls_check(log, settings->walls.materials, changed))
        return VIRGA_ERROR_INVALID;
    if (settings->wind_texture && (!rain->def.wind_texture || !settings->wind_texture->view))
        return virga_wrong_argument(log, "rain.wind_texture: expected def.wind_texture at creation and an image view");
    const virga_result result = virga_settings_check_positions(log, "rain.wind_min_m", settings->wind_min_m, 3);
    return result ? result : virga_settings_check_positions(log, "rain.wind_max_m", settings->wind_max_m, 3);
}

/* Copies the host's table, so that its pointers need not stay valid. The results are NULL for other kinds of sizes. */
static virga_result copy_table(virga_rain *rain, const virga_sizes *sizes, double **diameters, double **numbers)
{
    *diameters = *numbers = NULL;
    const virga_result result = virga_sizes_densities(sizes, 1, VIRGA_AIR_DENSITY, 0, NULL, NULL);
    if (result)
        return virga_wrong_argument(&rain->base.context->log,
                                    "rain.sizes: expected Marshall-Palmer, Best, or a table of 2 "
                                    "to 256 rising diameters with numbers >= 0");
    if (sizes->kind != VIRGA_SIZES_TABLE)
        return VIRGA_OK;
    const size_t bytes = sizes->table_count * sizeof(double);
    *diameters = virga_memdup(&rain->base.context->heap, sizes->table_diameter_m, bytes);
    *numbers = virga_memdup(&rain->base.context->heap, sizes->table_number, bytes);
    if (*diameters && *numbers)
        return VIRGA_OK;
    virga_free(&rain->base.context->heap, *diameters);
    virga_free(&rain->base.context->heap, *numbers);
    return virga_out_of_host_memory(rain->base.context, "a table of drop sizes");
}

static bool same_sizes(const virga_sizes *a, const virga_sizes *b)
{
    if (a->kind != b->kind)
        return false;
    if (a->kind != VIRGA_SIZES_TABLE)
        return true;
    return a->table_count == b->table_count &&
           !memcmp(a->table_diameter_m, b->table_diameter_m, a->table_count * sizeof(double)) &&
           !memcmp(a->table_number, b->table_number, a->table_count * sizeof(double));
}

static virga_result apply_settings(void *object, void *given)
{
    virga_rain *rain = object;
    virga_rain_settings *next = given;
    const virga_rain_settings *old = &rain->settings;
    const bool new_rain = old->rate_mm_h != next->rate_mm_h || old->air_density != next->air_density ||
                          !same_sizes(&old->sizes, &next->sizes);
    double *diameters, *numbers;
    const virga_result result = copy_table(rain, &next->sizes, &diameters, &numbers);
    if (result)
        return result;
    next->sizes.table_diameter_m = diameters;
    next->sizes.table_number = numbers;
    virga_free(&rain->base.context->heap, rain->table_diameter_m);
    virga_free(&rain->base.context->heap, rain->table_number);
    rain->table_diameter_m = diameters;
    rain->table_number = numbers;
    if (next->wind_texture) {
        rain->wind_image = *next->wind_texture;
        next->wind_texture = &rain->wind_image;
        rain->sway_on = true;
    }
    if (new_rain) {
        rain_classes_set_air(rain->classes, (double)next->air_density);
        rain_classes_set_rain(rain->classes, &next->sizes, (double)next->rate_mm_h, (double)next->air_density,
                              rain->ticks ? (double)next->transition_s : 0);
    }
    if (!rain->ticks) {
        rain_wind_at(&rain->wind, next, rain->def.seed, rain->wind_now);
        rain_classes_settle(rain->classes, rain->wind_now);
    }
    return VIRGA_OK;
}

/* ---- state: occlusion maps are drawn anew, see rain_occlusion.c */

static const virga_effect_state_row state_rows[] = {
    {"rain_settings.sizes.kind", AT(settings.sizes.kind), sizeof(virga_sizes_kind), .must_match = true},
    {"classes", AT(classes), sizeof(rain_classes), .pointed = true},
    STATE(wind),
    STATE(wind_now),
    STATE(walls),
    STATE(ticks),
    STATE(ticks_of_step),
    STATE(left_over_s),
    STATE(origin),
    STATE(sway_on),
    STATE(slant_smooth),
    STATE(maps),
    STATE(map_count),
    STATE(next_map),
};

VIRGA_EFFECT_FUNCTIONS(rain)
VIRGA_EFFECT_DRAW_FUNCTIONS(rain)
VIRGA_EFFECT_PREPARE_FUNCTIONS(rain)
VIRGA_EFFECT_STATE_FUNCTIONS(rain)

const virga_effect_type rain_type = {
    VIRGA_EFFECT_TYPE(rain, "rain", "rain"),
    VIRGA_EFFECT_DRAWS(rain),
    VIRGA_CALLBACKS(extra_bytes, init, create, destroy, pass_constant, check_settings, apply_settings, prepare),
    .fill_settings = fill_settings,
    .lost = rain_lost,
    VIRGA_TABLE(state_row),
    .check_state = rain_check_state,
    .state_loaded = rain_state_loaded,
};

/* ---- buffers and statistics */

void virga_rain_impacts(const virga_rain *rain, virga_rain_buffer *impacts)
{
    if (rain && impacts)
        *impacts = (virga_rain_buffer){rain->impact_buffer->buffer, 0, rain->impact_buffer->size};
}

void virga_rain_drops(const virga_rain *rain, virga_rain_buffer *drops, uint32_t *count, double origin_m[3])
{
    if (!rain)
        return;
    if (drops)
        *drops = (virga_rain_buffer){rain->drop_buffer->buffer, 0, rain->drop_buffer->size};
    if (count)
        *count = rain->slots;
    if (origin_m)
        memcpy(origin_m, rain->origin, sizeof rain->origin);
}

void virga_rain_stats_get(virga_rain *rain, virga_rain_stats *stats)
{
    if (!rain || !stats)
        return;
    virga_effect_read_statistics(&rain->base);
    *stats = rain->stats;
    stats->slots = rain->slots;
    stats->real_drop_radius_m = (float)rain_classes_real_drop_radius(rain->classes);
}
