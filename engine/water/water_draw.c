/* water/water_draw.c - renders water for a view: prepare adds up its surfels and its thickness, draw computes light. */
#include "water/water_internal.h"

#include "gpu/builds.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/target.h"
#include "gpu/timers.h"
#include "gpu/view.h"

#define EFFECT water
#include "gpu/effect_rows.h"

#include "shaders/water_shaders.h"

#include <math.h>
#include <string.h>

_Static_assert(VIRGA_WATER_DATA_THICKNESS == VIRGA_WATER_DATA_THICKNESS_GPU, "the same values");
_Static_assert(VIRGA_WATER_DATA_NORMAL == VIRGA_WATER_DATA_NORMAL_GPU, "the same values");
_Static_assert(VIRGA_WATER_DATA_MOTION == VIRGA_WATER_DATA_MOTION_GPU, "the same values");

enum { BIND_SUMS = 14, BIND_MOTION, BIND_THICKNESS, BIND_DEPTH, BIND_COLOR, BIND_PANORAMA, BIND_COLORS = 27 };

const virga_binding_kind water_draw_bindings[WATER_DRAW_BINDINGS] = {
    RING(VIRGA_ALL_STAGES, picture.view_ring, water_view_block),             /* 0 */
    BUFFER(state),                                                           /* 1 */
    BUFFER(surfels),                                                         /* 2 */
    TEXEL_BUFFER(surfels),                                                   /* 3 */
    BUFFER(picture.selection),                                               /* 4 */
    BUFFER(picture.list),                                                    /* 5 */
    BUFFER_IN(COMPUTE | VERTEX, picture.splats),                             /* 6 */
    TEXEL_BUFFER_IN(VERTEX, picture.splats),                                 /* 7 */
    BUFFER(picture.prepared),                                                /* 8 */
    BUFFER(grid.state),                                                      /* 9 */
    BUFFER(picture.pyramid),                                                 /* 10 */
    BUFFER(grid.sorted),                                                     /* 11 */
    TEXEL_BUFFER(grid.sorted),                                               /* 12 */
    STORAGE_IMAGE(picture.thickness),                                        /* 13 */
    [BIND_SUMS] = {SAMPLED, FRAGMENT | COMPUTE},                             /* 14 */
    [BIND_MOTION] = {SAMPLED, FRAGMENT | COMPUTE},                           /* 15 */
    [BIND_THICKNESS] = SAMPLED_IMAGE(FRAGMENT | COMPUTE, picture.thickness), /* 16 */
    [BIND_DEPTH] = {SAMPLED, FRAGMENT | COMPUTE},                            /* 17 */
    [BIND_COLOR] = {SAMPLED, FRAGMENT | COMPUTE},                            /* 18 */
    [BIND_PANORAMA] = {SAMPLED, FRAGMENT | COMPUTE},                         /* 19 */
    BUFFER(foam.slots),                                                      /* 20 */
    BUFFER(foam.particles),                                                  /* 21 */
    BUFFER_IN(COMPUTE | VERTEX, picture.foam_splats),                        /* 22 */
    TEXEL_BUFFER_IN(VERTEX, picture.foam_splats),                            /* 23 */
    BUFFER(picture.divisions),                                               /* 24 */
    BUFFER_IN(COMPUTE | VERTEX, picture.parts),                              /* 25 */
    TEXEL_BUFFER_IN(VERTEX, picture.parts),                                  /* 26 */
    [BIND_COLORS] = {SAMPLED, FRAGMENT},                                     /* 27 */
    STORAGE_IMAGE(picture.gaps),                                             /* 28 */
    SAMPLED_IMAGE(FRAGMENT, picture.gaps),                                   /* 29 */
    BUFFER_IN(COMPUTE | VERTEX, picture.open_blocks),                        /* 30 */
    TEXEL_BUFFER_IN(VERTEX, picture.open_blocks),                            /* 31 */
    BUFFER_IN(COMPUTE | VERTEX, picture.tiles),                              /* 32 */
};

