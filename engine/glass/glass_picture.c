/* glass/glass_picture.c - creates and destroys the resources of the height map and the draws, and writes their
 * descriptor sets. */
#include "glass/glass_internal.h"

#include "gpu/errors.h"

#define EFFECT glass
#include "gpu/effect_rows.h"

#include "shaders/glass_shaders.h"

#include <math.h>
#include <stddef.h>

#define TILE VIRGA_GLASS_TILE

/* ---- sizes */

static uint32_t tiles_of(float side_m, float longer_m, uint32_t max_texels)
{
    const double tiles = ceil((double)side_m / (double)longer_m * max_texels / TILE - 1e-4);
    return tiles > 1 ? (uint32_t)tiles : 1;
}

static uint32_t blocks_of(uint32_t cells)
{
    while (cells > VIRGA_GLASS_MAX_MIST_TEXELS)
        cells = (cells + 1) / 2;
    return (cells + VIRGA_GLASS_MIST_BLOCK - 1) / VIRGA_GLASS_MIST_BLOCK;
}

/* Estimates the number of ball entries in tiles. The balls of two drops do not overlap, because such drops merge. So
 * the sum of their squared radii is at most the pane's texels over pi. A ball with a reach of r texels (two to three
 * radii) is in (2 r / 8 + 1)^2 tiles on average. That is a quarter of an entry per texel for large balls, and about
 * four entries per ball for the smallest. */
void glass_picture_fill_sizes(const virga_glass_def *def, struct glass_picture *picture)
{
    const float longer = def->width_m > def->height_m ? def->width_m : def->height_m;
    picture->max_tile_columns = tiles_of(def->width_m, longer, def->max_texels);
    picture->max_tile_rows = tiles_of(def->height_m, longer, def->max_texels);
    picture->max_columns = picture->max_tile_columns * TILE;
    picture->max_rows = picture->max_tile_rows * TILE;
    picture->max_entries = picture->max_columns * picture->max_rows / 4 + 16 * def->max_drops;
    picture->max_mist.width = blocks_of(glass_cells_along(def->width_m, def->cell_m)) * VIRGA_GLASS_MIST_BLOCK;
    picture->max_mist.height = blocks_of(glass_cells_along(def->height_m, def->cell_m)) * VIRGA_GLASS_MIST_BLOCK;
}

VkDeviceSize glass_fog_offset(const struct glass_picture *sizes, const virga_glass_def *def)
{
    const VkDeviceSize tiles = (VkDeviceSize)sizes->max_tile_columns * sizes->max_tile_rows;
    const VkDeviceSize texels = (VkDeviceSize)sizes->max_mist.width * sizes->max_mist.height;
    const VkDeviceSize blocks = texels / (VIRGA_GLASS_MIST_BLOCK * VIRGA_GLASS_MIST_BLOCK);
    return tiles * 8 + blocks * 6 + (3 + VIRGA_GLASS_QUAD_WORDS) * ((VkDeviceSize)def->max_drops + 2);
}

/* ---- bindings */

enum { BIND_RELIEF = 12, BIND_COPIES = 14, BIND_DEPTH = 15, BIND_COLOR, BIND_MOTION = 24, BIND_VIEWS = 28 };

