/* glass/glass.c - create, destroy, settings, and what others read. */
#include "glass/glass_internal.h"

#include "core/light.h"
#include "core/settings.h"
#include "gpu/budget.h"
#include "gpu/builds.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"

#include <virga/shared/impact.h>

#include "shaders/glass_step_active_compact_comp.spv.h"
#include "shaders/glass_step_active_scan_comp.spv.h"
#include "shaders/glass_step_begin_tick_comp.spv.h"
#include "shaders/glass_step_capture_comp.spv.h"
#include "shaders/glass_step_capture_mark_comp.spv.h"
#include "shaders/glass_step_choose_cell_comp.spv.h"
#include "shaders/glass_step_dry_film_comp.spv.h"
#include "shaders/glass_step_empty_bins_comp.spv.h"
#include "shaders/glass_step_end_tick_comp.spv.h"
#include "shaders/glass_step_enter_cell_comp.spv.h"
#include "shaders/glass_step_film_compact_comp.spv.h"
#include "shaders/glass_step_live_compact_comp.spv.h"
#include "shaders/glass_step_live_mark_comp.spv.h"
#include "shaders/glass_step_live_scan_comp.spv.h"
#include "shaders/glass_step_measure_comp.spv.h"
#include "shaders/glass_step_particle_grid_comp.spv.h"
#include "shaders/glass_step_push_particles_comp.spv.h"
#include "shaders/glass_step_spawn_claim_comp.spv.h"
#include "shaders/glass_step_spawn_comp.spv.h"
#include "shaders/glass_step_spawn_scan_comp.spv.h"
#include "shaders/glass_step_split_drops_comp.spv.h"
#include "shaders/glass_step_to_drops_claim_comp.spv.h"
#include "shaders/glass_step_to_drops_comp.spv.h"
#include "shaders/glass_step_wipe_film_comp.spv.h"

#include <math.h>
#include <string.h>

#define DEF_COOKIE      VIRGA_COOKIE(11)
#define SETTINGS_COOKIE VIRGA_COOKIE(12)
#define MOST_CELLS      4194304.0

/* ---- defaults */

virga_glass_def virga_default_glass_def(void)
{
    return (virga_glass_def){.size = sizeof(virga_glass_def),
                             .cookie = DEF_COOKIE,
                             .seed = 1,
                             .width_m = 1.4f,
                             .height_m = 0.75f,
                             .cell_m = 0.002f,
                             .max_drops = 32768,
                             .affinity_m = 0.006f,
                             .max_texels = 1024,
                             .max_ticks_per_step = 16,
                             .tick_s = 1.0 / 60};
}

virga_glass_settings virga_default_glass_settings(void)
{
    virga_glass_settings settings = {.size = sizeof settings,
                                     .cookie = SETTINGS_COOKIE,
                                     .drag = 1,
                                     .meander = 0.1f,
                                     .path_ease = 0.6f,
                                     .path_s = 8,
                                     .touch = 1.2f,
                                     .tail_m = 0.012f,
                                     .tail_s = 12,
                                     .film_break_s = 0.8f,
                                     .evaporation_mm_h = 0.5f,
                                     .mist_mm = 0.6f,
                                     .air_share = 0.4f,
                                     .particle_mm = 1.5f,
                                     .penalty = 0.1f,
                                     .band = 4,
                                     .hold_back_mm = 2.2f,
                                     .hold_back_cells = 3,
                                     .density = VIRGA_GLASS_DENSITY_GOTO,
                                     .blend = VIRGA_GLASS_BLEND_SUM,
                                     .compress = true,
                                     .compress_from = 0.5f,
                                     .compress_step = 0.1f,
                                     .compress_k = 0.3f,
                                     .compress_steps = 5,
                                     .threshold = 0.5f,
                                     .impact_s = 0.25f,
                                     .style = VIRGA_GLASS_STYLE_PHYSICAL,
                                     .paper_shift = 0.35f,
                                     .thickness_mm = 5,
                                     .tint = {1, 1, 1},
                                     .gain = 1,
                                     .lighting = virga_default_lighting()};
    virga_glass_settings_of(VIRGA_GLASS_KIND_PAPER, &settings);
    for (uint32_t i = 0; i < VIRGA_GLASS_MAX_WIPERS; i++)
        settings.wipers[i] = virga_default_glass_wiper();
    return settings;
}

