/* glass/glass_picture.c - what the height map and the draws need: create, destroy, and what their sets hold. */
#include "glass/glass_picture.h"

#include "gpu/device_check.h"
#include "gpu/errors.h"

#include "shaders/glass_draw_balls_comp.spv.h"
#include "shaders/glass_draw_film_tiles_comp.spv.h"
#include "shaders/glass_draw_height_comp.spv.h"
#include "shaders/glass_draw_height_narrow_comp.spv.h"
#include "shaders/glass_draw_height_shuffle_comp.spv.h"
#include "shaders/glass_draw_mist_blocks_comp.spv.h"
#include "shaders/glass_draw_mist_comp.spv.h"
#include "shaders/glass_draw_plate_copy_comp.spv.h"
#include "shaders/glass_draw_plate_shrink_comp.spv.h"
#include "shaders/glass_draw_relief_comp.spv.h"
#include "shaders/glass_draw_relief_narrow_comp.spv.h"
#include "shaders/glass_draw_tile_fill_comp.spv.h"
#include "shaders/glass_draw_tile_list_comp.spv.h"
#include "shaders/glass_draw_tile_quads_comp.spv.h"

#include <math.h>
#include <string.h>

#define TILE VIRGA_GLASS_TILE

uint32_t glass_view_bytes(void)
{
    return (uint32_t)((sizeof(glass_view_block) + VIRGA_RING_ALIGNMENT - 1) / VIRGA_RING_ALIGNMENT *
                      VIRGA_RING_ALIGNMENT);
}

/* ---- sizes */

static uint32_t tiles_of(float side_m, float longer_m, uint32_t max_texels)
{
    const double tiles = ceil((double)side_m / (double)longer_m * max_texels / TILE - 1e-4);
    return tiles > 1 ? (uint32_t)tiles : 1;
}

static uint32_t blocks_of(uint32_t cells)
{
    while (cells > VIRGA_GLASS_MIST_MOST)
        cells = (cells + 1) / 2;
    return (cells + VIRGA_GLASS_MIST_BLOCK - 1) / VIRGA_GLASS_MIST_BLOCK;
}

/* A drop's balls do not lie on those of another, as drops merge: the squares of their radii add up to no more than the
 * pane's texels over pi. One that reaches r texels, which is two to three radii, is in (2 r / 8 + 1)^2 tiles on
 * average: that is a quarter of an entry for each texel of the large ones, and some four entries
 * each for the smallest. */
static void fill_sizes(const virga_glass_def *def, struct glass_picture *picture)
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

enum { BUFFERS = 8, PASSES = 8 };

static void list_buffers(const virga_glass_def *def, uint32_t frames, struct glass_picture *picture,
                         virga_buffer_row rows[BUFFERS])
{
    const VkBufferUsageFlags storage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const VkDeviceSize tiles = (VkDeviceSize)picture->max_tile_columns * picture->max_tile_rows;
    const VkDeviceSize mist = (VkDeviceSize)picture->max_mist.width * picture->max_mist.height;
    const VkDeviceSize blocks = mist / (VIRGA_GLASS_MIST_BLOCK * VIRGA_GLASS_MIST_BLOCK);
    const virga_buffer_row wanted[BUFFERS] = {
        {&picture->balls, (VkDeviceSize)def->max_drops * VIRGA_GLASS_DROP_BALLS * sizeof(virga_glass_ball_gpu), storage,
         VIRGA_HEAP_DEVICE, "glass.balls"},
        {&picture->tiles, tiles * sizeof(virga_glass_tile_gpu), storage, VIRGA_HEAP_DEVICE, "glass.tiles"},
        {&picture->entries, (VkDeviceSize)picture->max_entries * 4, storage, VIRGA_HEAP_DEVICE, "glass.entries"},
        {&picture->mist, mist, storage, VIRGA_HEAP_DEVICE, "glass.mist"},
        {&picture->written, tiles * 4, storage, VIRGA_HEAP_DEVICE, "glass.written"},
        {&picture->work, sizeof(virga_glass_work_gpu) + (3 * tiles + 2 * blocks) * 4,
         storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, VIRGA_HEAP_DEVICE, "glass.work"},
        {&picture->corners, (tiles * 8 + blocks * 6) * 4, storage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT, VIRGA_HEAP_DEVICE,
         "glass.corners"},
        {&picture->view_ring, (VkDeviceSize)frames * VIRGA_GLASS_MAX_VIEWS * glass_view_bytes(),
         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, VIRGA_HEAP_UPLOAD,
         "glass.views"},
    };
    memcpy(rows, wanted, sizeof wanted);
}

