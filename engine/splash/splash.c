/* splash/splash.c - create, destroy, settings, and what others read. */
#include "splash/splash_internal.h"

#include "core/light.h"
#include "core/settings.h"
#include "gpu/budget.h"
#include "gpu/builds.h"
#include "gpu/errors.h"

#include "shaders/splash_draw_droplet_mark_comp.spv.h"
#include "shaders/splash_draw_few_mark_comp.spv.h"
#include "shaders/splash_draw_indices_comp.spv.h"
#include "shaders/splash_draw_splash_mark_comp.spv.h"
#include "shaders/splash_draw_sprite_write_comp.spv.h"
#include "shaders/splash_draw_view_compact_comp.spv.h"
#include "shaders/splash_draw_view_scan_comp.spv.h"
#include "shaders/splash_step_fall_compact_comp.spv.h"
#include "shaders/splash_step_fall_scan_comp.spv.h"
#include "shaders/splash_step_fly_comp.spv.h"
#include "shaders/splash_step_rebase_comp.spv.h"
#include "shaders/splash_step_spawn_comp.spv.h"
#include "shaders/splash_step_spawn_scan_comp.spv.h"

#include <string.h>

#define DEF_COOKIE      VIRGA_COOKIE(9)
#define SETTINGS_COOKIE VIRGA_COOKIE(10)

/* ---- defaults */

virga_splash_def virga_default_splash_def(void)
{
    return (virga_splash_def){.size = sizeof(virga_splash_def),
                              .cookie = DEF_COOKIE,
                              .max_splashes = 65536,
                              .max_droplets = 131072,
                              .max_spawns = 65536,
                              .max_returns = 131072,
                              .max_ticks_per_step = 16,
                              .tick_s = 1.0 / 60};
}

virga_splash_settings virga_default_splash_settings(void)
{
    virga_splash_settings settings = {.size = sizeof settings,
                                      .cookie = SETTINGS_COOKIE,
                                      .mode = VIRGA_SPLASH_MODE_PHYSICAL,
                                      .style = VIRGA_SPLASH_STYLE_FILM,
                                      .pile_s = 0.012f,
                                      .pile_m = 0.008f,
                                      .bounce = 0.25f,
                                      .wind_share = 0.4f,
                                      .droplets_m = 2.5f,
                                      .dot_mm = 0.5f,
                                      .air_density = 1.204f,
                                      .lighting = virga_default_lighting(),
                                      .gain = 1,
                                      .light_gain = 1,
                                      .min_width_px = 1,
                                      .soft_m = 0.002f,
                                      .near_m = 0.05f};
    splash_default_rows(settings.rows);
    return settings;
}

static uint32_t power_of_two(uint32_t least)
{
    uint32_t power = 1;
    while (power < least)
        power *= 2;
    return power;
}

static virga_result check_def(const virga_log *log, const virga_splash_def *given, virga_splash_def *def)
{
    const virga_result result =
        virga_settings_check(log, "splash_def", given->size, sizeof *given, given->cookie, DEF_COOKIE);
    if (result)
        return result;
    if (virga_settings_finite_double(log, "splash_def.tick_s", &given->tick_s, 1))
        return VIRGA_ERROR_INVALID;
    *def = *given;
    def->max_splashes =
        power_of_two(virga_clamp_setting_u32(log, "splash_def.max_splashes", def->max_splashes, 256, 1048576, NULL));
    def->max_droplets = virga_clamp_setting_u32(log, "splash_def.max_droplets", def->max_droplets, 256, 4194304, NULL);
    def->max_droplets = (def->max_droplets + VIRGA_SPLASH_BLOCK - 1) / VIRGA_SPLASH_BLOCK * VIRGA_SPLASH_BLOCK;
    def->max_spawns = virga_clamp_setting_u32(log, "splash_def.max_spawns", def->max_spawns, 256, 1048576, NULL);
    def->max_returns =
        virga_clamp_setting_u32(log, "splash_def.max_returns", def->max_returns, def->max_spawns, 4194240, NULL);
    def->max_ticks_per_step =
        virga_clamp_setting_u32(log, "splash_def.max_ticks_per_step", def->max_ticks_per_step, 1, 64, NULL);
    def->tick_s = virga_clamp_setting(log, "splash_def.tick_s", def->tick_s, 1e-3, 0.05, NULL);
    return VIRGA_OK;
}

/* Quads of sprites, pyramids, the mesh of a sheet, and lines of sprites. */
static VkDeviceSize splash_index_bytes(const virga_splash_def *def)
{
    return (20ull * splash_max_sprites(def) + VIRGA_CROWN_INDICES) * sizeof(uint32_t);
}