/* ---- prepare */

/* The images are as large as the view, or smaller by the same factor on both sides. */
static void fit_images(const virga_water *water, const virga_view *view, virga_water_look_gpu *look)
{
    const float width = view->viewport[2], height = view->viewport[3];
    const float fits = fminf((float)water->def.max_width / ceilf(width), (float)water->def.max_height / ceilf(height));
    look->scale = fminf(fits, 1);
    look->width = (uint32_t)fmaxf(fminf(ceilf(width * look->scale), (float)water->def.max_width), 1);
    look->height = (uint32_t)fmaxf(fminf(ceilf(height * look->scale), (float)water->def.max_height), 1);
    look->volume_columns = (look->width + VIRGA_WATER_VOLUME_PX - 1) / VIRGA_WATER_VOLUME_PX;
    look->volume_rows = (look->height + VIRGA_WATER_VOLUME_PX - 1) / VIRGA_WATER_VOLUME_PX;
}

static void fill_look(const virga_water *water, const virga_view *view, virga_water_look_gpu *look)
{
    const virga_water_settings *settings = &water->settings;
    fit_images(water, view, look);
    for (int row = 0; row < 3; row++)
        for (int i = 0; i < 3; i++)
            look->axes[3 * row + i] = view->view_from_world[4 * i + row];
    look->surfel_scale = settings->surfel_radius;
    look->surfel_m = (float)water_surfel_m(settings);
    look->max_splats = water->def.max_surfels;
    look->volume_m3 = (float)water_particle_m3(settings);
    look->spacing_m = settings->spacing_m;
    memcpy(look->volume_first, water->picture.volume_first, sizeof look->volume_first);
    memcpy(look->absorption_1_m, settings->absorption_1_m, sizeof look->absorption_1_m);
    memcpy(look->scattering_1_m, settings->scattering_1_m, sizeof look->scattering_1_m);
    look->reflection = settings->reflection;
    look->refraction = settings->refraction;
    look->foam_coverage = settings->foam_coverage;
    look->foam_late_s = water->foam_late_s;
    look->divisions = settings->surfel_divisions;
    look->max_parts = water->def.max_parts;
    look->difference = settings->surfel_difference;
    look->panorama_given = water->picture.panorama.view != VK_NULL_HANDLE;
}

static void fill_view(const virga_water *water, const virga_view *view, water_view_block *out)
{
    const virga_water_settings *settings = &water->settings;
    memset(out, 0, sizeof *out);
    virga_view_fill(view, &settings->lighting, water->origin_m, 0, 0, &out->view);
    out->view.light_gain = settings->light_gain;
    out->view.soft_m = settings->soft_m;
    fill_look(water, view, &out->look);
    out->look.pixel_angle = out->view.pixel_angle / out->look.scale;
}

static virga_bound sampled(const virga_context *context, const virga_image_2d *image)
{
    return (virga_bound){.view = image->layer_views[0],
                         .image_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                         .sampler = context->nearest};
}

static VkDescriptorSet write_set(virga_water *water, uint32_t index, const virga_view *view)
{
    virga_context *context = water->base.context;
    const water_picture *picture = &water->picture;
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&water->base, picture->bindings, bound);
    bound[BIND_SUMS] = sampled(context, picture->sums->colors[0]);
    bound[BIND_MOTION] = sampled(context, picture->sums->colors[1]);
    bound[BIND_COLORS] = sampled(context, picture->colors ? picture->colors->colors[0] : picture->blank_color);
    bound[BIND_DEPTH] = virga_bound_or_blank(&view->depth, picture->blank_depth, context->nearest);
    bound[BIND_COLOR] =
        virga_bound_or_blank(&view->color, picture->blank_color, virga_color_sampler(context, &view->color));
    bound[BIND_PANORAMA] = virga_bound_or_blank(&picture->panorama, picture->blank_color,
                                                virga_color_sampler(context, &picture->panorama));
    return virga_bindings_write(context, picture->bindings, index, bound);
}

