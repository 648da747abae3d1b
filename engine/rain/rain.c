/* rain/rain.c - creating and destroying a field of rain, and its settings. */
#include "rain/rain_internal.h"

#include "core/light.h"
#include "core/settings.h"
#include "gpu/budget.h"
#include "gpu/builds.h"
#include "gpu/errors.h"

#include "shaders/rain_compact_comp.spv.h"
#include "shaders/rain_draw_order_count_comp.spv.h"
#include "shaders/rain_draw_order_indices_comp.spv.h"
#include "shaders/rain_draw_order_scan_comp.spv.h"
#include "shaders/rain_draw_streak_mark_comp.spv.h"
#include "shaders/rain_draw_streak_scan_comp.spv.h"
#include "shaders/rain_draw_streak_write_comp.spv.h"
#include "shaders/rain_step_hit_count_comp.spv.h"
#include "shaders/rain_step_hit_mark_comp.spv.h"
#include "shaders/rain_step_hit_offsets_comp.spv.h"
#include "shaders/rain_step_hit_scan_comp.spv.h"
#include "shaders/rain_step_hit_write_comp.spv.h"
#include "shaders/rain_step_impact_mark_comp.spv.h"
#include "shaders/rain_step_impact_near_mark_comp.spv.h"
#include "shaders/rain_step_impact_near_scan_comp.spv.h"
#include "shaders/rain_step_impact_scan_comp.spv.h"
#include "shaders/rain_step_impact_write_comp.spv.h"
#include "shaders/rain_step_move_comp.spv.h"
#include "shaders/rain_step_points_comp.spv.h"
#include "shaders/rain_step_sway_comp.spv.h"

#include <math.h>
#include <string.h>

#define DEF_COOKIE        VIRGA_COOKIE(3)
#define SETTINGS_COOKIE   VIRGA_COOKIE(5)
#define REAL_DROPS_PER_M3 3200.0 /* of a cloudburst, from 0.2 mm up: decides how wide the innermost box may be */
#define RANGE_SHARE       0.75   /* of the widest box's half side is at full density, see FADE_FROM in field.glsl */

/* ---- defaults */

virga_rain_def virga_default_rain_def(void)
{
    return (virga_rain_def){.size = sizeof(virga_rain_def),
                            .cookie = DEF_COOKIE,
                            .seed = 1,
                            .max_drops = 131072,
                            .range_m = 32,
                            .max_impacts = 65536,
                            .max_ticks_per_step = 16,
                            .tick_s = 1.0 / 60,
                            .occlusion_size = 1024,
                            .occlusion_cascades = 2,
                            .occlusion_slants = 2,
                            .occluder_strides = {12, 32}};
}

virga_rain_settings virga_default_rain_settings(void)
{
    return (virga_rain_settings){.size = sizeof(virga_rain_settings),
                                 .cookie = SETTINGS_COOKIE,
                                 .rate_mm_h = 10,
                                 .air_density = (float)VIRGA_AIR_DENSITY,
                                 .transition_s = 0.5f,
                                 .gust_time_s = 4,
                                 .lighting = virga_default_lighting(),
                                 .streak_gain = 1,
                                 .light_gain = 1,
                                 .min_width_px = 1,
                                 .soft_m = 0.05f,
                                 .near_m = 0.15f,
                                 .oscillation = 1,
                                 .haze = 1,
                                 .haze_sky_m = 400,
                                 .glow = 1,
                                 .bodies_min_mm = 0.4f,
                                 .occlusion_turns = 1};
}

/* ---- the sizes that follow from a definition */