/* Of droplets as lines, as quads and for their piles, and of splashes for sprites and for sheets. */
static VkDeviceSize pick_bytes(const virga_splash_def *def)
{
    return VIRGA_PICK_BYTES(3 * (VkDeviceSize)def->max_droplets + 2 * (VkDeviceSize)def->max_splashes);
}

/* What storage buffers of this device can hold, its indices count and its dispatches reach. True: less than asked
 * for. */
static bool fit_device(const virga_context *context, virga_splash_def *def)
{
    const VkDeviceSize most = context->properties.limits.maxStorageBufferRange;
    /* Both are wider than a droplet; what they have beside that for each is a block's, which is left out below. */
    const VkDeviceSize indices = splash_index_bytes(def) / def->max_droplets;
    const VkDeviceSize widest = indices > SPLASH_SPRITE_BYTES ? indices : SPLASH_SPRITE_BYTES;
    const VkDeviceSize indexed = context->properties.limits.maxDrawIndexedIndexValue / 8;
    const VkDeviceSize grouped =
        (VkDeviceSize)context->properties.limits.maxComputeWorkGroupCount[0] * VIRGA_SPLASH_GROUP;
    const VkDeviceSize counted = indexed < grouped ? indexed : grouped;
    const VkDeviceSize fits = most / widest < counted ? most / widest : counted;
    const uint32_t asked = def->max_droplets, blocks = (uint32_t)(fits / VIRGA_SPLASH_BLOCK) - 1;
    if (def->max_droplets > blocks * VIRGA_SPLASH_BLOCK)
        def->max_droplets = blocks * VIRGA_SPLASH_BLOCK;
    if (asked != def->max_droplets)
        virga_log_say(&context->log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED,
                      "splash_def.max_droplets: %u, as storage buffers of this device hold no more than %llu bytes",
                      def->max_droplets, (unsigned long long)most);
    while (sizeof(virga_impacts_gpu) + def->max_returns * sizeof(virga_impact_gpu) > most)
        def->max_returns /= 2;
    return asked != def->max_droplets;
}

VkDeviceSize virga_splash_estimate(const virga_splash_def *given)
{
    virga_splash_def def;
    if (!given || check_def(NULL, given, &def))
        return 0;
    return sizeof(virga_splash_state_gpu) + (VkDeviceSize)def.max_splashes * sizeof(virga_splash_gpu) +
           (VkDeviceSize)def.max_droplets * (2 * sizeof(virga_droplet_gpu) + 1) + (VkDeviceSize)def.max_spawns * 8 +
           (VkDeviceSize)def.max_returns * sizeof(virga_impact_gpu) +
           (VkDeviceSize)VIRGA_MAX_FRAMES_IN_FLIGHT * (def.max_ticks_per_step * splash_tick_bytes() +
                                                       splash_rules_bytes() + SPLASH_MAX_VIEWS * splash_view_bytes()) +
           pick_bytes(&def) + (VkDeviceSize)splash_max_sprites(&def) * (SPLASH_SPRITE_BYTES + 4) +
           splash_index_bytes(&def);
}

/* ---- creating */

enum { BUFFERS = 16, PASSES = 13 };