/* The same bindings as in shaders/glass, where each file declares those it uses. */
const virga_binding_kind glass_picture_bindings[GLASS_PICTURE_BINDINGS] = {
    RING(VIRGA_ALL_STAGES, picture.view_ring, glass_view_block), /* 0 */
    BUFFER(drops),                                               /* 1 */
    BUFFER(film),                                                /* 2 */
    BUFFER(passed),                                              /* 3 */
    BUFFER(surface),                                             /* 4 */
    TEXEL_BUFFER_IN(VIRGA_ALL_STAGES, nodes),                    /* 5 */
    BUFFER(picture.balls),                                       /* 6 */
    BUFFER(picture.tiles),                                       /* 7 */
    BUFFER(picture.entries),                                     /* 8 */
    BUFFER(picture.mist),                                        /* 9 */
    BUFFER(list),                                                /* 10 */
    STORAGE_IMAGE(picture.map),                                  /* 11 */
    [BIND_RELIEF] = SAMPLED_IMAGE(FRAGMENT, picture.relief),     /* 12 */
    STORAGE_IMAGE(picture.copies),                               /* 13 copies of the plate, written */
    [BIND_COPIES] = {SAMPLED, VIRGA_ALL_STAGES, VIRGA_SOURCE_IMAGE, AT(picture.copies),
                     .sampler = VIRGA_SAMPLER_LINEAR}, /* 14 */
    [BIND_DEPTH] = {SAMPLED, COMPUTE | FRAGMENT},      /* 15 */
    [BIND_COLOR] = {SAMPLED, COMPUTE | FRAGMENT},      /* 16 */
    BUFFER(picture.written),                           /* 17 contents of tiles */
    BUFFER(picture.work),                              /* 18 */
    BUFFER_IN(VIRGA_ALL_STAGES, picture.corners),      /* 19 indices of the draws */
    STORAGE_IMAGE(picture.relief),                     /* 20 */
    {SAMPLED, FRAGMENT, VIRGA_SOURCE_IMAGE, AT(picture.mist_map), .sampler = VIRGA_SAMPLER_LINEAR}, /* 21 */
    BUFFER(state),                                                                                  /* 22 */
    SAMPLED_IMAGE(COMPUTE, picture.map),                                                            /* 23 */
    [BIND_MOTION] = {SAMPLED, FRAGMENT},                                                            /* 24 */
    BUFFER(film_blocks),                                                                            /* 25 */
    STORAGE_IMAGE(picture.paper_map),                                                               /* 26 */
    SAMPLED_IMAGE(FRAGMENT, picture.paper_map),                                                     /* 27 */
    [BIND_VIEWS] = {TEXELS, FRAGMENT}, /* 28 the ring's buffer, as texels */
    STORAGE_IMAGE(picture.textures),   /* 29 */
    {SAMPLED, FRAGMENT, VIRGA_SOURCE_IMAGE, AT(picture.textures), .sampler = VIRGA_SAMPLER_LINEAR}, /* 30 */
    STORAGE_IMAGE(picture.fog_map),                                                                 /* 31 */
    {SAMPLED, FRAGMENT, VIRGA_SOURCE_IMAGE, AT(picture.fog_map), .sampler = VIRGA_SAMPLER_LINEAR},  /* 32 */
};

VkDescriptorSet glass_picture_write_set(virga_glass *glass, uint32_t index, const virga_view *view, VkImageView copies)
{
    const struct glass_picture *picture = &glass->picture;
    virga_context *context = glass->base.context;
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&glass->base, picture->bindings, bound);
    bound[BIND_RELIEF].sampler = picture->filtered ? context->linear : context->nearest;
    if (copies)
        bound[BIND_COPIES].view = copies;
    bound[BIND_DEPTH] = virga_bound_or_blank(&view->depth, picture->blank_depth, context->nearest);
    bound[BIND_COLOR] =
        virga_bound_or_blank(&view->color, picture->blank_color, virga_color_sampler(context, &view->color));
    bound[BIND_MOTION] = virga_bound_or_blank(&view->temporal.motion, picture->blank_color, context->nearest);
    bound[BIND_VIEWS] = (virga_bound){.texels = picture->view_ring.buffer->texels};
    return virga_bindings_write(context, picture->bindings, index, bound);
}

/* ---- creating */