static void bind(virga_water *water, VkCommandBuffer cmd, VkPipelineBindPoint point, VkDescriptorSet set,
                 uint32_t view_offset)
{
    virga_bind(water->base.context, cmd, point, water->picture.bindings, set, 1, &view_offset);
}

/* Waits for draws of an earlier prepare, and clears what is counted up. */
static void record_clear(virga_water *water, VkCommandBuffer cmd)
{
    virga_context *context = water->base.context;
    const water_picture *picture = &water->picture;
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES | VIRGA_VERTICES | VIRGA_FRAGMENTS,
               VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES);
    context->vk.CmdFillBuffer(cmd, picture->prepared->buffer, 0, VK_WHOLE_SIZE, 0);
    context->vk.CmdFillBuffer(cmd, picture->pyramid->buffer, 0, VK_WHOLE_SIZE, 0);
    context->vk.CmdFillBuffer(cmd, picture->open_blocks->buffer, 0, VK_WHOLE_SIZE, 0);
    context->vk.CmdFillBuffer(cmd, picture->tiles->buffer, 0, sizeof(virga_water_tiles_gpu), 0);
    virga_wait(context, cmd, VIRGA_COPIES, VIRGA_PASSES);
}

static void over(const virga_water *water, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                 const virga_buffer *arguments, size_t groups)
{
    virga_dispatch_indirect_and_barrier(water->base.context, cmd, pipeline, arguments->buffer, groups);
}

static void record_volumes(virga_water *water, VkCommandBuffer cmd, const virga_water_look_gpu *look)
{
    virga_context *context = water->base.context;
    const water_picture *picture = &water->picture;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "water.thickness");
    over(water, cmd, picture->volume, water->grid.state, offsetof(virga_particle_grid_gpu, sorted_groups));
    virga_dispatch_2d(context, cmd, picture->volume_merge, (look->volume_columns + 7) / 8, (look->volume_rows + 7) / 8);
    virga_pass_end(context, cmd, scope);
}

static void record_list(virga_water *water, VkCommandBuffer cmd)
{
    virga_context *context = water->base.context;
    const water_picture *picture = &water->picture;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "water.visible");
    over(water, cmd, picture->splat_mark, water->state, offsetof(virga_water_state_gpu, surfel_groups));
    virga_dispatch_and_barrier(context, cmd, picture->splat_scan, 1);
    over(water, cmd, picture->splat_compact, picture->prepared, offsetof(virga_water_prepared_gpu, word_groups));
    over(water, cmd, picture->splat_write, picture->list, 0);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_ARGUMENTS | VIRGA_VERTICES | VIRGA_FRAGMENTS);
    virga_pass_end(context, cmd, scope);
}

/* What splats or their parts are added up in, and the passes that do it. */
typedef struct sums_passes {
    const virga_offscreen *images;
    const virga_pipeline *depth, *sum, *behind;
    VkDeviceSize sum_arguments; /* of the draws of the second and third pass, in `prepared` */
} sums_passes;

static void record_draw(virga_water *water, VkCommandBuffer cmd, const virga_pipeline *pipeline, VkDeviceSize arguments)
{
    virga_context *context = water->base.context;
    if (virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline))
        context->vk.CmdDrawIndirect(cmd, water->picture.prepared->buffer, arguments, 1, 0);
}

static void set_area(virga_water *water, VkCommandBuffer cmd, VkDescriptorSet set, const virga_water_look_gpu *look)
{
    virga_set_draw_area(water->base.context, cmd, (const float[4]){0, 0, (float)look->width, (float)look->height});
    bind(water, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, set, water->picture.view_offset);
}

/* The depth of the nearest water, and the sums of what lies on it. */
static void record_sums(virga_water *water, VkCommandBuffer cmd, VkDescriptorSet set, const virga_water_look_gpu *look,
                        const sums_passes *passes)
{
    virga_offscreen_begin(water->base.context, cmd, passes->images, 0);
    set_area(water, cmd, set, look);
    record_draw(water, cmd, passes->depth, 0);
    record_draw(water, cmd, passes->sum, passes->sum_arguments);
    virga_offscreen_end(water->base.context, cmd);
}