static void list_buffers(virga_splash *splash, virga_buffer_row rows[BUFFERS])
{
    const virga_splash_def *def = &splash->def;
    const uint32_t frames = splash->context->frames_in_flight, sprites = splash_max_sprites(def);
    const VkBufferUsageFlags storage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const VkBufferUsageFlags indirect = storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                             texels = storage | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    const virga_buffer_row wanted[BUFFERS] = {
        {&splash->state, sizeof(virga_splash_state_gpu), indirect, VIRGA_HEAP_DEVICE, "splash.state"},
        {&splash->splashes, def->max_splashes * sizeof(virga_splash_gpu), texels, VIRGA_HEAP_DEVICE, "splash.splashes"},
        {&splash->droplet_buffers[0], def->max_droplets * sizeof(virga_droplet_gpu), texels, VIRGA_HEAP_DEVICE,
         "splash.droplets0"},
        {&splash->droplet_buffers[1], def->max_droplets * sizeof(virga_droplet_gpu), texels, VIRGA_HEAP_DEVICE,
         "splash.droplets1"},
        {&splash->marks, def->max_droplets / 32 * 16, storage, VIRGA_HEAP_DEVICE, "splash.marks"},
        {&splash->places, (VkDeviceSize)def->max_spawns * 8, storage, VIRGA_HEAP_DEVICE, "splash.places"},
        {&splash->returns, sizeof(virga_impacts_gpu) + (VkDeviceSize)def->max_returns * sizeof(virga_impact_gpu),
         indirect, VIRGA_HEAP_DEVICE, "splash.returns"},
        {&splash->picks, pick_bytes(def), storage, VIRGA_HEAP_DEVICE, "splash.picks"},
        {&splash->lists, 2 * sizeof(virga_list_gpu) + ((VkDeviceSize)sprites + splash_max_crowns(def)) * 4, indirect,
         VIRGA_HEAP_DEVICE, "splash.lists"},
        {&splash->sprites, sprites * SPLASH_SPRITE_BYTES, texels, VIRGA_HEAP_DEVICE, "splash.sprites"},
        {&splash->prepared_buffer, sizeof(virga_splash_prepared_gpu), indirect, VIRGA_HEAP_DEVICE, "splash.prepared"},
        {&splash->index_buffer, splash_index_bytes(def), storage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT, VIRGA_HEAP_DEVICE,
         "splash.indices"},
        {&splash->tick_ring, (VkDeviceSize)frames * (def->max_ticks_per_step + 1) * splash_tick_bytes(),
         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, VIRGA_HEAP_UPLOAD, "splash.ticks"},
        {&splash->rules_ring, (VkDeviceSize)frames * splash_rules_bytes(), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
         VIRGA_HEAP_UPLOAD, "splash.rules"},
        {&splash->view_ring, (VkDeviceSize)frames * SPLASH_MAX_VIEWS * splash_view_bytes(),
         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, VIRGA_HEAP_UPLOAD, "splash.views"},
        {&splash->readback_ring, frames * sizeof(splash_readback), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
         VIRGA_HEAP_READBACK, "splash.readback"},
    };
    memcpy(rows, wanted, sizeof wanted);
}

/* A pass with as many pipelines as it has forms, which are their specialisation constants. */
typedef struct pass_row {
    virga_pipeline **forms;
    uint32_t count;
    virga_spirv shader;
    const char *name;
} pass_row;

static void list_passes(virga_splash *splash, pass_row rows[PASSES])
{
    const pass_row wanted[PASSES] = {
        {&splash->spawn_scan, 1, VIRGA_SPIRV(splash_step_spawn_scan_comp), "splash.spawn_scan"},
        {&splash->spawn, 1, VIRGA_SPIRV(splash_step_spawn_comp), "splash.spawn"},
        {&splash->step, 1, VIRGA_SPIRV(splash_step_fly_comp), "splash.fly"},
        {&splash->fall_scan, 1, VIRGA_SPIRV(splash_step_fall_scan_comp), "splash.fall_scan"},
        {&splash->fall, 1, VIRGA_SPIRV(splash_step_fall_compact_comp), "splash.fall_compact"},
        {&splash->rebase, 1, VIRGA_SPIRV(splash_step_rebase_comp), "splash.rebase"},
        {&splash->indices, 1, VIRGA_SPIRV(splash_draw_indices_comp), "splash.indices"},
        {splash->few_find, SPLASH_STYLES, VIRGA_SPIRV(splash_draw_few_mark_comp), "splash.few_mark"},
        {splash->droplet_find, SPLASH_STYLES, VIRGA_SPIRV(splash_draw_droplet_mark_comp), "splash.droplet_mark"},
        {splash->splash_find, SPLASH_STYLES, VIRGA_SPIRV(splash_draw_splash_mark_comp), "splash.splash_mark"},
        {&splash->view_scan, 1, VIRGA_SPIRV(splash_draw_view_scan_comp), "splash.view_scan"},
        {&splash->view_list, 1, VIRGA_SPIRV(splash_draw_view_compact_comp), "splash.view_compact"},
        {splash->sprite_write, VIRGA_SPLASH_FORMS, VIRGA_SPIRV(splash_draw_sprite_write_comp), "splash.sprite_write"},
    };
    memcpy(rows, wanted, sizeof wanted);
}

static virga_result create_passes(virga_splash *splash)
{
    virga_result result = VIRGA_OK;
    pass_row rows[PASSES];
    list_passes(splash, rows);
    for (uint32_t i = 0; i < PASSES; i++)
        for (uint32_t form = 0; form < rows[i].count; form++) {
            const virga_compute_def def = {.shader = rows[i].shader,
                                           .layout = splash->bindings->layout,
                                           .constant = form,
                                           .group = &splash->needed,
                                           .name = rows[i].name};
            TRY(virga_compute_pipeline_create(splash->context, &def, &rows[i].forms[form]));
        }
error:
    return result;
}