static float clamped(const virga_log *log, const char *name, float value, float low, float high)
{
    return virga_clamp_setting_float(log, name, value, low, high, NULL);
}

static virga_result check_def(const virga_log *log, const virga_glass_def *given, virga_glass_def *def)
{
    const virga_result result =
        virga_settings_check(log, "glass_def", given->size, sizeof *given, given->cookie, DEF_COOKIE);
    if (result)
        return result;
    if (virga_settings_finite(log, "glass_def.width_m", &given->width_m, 1) ||
        virga_settings_finite(log, "glass_def.height_m", &given->height_m, 1) ||
        virga_settings_finite(log, "glass_def.cell_m", &given->cell_m, 1) ||
        virga_settings_finite(log, "glass_def.affinity_m", &given->affinity_m, 1) ||
        virga_settings_finite_double(log, "glass_def.tick_s", &given->tick_s, 1))
        return VIRGA_ERROR_INVALID;
    *def = *given;
    def->width_m = clamped(log, "glass_def.width_m", def->width_m, 0.01f, 10);
    def->height_m = clamped(log, "glass_def.height_m", def->height_m, 0.01f, 10);
    const float least = (float)sqrt((double)def->width_m * (double)def->height_m / MOST_CELLS) * 1.01f;
    def->cell_m = clamped(log, "glass_def.cell_m", def->cell_m, least > 0.0005f ? least : 0.0005f, 0.01f);
    def->affinity_m = clamped(log, "glass_def.affinity_m", def->affinity_m, 0.0005f, 0.1f);
    def->max_drops = virga_clamp_setting_u32(log, "glass_def.max_drops", def->max_drops, 256, 262144, NULL);
    def->max_drops = (def->max_drops + VIRGA_GLASS_GROUP - 1) / VIRGA_GLASS_GROUP * VIRGA_GLASS_GROUP;
    def->max_texels = virga_clamp_setting_u32(log, "glass_def.max_texels", def->max_texels, 64, 4096, NULL);
    def->max_ticks_per_step =
        virga_clamp_setting_u32(log, "glass_def.max_ticks_per_step", def->max_ticks_per_step, 1, 64, NULL);
    def->tick_s = virga_clamp_setting(log, "glass_def.tick_s", def->tick_s, 1e-3, 0.05, NULL);
    return VIRGA_OK;
}

/* Whole cells over the pane; the last may stick out by a part. */
uint32_t glass_cells_along(float length_m, float cell_m)
{
    const double cells = ceil((double)length_m / (double)cell_m - 1e-4);
    return cells < 1 ? 1 : (uint32_t)cells;
}

/* ---- creating */

enum { BUFFERS = 18, PASSES = 24 };

uint32_t glass_film_blocks(const virga_glass *glass)
{
    const uint32_t side = VIRGA_GLASS_FILM_BLOCK;
    return (glass->columns + side - 1) / side * ((glass->rows + side - 1) / side);
}

static VkDeviceSize grid_cells(const virga_glass *glass)
{
    const float least = glass_least_grid_m(&glass->def);
    return (VkDeviceSize)glass_cells_along(glass->def.width_m, least) * glass_cells_along(glass->def.height_m, least);
}