/* What is behind it, where it leaves gaps. */
static void record_behind(virga_water *water, VkCommandBuffer cmd, VkDescriptorSet set,
                          const virga_water_look_gpu *look, const sums_passes *passes)
{
    virga_offscreen_resume(water->base.context, cmd, passes->images, 0);
    set_area(water, cmd, set, look);
    record_draw(water, cmd, passes->behind, passes->sum_arguments);
    virga_offscreen_end(water->base.context, cmd);
}

static void record_splats(virga_water *water, VkCommandBuffer cmd, VkDescriptorSet set,
                          const virga_water_look_gpu *look)
{
    virga_context *context = water->base.context;
    const water_picture *picture = &water->picture;
    const sums_passes passes = {picture->sums, picture->splat_depth, picture->splat_sum, picture->splat_behind, 0};
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "water.splats");
    record_sums(water, cmd, set, look, &passes);
    const uint32_t px = VIRGA_WATER_BLOCK_PX;
    virga_dispatch_2d(context, cmd, picture->splat_gaps, (look->width + px - 1) / px, (look->height + px - 1) / px);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_PASSES | VIRGA_ARGUMENTS);
    virga_dispatch_indirect(context, cmd, picture->splat_close, picture->prepared->buffer,
                            offsetof(virga_water_prepared_gpu, block_groups));
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_VERTICES | VIRGA_FRAGMENTS);
    record_behind(water, cmd, set, look, &passes);
    virga_pass_end(context, cmd, scope);
}

/* The host's barriers may cover only fragment shaders, so this adds one for compute. */
static void wait_for_host(virga_water *water, VkCommandBuffer cmd, VkPipelineStageFlags stages)
{
    virga_barrier(water->base.context, cmd, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | stages, 0,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
}

/* On a GPU a draw pays for contact lines only where they are. Larger views than the effect's images have no tiles. */
static bool has_tiles(const virga_water *water, const virga_view *view, const virga_water_look_gpu *look)
{
    return water->base.context->for_software && water->settings.contact == VIRGA_WATER_CONTACT_PREPARE &&
           view->depth.view && look->scale >= 1;
}

static void record_tiles(virga_water *water, VkCommandBuffer cmd, VkDescriptorSet set, const virga_view *view,
                         const virga_water_look_gpu *look)
{
    virga_context *context = water->base.context;
    const uint32_t px = VIRGA_WATER_TILE_PX * VIRGA_WATER_WIDE_TILES;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "water.tiles");
    wait_for_host(water, cmd, view->depth.before.stage);
    bind(water, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, set, water->picture.view_offset);
    virga_dispatch_2d(context, cmd, water->picture.contact_tiles, (look->width + px - 1) / px,
                      (look->height + px - 1) / px);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_ARGUMENTS | VIRGA_VERTICES);
    virga_pass_end(context, cmd, scope);
}

/* Light by surfels. */
static void record_parts(virga_water *water, VkCommandBuffer cmd, VkDescriptorSet set, const virga_water_look_gpu *look,
                         const virga_view *view)
{
    virga_context *context = water->base.context;
    const water_picture *picture = &water->picture;
    const sums_passes passes = {picture->colors, picture->part_depth, picture->part_sum, picture->part_behind,
                                offsetof(virga_water_prepared_gpu, part_vertices)};
    virga_pass_scope scope = virga_pass_begin(context, cmd, "water.divide");
    wait_for_host(water, cmd, view->color.view ? view->color.before.stage : 0);
    bind(water, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, set, picture->view_offset);
    over(water, cmd, picture->divide_mark, picture->list, 0);
    virga_dispatch_and_barrier(context, cmd, picture->divide_scan, 1);
    over(water, cmd, picture->divide_write, picture->list, 0);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_ARGUMENTS | VIRGA_VERTICES);
    virga_pass_end(context, cmd, scope);
    scope = virga_pass_begin(context, cmd, "water.parts");
    record_sums(water, cmd, set, look, &passes);
    record_behind(water, cmd, set, look, &passes);
    virga_pass_end(context, cmd, scope);
}

