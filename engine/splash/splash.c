/* splash/splash.c - creates and destroys splash objects, applies settings, and answers queries. */
#include "splash/splash_internal.h"

#include "core/settings.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"

#define EFFECT splash
#include "gpu/effect_rows.h"

#include "shaders/splash_shaders.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* ---- defaults */

/* clang-format off */
static const virga_setting_row def_rows[] = {
    DEF(U32, max_splashes, 256, 1048576, 65536),
    DEF(U32, max_droplets, 256, 4194304, 131072),
    DEF(U32, max_spawns, 256, 1048576, 65536),
    DEF(U32, max_returned_droplets, 0, 4194240, 131072),
    DEF(U32, max_handed, 0, 1048576),
    DEF(U32, max_drips, 0, 65536),
    DEF(U32, max_views, 1, VIRGA_MAX_VIEWS, 1, .look = true),
    VIRGA_TICK_ROWS,
};
/* clang-format on */

static const virga_setting_row setting_rows[] = {
    SETTING(ENUM, mode, 0, VIRGA_SPLASH_MODE_PHYSICAL, VIRGA_SPLASH_MODE_PHYSICAL),
    SETTING(ENUM, style, 0, VIRGA_SPLASH_STYLE_FILM, VIRGA_SPLASH_STYLE_FILM, .look = true),
    SETTING(FLOAT, pile_max_s, 0.001, 0.2, 0.012),
    SETTING(FLOAT, pile_max_m, 0.001, 0.2, 0.008),
    SETTING(FLOAT, bounce, 0, 1, 0.25),
    SETTING(FLOAT, wind_share, 0, 2, 0.4),
    SETTING(FLOAT, droplet_range_m, 0, 1000, 2.5),
    SETTING(FLOAT, dot_min_mm, 0.05, 5, 0.5),
    SETTING(FLOAT, drip_min_mm, 1, 7, 3),
    SETTING(FLOAT, drip_max_mm, 1, 7, 5),
    SETTING(BOOL, drip_wet, false, true, true),
    SETTING(FLOAT, air_density, 0.3, 2, 1.204),
    SETTING(FLOAT, gain, 0, 100, 1, .look = true),
    SETTING(FLOAT, light_gain, 0, 100, 1, .look = true),
    SETTING(FLOAT, min_width_px, 0.5, 4, 1, .look = true),
    SETTING(FLOAT, soft_m, 0, 1, 0.002, .look = true),
    SETTING(FLOAT, parts_px, 0.5, 10000, 1.3, .look = true),
    SETTING(FLOAT, hole_um, 0, 200, 25, .look = true),
    SETTING(FLOAT, near_fade_m, 0, 5, 0.05, .look = true),
};

static void fill_settings(void *settings)
{
    splash_default_rows(((virga_splash_settings *)settings)->rules);
}

static uint32_t power_of_two(uint32_t min)
{
    uint32_t power = 1;
    while (power < min)
        power *= 2;
    return power;
}

#define HANDED_BY_DRIPS 4096 /* room for drops of a step, if nothing else is handed over */

static virga_result check_def(const virga_log *log, void *given)
{
    virga_splash_def *def = given;
    def->max_splashes = power_of_two(def->max_splashes);
    def->max_droplets = (def->max_droplets + VIRGA_SPLASH_BLOCK - 1) / VIRGA_SPLASH_BLOCK * VIRGA_SPLASH_BLOCK;
    if (def->max_drips && !def->max_handed)
        def->max_handed = HANDED_BY_DRIPS;
    def->max_returned_droplets = virga_clamp_setting_u32(log, "splash_def.max_returned_droplets",
                                                         def->max_returned_droplets, def->max_spawns, 4194240, NULL);
    return VIRGA_OK;
}

/* ---- resources */

/* Number of indices: quads of sprites, pyramids, the mesh of a sheet, and lines of sprites. */
static VkDeviceSize index_count(const virga_splash_def *def)
{
    return 20ull * splash_max_sprites(def) + VIRGA_CROWN_INDICES;
}