static virga_result check_def(const virga_log *log, const virga_rain_def *given, virga_rain_def *def)
{
    const virga_result result =
        virga_settings_check(log, "rain_def", given->size, sizeof *given, given->cookie, DEF_COOKIE);
    if (result)
        return result;
    if (virga_settings_finite(log, "rain_def.range_m", &given->range_m, 1) ||
        virga_settings_finite_double(log, "rain_def.tick_s", &given->tick_s, 1))
        return VIRGA_ERROR_INVALID;
    *def = *given;
    def->max_drops = virga_clamp_setting_u32(log, "rain_def.max_drops", def->max_drops, 1024, 4194304, NULL);
    def->range_m = virga_clamp_setting_float(log, "rain_def.range_m", def->range_m, 4, 512, NULL);
    def->max_impacts = virga_clamp_setting_u32(log, "rain_def.max_impacts", def->max_impacts, 256, 4194240, NULL);
    def->max_streaks = def->max_streaks ? def->max_streaks : def->max_drops;
    def->max_streaks = virga_clamp_setting_u32(log, "rain_def.max_streaks", def->max_streaks, 256, 4194304, NULL);
    def->max_ticks_per_step =
        virga_clamp_setting_u32(log, "rain_def.max_ticks_per_step", def->max_ticks_per_step, 1, 64, NULL);
    def->max_panes = virga_clamp_setting_u32(log, "rain_def.max_panes", def->max_panes, 0, VIRGA_RAIN_MAX_PANES, NULL);
    def->tick_s = virga_clamp_setting(log, "rain_def.tick_s", def->tick_s, 1e-3, 0.05, NULL);
    if (def->occlusion_size)
        def->occlusion_size =
            virga_clamp_setting_u32(log, "rain_def.occlusion_size", def->occlusion_size, 64, 8192, NULL);
    def->occlusion_cascades =
        virga_clamp_setting_u32(log, "rain_def.occlusion_cascades", def->occlusion_cascades, 1, 4, NULL);
    def->occlusion_slants =
        virga_clamp_setting_u32(log, "rain_def.occlusion_slants", def->occlusion_slants, 1, 4, NULL);
    for (int i = 0; i < 4; i++)
        if (def->occluder_strides[i] && (def->occluder_strides[i] < 12 || def->occluder_strides[i] % 4))
            return virga_wrong_argument(log, "rain_def.occluder_strides: expected multiples of 4 from 12, got %u",
                                        def->occluder_strides[i]);
    return VIRGA_OK;
}

/* Boxes double from one in which a cloudburst's drops are all slots up to one that holds the range. */
static void plan_boxes(const virga_rain_def *def, uint32_t *levels, uint32_t *groups_per_level, double *side_m)
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
    /* Slots must fit into an id's bits. */
    const uint32_t most = (1u << VIRGA_RAIN_ID_SLOT_BITS) / (VIRGA_RAIN_GROUP * *levels);
    *groups_per_level = *groups_per_level < most ? *groups_per_level : most;
    *side_m = widest;
}

/* Six indices a streak, and counts by bucket and workgroup, see shaders/rain/order.glsl. */
static VkDeviceSize order_bytes(const virga_rain_def *def)
{
    const VkDeviceSize groups = (def->max_streaks + VIRGA_RAIN_GROUP - 1) / VIRGA_RAIN_GROUP;
    return (6 * (VkDeviceSize)def->max_streaks + VIRGA_RAIN_BUCKETS * (1 + groups)) * sizeof(uint32_t);
}

VkDeviceSize virga_rain_estimate(const virga_rain_def *given)
{
    virga_rain_def def;
    if (!given || check_def(NULL, given, &def))
        return 0;
    uint32_t levels, groups_per_level;
    double side;
    plan_boxes(&def, &levels, &groups_per_level, &side);
    const VkDeviceSize slots = (VkDeviceSize)levels * groups_per_level * VIRGA_RAIN_GROUP;
    const VkDeviceSize maps =
        (VkDeviceSize)def.occlusion_size * def.occlusion_size * 8 * def.occlusion_cascades * def.occlusion_slants;
    return slots *
               (sizeof(virga_slot_gpu) * 2 + sizeof(virga_drop_gpu) + sizeof(uint32_t) + (def.wind_texture ? 40 : 0) +
                (def.points ? sizeof(virga_point_gpu) : 0) + (def.max_panes ? sizeof(uint32_t) : 0)) +
           VIRGA_PICK_BYTES(slots) + def.max_impacts * sizeof(virga_impact_gpu) +
           (VkDeviceSize)def.max_streaks * RAIN_STREAK_BYTES + order_bytes(&def) + maps +
           def.max_panes * rain_hits_bytes() +
           (VkDeviceSize)VIRGA_MAX_FRAMES_IN_FLIGHT *
               ((def.max_ticks_per_step + 1) * rain_tick_bytes() + VIRGA_RAIN_MAX_VIEWS * rain_view_bytes());
}