#define MAP_TEXELS 36 /* bytes of a texel of the map, of the relief and of the words together */
#define COPY_TEXEL 8

VkDeviceSize glass_picture_estimate(const virga_glass_def *def)
{
    struct glass_picture sizes = {0};
    virga_buffer_row rows[BUFFERS];
    fill_sizes(def, &sizes);
    list_buffers(def, VIRGA_MAX_FRAMES_IN_FLIGHT, &sizes, rows);
    VkDeviceSize sum = (VkDeviceSize)sizes.max_columns * sizes.max_rows * MAP_TEXELS +
                       (VkDeviceSize)VIRGA_GLASS_COPY_WIDTH * VIRGA_GLASS_COPY * COPY_TEXEL +
                       (VkDeviceSize)sizes.max_mist.width * sizes.max_mist.height;
    for (int i = 0; i < BUFFERS; i++)
        sum += rows[i].size;
    return sum;
}

/* ---- bindings */

#define COMPUTE  VK_SHADER_STAGE_COMPUTE_BIT
#define FRAGMENT VK_SHADER_STAGE_FRAGMENT_BIT

_Static_assert(VIRGA_MAX_FRAMES_IN_FLIGHT *VIRGA_GLASS_MAX_VIEWS *(sizeof(glass_view_block) + VIRGA_RING_ALIGNMENT) <=
                   16 * VIRGA_SURE_TEXELS,
               "views are texels on every device");

/* As in shaders/glass/picture*: what each file declares. */
static const virga_binding_kind kinds[] = {
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VIRGA_ALL_STAGES},                   /* 0 view and look */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                    /* 1 drops */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                    /* 2 film */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                    /* 3 passed */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                    /* 4 surface */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, COMPUTE | VK_SHADER_STAGE_VERTEX_BIT}, /* 5 nodes */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                    /* 6 balls */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                    /* 7 tiles */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                    /* 8 entries */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                    /* 9 mist, written */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                    /* 10 list of places */
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, COMPUTE},                                     /* 11 map */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, FRAGMENT},                           /* 12 relief, read */
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, COMPUTE}, /* 13 copies of the plate, written */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, FRAGMENT | VK_SHADER_STAGE_VERTEX_BIT}, /* 14 the same, read */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, FRAGMENT},                              /* 15 scene depth */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, COMPUTE | FRAGMENT},                    /* 16 scene colour */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                       /* 17 what tiles hold */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                       /* 18 work */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE | VK_SHADER_STAGE_VERTEX_BIT},          /* 19 what is to be drawn */
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, COMPUTE},                                        /* 20 relief, written */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, FRAGMENT},                              /* 21 mist, read */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                       /* 22 state of the pane */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, COMPUTE},                               /* 23 map, read */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, FRAGMENT},                              /* 24 scene motion */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                                       /* 25 blocks with film */
    {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, COMPUTE},                                        /* 26 words, written */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, FRAGMENT},                              /* 27 words, read */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, FRAGMENT},                                /* 28 views, as texels */
};

enum { BINDINGS = sizeof kinds / sizeof kinds[0] };

static virga_bound whole(const virga_buffer *buffer)
{
    return (virga_bound){.buffer = buffer->buffer};
}

static virga_bound own_image(const virga_image_2d *image, VkSampler sampler)
{
    return (virga_bound){.view = image->layer_views[0], .image_layout = VK_IMAGE_LAYOUT_GENERAL, .sampler = sampler};
}