static void list_buffers(virga_glass *glass, virga_buffer_row rows[BUFFERS])
{
    const virga_glass_def *def = &glass->def;
    const uint32_t frames = glass->context->frames_in_flight;
    const VkDeviceSize cells = (VkDeviceSize)glass->columns * glass->rows, places = def->max_drops;
    const VkDeviceSize seeds =
        GLASS_MOST_ARRIVALS + GLASS_MOST_IMPACTS + places + VIRGA_GLASS_BLADES * VIRGA_GLASS_BINS;
    const VkBufferUsageFlags storage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const VkBufferUsageFlags indirect = storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    const virga_buffer_row wanted[BUFFERS] = {
        {&glass->state, sizeof(virga_glass_state_gpu), indirect, VIRGA_HEAP_DEVICE, "glass.state"},
        {&glass->drops, places * sizeof(virga_glass_drop_gpu), storage, VIRGA_HEAP_DEVICE, "glass.drops"},
        {&glass->picks, VIRGA_PICK_BYTES(places), storage, VIRGA_HEAP_DEVICE, "glass.picks"},
        {&glass->list, sizeof(virga_list_gpu) + places * 4, indirect, VIRGA_HEAP_DEVICE, "glass.list"},
        {&glass->awake, sizeof(virga_list_gpu) + places * 4, storage, VIRGA_HEAP_DEVICE, "glass.awake"},
        {&glass->claims, cells * 8, storage, VIRGA_HEAP_DEVICE, "glass.claims"},
        {&glass->occupants, cells * 4, storage, VIRGA_HEAP_DEVICE, "glass.occupants"},
        {&glass->film, cells * 4, storage, VIRGA_HEAP_DEVICE, "glass.film"},
        {&glass->passed, cells * 4, storage, VIRGA_HEAP_DEVICE, "glass.passed"},
        {&glass->film_blocks, (VkDeviceSize)glass_film_blocks(glass) * 8, storage, VIRGA_HEAP_DEVICE,
         "glass.film_blocks"},
        {&glass->seeds, seeds * sizeof(virga_glass_seed_gpu), storage, VIRGA_HEAP_DEVICE, "glass.seeds"},
        {&glass->ranks, seeds * 4, storage, VIRGA_HEAP_DEVICE, "glass.ranks"},
        {&glass->grid, (grid_cells(glass) + places) * 4, storage, VIRGA_HEAP_DEVICE, "glass.grid"},
        {&glass->moved, places * 16, storage, VIRGA_HEAP_DEVICE, "glass.moved"},
        {&glass->surface, cells * 4, storage, VIRGA_HEAP_DEVICE, "glass.surface"},
        {&glass->nodes, VIRGA_GLASS_NODES * VIRGA_GLASS_NODES * sizeof(virga_glass_node_gpu),
         storage | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, VIRGA_HEAP_DEVICE, "glass.nodes"},
        {&glass->tick_ring, (VkDeviceSize)frames * def->max_ticks_per_step * glass_tick_bytes(),
         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, VIRGA_HEAP_UPLOAD, "glass.ticks"},
        {&glass->readback_ring, frames * sizeof(glass_readback), VK_BUFFER_USAGE_TRANSFER_DST_BIT, VIRGA_HEAP_READBACK,
         "glass.readback"},
    };
    memcpy(rows, wanted, sizeof wanted);
}