/* ---- creating */

/* What rain makes and lets go of, each in one table for both. */
enum { BUFFERS = 16, PASSES = 20 };

static void list_buffers(virga_rain *rain, virga_buffer_row rows[BUFFERS])
{
    const VkDeviceSize frames = rain->context->frames_in_flight, slots = rain->slots;
    const VkDeviceSize slot_bytes = slots * sizeof(virga_slot_gpu);
    const VkBufferUsageFlags storage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const VkBufferUsageFlags indirect = storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    const VkBufferUsageFlags uniform = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    const VkBufferUsageFlags texels = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    const virga_heap_kind device = VIRGA_HEAP_DEVICE, upload = VIRGA_HEAP_UPLOAD;
    const virga_buffer_row all[] = {
        {&rain->slot_buffer, slot_bytes, storage | texels, device, "rain.slots"},
        {&rain->drop_buffer, slots * sizeof(virga_drop_gpu), storage | texels, device, "rain.drops"},
        {&rain->impact_buffer, sizeof(virga_impacts_gpu) + rain->def.max_impacts * sizeof(virga_impact_gpu), indirect,
         device, "rain.impacts"},
        {&rain->pick_buffer, VIRGA_PICK_BYTES(slots), storage, device, "rain.picks"},
        {&rain->list_buffer, sizeof(virga_list_gpu) + slots * sizeof(uint32_t), indirect, device, "rain.list"},
        {&rain->streak_buffer, (VkDeviceSize)rain->def.max_streaks * RAIN_STREAK_BYTES, storage | texels, device,
         "rain.streaks"},
        {&rain->prepared_buffer, sizeof(virga_prepared_gpu), indirect, device, "rain.prepared"},
        {&rain->order_buffer, order_bytes(&rain->def), storage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT, device,
         "rain.order"},
        {&rain->hit_buffer, rain->def.max_panes * rain_hits_bytes(), storage, device, "rain.hits"},
        {&rain->hit_places, rain->def.max_panes ? slots * sizeof(uint32_t) : 0, storage, device, "rain.hit_places"},
        {&rain->sway_buffer, rain->def.wind_texture ? slots * sizeof(virga_sway_gpu) : 0, storage, device,
         "rain.sways"},
        {&rain->point_buffer, rain->def.points ? slots * sizeof(virga_point_gpu) : 0, storage, device, "rain.points"},
        {&rain->slot_upload, slot_bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, upload, "rain.slot_upload"},
        {&rain->tick_ring, frames * (rain->def.max_ticks_per_step + 1) * rain_tick_bytes(),
         uniform | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, upload, "rain.ticks"},
        {&rain->view_ring, frames * VIRGA_RAIN_MAX_VIEWS * rain_view_bytes(), uniform, upload, "rain.views"},
        {&rain->readback_ring, frames * sizeof(rain_readback), VK_BUFFER_USAGE_TRANSFER_DST_BIT, VIRGA_HEAP_READBACK,
         "rain.readback"},
    };
    _Static_assert(sizeof all == BUFFERS * sizeof all[0], "a row for each buffer");
    memcpy(rows, all, sizeof all);
}

