/* water/water_images.c - the images that surfels are drawn into, and the pipelines that draw them. */
#include "water/water_internal.h"

#include "gpu/errors.h"

#include "shaders/water_shaders.h"

#define SUMS   VK_FORMAT_R32G32B32A32_SFLOAT
#define MOTION VK_FORMAT_R16G16B16A16_SFLOAT
#define DEPTH  VK_FORMAT_D32_SFLOAT

/* ---- sizes */

VkExtent2D water_pyramid_extent(const virga_water_def *def)
{
    const uint32_t px = VIRGA_WATER_VOLUME_PX;
    return (VkExtent2D){(def->max_width + px - 1) / px, (def->max_height + px - 1) / px};
}

uint32_t water_pyramid_texels(const virga_water_def *def, uint32_t first[VIRGA_WATER_VOLUME_LEVELS])
{
    const VkExtent2D finest = water_pyramid_extent(def);
    uint32_t sum = 0;
    for (uint32_t level = 0; level < VIRGA_WATER_VOLUME_LEVELS; level++) {
        const uint32_t up = (1u << level) - 1;
        if (first)
            first[level] = sum;
        sum += ((finest.width + up) >> level) * ((finest.height + up) >> level);
    }
    return sum;
}

VkDeviceSize water_images_bytes(const virga_water_def *def)
{
    const VkDeviceSize each = 16 + 8 + 4 + (def->max_parts ? 16 + 4 : 0);
    return def->max_views * (VkDeviceSize)def->max_width * def->max_height * each;
}

/* ---- creation */

/* Three draws into the same images: the depth of the nearest water by its splats, the sums of what lies on it, then the
 * sums of what is behind where it leaves gaps. */
typedef struct water_sums {
    const virga_offscreen *images;
    const virga_spirv *vertex, *fragment, *behind; /* of the sums */
    const char *depth_name, *sum_name, *behind_name;
    virga_pipeline **depth_pipeline, **sum_pipeline, **behind_pipeline;
} water_sums;

static virga_result create_pipelines(virga_water *water, const water_sums *sums)
{
    virga_context *context = water->base.context;
    virga_result result = VIRGA_OK;
    virga_graphics_def def = {.vertex = VIRGA_SPIRV(water_draw_splat_vert),
                              .fragment = VIRGA_SPIRV(water_draw_splat_depth_frag),
                              .layout = water->picture.bindings->shared,
                              .render_pass = sums->images->pass,
                              .color_count = sums->images->color_count,
                              .no_color = true,
                              .depth_test = true,
                              .depth_write = true,
                              .reversed_depth = true,
                              .constant = 1,
                              .group = &water->base.passes,
                              .name = sums->depth_name};
    TRY(virga_graphics_pipeline_create(context, &def, sums->depth_pipeline));
    def.vertex = sums->vertex;
    def.fragment = sums->fragment;
    def.no_color = def.depth_write = false;
    def.blend_add = def.add_all = true;
    def.constant = 0;
    def.name = sums->sum_name;
    TRY(virga_graphics_pipeline_create(context, &def, sums->sum_pipeline));
    def.fragment = sums->behind;
    def.reversed_depth = false; /* what the sums leave out */
    def.constant = 2;
    def.name = sums->behind_name;
    TRY(virga_graphics_pipeline_create(context, &def, sums->behind_pipeline));
error:
    return result;
}

/* What light by surfels is added up in. */
static virga_result create_colors(virga_water *water)
{
    virga_context *context = water->base.context;
    water_picture *picture = &water->picture;
    const virga_offscreen_def def = {.name = "water.colors",
                                     .extent = {water->def.max_width, water->def.max_height},
                                     .layers = 1,
                                     .colors = {SUMS},
                                     .depth = DEPTH,
                                     .reversed_depth = true,
                                     .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                     .readers = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT};
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < water->base.max_views; i++)
        TRY(virga_offscreen_create(context, &def, &picture->colors_of_view[i]));
    picture->colors = picture->colors_of_view[0];
    const water_sums parts = {.images = picture->colors,
                              .vertex = VIRGA_SPIRV(water_draw_part_vert),
                              .fragment = VIRGA_SPIRV(water_draw_part_sum_frag),
                              .behind = VIRGA_SPIRV(water_draw_part_behind_frag),
                              .depth_name = "water.part_depth",
                              .sum_name = "water.part_sum",
                              .behind_name = "water.part_behind",
                              .depth_pipeline = &picture->part_depth,
                              .sum_pipeline = &picture->part_sum,
                              .behind_pipeline = &picture->part_behind};
    TRY(create_pipelines(water, &parts));
error:
    return result;
}

/* Not every device blends 32-bit floats. */
static virga_result check_device(const virga_context *context)
{
    VkFormatProperties found;
    context->vk.GetPhysicalDeviceFormatProperties(context->physical_device, SUMS, &found);
    if (found.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT)
        return VIRGA_OK;
    virga_log_write(
        &context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FEATURE_MISSING,
        "water: this device can not blend VK_FORMAT_R32G32B32A32_SFLOAT; only with max_width 0 it has water");
    return VIRGA_ERROR_UNSUPPORTED;
}

virga_result water_images_create(virga_water *water)
{
    virga_context *context = water->base.context;
    water_picture *picture = &water->picture;
    const virga_offscreen_def def = {.name = "water.sums",
                                     .extent = {water->def.max_width, water->def.max_height},
                                     .layers = 1,
                                     .colors = {SUMS, MOTION},
                                     .depth = DEPTH,
                                     .reversed_depth = true,
                                     .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                     .readers =
                                         VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT};
    if (!water->def.max_width)
        return VIRGA_OK;
    virga_result result = check_device(context);
    if (result)
        return result;
    water_pyramid_texels(&water->def, picture->volume_first);
    for (uint32_t i = 0; i < water->base.max_views; i++)
        TRY(virga_offscreen_create(context, &def, &picture->sums_of_view[i]));
    picture->sums = picture->sums_of_view[0];
    const water_sums splats = {.images = picture->sums,
                               .vertex = VIRGA_SPIRV(water_draw_splat_vert),
                               .fragment = VIRGA_SPIRV(water_draw_splat_sum_frag),
                               .behind = VIRGA_SPIRV(water_draw_splat_behind_frag),
                               .depth_name = "water.splat_depth",
                               .sum_name = "water.splat_sum",
                               .behind_name = "water.splat_behind",
                               .depth_pipeline = &picture->splat_depth,
                               .sum_pipeline = &picture->splat_sum,
                               .behind_pipeline = &picture->splat_behind};
    TRY(create_pipelines(water, &splats));
    if (water->def.max_parts)
        TRY(create_colors(water));
error:
    return result;
}

void water_images_retire(virga_water *water)
{
    virga_context *context = water->base.context;
    water_picture *picture = &water->picture;
    VIRGA_RETIRE(context, picture->splat_depth);
    VIRGA_RETIRE(context, picture->splat_sum);
    VIRGA_RETIRE(context, picture->splat_behind);
    VIRGA_RETIRE(context, picture->part_depth);
    VIRGA_RETIRE(context, picture->part_sum);
    VIRGA_RETIRE(context, picture->part_behind);
    for (uint32_t i = 0; i < water->base.max_views; i++) {
        virga_offscreen_retire(context, &picture->sums_of_view[i]);
        virga_offscreen_retire(context, &picture->colors_of_view[i]);
    }
}
