/* lens/lens.c - creates and destroys lenses, applies settings, and answers queries. */
#include "lens/lens_internal.h"

#include "core/settings.h"
#include "gpu/errors.h"
#include "lens/lens.h"

#define EFFECT lens
#include "gpu/effect_rows.h"

#include "shaders/lens_shaders.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- defaults */

static const virga_setting_row def_rows[] = {
    DEF(U32, max_width, 16, 16384, 1920),
    DEF(U32, max_height, 16, 16384, 1080),
    DEF(U32, half_resolution, 0, 1),
    DEF(U32, max_views, 1, VIRGA_MAX_VIEWS, 1, .look = true),
    DEF(U32, circles, 0, 1),
    DEF(U32, in_place, 0, 1),
};

static const virga_setting_row setting_rows[] = {
    SETTING(ENUM, style, VIRGA_LENS_STYLE_PAPER, VIRGA_LENS_STYLE_PHYSICAL, VIRGA_LENS_STYLE_PHYSICAL),
    SETTING(FLOAT, focal_m, 0.001, 10, 0.05),
    SETTING(FLOAT, aperture_f, 0, 128, 2.8),
    SETTING(FLOAT, focus_m, 0, 1e6, 10),
    SETTING(U32, follow, 0, 1),
    SETTING(FLOAT, focus_point[0], 0, 1, 0.5),
    SETTING(FLOAT, focus_point[1], 0, 1, 0.5),
    SETTING(FLOAT, focus_time_s, 0, 60, 0.25),
    SETTING(U32, blades, 0, 16),
    SETTING(FLOAT, blade_roundness, 0, 1),
    SETTING(FLOAT, blade_rotation_deg, -360, 360),
    SETTING(FLOAT, cats_eye, 0, 1),
    SETTING(FLOAT, max_radius_px, 1, 2 * VIRGA_LENS_MAX_RADIUS, 32),
    SETTING(FLOAT, threshold_m[0], 0, 1e6, 5),
    SETTING(FLOAT, threshold_m[1], 0, 1e6, 20),
    SETTING(FLOAT, filter_weight[0], 0, 100, 1),
    SETTING(FLOAT, filter_weight[1], 0, 100, 5),
};

static virga_result check_def(const virga_log *log, void *given)
{
    const virga_lens_def *def = given;
    if (def->in_place && (!def->half_resolution || def->circles))
        return virga_wrong_argument(log, "lens_def.in_place: expected half_resolution 1 and circles 0 beside it");
    return VIRGA_OK;
}

static virga_result fit_device(const virga_context *context, void *given)
{
    virga_lens_def *def = given;
    bool changed = false;
    const uint32_t max = context->properties.limits.maxImageDimension2D;
    def->max_width = virga_clamp_setting_u32(&context->log, "lens_def.max_width", def->max_width, 16, max, &changed);
    def->max_height = virga_clamp_setting_u32(&context->log, "lens_def.max_height", def->max_height, 16, max, &changed);
    return changed ? VIRGA_DEGRADED : VIRGA_OK;
}

/* ---- resources */

enum {
    COUNT_PICTURE_WIDTH = 1,
    COUNT_HEIGHT,
    COUNT_COLUMNS,
    COUNT_ROWS,
    COUNT_TILES,
    COUNT_BLOCK_COLUMNS,
    COUNT_BLOCK_ROWS,
    COUNT_APERTURE,
    COUNT_APERTURE_ROWS,
    COUNT_VIEWS,
    COUNT_CIRCLES_WIDTH,
    COUNT_CIRCLES_HEIGHT,
    COUNT_COARSE_COLUMNS,
    COUNT_COARSE_ROWS,
    COUNT_PACKED_COLUMNS,
    COUNT_PACKED_ROWS,
};

/* Blocks along a side with a ring around them, up to whole workgroups. */
static uint32_t level_size(uint32_t texels, uint32_t level)
{
    return (((texels + (1u << level) - 1) >> level) + 2 + 7) & ~7u;
}