/* Reduces the definition to the device's limits: storage buffer size, max index value and workgroup count. */
static virga_result fit_device(const virga_context *context, void *given)
{
    virga_splash_def *def = given;
    const VkDeviceSize max = context->properties.limits.maxStorageBufferRange;
    /* Indices and sprites need more bytes per droplet than the droplet itself. The parts of their buffers that do not
     * grow with droplets fit in one block, which is subtracted below. */
    const VkDeviceSize indices = index_count(def) * sizeof(uint32_t) / def->max_droplets;
    const VkDeviceSize widest = indices > SPLASH_SPRITE_BYTES ? indices : SPLASH_SPRITE_BYTES;
    const VkDeviceSize indexed = context->properties.limits.maxDrawIndexedIndexValue / 8;
    const VkDeviceSize grouped =
        (VkDeviceSize)context->properties.limits.maxComputeWorkGroupCount[0] * VIRGA_SPLASH_GROUP;
    const VkDeviceSize counted = indexed < grouped ? indexed : grouped;
    const VkDeviceSize fits = max / widest < counted ? max / widest : counted;
    const uint32_t requested = def->max_droplets;
    const uint32_t blocks = fits > 2 * VIRGA_SPLASH_BLOCK ? (uint32_t)(fits / VIRGA_SPLASH_BLOCK) - 1 : 1;
    if (def->max_droplets > blocks * VIRGA_SPLASH_BLOCK)
        def->max_droplets = blocks * VIRGA_SPLASH_BLOCK;
    if (requested != def->max_droplets)
        virga_log_write(&context->log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED,
                        "splash_def.max_droplets: %u, as this device allows no more (storage buffers of %llu bytes, "
                        "indices up to %u, %u workgroups)",
                        def->max_droplets, (unsigned long long)max, context->properties.limits.maxDrawIndexedIndexValue,
                        context->properties.limits.maxComputeWorkGroupCount[0]);
    while (sizeof(virga_impacts_gpu) + def->max_returned_droplets * sizeof(virga_impact_gpu) > max)
        def->max_returned_droplets /= 2;
    /* The budget may have asked for fewer. The water of each spawn may come back in the step in which it is read. */
    if (def->max_returned_droplets < def->max_spawns)
        def->max_returned_droplets = def->max_spawns;
    return requested != def->max_droplets ? VIRGA_DEGRADED : VIRGA_OK;
}

enum {
    COUNT_DROPLETS = 1,
    COUNT_MARK_WORDS,
    COUNT_SPLASHES,
    COUNT_SPAWNS,
    COUNT_RETURNS,
    COUNT_SELECTION_BYTES,
    COUNT_LISTED,
    COUNT_INDICES,
    COUNT_TICKS,
    COUNT_VIEWS,
    COUNT_HANDED_BYTES,
    COUNT_DRIP_BLOCKS,
    COUNT_DRIP_UPLOADS,
};

static void count(const void *given, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    const virga_splash_def *def = given;
    counts[COUNT_DROPLETS] = def->max_droplets;
    counts[COUNT_MARK_WORDS] = def->max_droplets / 32;
    counts[COUNT_SPLASHES] = def->max_splashes;
    counts[COUNT_SPAWNS] = def->max_spawns;
    counts[COUNT_RETURNS] = def->max_returned_droplets;
    /* Three lists of droplets (lines, quads, piles) and two of splashes (sprites, sheets). */
    counts[COUNT_SELECTION_BYTES] =
        VIRGA_SELECTION_BYTES(3 * (VkDeviceSize)def->max_droplets + 2 * (VkDeviceSize)def->max_splashes);
    counts[COUNT_LISTED] = (VkDeviceSize)splash_max_sprites(def) + splash_max_crowns(def);
    counts[COUNT_INDICES] = index_count(def);
    counts[COUNT_TICKS] = def->max_ticks_per_step + 2; /* one more for a move of the anchor, and one for spray */
    counts[COUNT_HANDED_BYTES] = def->max_handed ? sizeof(virga_handed_droplets_gpu) +
                                                       (VkDeviceSize)def->max_handed * sizeof(virga_handed_droplet_gpu)
                                                 : 0;
    counts[COUNT_DRIP_BLOCKS] = splash_drip_blocks(def);
    counts[COUNT_DRIP_UPLOADS] = counts[COUNT_DRIP_BLOCKS] ? counts[COUNT_DRIP_BLOCKS] : 1; /* a ring is never empty */
    counts[COUNT_VIEWS] = SPLASH_MAX_VIEWS;
}