/* After the splats: foam may be under the surface. */
static void record_foam(virga_water *water, VkCommandBuffer cmd, VkDescriptorSet set)
{
    virga_context *context = water->base.context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "water.foam_light");
    bind(water, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, set, water->picture.view_offset);
    virga_dispatch_indirect(context, cmd, water->picture.foam, water->state->buffer,
                            offsetof(virga_water_state_gpu, foam_groups));
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_VERTICES);
    virga_pass_end(context, cmd, scope);
}

/* The VIRGA_WATER_LOOK_... bits of a view. */
static uint32_t look_of(const virga_water *water, const virga_view *view, const virga_water_look_gpu *look,
                        bool by_surfels)
{
    const bool contact = view->depth.view && !by_surfels && water->settings.contact != VIRGA_WATER_CONTACT_OFF;
    return (view->depth.view ? VIRGA_WATER_LOOK_DEPTH : 0) | (view->color.view ? VIRGA_WATER_LOOK_COLOR : 0) |
           (look->scale < 1 ? VIRGA_WATER_LOOK_SCALED : 0) | (contact ? VIRGA_WATER_LOOK_CONTACT : 0) |
           (by_surfels ? VIRGA_WATER_LOOK_SURFELS : 0);
}

virga_result virga_water_prepare(virga_water *water, VkCommandBuffer cmd, const virga_view *view)
{
    return virga_water_prepare_view(water, cmd, view, NULL);
}

virga_result virga_water_prepare_view(virga_water *water, VkCommandBuffer cmd, const virga_view *view,
                                      virga_prepared *prepared)
{
    if (prepared)
        *prepared = 0;
    if (!water)
        return VIRGA_ERROR_INVALID;
    virga_context *context = water->base.context;
    water_picture *picture = &water->picture;
    const bool stepped = water->def.max_width && water->base.contents && water->base.step_frame == context->frame_index;
    virga_result result = virga_effect_check_prepare(&water->base, "virga_water_prepare", cmd, view, 0, stepped);
    if (result)
        return result;
    virga_timers_reset(context, cmd);
    picture->sums = picture->sums_of_view[water->base.slot];
    picture->colors = picture->colors_of_view[water->base.slot];
    const bool by_surfels = water->settings.shading == VIRGA_WATER_SHADING_SURFELS && water->def.max_parts;
    water_view_block block;
    uint32_t index;
    fill_view(water, view, &block);
    result = virga_effect_push_view(&water->base, "virga_water_prepare", &picture->view_ring, &block, sizeof block,
                                    &index, &picture->view_offset);
    if (result)
        return result;
    const VkDescriptorSet set = write_set(water, index, view);
    record_clear(water, cmd);
    bind(water, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, set, picture->view_offset);
    record_volumes(water, cmd, &block.look);
    record_list(water, cmd);
    record_splats(water, cmd, set, &block.look);
    const bool tiled = !by_surfels && has_tiles(water, view, &block.look);
    if (by_surfels)
        record_parts(water, cmd, set, &block.look, view);
    if (tiled)
        record_tiles(water, cmd, set, view, &block.look);
    virga_effect_set_view(&water->base, set, picture->view_offset, view, prepared);
    if (water_has_foam(water))
        record_foam(water, cmd, set);
    picture->look[water->base.slot] = look_of(water, view, &block.look, by_surfels);
    picture->tiled[water->base.slot] = tiled;
    return virga_recording_result(context);
}

/* ---- draw */

/* Without contact lines, then with them and so with depth. */
#define LOOKS 12
#define PLAIN 8
static const uint32_t looks[LOOKS] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 11, 13, 15};