/* The image of blocks, see shaders/lens/levels.glsl. */
static void count_blocks(VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    const uint32_t columns = (uint32_t)counts[COUNT_COLUMNS], rows = (uint32_t)counts[COUNT_ROWS];
    const uint32_t below = level_size(columns, 2) + level_size(columns, 3), above = level_size(columns, 1);
    counts[COUNT_BLOCK_COLUMNS] = columns ? above > below ? above : below : 0;
    counts[COUNT_BLOCK_ROWS] = columns ? level_size(rows, 1) + level_size(rows, 2) : 0;
}

static void count(const void *given, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    const virga_lens_def *def = given;
    const uint32_t step = def->half_resolution ? 2 : 1;
    const uint32_t width = def->circles ? 0 : def->max_width, height = def->circles ? 0 : def->max_height;
    counts[COUNT_PICTURE_WIDTH] = def->in_place ? 0 : width;
    counts[COUNT_HEIGHT] = height;
    counts[COUNT_COLUMNS] = (width + step - 1) / step;
    counts[COUNT_ROWS] = (height + step - 1) / step;
    count_blocks(counts);
    counts[COUNT_COARSE_COLUMNS] = def->in_place ? (counts[COUNT_COLUMNS] + 1) / 2 : 0;
    counts[COUNT_COARSE_ROWS] = def->in_place ? (counts[COUNT_ROWS] + 1) / 2 : 0;
    counts[COUNT_PACKED_COLUMNS] = def->in_place ? counts[COUNT_COLUMNS] : 0;
    counts[COUNT_PACKED_ROWS] = def->in_place ? counts[COUNT_ROWS] : 0;
    counts[COUNT_CIRCLES_WIDTH] = def->max_width - width;
    counts[COUNT_CIRCLES_HEIGHT] = def->max_height - height;
    counts[COUNT_TILES] = (counts[COUNT_COLUMNS] + VIRGA_LENS_TILE - 1) / VIRGA_LENS_TILE *
                          ((counts[COUNT_ROWS] + VIRGA_LENS_TILE - 1) / VIRGA_LENS_TILE);
    counts[COUNT_APERTURE] = VIRGA_LENS_APERTURE;
    counts[COUNT_APERTURE_ROWS] = VIRGA_LENS_APERTURE + VIRGA_LENS_AREA_ROWS;
    counts[COUNT_VIEWS] = VIRGA_MAX_VIEWS;
}

static const virga_effect_buffer buffers[] = {
    {"lens.state", AT(state), VIRGA_USE_STORAGE | VIRGA_USE_UNIFORM, DEVICE, .head = sizeof(virga_lens_state_gpu),
     .first = VIRGA_FIRST_FILL, .per_view = true},
    {"lens.focused", AT(focused), VIRGA_USE_STORAGE | VIRGA_USE_UNIFORM, DEVICE, .head = sizeof(virga_lens_state_gpu),
     .first = VIRGA_FIRST_FILL, .per_view = true, .scratch = true},
    {"lens.tiles", AT(tiles), VIRGA_USE_STORAGE, DEVICE, .entry = sizeof(virga_lens_tile_gpu), .count = COUNT_TILES,
     .first = VIRGA_FIRST_FILL, .scratch = true},
    {"lens.lists", AT(lists), VIRGA_USE_INDIRECT, DEVICE, .head = VIRGA_LENS_LISTS * sizeof(virga_lens_list_gpu),
     .entry = VIRGA_LENS_TILE_WORDS * sizeof(uint32_t), .count = COUNT_TILES, .per_view = true},
    {"lens.reaches", AT(reaches), VIRGA_USE_STORAGE, DEVICE, .entry = 4 * sizeof(float), .count = COUNT_TILES},
};