static void list_passes(virga_rain *rain, virga_compute_row rows[PASSES])
{
    const virga_compute_row all[] = {
        {&rain->step, VIRGA_SPIRV(rain_step_move_comp), "rain.move"},
        {&rain->sway, VIRGA_SPIRV(rain_step_sway_comp), "rain.sway"},
        {&rain->impact_near, VIRGA_SPIRV(rain_step_impact_near_mark_comp), "rain.impact_near_mark"},
        {&rain->impact_near_scan, VIRGA_SPIRV(rain_step_impact_near_scan_comp), "rain.impact_near_scan"},
        {&rain->impact_find, VIRGA_SPIRV(rain_step_impact_mark_comp), "rain.impact_mark"},
        {&rain->list, VIRGA_SPIRV(rain_compact_comp), "rain.compact"},
        {&rain->impact_scan, VIRGA_SPIRV(rain_step_impact_scan_comp), "rain.impact_scan"},
        {&rain->impact_write, VIRGA_SPIRV(rain_step_impact_write_comp), "rain.impact_write"},
        {&rain->prepare_find, VIRGA_SPIRV(rain_draw_streak_mark_comp), "rain.streak_mark"},
        {&rain->prepare_scan, VIRGA_SPIRV(rain_draw_streak_scan_comp), "rain.streak_scan"},
        {&rain->prepare_write, VIRGA_SPIRV(rain_draw_streak_write_comp), "rain.streak_write"},
        {&rain->prepare_order_count, VIRGA_SPIRV(rain_draw_order_count_comp), "rain.order_count"},
        {&rain->prepare_order_scan, VIRGA_SPIRV(rain_draw_order_scan_comp), "rain.order_scan"},
        {&rain->prepare_order, VIRGA_SPIRV(rain_draw_order_indices_comp), "rain.order_indices"},
        {&rain->hit_find, VIRGA_SPIRV(rain_step_hit_mark_comp), "rain.hit_mark"},
        {&rain->hit_scan, VIRGA_SPIRV(rain_step_hit_scan_comp), "rain.hit_scan"},
        {&rain->hit_count, VIRGA_SPIRV(rain_step_hit_count_comp), "rain.hit_count"},
        {&rain->hit_place, VIRGA_SPIRV(rain_step_hit_offsets_comp), "rain.hit_offsets"},
        {&rain->hit_write, VIRGA_SPIRV(rain_step_hit_write_comp), "rain.hit_write"},
        {&rain->points, VIRGA_SPIRV(rain_step_points_comp), "rain.points"},
    };
    _Static_assert(sizeof all == PASSES * sizeof all[0], "a row for each pass");
    memcpy(rows, all, sizeof all);
}

/* What the host writes before the first frame. */
static void fill_host_buffers(virga_rain *rain)
{
    rain_classes_fill_slots(rain->classes, rain->def.seed, rain->slot_upload->memory.block.mapped);
    virga_buffer_flush(rain->context, rain->slot_upload, 0, rain->slot_upload->size);
    memset(rain->readback_ring->memory.block.mapped, 0, rain->readback_ring->size);
    virga_buffer_flush(rain->context, rain->readback_ring, 0, rain->readback_ring->size);
}

static virga_result create_field(virga_rain *rain)
{
    double side_m;
    plan_boxes(&rain->def, &rain->levels, &rain->groups_per_level, &side_m);
    rain->groups = rain->levels * rain->groups_per_level;
    rain->slots = rain->groups * VIRGA_RAIN_GROUP;
    rain->classes = virga_alloc(&rain->context->heap, sizeof *rain->classes);
    if (!rain->classes)
        return virga_out_of_host_memory(rain->context, "the size classes of rain");
    rain_classes_init(rain->classes, rain->levels, rain->groups_per_level * VIRGA_RAIN_GROUP, side_m);
    const virga_rain_settings *settings = &rain->settings;
    rain_classes_set_rain(rain->classes, &settings->sizes, (double)settings->rate_mm_h, (double)settings->air_density,
                          0);
    rain_wind_at(&rain->wind, settings, rain->def.seed, rain->wind_now);
    rain_classes_settle(rain->classes, rain->wind_now);
    return VIRGA_OK;
}