const virga_effect_draw water_draws[WATER_DRAWS] = {
    {"water.draw", VIRGA_VERTEX_FORM(water_draw_water_vert), VIRGA_FRAGMENT_FORMS(water_draw_water_frag), looks, LOOKS},
    {"water.foam_draw", VIRGA_VERTEX_FORM(water_draw_foam_vert), VIRGA_FRAGMENT_FORMS(water_draw_foam_frag), looks, 2},
    {"water.data_draw", VIRGA_VERTEX_FORM(water_draw_data_vert), VIRGA_FORM(water_draw_data_frag)},
    {"water.surfel_draw", VIRGA_VERTEX_FORM(water_draw_water_vert), VIRGA_FRAGMENT_FORMS(water_draw_surfel_frag), looks,
     2},
};

virga_result virga_water_attach(virga_water *water, const virga_target *target)
{
    if (!water)
        return VIRGA_ERROR_INVALID;
    if (target && target->context == water->base.context && !water->def.max_width) /* it is never drawn */
        return VIRGA_OK;
    return virga_effect_attach(&water->base, "virga_water_attach", target);
}

/* The pipelines of a target: those of water and of foam by looks, that of data, and those of light by surfels. */
static uint32_t draw_of_water(uint32_t look)
{
    if (look & VIRGA_WATER_LOOK_SURFELS)
        return LOOKS + 3 + (look & VIRGA_WATER_LOOK_DEPTH);
    return look & VIRGA_WATER_LOOK_CONTACT ? PLAIN + (look - VIRGA_WATER_LOOK_CONTACT) / 2 : look;
}

static uint32_t draw_of_plain(uint32_t look)
{
    return draw_of_water(look & ~VIRGA_WATER_LOOK_CONTACT);
}

static uint32_t draw_of_foam(uint32_t look)
{
    return LOOKS + (look & VIRGA_WATER_LOOK_DEPTH);
}

static uint32_t draw_of_data(uint32_t look)
{
    (void)look;
    return LOOKS + 2;
}

static void draw_tiles(virga_water *water, VkCommandBuffer cmd, const virga_pipeline *pipeline, VkDeviceSize arguments)
{
    virga_context *context = water->base.context;
    if (virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline))
        context->vk.CmdDrawIndirect(cmd, water->picture.tiles->buffer, arguments, 1, 0);
}

/* Begins a draw with one of a target's pipelines: the one of a row that fits the view. */
static virga_result begin_draw(virga_water *water, VkCommandBuffer cmd, const virga_target *target,
                               virga_prepared prepared, const char *call, uint32_t (*draw_of)(uint32_t look),
                               virga_pass_scope *scope)
{
    virga_context *context = water->base.context;
    const virga_effect_target *found;
    const bool stepped = water->def.max_width && water->base.contents;
    virga_result result = virga_effect_check_draw(&water->base, call, cmd, target, prepared, stepped, &found);
    if (result)
        return result;
    const uint32_t look = water->picture.look[water->base.slot];
    const bool tiled = draw_of == draw_of_water && water->picture.tiled[water->base.slot];
    const virga_pipeline *const used[] = {found->draws[draw_of(look)], found->draws[draw_of_plain(look)]};
    result = virga_pipelines_ready(used, tiled ? 2 : 1);
    if (result)
        return result;
    *scope = virga_draw_begin(context, cmd,
                              draw_of == draw_of_foam   ? "water.foam_draw"
                              : draw_of == draw_of_data ? "water.data_draw"
                                                        : "water.draw");
    const virga_effect_view *view = virga_effect_selected(&water->base);
    virga_set_draw_area(context, cmd, view->viewport);
    bind(water, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, view->set, view->offset);
    if (tiled) /* the caller draws those with contact lines */
        draw_tiles(water, cmd, used[1], offsetof(virga_water_tiles_gpu, plain_vertices));
    virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, used[0]);
    return VIRGA_OK;
}