static void list_passes(virga_glass *glass, virga_compute_row rows[PASSES])
{
    const virga_compute_row wanted[PASSES] = {
        {&glass->census_find, VIRGA_SPIRV(glass_step_live_mark_comp), "glass.live_mark"},
        {&glass->census_scan, VIRGA_SPIRV(glass_step_live_scan_comp), "glass.live_scan"},
        {&glass->census_list, VIRGA_SPIRV(glass_step_live_compact_comp), "glass.live_compact"},
        {&glass->move, VIRGA_SPIRV(glass_step_begin_tick_comp), "glass.begin_tick"},
        {&glass->awake_scan, VIRGA_SPIRV(glass_step_active_scan_comp), "glass.active_scan"},
        {&glass->awake_list, VIRGA_SPIRV(glass_step_active_compact_comp), "glass.active_compact"},
        {&glass->choose, VIRGA_SPIRV(glass_step_choose_cell_comp), "glass.choose_cell"},
        {&glass->enter, VIRGA_SPIRV(glass_step_enter_cell_comp), "glass.enter_cell"},
        {&glass->capture_find, VIRGA_SPIRV(glass_step_capture_mark_comp), "glass.capture_mark"},
        {&glass->capture, VIRGA_SPIRV(glass_step_capture_comp), "glass.capture"},
        {&glass->wipe, VIRGA_SPIRV(glass_step_wipe_film_comp), "glass.wipe_film"},
        {&glass->touch, VIRGA_SPIRV(glass_step_split_drops_comp), "glass.split_drops"},
        {&glass->gather, VIRGA_SPIRV(glass_step_empty_bins_comp), "glass.empty_bins"},
        {&glass->relax_sort, VIRGA_SPIRV(glass_step_particle_grid_comp), "glass.particle_grid"},
        {&glass->relax, VIRGA_SPIRV(glass_step_push_particles_comp), "glass.push_particles"},
        {&glass->leave_find, VIRGA_SPIRV(glass_step_to_drops_claim_comp), "glass.to_drops_claim"},
        {&glass->leave, VIRGA_SPIRV(glass_step_to_drops_comp), "glass.to_drops"},
        {&glass->place_claim, VIRGA_SPIRV(glass_step_spawn_claim_comp), "glass.spawn_claim"},
        {&glass->place_scan, VIRGA_SPIRV(glass_step_spawn_scan_comp), "glass.spawn_scan"},
        {&glass->place, VIRGA_SPIRV(glass_step_spawn_comp), "glass.spawn"},
        {&glass->settle, VIRGA_SPIRV(glass_step_end_tick_comp), "glass.end_tick"},
        {&glass->dry, VIRGA_SPIRV(glass_step_dry_film_comp), "glass.dry_film"},
        {&glass->film_list, VIRGA_SPIRV(glass_step_film_compact_comp), "glass.film_compact"},
        {&glass->measure, VIRGA_SPIRV(glass_step_measure_comp), "glass.measure"},
    };
    memcpy(rows, wanted, sizeof wanted);
}

#define COMPUTE VK_SHADER_STAGE_COMPUTE_BIT

_Static_assert(VIRGA_GLASS_NODES *VIRGA_GLASS_NODES * sizeof(virga_glass_node_gpu) <= 16 * VIRGA_SURE_TEXELS,
               "nodes are texels on every device");

/* As in shaders/glass: what each file declares. */
static const virga_binding_kind kinds[] = {
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, COMPUTE}, /* 0 tick */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 1 state */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 2 drops */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 3 picks */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 4 list */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 5 claims */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 6 occupants */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 7 film */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 8 passed */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 9 seeds */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 10 ranks */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 11 grid */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 12 surface */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, COMPUTE},   /* 13 nodes */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 14 impacts */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 15 moved */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 16 awake */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},         /* 17 blocks with film */
};

enum { BINDINGS = sizeof kinds / sizeof kinds[0] };

static virga_bound whole(const virga_buffer *buffer)
{
    return (virga_bound){.buffer = buffer->buffer};
}

VkDescriptorSet glass_write_set(virga_glass *glass)
{
    const virga_bound impacts = {.buffer = glass->impacts ? glass->impacts : glass->state->buffer,
                                 .offset = glass->impacts ? glass->impacts_offset : 0};
    const virga_bound bound[BINDINGS] = {{.buffer = glass->tick_ring->buffer, .range = sizeof(virga_glass_tick_gpu)},
                                         whole(glass->state),
                                         whole(glass->drops),
                                         whole(glass->picks),
                                         whole(glass->list),
                                         whole(glass->claims),
                                         whole(glass->occupants),
                                         whole(glass->film),
                                         whole(glass->passed),
                                         whole(glass->seeds),
                                         whole(glass->ranks),
                                         whole(glass->grid),
                                         whole(glass->surface),
                                         {.texels = glass->nodes->texels},
                                         impacts,
                                         whole(glass->moved),
                                         whole(glass->awake),
                                         whole(glass->film_blocks)};
    return virga_bindings_write(glass->context, glass->bindings, 0, bound);
}