static const virga_effect_buffer buffers[] = {
    {"splash.state", AT(state), VIRGA_USE_INDIRECT, DEVICE, .head = sizeof(virga_splash_state_gpu), .first = FILL},
    {"splash.splashes", AT(splashes), VIRGA_USE_TEXELS, DEVICE, .entry = sizeof(virga_splash_gpu),
     .count = COUNT_SPLASHES, .first = FILL},
    {"splash.droplets0", AT(droplet_buffers[0]), VIRGA_USE_TEXELS, DEVICE, .entry = sizeof(virga_droplet_gpu),
     .count = COUNT_DROPLETS, .first = FILL},
    {"splash.droplets1", AT(droplet_buffers[1]), VIRGA_USE_TEXELS, DEVICE, .entry = sizeof(virga_droplet_gpu),
     .count = COUNT_DROPLETS, .first = FILL},
    {"splash.marks", AT(marks), VIRGA_USE_STORAGE, DEVICE, .entry = 16, .count = COUNT_MARK_WORDS, .first = FILL},
    {"splash.spawn_offsets", AT(spawn_offsets), VIRGA_USE_STORAGE, DEVICE, .entry = 8, .count = COUNT_SPAWNS},
    {"splash.returns", AT(returned_droplets), VIRGA_USE_INDIRECT, DEVICE, .head = sizeof(virga_impacts_gpu),
     .entry = sizeof(virga_impact_gpu), .count = COUNT_RETURNS, .first = FILL},
    {"splash.handed", AT(handed), VIRGA_USE_INDIRECT, DEVICE, .entry = 1, .count = COUNT_HANDED_BYTES, .first = FILL},
    {"splash.drip_sites", AT(drip_sites), VIRGA_USE_STORAGE, DEVICE,
     .entry = VIRGA_DRIP_SITES_PER_BLOCK * sizeof(virga_drip_site_gpu), .count = COUNT_DRIP_BLOCKS, .first = FILL,
     .scratch = true},
    {"splash.drip_waters", AT(drip_waters), VIRGA_USE_STORAGE, DEVICE,
     .entry = VIRGA_DRIP_SITES_PER_BLOCK * sizeof(virga_drip_gpu), .count = COUNT_DRIP_BLOCKS, .first = FILL},
    {"splash.selection", AT(selection), VIRGA_USE_STORAGE, DEVICE, .entry = 1, .count = COUNT_SELECTION_BYTES},
    {"splash.lists", AT(lists), VIRGA_USE_INDIRECT, DEVICE, .head = 2 * sizeof(virga_list_gpu), .entry = 4,
     .count = COUNT_LISTED, .per_view = true},
    {"splash.sprites", AT(sprites), VIRGA_USE_TEXELS, DEVICE, .entry = SPLASH_SPRITE_BYTES, .count = COUNT_DROPLETS,
     .per_view = true},
    {"splash.prepared", AT(prepared_buffer), VIRGA_USE_INDIRECT, DEVICE, .head = sizeof(virga_splash_prepared_gpu),
     .per_view = true},
    {"splash.indices", AT(index_buffer), VIRGA_USE_INDEX, DEVICE, .entry = sizeof(uint32_t), .count = COUNT_INDICES},
};