static virga_result init(virga_rain *rain)
{
    virga_result result = VIRGA_OK;
    virga_buffer_row buffers[BUFFERS];
    virga_compute_row passes[PASSES];
    const virga_rain_def *def = &rain->def;
    const uint32_t form = VIRGA_RAIN_FORM(def->occlusion_cascades, def->occlusion_slants, def->wind_texture);
    TRY(create_field(rain));
    list_buffers(rain, buffers);
    list_passes(rain, passes);
    TRY(virga_buffers_create(rain->context, buffers, BUFFERS));
    fill_host_buffers(rain);
    TRY(virga_uploaded(rain->context));
    TRY(virga_image_create(rain->context, VK_FORMAT_D32_SFLOAT, (VkExtent2D){1, 1}, 1,
                           VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                           VK_IMAGE_ASPECT_DEPTH_BIT, "rain.blank", &rain->blank));
    TRY(virga_image_create(rain->context, VK_FORMAT_R16G16B16A16_SFLOAT, (VkExtent2D){1, 1}, 0,
                           VK_IMAGE_USAGE_SAMPLED_BIT, VK_IMAGE_ASPECT_COLOR_BIT, "rain.blank_wind",
                           &rain->blank_wind));
    TRY(rain_occlusion_create(rain));
    TRY(rain_descriptors_create(rain));
    TRY(virga_compute_pipelines_create(rain->context, rain->bindings->layout, form, &rain->needed, passes, PASSES));
error:
    return result;
}

static virga_result make(virga_context *context, const void *def, void **rain)
{
    virga_rain *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, "rain");
    made->context = context;
    made->def = *(const virga_rain_def *)def;
    made->settings = virga_default_rain_settings();
    context->effects++;
    const virga_result result = init(made);
    if (result)
        virga_rain_destroy(&made);
    *rain = made;
    return result;
}

/* The field of drops, what is seen of it, what it hits, and its maps. */
static virga_result make_in_budget(virga_context *context, virga_rain_def *def, virga_rain **rain)
{
    const virga_pool pools[] = {
        {"max_drops", &def->max_drops, 1024, 1},
        {"max_streaks", &def->max_streaks, 256, 1},
        {"max_impacts", &def->max_impacts, 256, 1},
        {"occlusion_size", &def->occlusion_size, def->occlusion_size < 64 ? def->occlusion_size : 64, 1},
    };
    void *made = NULL;
    const virga_result result = virga_make_in_budget(context, "rain", pools, 4, make, def, &made);
    *rain = made;
    return result;
}

virga_result virga_rain_create(virga_context *context, const virga_rain_def *def, virga_rain **rain)
{
    if (rain)
        *rain = NULL;
    if (!context || !def || !rain)
        return virga_wrong_argument(context ? &context->log : NULL, "virga_rain_create: NULL argument");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    virga_rain_def checked;
    virga_result result = check_def(&context->log, def, &checked);
    if (result)
        return result;
    virga_rain *made = NULL;
    result = make_in_budget(context, &checked, &made);
    if (result < 0)
        return result;
    virga_log_say(&context->log, VIRGA_LOG_INFO, VIRGA_LOG_CREATED,
                  "rain: %u slots in %u boxes up to %.4g m wide, %.1f MB of device memory in use", made->slots,
                  made->levels, made->classes->side_m, (double)context->device_used * 1e-6);
    *rain = made;
    return result;
}

void virga_rain_destroy(virga_rain **rain)
{
    if (!rain || !*rain)
        return;
    virga_rain *dying = *rain;
    virga_context *context = dying->context;
    rain_targets_destroy(dying);
    virga_compute_row passes[PASSES];
    virga_buffer_row buffers[BUFFERS];
    list_passes(dying, passes);
    list_buffers(dying, buffers);
    virga_compute_pipelines_retire(context, passes, PASSES);
    virga_buffers_retire(context, buffers, BUFFERS);
    VIRGA_RETIRE(context, dying->blank);
    VIRGA_RETIRE(context, dying->blank_wind);
    virga_mesh_map_retire(context, &dying->map);
    VIRGA_RETIRE(context, dying->bindings);
    virga_free(&context->heap, dying->classes);
    virga_free(&context->heap, dying->table_diameter_m);
    virga_free(&context->heap, dying->table_number);
    context->effects--;
    virga_free(&context->heap, dying);
    *rain = NULL;
}

