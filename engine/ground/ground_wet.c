/* ground/ground_wet.c - draws what water makes of the ground on a host's picture, from its depth and color alone. */
#include "ground/ground_internal.h"

#include "core/settings.h"
#include "gpu/builds.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/target.h"
#include "gpu/timers.h"
#include "gpu/view.h"

#include <virga/light.h>

#define EFFECT ground
#include "gpu/effect_rows.h"

#include "shaders/ground_shaders.h"

#include <math.h>
#include <string.h>

enum { BIND_WETNESS = 1, BIND_SPOTS, BIND_RIPPLES, BIND_FAR_WETNESS, BIND_DEPTH, BIND_COLOR };

/* As shaders/ground/wet.frag declares them. */
const virga_binding_kind ground_wet_bindings[GROUND_WET_BINDINGS] = {
    RING(VIRGA_ALL_STAGES, wet_ring, ground_wet_block), /* 0 */
    [BIND_WETNESS] = {SAMPLED, FRAGMENT},               /* 1 */
    [BIND_SPOTS] = {SAMPLED, FRAGMENT},                 /* 2 */
    [BIND_RIPPLES] = {SAMPLED, FRAGMENT},               /* 3 */
    [BIND_FAR_WETNESS] = {SAMPLED, FRAGMENT},           /* 4 */
    [BIND_DEPTH] = {SAMPLED, FRAGMENT},                 /* 5 */
    [BIND_COLOR] = {SAMPLED, FRAGMENT},                 /* 6 */
};

const virga_effect_draw ground_draws[1] = {
    {"ground.draw_wet", VIRGA_VERTEX_FORM(ground_wet_vert), VIRGA_FORM(ground_wet_frag), .no_depth = true},
};

virga_ground_wet virga_default_ground_wet(void)
{
    const virga_lighting lighting = virga_default_lighting();
    virga_ground_wet wet = {.size = sizeof wet,
                            .cookie = virga_settings_cookie("ground_wet"),
                            .strength = 1,
                            .darkening = 0.5f,
                            .mirror_reach_m = 60,
                            .far_material = VIRGA_MATERIAL_ASPHALT};
    memcpy(wet.environment_sh, lighting.environment_sh, sizeof wet.environment_sh);
    return wet;
}

virga_result virga_ground_attach(virga_ground *ground, const virga_target *target)
{
    return ground ? virga_effect_attach(&ground->base, "virga_ground_attach", target) : VIRGA_ERROR_INVALID;
}

/* ---- checks */

static virga_result check_range(const virga_log *log, const char *name, float value, float low, float high)
{
    if (value >= low && value <= high)
        return VIRGA_OK;
    return virga_wrong_argument(log, "ground_wet.%s: expected %g to %g, got %g", name, (double)low, (double)high,
                                (double)value);
}

static virga_result check_wet(const virga_log *log, const virga_ground_wet *wet)
{
    virga_result result = virga_settings_check(log, "ground_wet", wet->size, sizeof *wet, wet->cookie);
    if (!result)
        result = check_range(log, "strength", wet->strength, 0, 4);
    if (!result)
        result = check_range(log, "darkening", wet->darkening, 0, 1);
    if (!result)
        result = check_range(log, "mirror_reach_m", wet->mirror_reach_m, 1, 1000);
    if (!result && wet->far_material >= VIRGA_GROUND_MATERIALS)
        result = virga_wrong_argument(log, "ground_wet.far_material: expected less than %d, got %u",
                                      VIRGA_GROUND_MATERIALS, wet->far_material);
    return result ? result
                  : virga_settings_check_finite(log, "ground_wet.environment_sh", wet->environment_sh[0], 9 * 3);
}

static virga_result check_draw(const virga_ground *ground, VkCommandBuffer cmd, const virga_view *view,
                               const virga_ground_wet *wet, const virga_target *target,
                               const virga_effect_target **found)
{
    static const char *const call = "virga_ground_draw_wet";
    const virga_log *log = &ground->base.context->log;
    virga_result result =
        virga_effect_find_target(&ground->base, call, view && wet ? cmd : VK_NULL_HANDLE, target, found);
    if (!result)
        result = check_wet(log, wet);
    if (!result)
        result = virga_view_check(ground->base.context, view, 0);
    if (!result)
        result = virga_effect_check_multiview(&ground->base, call, target, view->multiview_index);
    if (!result && (!view->depth.view || !view->color.view))
        result = virga_wrong_argument(log, "%s: expected a view with depth and color, got no %s", call,
                                      view->depth.view ? "color" : "depth");
    return result;
}

/* ---- the block of a view */