static virga_result init(virga_glass *glass)
{
    virga_result result = VIRGA_OK;
    virga_buffer_row buffers[BUFFERS];
    virga_compute_row passes[PASSES];
    list_buffers(glass, buffers);
    list_passes(glass, passes);
    TRY(virga_buffers_create(glass->context, buffers, BUFFERS));
    TRY(virga_bindings_create(glass->context, kinds, BINDINGS, 1, 5 * sizeof(uint32_t), &glass->bindings));
    TRY(virga_compute_pipelines_create(glass->context, glass->bindings->layout, 0, &glass->needed, passes, PASSES));
    TRY(glass_shape_init(glass));
    TRY(glass_picture_create(glass));
error:
    return result;
}

static virga_result make(virga_context *context, const void *def, void **glass)
{
    virga_glass *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, "a pane");
    made->context = context;
    made->def = *(const virga_glass_def *)def;
    made->columns = glass_cells_along(made->def.width_m, made->def.cell_m);
    made->rows = glass_cells_along(made->def.height_m, made->def.cell_m);
    made->settings = virga_default_glass_settings();
    context->effects++;
    const virga_result result = init(made);
    if (result < 0)
        virga_glass_destroy(&made);
    *glass = made;
    return result;
}

/* How many drops it holds and how fine its picture is. Its cells stay: they say where drops can be. */
static virga_result make_in_budget(virga_context *context, virga_glass_def *def, virga_glass **glass)
{
    const virga_pool pools[] = {
        {"max_drops", &def->max_drops, VIRGA_GLASS_GROUP, VIRGA_GLASS_GROUP},
        {"max_texels", &def->max_texels, 64, 1},
    };
    void *made = NULL;
    const virga_result result = virga_make_in_budget(context, "a pane", pools, 2, make, def, &made);
    *glass = made;
    return result;
}

virga_result virga_glass_create(virga_context *context, const virga_glass_def *given, virga_glass **glass)
{
    if (glass)
        *glass = NULL;
    if (!context || !given || !glass)
        return virga_wrong_argument(context ? &context->log : NULL, "virga_glass_create: NULL argument");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    virga_glass_def def;
    virga_result result = check_def(&context->log, given, &def);
    if (result)
        return result;
    virga_glass *made = NULL;
    result = make_in_budget(context, &def, &made);
    if (result < 0)
        return result;
    virga_log_say(&context->log, VIRGA_LOG_INFO, VIRGA_LOG_CREATED,
                  "glass: %u x %u cells, up to %u drops, %.1f MB of device memory in use", made->columns, made->rows,
                  made->def.max_drops, (double)context->device_used * 1e-6);
    *glass = made;
    return result;
}

void virga_glass_destroy(virga_glass **glass)
{
    if (!glass || !*glass)
        return;
    virga_glass *dying = *glass;
    virga_context *context = dying->context;
    virga_buffer_row buffers[BUFFERS];
    virga_compute_row passes[PASSES];
    list_buffers(dying, buffers);
    list_passes(dying, passes);
    glass_picture_destroy(dying);
    virga_compute_pipelines_retire(context, passes, PASSES);
    virga_buffers_retire(context, buffers, BUFFERS);
    VIRGA_RETIRE(context, dying->surface_upload);
    VIRGA_RETIRE(context, dying->nodes_upload);
    VIRGA_RETIRE(context, dying->bindings);
    context->effects--;
    virga_free(&context->heap, dying);
    *glass = NULL;
}

VkDeviceSize virga_glass_estimate(const virga_glass_def *given)
{
    virga_glass_def def;
    if (!given || check_def(NULL, given, &def))
        return 0;
    virga_context context = {.frames_in_flight = VIRGA_MAX_FRAMES_IN_FLIGHT};
    virga_glass glass = {.context = &context, .def = def};
    glass.columns = glass_cells_along(def.width_m, def.cell_m);
    glass.rows = glass_cells_along(def.height_m, def.cell_m);
    virga_buffer_row rows[BUFFERS];
    list_buffers(&glass, rows);
    VkDeviceSize sum = glass_picture_estimate(&def);
    for (uint32_t i = 0; i < BUFFERS; i++)
        sum += rows[i].size;
    return sum + (VkDeviceSize)glass.columns * glass.rows * 4 + /* the uploads */
           VIRGA_GLASS_NODES * VIRGA_GLASS_NODES * sizeof(virga_glass_node_gpu);
}