/* A host's image, or a blank in its place. */
static virga_bound image_or_blank(const virga_image *image, const virga_image_2d *blank, VkSampler sampler)
{
    return (virga_bound){.sampler = sampler,
                         .view = image->view ? image->view : blank->layer_views[0],
                         .image_layout = image->view ? image->before.layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

VkDescriptorSet glass_picture_write_set(virga_glass *glass, uint32_t index, const virga_view *view)
{
    const struct glass_picture *picture = glass->picture;
    virga_context *context = glass->context;
    /* Not every device filters four whole floats. */
    const VkSampler color = view->color.format == VK_FORMAT_R32G32B32A32_SFLOAT ? context->nearest : context->linear;
    const virga_bound bound[BINDINGS] = {
        {.buffer = picture->view_ring->buffer, .range = sizeof(glass_view_block)},
        whole(glass->drops),
        whole(glass->film),
        whole(glass->passed),
        whole(glass->surface),
        {.texels = glass->nodes->texels},
        whole(picture->balls),
        whole(picture->tiles),
        whole(picture->entries),
        whole(picture->mist),
        whole(glass->list),
        own_image(picture->map, VK_NULL_HANDLE),
        own_image(picture->relief, picture->filtered ? context->linear : context->nearest),
        own_image(picture->copies, VK_NULL_HANDLE),
        own_image(picture->copies, context->linear),
        image_or_blank(&view->depth, picture->blank_depth, context->nearest),
        image_or_blank(&view->color, picture->blank_color, color),
        whole(picture->written),
        whole(picture->work),
        whole(picture->corners),
        own_image(picture->relief, VK_NULL_HANDLE),
        own_image(picture->mist_map, context->linear),
        whole(glass->state),
        own_image(picture->map, context->nearest),
        image_or_blank(&view->temporal.motion, picture->blank_color, context->nearest),
        whole(glass->film_blocks),
        own_image(picture->words, VK_NULL_HANDLE),
        own_image(picture->words, context->nearest),
        {.texels = picture->view_ring->texels},
    };
    return virga_bindings_write(context, picture->bindings, index, bound);
}

/* ---- creating */

/* Lanes of a subgroup that passes may hand values around in by shuffles; 0: they use shared memory. Of processors
 * alone, where it was measured to gain and where a workgroup of whole subgroups has no lane missing. Other devices
 * may run a shader with fewer lanes than they say, or with some that do not exist, as Vulkan 1.2 cannot ask for full
 * subgroups: what comes out of a lane that is not there is undefined. */
static uint32_t shuffled_lanes(const virga_context *context)
{
    if (!context->software)
        return 0;
    VkPhysicalDeviceSubgroupProperties subgroup = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &subgroup};
    context->vk.GetPhysicalDeviceProperties2(context->physical_device, &properties);
    const bool can = (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) &&
                     (subgroup.supportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT);
    return can ? subgroup.subgroupSize : 0;
}

/* Whether samplers filter four whole floats. */
static bool can_filter(const virga_context *context)
{
    VkFormatProperties found;
    context->vk.GetPhysicalDeviceFormatProperties(context->physical_device, VK_FORMAT_R32G32B32A32_SFLOAT, &found);
    return (found.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
}

static void list_passes(struct glass_picture *picture, virga_compute_row rows[PASSES])
{
    const virga_compute_row wanted[PASSES] = {
        {&picture->ball_pass, VIRGA_SPIRV(glass_draw_balls_comp), "glass.balls"},
        {&picture->block_pass, VIRGA_SPIRV(glass_draw_mist_blocks_comp), "glass.mist_blocks"},
        {&picture->film_pass, VIRGA_SPIRV(glass_draw_film_tiles_comp), "glass.film_tiles"},
        {&picture->list_pass, VIRGA_SPIRV(glass_draw_tile_list_comp), "glass.tile_list"},
        {&picture->fill_pass, VIRGA_SPIRV(glass_draw_tile_fill_comp), "glass.tile_fill"},
        {&picture->box_pass, VIRGA_SPIRV(glass_draw_tile_quads_comp), "glass.tile_quads"},
        {&picture->copy_pass, VIRGA_SPIRV(glass_draw_plate_copy_comp), "glass.plate_copy"},
        {&picture->shrink_pass, VIRGA_SPIRV(glass_draw_plate_shrink_comp), "glass.plate_shrink"},
    };
    memcpy(rows, wanted, sizeof wanted);
}

uint32_t glass_picture_gather(const virga_glass *glass, const virga_glass_settings *settings)
{
    const bool paper = settings->style == VIRGA_GLASS_STYLE_PAPER;
    const bool few = !settings->compress || settings->compress_steps <= VIRGA_GLASS_FEW_STEPS;
    return (uint32_t)settings->density | (uint32_t)settings->blend << 3 | (paper ? GLASS_GATHER_PAPER : 0) |
           (paper && glass->masked ? GLASS_GATHER_MASKED : 0) | (few ? GLASS_GATHER_FEW : 0);
}

/* Those for these settings that are not there yet: without film, with sheets of it, and with beads too. All of them
 * would be a hundred and eighty, of which a pane uses three. */
virga_result glass_picture_need(virga_glass *glass, const virga_glass_settings *settings)
{
    static const uint32_t films[3] = {0, GLASS_GATHER_FILM, GLASS_GATHER_FILM | GLASS_GATHER_BEADS};
    struct glass_picture *picture = glass->picture;
    const virga_spirv shader = !picture->lanes       ? VIRGA_SPIRV(glass_draw_height_comp)
                               : picture->lanes <= 8 ? VIRGA_SPIRV(glass_draw_height_narrow_comp)
                                                     : VIRGA_SPIRV(glass_draw_height_shuffle_comp);
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t mode = glass_picture_gather(glass, settings) | films[i];
        const virga_compute_def def = {.shader = shader,
                                       .layout = picture->bindings->layout,
                                       .constant = mode | (picture->whole_map ? GLASS_GATHER_MAP : 0),
                                       .name = "glass.gather"};
        if (!picture->gather_passes[mode])
            TRY(virga_compute_pipeline_create(glass->context, &def, &picture->gather_passes[mode]));
    }
error:
    return result;
}

static void retire_gathers(virga_context *context, struct glass_picture *picture)
{
    for (uint32_t i = 0; i < GLASS_GATHERS; i++)
        VIRGA_RETIRE(context, picture->gather_passes[i]);
}

/* Passes in several forms of which any may be used: of a pane with a mask and without, and mist of several cells to a
 * texel. */
static virga_result create_forms(virga_glass *glass)
{
    struct glass_picture *picture = glass->picture;
    virga_result result = VIRGA_OK;
    virga_compute_def def = {.shader = VIRGA_SPIRV(glass_draw_mist_comp),
                             .layout = picture->bindings->layout,
                             .group = &glass->needed,
                             .name = "glass.mist"};
    for (def.constant = 0; def.constant < 4; def.constant++)
        if (!picture->mist_passes[def.constant])
            TRY(virga_compute_pipeline_create(glass->context, &def, &picture->mist_passes[def.constant]));
    def.shader = picture->lanes == 8 ? VIRGA_SPIRV(glass_draw_relief_narrow_comp) : VIRGA_SPIRV(glass_draw_relief_comp);
    def.name = "glass.relief";
    for (def.constant = 0; def.constant < 2; def.constant++)
        TRY(virga_compute_pipeline_create(glass->context, &def, &picture->relief_passes[def.constant]));
error:
    return result;
}

static void retire_reliefs(virga_context *context, struct glass_picture *picture)
{
    for (uint32_t i = 0; i < 2; i++)
        VIRGA_RETIRE(context, picture->relief_passes[i]);
}

static virga_result create_images(virga_context *context, struct glass_picture *picture)
{
    virga_result result = VIRGA_OK;
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT, cleared = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    const VkExtent2D one = {1, 1}, map = {picture->max_columns, picture->max_rows},
                     copies = {VIRGA_GLASS_COPY_WIDTH, VIRGA_GLASS_COPY};
    TRY(virga_image_create(context, VK_FORMAT_R32G32B32A32_SFLOAT, map, 1,
                           sampled | cleared | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, "glass.relief", &picture->relief));
    TRY(virga_image_create(context, VK_FORMAT_R32G32B32A32_SFLOAT, map, 1,
                           sampled | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, "glass.map", &picture->map));
    TRY(virga_image_create(context, VK_FORMAT_R32_UINT, map, 1, sampled | VK_IMAGE_USAGE_STORAGE_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, "glass.words", &picture->words));
    TRY(virga_image_create(context, VK_FORMAT_R16G16B16A16_SFLOAT, copies, 1,
                           sampled | cleared | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, "glass.copies", &picture->copies));
    TRY(virga_image_create(context, VK_FORMAT_R8_UNORM, picture->max_mist, 1, sampled | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, "glass.mist_map", &picture->mist_map));
    TRY(virga_image_create(context, VK_FORMAT_D32_SFLOAT, one, 1, sampled, VK_IMAGE_ASPECT_DEPTH_BIT,
                           "glass.blank_depth", &picture->blank_depth));
    TRY(virga_image_create(context, VK_FORMAT_R8G8B8A8_UNORM, one, 1, sampled, VK_IMAGE_ASPECT_COLOR_BIT,
                           "glass.blank_color", &picture->blank_color));
error:
    return result;
}

virga_result glass_picture_create(virga_glass *glass)
{
    virga_context *context = glass->context;
    virga_result result = VIRGA_OK;
    virga_buffer_row buffers[BUFFERS];
    virga_compute_row passes[PASSES];
    struct glass_picture *picture = virga_alloc(&context->heap, sizeof *picture);
    if (!picture)
        return virga_out_of_host_memory(context, "a pane's picture");
    glass->picture = picture;
    picture->whole_map = glass->def.height_map;
    fill_sizes(&glass->def, picture);
    list_buffers(&glass->def, context->frames_in_flight, picture, buffers);
    list_passes(picture, passes);
    TRY(virga_buffers_create(context, buffers, BUFFERS));
    TRY(create_images(context, picture));
    picture->filtered = can_filter(context);
    TRY(virga_bindings_create(context, kinds, BINDINGS, VIRGA_GLASS_MAX_VIEWS, 0, &picture->bindings));
    TRY(virga_compute_pipelines_create(context, picture->bindings->layout, 0, &glass->needed, passes, PASSES));
    picture->lanes = shuffled_lanes(context);
    TRY(create_forms(glass));
    TRY(glass_picture_need(glass, &glass->settings));
error:
    return result; /* what was made goes with the pane */
}

virga_result glass_picture_take_lanes(virga_glass *glass, uint32_t lanes)
{
    retire_gathers(glass->context, glass->picture);
    retire_reliefs(glass->context, glass->picture);
    glass->picture->lanes = lanes;
    const virga_result result = create_forms(glass);
    return result ? result : glass_picture_need(glass, &glass->settings);
}

void glass_picture_destroy(virga_glass *glass)
{
    struct glass_picture *picture = glass->picture;
    virga_context *context = glass->context;
    virga_buffer_row buffers[BUFFERS];
    virga_compute_row passes[PASSES];
    if (!picture)
        return;
    list_buffers(&glass->def, context->frames_in_flight, picture, buffers);
    list_passes(picture, passes);
    virga_compute_pipelines_retire(context, passes, PASSES);
    retire_gathers(context, picture);
    retire_reliefs(context, picture);
    for (uint32_t i = 0; i < 4; i++)
        VIRGA_RETIRE(context, picture->mist_passes[i]);
    virga_buffers_retire(context, buffers, BUFFERS);
    for (uint32_t i = 0; i < GLASS_MAX_TARGETS * GLASS_DRAWS; i++)
        VIRGA_RETIRE(context, picture->targets[i / GLASS_DRAWS].draws[i % GLASS_DRAWS]);
    VIRGA_RETIRE(context, picture->relief);
    VIRGA_RETIRE(context, picture->map);
    VIRGA_RETIRE(context, picture->words);
    VIRGA_RETIRE(context, picture->copies);
    VIRGA_RETIRE(context, picture->mist_map);
    VIRGA_RETIRE(context, picture->blank_depth);
    VIRGA_RETIRE(context, picture->blank_color);
    VIRGA_RETIRE(context, picture->bindings);
    virga_free(&context->heap, picture);
    glass->picture = NULL;
}