static void retire_passes(virga_splash *splash)
{
    pass_row rows[PASSES];
    list_passes(splash, rows);
    for (uint32_t i = 0; i < PASSES; i++)
        for (uint32_t form = 0; form < rows[i].count; form++)
            VIRGA_RETIRE(splash->context, rows[i].forms[form]);
}

#define COMPUTE VK_SHADER_STAGE_COMPUTE_BIT

/* As in shaders/splash: what each file declares. */
static const virga_binding_kind kinds[] = {
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VIRGA_ALL_STAGES},             /* 0 tick */
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VIRGA_ALL_STAGES},             /* 1 view */
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VIRGA_ALL_STAGES},             /* 2 rules */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 3 spawns */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VIRGA_ALL_STAGES},                     /* 4 state */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE | VK_SHADER_STAGE_VERTEX_BIT}, /* 5 splashes */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE | VK_SHADER_STAGE_VERTEX_BIT}, /* 6 droplets */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 7 marks */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 8 places */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 9 returns */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VIRGA_ALL_STAGES},                     /* 10 picks */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VIRGA_ALL_STAGES},                     /* 11 lists */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 12 droplets that stay */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE | VK_SHADER_STAGE_VERTEX_BIT}, /* 13 sprites */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 14 prepared */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 15 indices */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT}, /* 16 scene depth */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT}, /* 17 scene colour */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VIRGA_ALL_STAGES},               /* 18 droplets as texels */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VIRGA_ALL_STAGES},               /* 19 splashes as texels */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VIRGA_ALL_STAGES},               /* 20 sprites as texels */
};

enum { BINDINGS = sizeof kinds / sizeof kinds[0] };

static virga_bound whole(const virga_buffer *buffer)
{
    return (virga_bound){.buffer = buffer->buffer};
}