virga_result virga_glass_ready(const virga_glass *glass)
{
    return !glass                 ? VIRGA_ERROR_INVALID
           : glass->context->lost ? VIRGA_ERROR_DEVICE_LOST
                                  : virga_group_ready(&glass->needed);
}

/* ---- settings */

typedef struct number_row {
    float *value;
    float low, high;
    const char *name;
} number_row;

static virga_result check_rows(const virga_log *log, const number_row *rows, size_t count, bool *changed)
{
    for (size_t i = 0; i < count; i++) {
        if (virga_settings_finite(log, rows[i].name, rows[i].value, 1))
            return VIRGA_ERROR_INVALID;
        *rows[i].value =
            virga_clamp_setting_float(log, rows[i].name, *rows[i].value, rows[i].low, rows[i].high, changed);
    }
    return VIRGA_OK;
}

static virga_result check_wiper(const virga_log *log, virga_glass_wiper *w, bool *changed)
{
    const number_row rows[] = {
        {&w->pivot_m[0], -20, 20, "glass_wiper.pivot_m[0]"},
        {&w->pivot_m[1], -20, 20, "glass_wiper.pivot_m[1]"},
        {&w->reach_m, 0.01f, 10, "glass_wiper.reach_m"},
        {&w->blade_m, 0.01f, fminf(fmaxf(w->reach_m, 0.01f), 10), "glass_wiper.blade_m"},
        {&w->width_m, 0.001f, 0.1f, "glass_wiper.width_m"},
        {&w->low_deg, -720, 720, "glass_wiper.low_deg"},
        {&w->high_deg, -720, 720, "glass_wiper.high_deg"},
        {&w->blade_deg, -180, 180, "glass_wiper.blade_deg"},
        {&w->blade_turn, 0, 1, "glass_wiper.blade_turn"},
        {&w->sweep_s, 0.1f, 60, "glass_wiper.sweep_s"},
        {&w->pause_s, 0, 3600, "glass_wiper.pause_s"},
        {&w->phase_s, 0, 3600, "glass_wiper.phase_s"},
        {&w->host_deg, -7200, 7200, "glass_wiper.host_deg"},
        {&w->film_mm, 0, 0.5f, "glass_wiper.film_mm"},
        {&w->wear, 0, 1, "glass_wiper.wear"},
    };
    if ((uint32_t)w->drive > VIRGA_GLASS_HOST)
        return virga_wrong_argument(log, "glass_wiper.drive: there is no drive %d", (int)w->drive);
    return check_rows(log, rows, sizeof rows / sizeof rows[0], changed);
}