/* Whether the device can filter images of four 32-bit floats. */
static bool can_filter(const virga_context *context)
{
    VkFormatProperties found;
    context->vk.GetPhysicalDeviceFormatProperties(context->physical_device, VK_FORMAT_R32G32B32A32_SFLOAT, &found);
    return (found.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
}

uint32_t glass_picture_gather(const virga_glass *glass, const virga_glass_settings *settings)
{
    const bool paper = settings->style == VIRGA_GLASS_STYLE_PAPER;
    const bool usual_steps = !settings->compress || settings->compress_steps <= VIRGA_GLASS_USUAL_STEPS;
    return (uint32_t)settings->density | (uint32_t)settings->blend << 3 | (paper ? GLASS_GATHER_PAPER : 0) |
           (paper && glass->masked ? GLASS_GATHER_MASKED : 0) | (usual_steps ? GLASS_GATHER_USUAL_STEPS : 0) |
           (settings->pinning > 0 ? GLASS_GATHER_PINNED : 0);
}

bool glass_picture_has_beads(float cell_m, float texel_m)
{
    return VIRGA_GLASS_BEAD_CELLS * cell_m > VIRGA_GLASS_BEAD_SEEN * texel_m;
}

/* Creates the gather passes for these settings that do not exist yet: without film, with sheets of film, and, if the
 * finest height map shows beads, with sheets and beads. There are 360 variants in total. */
virga_result glass_picture_need(virga_glass *glass, const virga_glass_settings *settings)
{
    static const uint32_t films[3] = {0, GLASS_GATHER_FILM, GLASS_GATHER_FILM | GLASS_GATHER_BEADS};
    struct glass_picture *picture = &glass->picture;
    const virga_spirv *shader = !picture->lanes       ? VIRGA_SPIRV(glass_draw_height_comp)
                                : picture->lanes <= 8 ? VIRGA_SPIRV(glass_draw_height_narrow_comp)
                                                      : VIRGA_SPIRV(glass_draw_height_shuffle_comp);
    virga_result result = VIRGA_OK;
    const uint32_t count = glass_is_all_textured(settings) ? 0 : picture->any_beads ? 3 : 2;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t mode = glass_picture_gather(glass, settings) | films[i];
        const virga_compute_def def = {.shader = shader,
                                       .layout = picture->bindings->shared,
                                       .constant = mode | (picture->whole_map ? GLASS_GATHER_MAP : 0),
                                       .name = "glass.gather"};
        if (!picture->gather_passes[mode])
            TRY(virga_compute_pipeline_create(glass->base.context, &def, &picture->gather_passes[mode]));
    }
error:
    return result;
}

static void retire_gathers(virga_context *context, struct glass_picture *picture)
{
    for (uint32_t i = 0; i < GLASS_GATHERS; i++)
        VIRGA_RETIRE(context, picture->gather_passes[i]);
}

/* Creates the relief passes without and with a mask. */
static virga_result create_reliefs(virga_glass *glass)
{
    struct glass_picture *picture = &glass->picture;
    virga_result result = VIRGA_OK;
    virga_compute_def def = {.shader = picture->lanes == 8 ? VIRGA_SPIRV(glass_draw_relief_narrow_comp)
                                                           : VIRGA_SPIRV(glass_draw_relief_comp),
                             .layout = picture->bindings->shared,
                             .group = &glass->base.passes,
                             .name = "glass.relief"};
    for (def.constant = 0; def.constant < 2; def.constant++)
        TRY(virga_compute_pipeline_create(glass->base.context, &def, &picture->relief_passes[def.constant]));
error:
    return result;
}

static void retire_reliefs(virga_context *context, struct glass_picture *picture)
{
    for (uint32_t i = 0; i < 2; i++)
        VIRGA_RETIRE(context, picture->relief_passes[i]);
}

virga_result glass_picture_create(virga_glass *glass)
{
    struct glass_picture *picture = &glass->picture;
    glass_picture_fill_sizes(&glass->def, picture);
    picture->whole_map = glass->def.height_map;
    const float width_m = (float)((double)glass->def.width_m / picture->max_columns);
    const float height_m = (float)((double)glass->def.height_m / picture->max_rows);
    picture->any_beads = glass_picture_has_beads(glass->def.cell_m, width_m > height_m ? width_m : height_m);
    picture->filtered = can_filter(glass->base.context);
    picture->lanes = virga_shuffled_lanes(glass->base.context);
    return create_reliefs(glass);
}

virga_result glass_picture_use_lanes(virga_glass *glass, uint32_t lanes)
{
    retire_gathers(glass->base.context, &glass->picture);
    retire_reliefs(glass->base.context, &glass->picture);
    glass->picture.lanes = lanes;
    const virga_result result = create_reliefs(glass);
    return result ? result : glass_picture_need(glass, &glass->settings);
}

void glass_picture_forget(virga_glass *glass)
{
    for (uint32_t i = 0; i < VIRGA_MAX_VIEWS; i++)
        glass->picture.prepared[i].has_written = glass->picture.prepared[i].has_textures = false;
}

void glass_picture_destroy(virga_glass *glass)
{
    retire_gathers(glass->base.context, &glass->picture);
    retire_reliefs(glass->base.context, &glass->picture);
}