virga_result water_draw(virga_water *water, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                        const char *call)
{
    virga_pass_scope scope;
    const virga_result result = begin_draw(water, cmd, target, prepared, call, draw_of_water, &scope);
    if (result)
        return result;
    if (water->picture.tiled[water->base.slot])
        water->base.context->vk.CmdDrawIndirect(cmd, water->picture.tiles->buffer,
                                                offsetof(virga_water_tiles_gpu, contact_vertices), 1, 0);
    else
        water->base.context->vk.CmdDraw(cmd, 3, 1, 0, 0);
    virga_pass_end(water->base.context, cmd, scope);
    return VIRGA_OK;
}

static virga_result draw_foam(virga_water *water, VkCommandBuffer cmd, const virga_target *target,
                              virga_prepared prepared, const char *call)
{
    virga_pass_scope scope;
    if (!cmd || !target || target->context != water->base.context)
        return virga_wrong_argument(&water->base.context->log,
                                    "%s: expected a command buffer, and a target of the same context", call);
    if (!water_has_foam(water))
        return VIRGA_OK;
    const virga_result result = begin_draw(water, cmd, target, prepared, call, draw_of_foam, &scope);
    if (result)
        return result;
    water->base.context->vk.CmdDrawIndirect(cmd, water->state->buffer, offsetof(virga_water_state_gpu, foam_vertices),
                                            1, 0);
    virga_pass_end(water->base.context, cmd, scope);
    return VIRGA_OK;
}

virga_result virga_water_draw_foam(virga_water *water, VkCommandBuffer cmd, const virga_target *target)
{
    return water ? draw_foam(water, cmd, target, virga_effect_newest(&water->base), "virga_water_draw_foam")
                 : VIRGA_ERROR_INVALID;
}

virga_result virga_water_draw_foam_view(virga_water *water, VkCommandBuffer cmd, const virga_target *target,
                                        virga_prepared prepared)
{
    return water ? draw_foam(water, cmd, target, prepared, "virga_water_draw_foam_view") : VIRGA_ERROR_INVALID;
}

static virga_result draw_data(virga_water *water, VkCommandBuffer cmd, const virga_target *target,
                              virga_prepared prepared, virga_water_data what, const char *call)
{
    virga_pass_scope scope;
    if ((uint32_t)what > VIRGA_WATER_DATA_MOTION)
        return virga_wrong_argument(&water->base.context->log, "%s: expected a virga_water_data, got %d", call,
                                    (int)what);
    const virga_result result = begin_draw(water, cmd, target, prepared, call, draw_of_data, &scope);
    if (result)
        return result;
    water->base.context->vk.CmdDraw(cmd, 3, 1, 0, (uint32_t)what);
    virga_pass_end(water->base.context, cmd, scope);
    return VIRGA_OK;
}

virga_result virga_water_draw_data(virga_water *water, VkCommandBuffer cmd, const virga_target *target,
                                   virga_water_data what)
{
    return water ? draw_data(water, cmd, target, virga_effect_newest(&water->base), what, "virga_water_draw_data")
                 : VIRGA_ERROR_INVALID;
}

virga_result virga_water_draw_data_view(virga_water *water, VkCommandBuffer cmd, const virga_target *target,
                                        virga_prepared prepared, virga_water_data what)
{
    return water ? draw_data(water, cmd, target, prepared, what, "virga_water_draw_data_view") : VIRGA_ERROR_INVALID;
}

/* ---- environment */

virga_result virga_water_environment(virga_water *water, const virga_image *panorama)
{
    if (!water)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &water->base.context->log;
    const virga_image none = {.image = VK_NULL_HANDLE};
    if (panorama && !panorama->image != !panorama->view)
        return virga_wrong_argument(log, "water panorama: expected an image and its view or neither, got no %s",
                                    panorama->view ? "image" : "view");
    if (panorama && panorama->view && panorama->before.layout == VK_IMAGE_LAYOUT_UNDEFINED)
        return virga_wrong_argument(log,
                                    "water panorama.before.layout: expected the layout while drawing, got UNDEFINED");
    water->picture.panorama = panorama ? *panorama : none;
    return VIRGA_OK;
}