static const virga_effect_ring rings[] = {
    {"lens.views", AT(view_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(virga_lens_gpu), COUNT_VIEWS},
};

#define WRITTEN (VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT)

static const virga_effect_image images[] = {
    {"lens.aperture", AT(aperture), VK_FORMAT_R32_SFLOAT, COLOR, WRITTEN, COUNT_APERTURE, COUNT_APERTURE_ROWS, 1,
     VIRGA_FIRST_STORAGE},
    {"lens.samples", AT(samples), VK_FORMAT_R32G32B32A32_SFLOAT, COLOR, WRITTEN, COUNT_COLUMNS, COUNT_ROWS, 1,
     VIRGA_FIRST_STORAGE},
    {"lens.spreads", AT(spreads), VK_FORMAT_R32G32B32A32_SFLOAT, COLOR, WRITTEN, COUNT_COLUMNS, COUNT_ROWS, 1,
     VIRGA_FIRST_STORAGE},
    {"lens.blocks", AT(blocks), VK_FORMAT_R32G32B32A32_UINT, COLOR, WRITTEN, COUNT_BLOCK_COLUMNS, COUNT_BLOCK_ROWS,
     VIRGA_LENS_BLOCK_KINDS *VIRGA_LENS_BLOCK_PARTS, VIRGA_FIRST_STORAGE},
    {"lens.fields", AT(fields), VK_FORMAT_R16G16B16A16_SFLOAT, COLOR, WRITTEN, COUNT_COLUMNS, COUNT_ROWS,
     VIRGA_LENS_FIRST_LAYER + VIRGA_LENS_LAYERS, VIRGA_FIRST_STORAGE, .per_view = true},
    {"lens.coarse_fields", AT(coarse), VK_FORMAT_R16G16B16A16_SFLOAT, COLOR, WRITTEN, COUNT_COARSE_COLUMNS,
     COUNT_COARSE_ROWS, VIRGA_LENS_FIRST_LAYER + VIRGA_LENS_LAYERS, VIRGA_FIRST_STORAGE, .per_view = true},
    {"lens.packed_far", AT(packed), VK_FORMAT_R32_UINT, COLOR, WRITTEN, COUNT_PACKED_COLUMNS, COUNT_PACKED_ROWS, 1,
     VIRGA_FIRST_STORAGE, .per_view = true, .seen_as = VK_FORMAT_E5B9G9R9_UFLOAT_PACK32},
    {"lens.near_circles", AT(near_circles), VK_FORMAT_R16G16B16A16_SFLOAT, COLOR, WRITTEN, COUNT_PACKED_COLUMNS,
     COUNT_PACKED_ROWS, 1, VIRGA_FIRST_STORAGE, .per_view = true},
    {"lens.picture", AT(picture), VK_FORMAT_R16G16B16A16_SFLOAT, COLOR, WRITTEN | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
     COUNT_PICTURE_WIDTH, COUNT_HEIGHT, 1, VIRGA_FIRST_STORAGE, .per_view = true},
    {"lens.circles", AT(circles), VK_FORMAT_R32_SFLOAT, COLOR, WRITTEN | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
     COUNT_CIRCLES_WIDTH, COUNT_CIRCLES_HEIGHT, 1 + VIRGA_LENS_LAYERS, VIRGA_FIRST_STORAGE, .per_view = true},
    BLANK_DEPTH("lens.blank_depth", blank_depth),
    BLANK_COLOR("lens.blank_color", blank_color),
};

#define SEEN VIRGA_ALL_STAGES

/* The same bindings as in shaders/lens, where each file declares those it uses. */
static const virga_binding_kind bindings[LENS_BINDINGS] = {
    RING(SEEN, view_ring, virga_lens_gpu),         /* 0 */
    BUFFER(state),                                 /* 1 */
    SAMPLED_IMAGE(COMPUTE, aperture),              /* 2 */
    STORAGE_IMAGE(aperture),                       /* 3 */
    [LENS_BIND_DEPTH] = {SAMPLED, SEEN},           /* 4 */
    [LENS_BIND_COLOR] = {SAMPLED, SEEN},           /* 5 */
    STORAGE_IMAGE(samples),                        /* 6 */
    STORAGE_IMAGE(spreads),                        /* 7 */
    SAMPLED_IMAGE(COMPUTE, samples),               /* 8 */
    BUFFER(tiles),                                 /* 9 */
    BUFFER(reaches),                               /* 10 */
    [LENS_BIND_FIELDS_WRITTEN] = {IMAGE, COMPUTE}, /* 11 */
    [LENS_BIND_FIELDS] = {SAMPLED, SEEN},          /* 12 */
    STORAGE_IMAGE(picture),                        /* 13 */
    SAMPLED_IMAGE(FRAGMENT, picture),              /* 14 */
    {SAMPLED, SEEN},                               /* 15 colors of layers */
    {SAMPLED, SEEN},
    {SAMPLED, SEEN},
    {SAMPLED, SEEN},
    {SAMPLED, SEEN},
    {SAMPLED, SEEN}, /* 20 depths of layers */
    {SAMPLED, SEEN},
    {SAMPLED, SEEN},
    {SAMPLED, SEEN},
    {SAMPLED, SEEN},
    SAMPLED_IMAGE(COMPUTE, spreads),                        /* 25 */
    {SAMPLED, COMPUTE},                                     /* 26 color of the layer on the scene */
    [LENS_BIND_CIRCLES] = {IMAGE, COMPUTE},                 /* 27 */
    BUFFER_IN(COMPUTE | VERTEX, lists),                     /* 28 */
    {UNIFORM, SEEN, VIRGA_SOURCE_BUFFER, AT(focused)},      /* 29: words of a uniform block are cheaper */
    [LENS_BIND_BLOCKS] = {SAMPLED, COMPUTE},                /* 30 */
    [LENS_BIND_BLOCKS_WRITTEN] = {IMAGE, COMPUTE},          /* 31 */
    [LENS_BIND_FAR] = {SAMPLED, FRAGMENT},                  /* 32: the first image of fields, or packed */
    [LENS_BIND_COARSE_WRITTEN] = {IMAGE, COMPUTE},          /* 33 */
    [LENS_BIND_COARSE_NEAR] = {SAMPLED, FRAGMENT},          /* 34 */
    [LENS_BIND_COARSE_FAR] = {SAMPLED, VERTEX | FRAGMENT},  /* 35 */
    [LENS_BIND_PACKED_WRITTEN] = {IMAGE, COMPUTE},          /* 36 */
    [LENS_BIND_FIRST_LAYER] = {SAMPLED, FRAGMENT},          /* 37 */
    [LENS_BIND_FIRST_COARSE_LAYER] = {SAMPLED, FRAGMENT},   /* 38 */
    [LENS_BIND_COARSE] = {SAMPLED, FRAGMENT},               /* 39 */
    [LENS_BIND_FOCUS_WRITTEN] = BUFFER(focused),            /* 40 */
    [LENS_BIND_CIRCLES_OF_NEAR_WRITTEN] = {IMAGE, COMPUTE}, /* 41 */
    [LENS_BIND_CIRCLES_OF_NEAR] = {SAMPLED, FRAGMENT},      /* 42 */
};

static const virga_effect_layout layouts[] = {
    {AT(bindings), bindings, LENS_BINDINGS, VIRGA_MAX_VIEWS, sizeof(uint32_t)},
};

static const virga_effect_pass passes[] = {
    PASS(focus),
    {"lens.aperture", AT(aperture_reach), VIRGA_SPIRV(lens_aperture_comp)},
    PASS(sample, .forms = LENS_SAMPLES),
    PASS(tile, .forms = VIRGA_LENS_LAYERS + 1),
    PASS(reach),
    {"lens.blocks", AT(block), VIRGA_SPIRV(lens_blocks_comp), .forms = VIRGA_LENS_BLOCK_FORMS},
    PASS(gather, .forms = LENS_GATHERS),
    PASS(narrow, .forms = LENS_NARROWS),
    PASS(wide, .forms = LENS_NARROWS),
    PASS(narrow_plane, .forms = LENS_LAYER_SCALES),
    PASS(narrow_depths, .forms = LENS_LAYER_SCALES),
    PASS(layer_sample, .forms = VIRGA_LENS_LAYERS),
    PASS(layer, .forms = LENS_LAYER_FORMS),
    PASS(combine, .forms = VIRGA_LENS_COMBINE_FORMS * (VIRGA_LENS_LAYERS + 1)),
    PASS(paper, .forms = 2 * (VIRGA_LENS_LAYERS + 1)),
    {"lens.circles", AT(circle), VIRGA_SPIRV(lens_circles_comp), .forms = VIRGA_LENS_LAYERS + 1},
};

static uint32_t pass_constant(const void *object)
{
    const virga_lens *lens = object;
    const uint32_t halved = lens->def.half_resolution && !lens->def.circles ? VIRGA_LENS_HALVED : 0;
    return halved | (lens->def.in_place ? VIRGA_LENS_IN_PLACE : 0);
}

uint32_t lens_layer_form(const virga_lens *lens, uint32_t layers)
{
    return lens->base.context->for_software || layers <= 1 ? layers : VIRGA_LENS_LAYERS;
}

#define NARROW_SHARED_BYTES 27648 /* of shared memory, in shaders/lens/narrow_layer.glsl; narrow.glsl has less */

static bool has_memory(const virga_context *context)
{
    return context->properties.limits.maxComputeSharedMemorySize >= NARROW_SHARED_BYTES;
}

lens_way lens_way_of(const virga_lens *lens, const virga_lens_settings *settings)
{
    const virga_context *context = lens->base.context;
    if (!lens->def.half_resolution || lens->def.circles || context->for_software || !has_memory(context))
        return LENS_WAY_ANY;
    if (settings->max_radius_px <= 2 * VIRGA_LENS_FINE)
        return LENS_WAY_NARROW;
    return lens->def.in_place && settings->max_radius_px <= (float)VIRGA_LENS_COARSE_MOST ? LENS_WAY_WIDE
                                                                                          : LENS_WAY_ANY;
}

/* Whether a form of the passes for some way is ever recorded. */
static bool narrow_form_used(const virga_lens *lens, lens_way way, size_t member, uint32_t form)
{
    const bool alone = form & VIRGA_LENS_ALONE;
    if (member == AT(narrow_plane) || member == AT(narrow_depths))
        return way == LENS_WAY_WIDE || (way == LENS_WAY_NARROW && !(form & VIRGA_LENS_QUARTER));
    if (member == AT(narrow))
        return way == LENS_WAY_NARROW && (!alone || lens->def.in_place);
    return way == LENS_WAY_WIDE && alone;
}

/* Draws of a whole picture or a part of it, or those in place. */
static uint32_t wanted_draws(const void *object, const void *settings)
{
    const virga_lens *lens = object;
    if (!lens->def.in_place)
        return 1u << LENS_DRAW_PICTURE | 1u << LENS_DRAW_PART;
    return 1u << LENS_DRAW_TILES | 1u << LENS_DRAW_LAYERS | 1u << LENS_DRAW_SOFT |
           (lens_way_of(lens, settings) == LENS_WAY_WIDE ? 1u << LENS_DRAW_BOTH | 1u << LENS_DRAW_WIDE : 0);
}

static bool form_used(const void *object, const void *given, const virga_effect_pass *pass, uint32_t form)
{
    const virga_lens *lens = object;
    const virga_lens_settings *settings = given;
    const uint32_t forms = VIRGA_LENS_LAYERS + 1, layers = form % forms;
    const uint32_t kind = form / forms % VIRGA_LENS_COMBINE_KINDS;
    const size_t member = pass->member;
    if (member == AT(focus))
        return true;
    if (lens->def.circles || member == AT(circle))
        return lens->def.circles && member == AT(circle);
    if (member == AT(paper))
        return settings->style == VIRGA_LENS_STYLE_PAPER;
    if (member == AT(combine) && lens->def.in_place)
        return false;
    if (member == AT(narrow) || member == AT(wide) || member == AT(narrow_plane) || member == AT(narrow_depths))
        return narrow_form_used(lens, lens_way_of(lens, settings), member, form);
    if (member != AT(tile) && member != AT(combine))
        return true;
    const bool sharp_or_blurred = kind == VIRGA_LENS_ALL_SHARP || kind == VIRGA_LENS_TILES_BLURRED;
    return layers == lens_layer_form(lens, layers) &&
           (member != AT(combine) || lens->def.half_resolution || sharp_or_blurred);
}

static void fill_areas(virga_lens *lens)
{
    lens_fill_areas(lens->settings.blades, (double)lens->settings.blade_roundness,
                    (double)lens->settings.blade_rotation_deg, lens->areas);
}

static virga_result init(void *object)
{
    fill_areas(object);
    return VIRGA_OK;
}

/* At full resolution a texel of the work image is a pixel, so radii end at half of what they reach in texels of two. */
static virga_result check_settings(const void *object, void *given, bool *changed)
{
    const virga_lens *lens = object;
    virga_lens_settings *settings = given;
    if (lens->def.in_place && settings->style == VIRGA_LENS_STYLE_PAPER)
        return virga_wrong_argument(&lens->base.context->log,
                                    "lens_settings.style: expected physical; lens_def.in_place is 1");
    if (!lens->def.half_resolution && !lens->def.circles)
        settings->max_radius_px =
            virga_clamp_setting_float(&lens->base.context->log, "lens_settings.max_radius_px, at full resolution",
                                      settings->max_radius_px, 1, VIRGA_LENS_MAX_RADIUS, changed);
    return VIRGA_OK;
}

static virga_result apply_settings(void *object, void *given)
{
    virga_lens *lens = object;
    virga_lens_settings *next = given, *now = &lens->settings;
    next->blades = next->blades < 3 ? 0 : next->blades;
    next->threshold_m[1] = fmaxf(next->threshold_m[0], next->threshold_m[1]);
    const bool reshaped = next->blades != now->blades || next->blade_roundness != now->blade_roundness ||
                          next->blade_rotation_deg != now->blade_rotation_deg;
    *now = *next;
    if (reshaped)
        fill_areas(lens);
    return VIRGA_OK;
}

static void describe(const void *object, char *line, size_t size)
{
    const virga_lens *lens = object;
    const char *how = lens->def.in_place          ? ", blurred at half resolution, in place"
                      : lens->def.half_resolution ? ", blurred at half resolution"
                                                  : "";
    const virga_context *context = lens->base.context;
    const bool halved = lens->def.half_resolution && !lens->def.circles;
    const bool lacks = halved && !context->for_software && !has_memory(context);
    snprintf(line, size, "lens: %s of up to %u x %u pixels%s%s",
             lens->def.circles ? "circles of confusion" : "pictures", lens->def.max_width, lens->def.max_height,
             lens->def.circles ? "" : how, lacks ? ", with the passes for little shared memory" : "");
}

static void lens_read_statistics(void *object, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data)
{
    virga_lens *lens = object;
    virga_lens_state_gpu states[VIRGA_MAX_VIEWS];
    (void)parts;
    memcpy(states, data, sizeof states);
    lens->stats = (virga_lens_stats){.frame_index = frame, .views = lens->base.readback_views[ring_slot]};
    for (uint32_t i = 0; i < lens->stats.views; i++)
        lens->stats.view_focus_m[i] = states[i].focus_inv_m > 0 ? 1 / states[i].focus_inv_m : INFINITY;
    lens->stats.focus_m = lens->stats.view_focus_m[lens->stats.views - 1];
}

VIRGA_EFFECT_FUNCTIONS(lens)
VIRGA_EFFECT_DRAW_FUNCTIONS(lens)

const virga_effect_type lens_type = {
    VIRGA_EFFECT_TABLES(lens, "a lens", "lens_settings"),
    VIRGA_TABLE(image),
    VIRGA_CALLBACKS(check_def, fit_device, init, check_settings, apply_settings, pass_constant, form_used,
                    wanted_draws),
    .draw_constant = pass_constant,
    .draws = lens_draws,
    .draw_count = LENS_DRAWS,
    .readback_bytes = VIRGA_MAX_VIEWS * sizeof(virga_lens_state_gpu),
    .read_statistics = lens_read_statistics,
    .draw = lens_type_draw,
    .max_views = offsetof(virga_lens_def, max_views),
};

/* ---- queries */

static virga_lens_image picture_of(const virga_lens *lens, uint32_t slot)
{
    const virga_image_2d *image = lens->picture_of_view[slot];
    const lens_prepared *seen = &lens->prepared[slot];
    return image ? (virga_lens_image){image->image, image->layer_views[0], seen->width, seen->height}
                 : (virga_lens_image){0};
}

void virga_lens_picture(const virga_lens *lens, virga_lens_image *picture)
{
    if (!picture)
        return;
    *picture = (virga_lens_image){0};
    if (lens && lens->base.contents)
        *picture = picture_of(lens, lens->base.newest_slot);
}

void virga_lens_picture_view(virga_lens *lens, virga_prepared prepared, virga_lens_image *picture)
{
    if (!picture)
        return;
    *picture = (virga_lens_image){0};
    if (lens && !virga_effect_find_view(&lens->base, "virga_lens_picture_view", prepared))
        *picture = picture_of(lens, lens->base.slot);
}

static virga_lens_image circles_of(const virga_lens *lens, uint32_t slot, uint32_t part)
{
    const virga_image_2d *image = lens->circles_of_view[slot];
    const lens_prepared *seen = &lens->prepared[slot];
    return image && part <= seen->layers
               ? (virga_lens_image){image->image, image->layer_views[part], seen->width, seen->height}
               : (virga_lens_image){0};
}

void virga_lens_circles(const virga_lens *lens, uint32_t part, virga_lens_image *circles)
{
    if (!circles)
        return;
    *circles = (virga_lens_image){0};
    if (lens && lens->base.contents)
        *circles = circles_of(lens, lens->base.newest_slot, part);
}

void virga_lens_circles_view(virga_lens *lens, virga_prepared prepared, uint32_t part, virga_lens_image *circles)
{
    if (!circles)
        return;
    *circles = (virga_lens_image){0};
    if (lens && !virga_effect_find_view(&lens->base, "virga_lens_circles_view", prepared))
        *circles = circles_of(lens, lens->base.slot, part);
}

double virga_lens_breathing(double focal_m, double focus_m)
{
    return focus_m > focal_m && focal_m > 0 && isfinite(focus_m) ? focus_m / (focus_m - focal_m) : 1;
}

void virga_lens_fill_view(virga_lens *lens, virga_view *view)
{
    if (!lens || !view)
        return;
    const virga_lens_settings *settings = &lens->settings;
    virga_lens_stats stats;
    virga_lens_stats_get(lens, &stats);
    view->aperture_m = settings->aperture_f > 0 ? fminf(settings->focal_m / settings->aperture_f, 1) : 0;
    view->focus_m = settings->focus_m;
    if (settings->follow && stats.frame_index)
        view->focus_m = stats.focus_m < 1e6f ? stats.focus_m : 0;
}

void virga_lens_stats_get(virga_lens *lens, virga_lens_stats *stats)
{
    if (!stats)
        return;
    memset(stats, 0, sizeof *stats);
    if (!lens)
        return;
    virga_effect_read_statistics(&lens->base);
    *stats = lens->stats;
}