/* ---- settings */

static virga_result check_finite(const virga_log *log, const virga_rain_settings *s)
{
    const struct {
        const char *name;
        const float *values;
        uint32_t count;
    } floats[] = {{"rain.rate_mm_h", &s->rate_mm_h, 1},
                  {"rain.air_density", &s->air_density, 1},
                  {"rain.transition_s", &s->transition_s, 1},
                  {"rain.wind_m_s", s->wind_m_s, 3},
                  {"rain.gust_m_s", &s->gust_m_s, 1},
                  {"rain.gust_time_s", &s->gust_time_s, 1},
                  {"rain.streak_gain", &s->streak_gain, 1},
                  {"rain.light_gain", &s->light_gain, 1},
                  {"rain.min_width_px", &s->min_width_px, 1},
                  {"rain.soft_m", &s->soft_m, 1},
                  {"rain.near_m", &s->near_m, 1},
                  {"rain.oscillation", &s->oscillation, 1},
                  {"rain.haze", &s->haze, 1},
                  {"rain.haze_sky_m", &s->haze_sky_m, 1},
                  {"rain.glow", &s->glow, 1},
                  {"rain.bodies_min_mm", &s->bodies_min_mm, 1}};
    for (size_t i = 0; i < sizeof floats / sizeof floats[0]; i++)
        if (virga_settings_finite(log, floats[i].name, floats[i].values, floats[i].count))
            return VIRGA_ERROR_INVALID;
    if (virga_settings_places(log, "rain.wind_min_m", s->wind_min_m, 3) ||
        virga_settings_places(log, "rain.wind_max_m", s->wind_max_m, 3))
        return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

static bool clamp_settings(const virga_log *log, virga_rain_settings *s)
{
    bool changed = false;
    const struct {
        const char *name;
        float *value, lo, hi;
    } ranges[] = {{"rain.rate_mm_h", &s->rate_mm_h, 0, 200},
                  {"rain.air_density", &s->air_density, 0.3f, 2},
                  {"rain.transition_s", &s->transition_s, 0, 60},
                  {"rain.wind_m_s.x", &s->wind_m_s[0], -60, 60},
                  {"rain.wind_m_s.y", &s->wind_m_s[1], -60, 60},
                  {"rain.wind_m_s.z", &s->wind_m_s[2], -60, 60},
                  {"rain.gust_m_s", &s->gust_m_s, 0, 30},
                  {"rain.gust_time_s", &s->gust_time_s, 0.1f, 600},
                  {"rain.streak_gain", &s->streak_gain, 0, 100},
                  {"rain.light_gain", &s->light_gain, 0, 100},
                  {"rain.min_width_px", &s->min_width_px, 0.5f, 4},
                  {"rain.soft_m", &s->soft_m, 0, 1},
                  {"rain.near_m", &s->near_m, 0, 5},
                  {"rain.oscillation", &s->oscillation, 0, 4},
                  {"rain.haze", &s->haze, 0, 4},
                  {"rain.haze_sky_m", &s->haze_sky_m, 0, 1e5f},
                  {"rain.glow", &s->glow, 0, 100},
                  {"rain.bodies_min_mm", &s->bodies_min_mm, 0.2f, 2}};
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++)
        *ranges[i].value =
            virga_clamp_setting_float(log, ranges[i].name, *ranges[i].value, ranges[i].lo, ranges[i].hi, &changed);
    s->default_material = virga_clamp_setting_u32(log, "rain.default_material", s->default_material, 0, 255, &changed);
    s->occlusion_turns = virga_clamp_setting_u32(log, "rain.occlusion_turns", s->occlusion_turns, 1, 16, &changed);
    return changed;
}