static virga_result check_numbers(const virga_log *log, virga_glass_settings *s, bool *changed)
{
    const number_row rows[] = {
        {&s->advancing_deg, 5, 175, "glass_settings.advancing_deg"},
        {&s->receding_deg, 1, fminf(fmaxf(s->advancing_deg, 5), 175), "glass_settings.receding_deg"},
        {&s->drag, 0.01f, 100, "glass_settings.drag"},
        {&s->run_hold, 0, 1, "glass_settings.run_hold"},
        {&s->affinity, 0, 2, "glass_settings.affinity"},
        {&s->meander, 0, 1, "glass_settings.meander"},
        {&s->path_ease, 0, 1, "glass_settings.path_ease"},
        {&s->path_s, 0.1f, 600, "glass_settings.path_s"},
        {&s->touch, 0, 2, "glass_settings.touch"},
        {&s->tail_m, 0.001f, 1, "glass_settings.tail_m"},
        {&s->tail_mm, 0, 2, "glass_settings.tail_mm"},
        {&s->tail_s, 0.1f, 3600, "glass_settings.tail_s"},
        {&s->film_um, 0, 100, "glass_settings.film_um"},
        {&s->film_break_s, 0, 60, "glass_settings.film_break_s"},
        {&s->evaporation_mm_h, 0, 100, "glass_settings.evaporation_mm_h"},
        {&s->mist_mm, 0, 1, "glass_settings.mist_mm"},
        {&s->air_share, 0, 2, "glass_settings.air_share"},
        {&s->particle_mm, 0.2f, 5, "glass_settings.particle_mm"},
        {&s->penalty, 0, 1, "glass_settings.penalty"},
        {&s->band, 1, 16, "glass_settings.band"},
        {&s->hold_back_mm, 0, 20, "glass_settings.hold_back_mm"},
        {&s->compress_from, 0, 2, "glass_settings.compress_from"},
        {&s->compress_step, 0, 1, "glass_settings.compress_step"},
        {&s->compress_k, 0, 1, "glass_settings.compress_k"},
        {&s->threshold, 0.05f, 0.95f, "glass_settings.threshold"},
        {&s->impact_s, 0, 2, "glass_settings.impact_s"},
        {&s->paper_shift, 0, 4, "glass_settings.paper_shift"},
        {&s->thickness_mm, 0, 50, "glass_settings.thickness_mm"},
        {&s->tint[0], 0, 1, "glass_settings.tint[0]"},
        {&s->tint[1], 0, 1, "glass_settings.tint[1]"},
        {&s->tint[2], 0, 1, "glass_settings.tint[2]"},
        {&s->gain, 0, 100, "glass_settings.gain"},
    };
    if (check_rows(log, rows, sizeof rows / sizeof rows[0], changed))
        return VIRGA_ERROR_INVALID;
    s->hold_back_cells =
        virga_clamp_setting_u32(log, "glass_settings.hold_back_cells", s->hold_back_cells, 0, 8, changed);
    s->compress_steps =
        virga_clamp_setting_u32(log, "glass_settings.compress_steps", s->compress_steps, 0, 16, changed);
    s->wiper_count =
        virga_clamp_setting_u32(log, "glass_settings.wiper_count", s->wiper_count, 0, VIRGA_GLASS_MAX_WIPERS, changed);
    for (uint32_t i = 0; i < s->wiper_count; i++)
        if (check_wiper(log, &s->wipers[i], changed))
            return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

virga_result virga_glass_set(virga_glass *glass, const virga_glass_settings *settings)
{
    if (!glass)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &glass->context->log;
    if (!settings)
        return virga_wrong_argument(log, "virga_glass_set: NULL argument");
    if (glass->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    const virga_result result = virga_settings_check(log, "glass_settings", settings->size, sizeof *settings,
                                                     settings->cookie, SETTINGS_COOKIE);
    if (result)
        return result;
    virga_glass_settings taken = *settings;
    bool changed = false;
    if ((uint32_t)taken.density > VIRGA_GLASS_DENSITY_NISHIMURA || (uint32_t)taken.blend > VIRGA_GLASS_BLEND_WEIGHTED ||
        (uint32_t)taken.style > VIRGA_GLASS_STYLE_PHYSICAL)
        return virga_wrong_argument(log, "glass_settings: there is no density %d, blend %d or style %d",
                                    (int)taken.density, (int)taken.blend, (int)taken.style);
    if (check_numbers(log, &taken, &changed) ||
        virga_lighting_check(log, "glass_settings", &taken.lighting, &changed) < 0)
        return VIRGA_ERROR_INVALID;
    const virga_result needed = glass_picture_need(glass, &taken);
    if (needed)
        return needed;
    glass->settings = taken;
    return changed ? VIRGA_DEGRADED : VIRGA_OK;
}

void virga_glass_get(const virga_glass *glass, virga_glass_settings *settings)
{
    if (glass && settings)
        *settings = glass->settings;
}

/* ---- what others read */

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

void virga_glass_stats_get(virga_glass *glass, virga_glass_stats *stats)
{
    if (!stats)
        return;
    memset(stats, 0, sizeof *stats);
    if (!glass)
        return;
    glass_take_statistics(glass);
    *stats = glass->stats;
}