static void relative(const double low_m[2], const virga_view *view, float out[2])
{
    out[0] = (float)(low_m[0] - view->position_m[0]);
    out[1] = (float)(low_m[1] - view->position_m[2]);
}

static void fill_maps(const virga_ground *ground, const virga_view *view, virga_ground_wet_gpu *out)
{
    const double middle_m[2] = {ground->info.camera_m[0], ground->info.camera_m[2]};
    virga_ground_maps maps;
    virga_ground_maps_get(ground, &maps);
    relative(maps.low_m, view, out->low);
    relative(middle_m, view, out->middle);
    relative(maps.far_low_m, view, out->far_low);
    relative(maps.ripple_low_m, view, out->ripple_low);
    for (int axis = 0; axis < 2; axis++)
        out->low_cell[axis] = (ground->window.low[axis] * VIRGA_GROUND_TILE) & (int32_t)(maps.cells - 1);
    out->cells = (int32_t)maps.cells;
    out->far_cells = (int32_t)maps.far_cells;
    out->cell_m = maps.cell_m;
    out->far_cell_m = maps.far_cell_m > 0 ? maps.far_cell_m : 1;
    out->ripple_m = (float)maps.ripple_texels * maps.ripple_texel_m;
    out->base_m = (float)((double)maps.base_m - view->position_m[1]);
    out->reach_m = maps.reach_m;
}

static void fill(const virga_ground *ground, const virga_view *view, const virga_ground_wet *wet,
                 ground_wet_block *block)
{
    virga_lighting lighting = {.light_count = 0};
    memcpy(lighting.environment_sh, wet->environment_sh, sizeof lighting.environment_sh);
    memset(block, 0, sizeof *block);
    virga_view_fill(view, &lighting, view->position_m, 0, 0, &block->view);
    fill_maps(ground, view, &block->wet);
    block->wet.far_material = wet->far_material;
    block->wet.strength = wet->strength;
    block->wet.darkening = wet->darkening;
    block->wet.mirror_reach_m = wet->mirror_reach_m;
}

static virga_bound map_of(const virga_image_2d *image, VkSampler sampler)
{
    return (virga_bound){.view = image->layer_views[0], .image_layout = VK_IMAGE_LAYOUT_GENERAL, .sampler = sampler};
}

static VkDescriptorSet write_set(virga_ground *ground, uint32_t index, const virga_view *view)
{
    virga_context *context = ground->base.context;
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&ground->base, ground->wet_bindings, bound);
    bound[BIND_WETNESS] = map_of(ground->wet_map, context->nearest);
    bound[BIND_SPOTS] = map_of(ground->spot_map, context->nearest);
    bound[BIND_RIPPLES] = map_of(ground->ripples.map->colors[0], context->linear);
    bound[BIND_FAR_WETNESS] = map_of(ground->far.map, context->nearest);
    bound[BIND_DEPTH] = virga_bound_or_blank(&view->depth, NULL, context->nearest);
    bound[BIND_COLOR] = virga_bound_or_blank(&view->color, NULL, virga_color_sampler(context, &view->color));
    return virga_bindings_write(context, ground->wet_bindings, index, bound);
}

virga_result virga_ground_draw_wet(virga_ground *ground, VkCommandBuffer cmd, const virga_view *view,
                                   const virga_ground_wet *wet, const virga_target *target)
{
    if (!ground)
        return VIRGA_ERROR_INVALID;
    virga_context *context = ground->base.context;
    const virga_effect_target *found = NULL;
    virga_result result = check_draw(ground, cmd, view, wet, target, &found);
    if (result)
        return result;
    if (!found)
        return virga_log_not_drawn(context, "virga_ground_draw_wet", false, VIRGA_OK, &ground->base.not_drawn_logged);
    if (!ground->has_base || !ground->base.contents)
        return VIRGA_NOT_READY;
    const virga_pipeline *pipeline = found->draws[0];
    result = virga_pipelines_ready(&pipeline, 1);
    if (result)
        return result;
    ground_wet_block block;
    uint32_t index, offset;
    fill(ground, view, wet, &block);
    result = virga_effect_push_view(&ground->base, "virga_ground_draw_wet", &ground->wet_ring, &block, sizeof block,
                                    &index, &offset);
    if (result)
        return result;
    ground->base.not_drawn_logged = false;
    const virga_pass_scope scope = virga_draw_begin(context, cmd, ground_draws[0].name);
    virga_set_draw_area(context, cmd, view->viewport);
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, ground->wet_bindings, write_set(ground, index, view), 1,
               &offset);
    virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    context->vk.CmdDraw(cmd, 3, 1, 0, 0);
    virga_pass_end(context, cmd, scope);
    return virga_recording_result(context);
}