/* Copies of the host's table, so that its pointers need not live on. NULL tables where it is of another kind. */
static virga_result copy_table(virga_rain *rain, const virga_sizes *sizes, double **diameters, double **numbers)
{
    *diameters = *numbers = NULL;
    const virga_result result = virga_sizes_densities(sizes, 1, VIRGA_AIR_DENSITY, 0, NULL, NULL);
    if (result)
        return virga_wrong_argument(&rain->context->log, "rain.sizes: expected Marshall-Palmer, Best, or a table of 2 "
                                                         "to 256 rising diameters with numbers >= 0");
    if (sizes->kind != VIRGA_SIZES_TABLE)
        return VIRGA_OK;
    const size_t bytes = sizes->table_count * sizeof(double);
    *diameters = virga_memdup(&rain->context->heap, sizes->table_diameter_m, bytes);
    *numbers = virga_memdup(&rain->context->heap, sizes->table_number, bytes);
    if (*diameters && *numbers)
        return VIRGA_OK;
    virga_free(&rain->context->heap, *diameters);
    virga_free(&rain->context->heap, *numbers);
    return virga_out_of_host_memory(rain->context, "a table of drop sizes");
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

/* Takes what was checked into force. */
static void apply(virga_rain *rain, virga_rain_settings *next, double *diameters, double *numbers)
{
    const virga_rain_settings *old = &rain->settings;
    const bool new_rain = old->rate_mm_h != next->rate_mm_h || old->air_density != next->air_density ||
                          !same_sizes(&old->sizes, &next->sizes);
    next->sizes.table_diameter_m = diameters;
    next->sizes.table_number = numbers;
    virga_free(&rain->context->heap, rain->table_diameter_m);
    virga_free(&rain->context->heap, rain->table_number);
    rain->table_diameter_m = diameters;
    rain->table_number = numbers;
    if (next->wind_texture) {
        rain->wind_image = *next->wind_texture;
        next->wind_texture = &rain->wind_image;
        rain->sway_on = true;
    }
    rain->settings = *next;
    if (new_rain) {
        rain_classes_set_air(rain->classes, (double)next->air_density);
        rain_classes_set_rain(rain->classes, &next->sizes, (double)next->rate_mm_h, (double)next->air_density,
                              rain->ticks ? (double)next->transition_s : 0);
    }
    if (!rain->ticks) {
        rain_wind_at(&rain->wind, next, rain->def.seed, rain->wind_now);
        rain_classes_settle(rain->classes, rain->wind_now);
    }
}

virga_result virga_rain_set(virga_rain *rain, const virga_rain_settings *settings)
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &rain->context->log;
    if (!settings)
        return virga_wrong_argument(log, "virga_rain_set: NULL settings");
    if (rain->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    virga_result result =
        virga_settings_check(log, "rain_settings", settings->size, sizeof *settings, settings->cookie, SETTINGS_COOKIE);
    if (!result)
        result = check_finite(log, settings);
    if (result)
        return result;
    if (settings->wind_texture && (!rain->def.wind_texture || !settings->wind_texture->view))
        return virga_wrong_argument(log, "rain.wind_texture: expected def.wind_texture at creation and an image view");
    virga_rain_settings next = *settings;
    bool changed = false;
    result = virga_lighting_check(log, "rain", &next.lighting, &changed);
    if (result)
        return result;
    changed |= clamp_settings(log, &next);
    double *diameters, *numbers;
    result = copy_table(rain, &next.sizes, &diameters, &numbers);
    if (result)
        return result;
    apply(rain, &next, diameters, numbers);
    return changed ? VIRGA_DEGRADED : VIRGA_OK;
}

void virga_rain_get(const virga_rain *rain, virga_rain_settings *settings)
{
    if (rain && settings)
        *settings = rain->settings;
}

/* ---- what others read */

virga_result virga_rain_ready(const virga_rain *rain)
{
    return !rain                 ? VIRGA_ERROR_INVALID
           : rain->context->lost ? VIRGA_ERROR_DEVICE_LOST
                                 : virga_group_ready(&rain->needed);
}

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
    rain_take_statistics(rain);
    *stats = rain->stats;
    stats->slots = rain->slots;
    stats->bodies_radius_m = (float)rain_classes_bodies_radius(rain->classes);
}