/* A host's image, or a blank in its place. */
static virga_bound image_or_blank(const virga_image *image, const virga_image_2d *blank, VkSampler sampler)
{
    const bool given = image && image->view;
    return (virga_bound){.sampler = sampler,
                         .view = given ? image->view : blank->layer_views[0],
                         .image_layout = given ? image->before.layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

/* Not every device filters four whole floats. */
static VkSampler color_sampler(const virga_splash *splash, const virga_view *view)
{
    const bool whole_floats = view && view->color.format == VK_FORMAT_R32G32B32A32_SFLOAT;
    return whole_floats ? splash->context->nearest : splash->context->linear;
}

uint32_t splash_current(const virga_splash *splash)
{
    return splash->droplets == splash->droplet_buffers[1];
}

VkDescriptorSet splash_write_set(virga_splash *splash, uint32_t index, uint32_t current, const virga_view *view)
{
    const virga_bound bound[BINDINGS] = {
        {.buffer = splash->tick_ring->buffer, .range = sizeof(virga_splash_tick_gpu)},
        {.buffer = splash->view_ring->buffer, .range = splash_view_bytes()},
        {.buffer = splash->rules_ring->buffer, .range = sizeof(virga_splash_rules_gpu)},
        {.buffer = splash->spawns, .offset = splash->spawns_offset, .range = splash->spawns_range},
        whole(splash->state),
        whole(splash->splashes),
        whole(splash->droplet_buffers[current]),
        whole(splash->marks),
        whole(splash->places),
        whole(splash->returns),
        whole(splash->picks),
        whole(splash->lists),
        whole(splash->droplet_buffers[current ^ 1]),
        whole(splash->sprites),
        whole(splash->prepared_buffer),
        whole(splash->index_buffer),
        image_or_blank(view ? &view->depth : NULL, splash->blank_depth, splash->context->nearest),
        image_or_blank(view ? &view->color : NULL, splash->blank_color, color_sampler(splash, view)),
        {.texels = splash->droplet_buffers[current]->texels},
        {.texels = splash->splashes->texels},
        {.texels = splash->sprites->texels}};
    return virga_bindings_write(splash->context, splash->bindings, index, bound);
}

void splash_bind(virga_splash *splash, VkCommandBuffer cmd, VkPipelineBindPoint point, VkDescriptorSet set)
{
    const uint32_t offsets[3] = {splash->tick_offset, splash->view_offset, splash->rules_offset};
    splash->context->vk.CmdBindDescriptorSets(cmd, point, splash->bindings->layout, 0, 1, &set, 3, offsets);
}

static virga_result init(virga_splash *splash)
{
    virga_result result = VIRGA_OK;
    virga_buffer_row buffers[BUFFERS];
    const bool smaller = fit_device(splash->context, &splash->def);
    list_buffers(splash, buffers);
    TRY(virga_buffers_create(splash->context, buffers, BUFFERS));
    splash->droplets = splash->droplet_buffers[0];
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT;
    const VkExtent2D one = {1, 1};
    TRY(virga_image_create(splash->context, VK_FORMAT_D32_SFLOAT, one, 1, sampled, VK_IMAGE_ASPECT_DEPTH_BIT,
                           "splash.blank_depth", &splash->blank_depth));
    TRY(virga_image_create(splash->context, VK_FORMAT_R8G8B8A8_UNORM, one, 1, sampled, VK_IMAGE_ASPECT_COLOR_BIT,
                           "splash.blank_color", &splash->blank_color));
    TRY(virga_bindings_create(splash->context, kinds, BINDINGS, SPLASH_SETS, sizeof(uint32_t), &splash->bindings));
    TRY(create_passes(splash));
    result = !result && smaller ? VIRGA_DEGRADED : result;
error:
    return result;
}

static virga_result make(virga_context *context, const void *def, void **splash)
{
    virga_splash *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, "splashes");
    made->context = context;
    made->def = *(const virga_splash_def *)def;
    made->settings = virga_default_splash_settings();
    context->effects++;
    const virga_result result = init(made);
    if (result < 0)
        virga_splash_destroy(&made);
    *splash = made;
    return result;
}

/* What lives at a time. What it shares with the ground stays. */
static virga_result make_in_budget(virga_context *context, virga_splash_def *def, virga_splash **splash)
{
    const virga_pool pools[] = {
        {"max_splashes", &def->max_splashes, 256, 0},
        {"max_droplets", &def->max_droplets, VIRGA_SPLASH_BLOCK, VIRGA_SPLASH_BLOCK},
    };
    void *made = NULL;
    const virga_result result = virga_make_in_budget(context, "splash", pools, 2, make, def, &made);
    *splash = made;
    return result;
}

virga_result virga_splash_create(virga_context *context, const virga_splash_def *given, virga_splash **splash)
{
    if (splash)
        *splash = NULL;
    if (!context || !given || !splash)
        return virga_wrong_argument(context ? &context->log : NULL, "virga_splash_create: NULL argument");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    virga_splash_def def;
    virga_result result = check_def(&context->log, given, &def);
    if (result)
        return result;
    virga_splash *made = NULL;
    result = make_in_budget(context, &def, &made);
    if (result < 0)
        return result;
    virga_log_say(&context->log, VIRGA_LOG_INFO, VIRGA_LOG_CREATED,
                  "splash: up to %u splashes and %u droplets, %.1f MB of device memory in use", made->def.max_splashes,
                  made->def.max_droplets, (double)context->device_used * 1e-6);
    *splash = made;
    return result;
}

void virga_splash_destroy(virga_splash **splash)
{
    if (!splash || !*splash)
        return;
    virga_splash *dying = *splash;
    virga_context *context = dying->context;
    virga_buffer_row buffers[BUFFERS];
    list_buffers(dying, buffers);
    retire_passes(dying);
    virga_buffers_retire(context, buffers, BUFFERS);
    splash_targets_destroy(dying);
    VIRGA_RETIRE(context, dying->blank_depth);
    VIRGA_RETIRE(context, dying->blank_color);
    VIRGA_RETIRE(context, dying->bindings);
    context->effects--;
    virga_free(&context->heap, dying);
    *splash = NULL;
}

virga_result virga_splash_ready(const virga_splash *splash)
{
    return !splash                 ? VIRGA_ERROR_INVALID
           : splash->context->lost ? VIRGA_ERROR_DEVICE_LOST
                                   : virga_group_ready(&splash->needed);
}

/* ---- settings */

static virga_result check_numbers(const virga_log *log, virga_splash_settings *s, bool *changed)
{
    const struct {
        float *value;
        float low, high;
        const char *name;
    } rows[] = {
        {&s->pile_s, 0.001f, 0.2f, "splash_settings.pile_s"},
        {&s->pile_m, 0.001f, 0.2f, "splash_settings.pile_m"},
        {&s->bounce, 0, 1, "splash_settings.bounce"},
        {&s->wind_share, 0, 2, "splash_settings.wind_share"},
        {&s->droplets_m, 0, 1000, "splash_settings.droplets_m"},
        {&s->dot_mm, 0.05f, 5, "splash_settings.dot_mm"},
        {&s->air_density, 0.3f, 2, "splash_settings.air_density"},
        {&s->gain, 0, 100, "splash_settings.gain"},
        {&s->light_gain, 0, 100, "splash_settings.light_gain"},
        {&s->min_width_px, 0.5f, 4, "splash_settings.min_width_px"},
        {&s->soft_m, 0, 1, "splash_settings.soft_m"},
        {&s->near_m, 0, 5, "splash_settings.near_m"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (virga_settings_finite(log, rows[i].name, rows[i].value, 1))
            return VIRGA_ERROR_INVALID;
        *rows[i].value =
            virga_clamp_setting_float(log, rows[i].name, *rows[i].value, rows[i].low, rows[i].high, changed);
    }
    return VIRGA_OK;
}

virga_result virga_splash_set(virga_splash *splash, const virga_splash_settings *settings)
{
    if (!splash)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &splash->context->log;
    if (!settings)
        return virga_wrong_argument(log, "virga_splash_set: NULL argument");
    if (splash->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    const virga_result result = virga_settings_check(log, "splash_settings", settings->size, sizeof *settings,
                                                     settings->cookie, SETTINGS_COOKIE);
    if (result)
        return result;
    virga_splash_settings taken = *settings;
    bool changed = false;
    if ((uint32_t)taken.mode > VIRGA_SPLASH_PHYSICAL || (uint32_t)taken.style > VIRGA_SPLASH_STYLE_FILM)
        return virga_wrong_argument(log, "splash_settings: there is no mode %d or style %d", (int)taken.mode,
                                    (int)taken.style);
    if (check_numbers(log, &taken, &changed) || splash_check_rows(log, taken.rows, &changed) ||
        virga_lighting_check(log, "splash_settings", &taken.lighting, &changed) < 0)
        return VIRGA_ERROR_INVALID;
    splash->settings = taken;
    return changed ? VIRGA_DEGRADED : VIRGA_OK;
}

void virga_splash_get(const virga_splash *splash, virga_splash_settings *settings)
{
    if (splash && settings)
        *settings = splash->settings;
}

/* ---- what others read */

void splash_push_rules(virga_splash *splash)
{
    virga_context *context = splash->context;
    if (splash->rules_frame == context->frame_index)
        return;
    splash->rules_frame = context->frame_index;
    splash->rules_offset = context->ring_slot * splash_rules_bytes();
    char *mapped = splash->rules_ring->memory.block.mapped;
    splash_fill_rules(splash, (virga_splash_rules_gpu *)(mapped + splash->rules_offset));
    virga_buffer_flush(context, splash->rules_ring, splash->rules_offset, splash_rules_bytes());
}

void virga_splash_rules(virga_splash *splash, virga_splash_buffer *rules)
{
    if (!rules)
        return;
    *rules = (virga_splash_buffer){0};
    if (!splash || splash->context->lost)
        return;
    if (!splash->context->frame_index)
        return;
    splash_push_rules(splash);
    *rules = (virga_splash_buffer){splash->rules_ring->buffer, splash->rules_offset, sizeof(virga_splash_rules_gpu)};
}

void virga_splash_returns(const virga_splash *splash, virga_splash_buffer *returns)
{
    if (returns)
        *returns = splash && splash->ticks ? (virga_splash_buffer){splash->returns->buffer, 0, splash->returns->size}
                                           : (virga_splash_buffer){0};
}

void virga_splash_droplets(const virga_splash *splash, virga_splash_buffer *droplets, uint32_t *count,
                           double anchor_m[3])
{
    if (droplets)
        *droplets = splash ? (virga_splash_buffer){splash->droplets->buffer, 0, splash->droplets->size}
                           : (virga_splash_buffer){0};
    if (count)
        *count = splash ? splash->def.max_droplets : 0;
    for (int axis = 0; anchor_m && axis < 3; axis++)
        anchor_m[axis] = splash ? splash->anchor_m[axis] : 0;
}

double virga_splash_time(const virga_splash *splash)
{
    return splash ? (double)splash->last_tick * splash->def.tick_s : 0;
}

void virga_splash_stats_get(virga_splash *splash, virga_splash_stats *stats)
{
    if (!stats)
        return;
    memset(stats, 0, sizeof *stats);
    if (!splash)
        return;
    splash_take_statistics(splash);
    *stats = splash->stats;
}