static const virga_effect_ring rings[] = {
    {"splash.ticks", AT(tick_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(virga_splash_tick_gpu), COUNT_TICKS},
    {"splash.rules", AT(rules_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(virga_splash_rules_gpu), VIRGA_COUNT_ONE},
    {"splash.drip_ring", AT(drip_ring), VIRGA_USE_STORAGE, VIRGA_DRIP_SITES_PER_BLOCK * sizeof(virga_drip_site_gpu),
     COUNT_DRIP_UPLOADS},
    {"splash.views", AT(view_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(splash_view_block), COUNT_VIEWS},
};

/* Bound where a view has no depth or color. */
static const virga_effect_image images[] = {
    BLANK_DEPTH("splash.blank_depth", blank_depth),
    BLANK_COLOR("splash.blank_color", blank_color),
};

static const virga_effect_layout layouts[] = {
    [SPLASH_LAYOUT] = {AT(bindings), splash_bindings, SPLASH_BINDINGS, SPLASH_SETS, sizeof(uint32_t)},
    [SPLASH_LAYOUT_RECALL] = {AT(recall_bindings), splash_recall_bindings, SPLASH_RECALL_BINDINGS, 1, 0},
    [SPLASH_LAYOUT_HITS] = {AT(hits_bindings), splash_hits_bindings, SPLASH_HITS_BINDINGS, VIRGA_SPLASH_MAX_PANES,
                            2 * sizeof(uint32_t)},
    [SPLASH_LAYOUT_DRIP] = {AT(drip_bindings), splash_drip_bindings, SPLASH_DRIP_BINDINGS, 1, 0},
};

static const virga_effect_pass passes[] = {
    STEP(spawn_scan),
    STEP(spawn),
    STEP(fly),
    STEP(fall_scan),
    STEP(fall_compact),
    STEP(recall, .layout = SPLASH_LAYOUT_RECALL),
    STEP(give_hits, .layout = SPLASH_LAYOUT_HITS),
    STEP(drip, .layout = SPLASH_LAYOUT_DRIP),
    STEP(adopt),
    STEP(adopt_end),
    STEP(rebase),
    STEP(alive),
    DRAW(indices),
    DRAW(few_mark, .forms = SPLASH_STYLES),
    DRAW(droplet_mark, .forms = SPLASH_STYLES),
    DRAW(splash_mark, .forms = SPLASH_STYLES),
    DRAW(view_scan),
    DRAW(view_compact),
    DRAW(sprite_write, .forms = VIRGA_SPLASH_FORMS),
};

/* The sizes that may shrink to fit the memory budget. Spawns are the ground's list, so their number stays; the ground
 * reads as many returned droplets as there are, up to its own number. */
static const virga_effect_pool pools[] = {
    POOL(max_splashes, 256, 0),
    POOL(max_droplets, VIRGA_SPLASH_BLOCK, VIRGA_SPLASH_BLOCK),
    POOL(max_returned_droplets, 256, 256),
};

static virga_result init(void *object)
{
    return splash_drips_init(object);
}

static void destroy(void *object)
{
    splash_drips_destroy(object);
}

static void describe(const void *object, char *line, size_t size)
{
    const virga_splash *splash = object;
    snprintf(line, size, "splash: up to %u splashes and %u droplets", splash->def.max_splashes,
             splash->def.max_droplets);
}

static virga_result check_settings(const void *object, void *settings, bool *changed)
{
    const virga_splash *splash = object;
    return splash_check_rows(&splash->base.context->log, ((virga_splash_settings *)settings)->rules, changed);
}

/* ---- state */

static const virga_effect_state_row state_rows[] = {
    {"splash_settings.rules", AT(settings.rules), sizeof((virga_splash *)0)->settings.rules, .must_match = true},
    STATE(anchor_m),
    STATE(anchored),
    STATE(ticks),
    STATE(last_tick),
    STATE(current),
};

VIRGA_EFFECT_FUNCTIONS(splash)
VIRGA_EFFECT_STATE_FUNCTIONS(splash)
VIRGA_EFFECT_DRAW_FUNCTIONS(splash)
VIRGA_EFFECT_PREPARE_FUNCTIONS(splash)
VIRGA_EFFECT_STATISTICS_FUNCTION(splash)

const virga_effect_type splash_type = {
    VIRGA_EFFECT_TYPE(splash, "splash", "splash_settings"),
    VIRGA_EFFECT_DRAWS(splash),
    VIRGA_CALLBACKS(fit_device, fill_settings, check_settings, prepare, init, destroy),
    .lost = splash_lost,
    VIRGA_TABLE(state_row),
    .check_state = splash_check_state,
    .state_loaded = splash_state_loaded,
};

/* ---- queries */

void virga_splash_rules(virga_splash *splash, virga_splash_buffer *rules)
{
    if (!rules)
        return;
    *rules = (virga_splash_buffer){0};
    if (!splash || splash->base.context->lost)
        return;
    if (!splash->base.context->frame_index)
        return;
    splash_push_rules(splash);
    *rules =
        (virga_splash_buffer){splash->rules_ring.buffer->buffer, splash->rules_offset, sizeof(virga_splash_rules_gpu)};
}

void virga_splash_returned_droplets(const virga_splash *splash, virga_splash_buffer *returned_droplets)
{
    if (returned_droplets)
        *returned_droplets =
            splash && splash->ticks && splash->base.contents
                ? (virga_splash_buffer){splash->returned_droplets->buffer, 0, splash->returned_droplets->size}
                : (virga_splash_buffer){0};
}

void virga_splash_handed(const virga_splash *splash, virga_splash_buffer *handed)
{
    if (handed)
        *handed = splash && splash->handed ? (virga_splash_buffer){splash->handed->buffer, 0, splash->handed->size}
                                           : (virga_splash_buffer){0};
}

void virga_splash_droplets(const virga_splash *splash, virga_splash_buffer *droplets, uint32_t *count,
                           double anchor_m[3])
{
    if (droplets)
        *droplets = splash ? (virga_splash_buffer){splash_droplets(splash)->buffer, 0, splash_droplets(splash)->size}
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
