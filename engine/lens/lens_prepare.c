/* lens/lens_prepare.c - prepare blurs a picture. */
#include "lens/lens_internal.h"

#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"
#include "gpu/view.h"

#include <math.h>

#define PI 3.14159265358979323846

/* ---- checks */

static virga_result check_layer_depth(const virga_log *log, const virga_lens_layer *layer, uint32_t index)
{
    if (layer->on_scene > 1)
        return virga_wrong_argument(log, "layers[%u].on_scene: expected 0 or 1, got %u", index, layer->on_scene);
    if (layer->on_scene)
        return VIRGA_OK;
    if (layer->depth.view && layer->depth.before.layout == VK_IMAGE_LAYOUT_UNDEFINED)
        return virga_wrong_argument(log, "layers[%u].depth.before.layout: expected the layout while reading", index);
    if (!layer->depth.view && !(layer->depth_m >= 0.001f && layer->depth_m <= 1e6f))
        return virga_wrong_argument(log, "layers[%u].depth_m: expected 0.001 to 1e6 m or a depth image, got %g", index,
                                    (double)layer->depth_m);
    return VIRGA_OK;
}

/* Circles of confusion need no colors. */
static virga_result check_layer(const virga_lens *lens, const virga_lens_layer *layer, uint32_t index)
{
    const virga_log *log = &lens->base.context->log;
    if (!lens->def.circles && (!layer->color.view || layer->color.before.layout == VK_IMAGE_LAYOUT_UNDEFINED))
        return virga_wrong_argument(log, "layers[%u].color: expected an image view, and its layout", index);
    return check_layer_depth(log, layer, index);
}

static virga_result check_view(const virga_lens *lens, const virga_view *view)
{
    const virga_context *context = lens->base.context;
    if (!view->color.view && !lens->def.circles)
        return virga_wrong_argument(&context->log, "virga_lens_prepare: expected a view with color");
    if (view->viewport[0] < 0 || view->viewport[1] < 0 || view->viewport[2] > (float)lens->def.max_width ||
        view->viewport[3] > (float)lens->def.max_height)
        return virga_wrong_argument(&context->log,
                                    "view.viewport: expected up to %u x %u pixels from (0, 0) on, got %g x %g at (%g, "
                                    "%g)",
                                    lens->def.max_width, lens->def.max_height, (double)view->viewport[2],
                                    (double)view->viewport[3], (double)view->viewport[0], (double)view->viewport[1]);
    return VIRGA_OK;
}

static virga_result check_prepare(virga_lens *lens, VkCommandBuffer cmd, const virga_view *view,
                                  const virga_lens_layer *layers, uint32_t layer_count, double time_s)
{
    const virga_log *log = &lens->base.context->log;
    virga_result result = virga_effect_check_step(&lens->base, "virga_lens_prepare", cmd, view);
    if (!result)
        result = virga_effect_check_prepare(&lens->base, "virga_lens_prepare", cmd, view, time_s, true);
    if (result)
        return result;
    if (layer_count > VIRGA_LENS_MAX_LAYERS || (layer_count && !layers))
        return virga_wrong_argument(log, "virga_lens_prepare: expected up to %d layers, got %u%s",
                                    VIRGA_LENS_MAX_LAYERS, layer_count, layers ? "" : " in no array");
    uint32_t on_scene = 0;
    result = check_view(lens, view);
    for (uint32_t i = 0; i < layer_count && !result; i++) {
        result = check_layer(lens, &layers[i], i);
        on_scene += layers[i].on_scene;
    }
    if (!result && on_scene > 1)
        return virga_wrong_argument(log, "layers: expected one on_scene at most, got %u", on_scene);
    return result;
}

/* ---- the uniforms of a view */

/* The share of the way to a new focus. Time that runs backwards, or the first picture, go there at once. */
static float ease(const virga_lens *lens, double time_s)
{
    const lens_prepared *before = &lens->prepared[lens->base.slot];
    const double passed_s = time_s - before->time_s, constant_s = (double)lens->settings.focus_time_s;
    if (!before->has_time || passed_s < 0 || constant_s <= 0)
        return 1;
    return (float)(1 - exp(-passed_s / constant_s));
}

static void fill_picture(const virga_lens *lens, const virga_view *view, virga_lens_gpu *out)
{
    const uint32_t step = lens->def.half_resolution && !lens->def.circles ? 2 : 1;
    out->depth_a = view->clip_from_view[10];
    out->depth_b = view->clip_from_view[14];
    out->far_depth = view->reversed_depth ? 0.0f : 1.0f;
    out->color_given = virga_view_color_given(view);
    out->multiview_index = view->multiview_index;
    out->depth_given = view->depth.view != VK_NULL_HANDLE && out->depth_b != 0;
    out->left = (uint32_t)view->viewport[0];
    out->top = (uint32_t)view->viewport[1];
    out->width = (uint32_t)view->viewport[2];
    out->height = (uint32_t)view->viewport[3];
    out->step = step;
    out->columns = (out->width + step - 1) / step;
    out->rows = (out->height + step - 1) / step;
    out->tile_columns = (out->columns + VIRGA_LENS_TILE - 1) / VIRGA_LENS_TILE;
    out->tile_rows = (out->rows + VIRGA_LENS_TILE - 1) / VIRGA_LENS_TILE;
}

/* The pixel at a share of a side. */
static uint32_t pixel_at(float share, uint32_t first, uint32_t pixels)
{
    const uint32_t pixel = (uint32_t)(share * (float)pixels);
    return first + (pixel < pixels ? pixel : pixels - 1);
}

static void fill_lens(const virga_lens *lens, const virga_view *view, double time_s, virga_lens_gpu *out)
{
    const virga_lens_settings *settings = &lens->settings;
    /* shaders/lens/lens.glsl: r = A p / 2 (1 / s - 1 / z); p is half the height times the projection's cotangent. */
    const double aperture_m = settings->aperture_f > 0 ? (double)settings->focal_m / (double)settings->aperture_f : 0;
    const double pixels = 0.5 * (double)view->viewport[3] * fabs((double)view->clip_from_view[5]);
    out->circle_px_m = (float)(0.5 * aperture_m * pixels);
    out->circle_per_depth = out->depth_given ? out->circle_px_m / out->depth_b : 0;
    out->max_radius = settings->max_radius_px / (float)out->step;
    if (!lens->def.circles)
        out->max_radius = fminf(out->max_radius, VIRGA_LENS_MAX_RADIUS);
    out->levels = 0;
    while (out->levels < VIRGA_LENS_LEVELS && out->max_radius > (float)(VIRGA_LENS_FINE << out->levels))
        out->levels++;
    const double most = VIRGA_LENS_MAX_RADIUS, shape = (double)lens->areas[VIRGA_LENS_SPREADS - 1] / (most * most);
    out->edge_area = (float)(VIRGA_LENS_EDGE_VARIANCE * PI / shape);
    out->follow = settings->follow;
    out->focus_x = pixel_at(settings->focus_point[0], out->left, out->width);
    out->focus_y = pixel_at(settings->focus_point[1], out->top, out->height);
    out->focus_inv_m = settings->focus_m > 0 ? 1 / settings->focus_m : 0;
    out->ease = ease(lens, time_s);
    out->cats_eye = settings->cats_eye;
    out->blades = (float)settings->blades;
    out->roundness = settings->blade_roundness;
    out->rotation = (float)((double)settings->blade_rotation_deg * PI / 180);
    for (int i = 0; i < 2; i++) {
        out->threshold_m[i] = settings->threshold_m[i];
        out->filter_weight[i] = settings->filter_weight[i];
    }
    for (int i = 0; i < VIRGA_LENS_SPREADS; i++)
        out->areas[i] = lens->areas[i];
}

/* Whether a layer is known to be in focus. The focus that follows the picture is known to the device only. */
static bool layer_is_sharp(const virga_lens_gpu *view, uint32_t layer)
{
    const float sharp_px = 0.5f; /* half a texel, or where half resolution begins to be mixed in */
    const float inv_m = view->layer_inv_m[layer];
    if (view->circle_px_m <= 0 || (layer + 1 == view->on_scene && !view->depth_given))
        return true;
    return !view->follow && inv_m > 0 && view->circle_px_m * fabsf(view->focus_inv_m - inv_m) <= sharp_px;
}

static void find_sharp(virga_lens_gpu *view)
{
    for (uint32_t i = 0; i < view->layers; i++)
        view->sharp_layers |= layer_is_sharp(view, i) ? 1u << i : 0;
    const bool sharp_scene = view->circle_px_m <= 0 || !view->depth_given;
    view->all_sharp = sharp_scene && view->sharp_layers == (1u << view->layers) - 1;
}

/* Whether discs, of the scene and of layers, are gathered by passes of their own each, which wait for none. */
static bool is_direct(const virga_lens *lens, const virga_lens_gpu *view)
{
    return !view->on_scene && lens_way_of(lens, &lens->settings) != LENS_WAY_ANY;
}

/* From which scales a layer comes, see coarseness in shaders/lens/lens.glsl. */
static void choose_scales(const virga_lens *lens, virga_lens_gpu *view, uint32_t layer)
{
    const uint32_t bit = 1u << layer;
    const bool wide = lens_way_of(lens, &lens->settings) == LENS_WAY_WIDE;
    const bool known = view->layer_inv_m[layer] > 0 && !view->follow; /* else the device knows */
    const float radius_px = view->circle_px_m * fabsf(view->focus_inv_m - view->layer_inv_m[layer]);
    if (!wide || !known || radius_px < (float)VIRGA_LENS_COARSE_TO)
        view->fine_layers |= bit;
    if (wide && (!known || radius_px > (float)VIRGA_LENS_COARSE_FROM))
        view->coarse_layers |= bit;
}

static void find_scales(const virga_lens *lens, virga_lens_gpu *view)
{
    for (uint32_t i = 0; i < view->layers && is_direct(lens, view); i++)
        if (!(view->sharp_layers >> i & 1))
            choose_scales(lens, view, i);
}

/* How many layers have to be looked at for their depths: up to the last one that has a depth image. */
static uint32_t depth_layers(const virga_lens_gpu *view)
{
    uint32_t layers = 0;
    for (uint32_t i = 0; i < view->layers; i++)
        if (view->layer_inv_m[i] <= 0 && i + 1 != view->on_scene)
            layers = i + 1;
    return layers;
}

/* Whether one pass gathers. */
static bool is_narrow(const virga_lens *lens, const virga_lens_gpu *view)
{
    return !view->on_scene && lens_way_of(lens, &lens->settings) == LENS_WAY_NARROW;
}

/* Whether one does that has what is wide as well. */
static bool is_wide(const virga_lens *lens, const virga_lens_gpu *view)
{
    return !view->on_scene && !view->all_sharp && lens_way_of(lens, &lens->settings) == LENS_WAY_WIDE;
}

/* Whether no other pass is needed for the scene. */
static bool is_alone(const virga_lens *lens, const virga_lens_gpu *view)
{
    return is_wide(lens, view) || (lens->def.in_place && !view->all_sharp && is_narrow(lens, view));
}

static virga_result push_view(virga_lens *lens, const virga_view *view, const virga_lens_layer *layers,
                              uint32_t layer_count, double time_s, virga_lens_gpu *filled, uint32_t *index,
                              uint32_t *offset)
{
    *filled = (virga_lens_gpu){.layers = layer_count};
    fill_picture(lens, view, filled);
    fill_lens(lens, view, time_s, filled);
    for (uint32_t i = 0; i < layer_count; i++) {
        filled->layer_inv_m[i] = layers[i].depth.view || layers[i].on_scene ? 0 : 1 / layers[i].depth_m;
        filled->on_scene = layers[i].on_scene ? i + 1 : filled->on_scene;
    }
    find_sharp(filled);
    find_scales(lens, filled);
    const virga_result result = virga_effect_push_view(&lens->base, "virga_lens_prepare", &lens->view_ring, filled,
                                                       sizeof *filled, index, offset);
    const uint32_t tiles = filled->tile_columns * filled->tile_rows;
    if (!result)
        lens->prepared[lens->base.slot] = (lens_prepared){.time_s = time_s,
                                                          .has_time = true,
                                                          .width = filled->width,
                                                          .height = filled->height,
                                                          .layers = layer_count,
                                                          .all_sharp = filled->all_sharp,
                                                          .tiles = is_alone(lens, filled) ? tiles : 0,
                                                          .wide = is_wide(lens, filled)};
    return result;
}

/* All layers of an image. */
static virga_bound in_general(const virga_image_2d *image, VkSampler sampler)
{
    return (virga_bound){.view = image->view, .image_layout = VK_IMAGE_LAYOUT_GENERAL, .sampler = sampler};
}

/* One layer of an image; without it, what is bound in its place. */
static virga_bound one_of(const virga_image_2d *image, uint32_t layer, virga_bound without, VkSampler sampler)
{
    if (!image)
        return without;
    return (virga_bound){
        .view = image->layer_views[layer], .image_layout = VK_IMAGE_LAYOUT_GENERAL, .sampler = sampler};
}

/* Whether the far field has 32 bits, which are enough for a color alone. Layers have to know what is near before them,
 * and wide discs how much of the coarse field is to be added. */
static bool is_packed(const lens_prepared *prepared)
{
    return prepared->tiles && !prepared->wide && !prepared->layers;
}

/* The far field: written, and seen by draws. */
static void bind_far(const virga_lens *lens, const virga_bound *without, virga_bound *bound)
{
    const VkSampler linear = lens->base.context->linear;
    bound[LENS_BIND_FAR] = one_of(lens->def.circles ? NULL : lens->fields, VIRGA_LENS_FAR, *without, linear);
    bound[LENS_BIND_PACKED_WRITTEN] = one_of(lens->packed ? lens->packed : lens->blocks, 0, *without, linear);
    if (lens->packed && is_packed(&lens->prepared[lens->base.slot]))
        bound[LENS_BIND_FAR].view = lens->packed->seen_view;
}

/* What only draws in place read, and passes for them write. */
static void bind_in_place(const virga_lens *lens, const virga_bound *without, virga_bound *bound)
{
    const VkSampler linear = lens->base.context->linear;
    const virga_image_2d *fields = lens->def.circles ? NULL : lens->fields, *coarse = lens->coarse;
    bound[LENS_BIND_COARSE_WRITTEN] = bound[LENS_BIND_COARSE] = coarse ? in_general(coarse, linear) : *without;
    bound[LENS_BIND_COARSE_NEAR] = one_of(coarse, VIRGA_LENS_NEAR, *without, linear);
    bound[LENS_BIND_COARSE_FAR] = one_of(coarse, VIRGA_LENS_FAR, *without, linear);
    bound[LENS_BIND_FIRST_LAYER] = one_of(fields, VIRGA_LENS_FIRST_LAYER, *without, linear);
    bound[LENS_BIND_FIRST_COARSE_LAYER] = one_of(coarse, VIRGA_LENS_FIRST_LAYER, *without, linear);
    bound[LENS_BIND_CIRCLES_OF_NEAR_WRITTEN] = bound[LENS_BIND_CIRCLES_OF_NEAR] =
        one_of(lens->near_circles, 0, *without, linear);
}

static VkDescriptorSet write_set(virga_lens *lens, uint32_t index, const virga_view *view,
                                 const virga_lens_layer *layers, uint32_t layer_count)
{
    virga_context *context = lens->base.context;
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&lens->base, lens->bindings, bound);
    bound[LENS_BIND_DEPTH] = virga_bound_or_blank(&view->depth, lens->blank_depth, context->nearest);
    bound[LENS_BIND_COLOR] = virga_bound_or_blank(&view->color, lens->blank_color, context->nearest);
    const virga_bound out = in_general(lens->def.circles ? lens->circles : lens->fields, context->linear);
    for (uint32_t i = 0; i < LENS_BIND_CIRCLES; i++)
        if (!bound[i].view && lens->bindings->kinds[i].source == VIRGA_SOURCE_IMAGE)
            bound[i] = out; /* no pass uses it, but software Vulkan looks at every image of a set */
    bound[LENS_BIND_FIELDS_WRITTEN] = bound[LENS_BIND_FIELDS] = bound[LENS_BIND_CIRCLES] = out;
    bound[LENS_BIND_BLOCKS_WRITTEN] = bound[LENS_BIND_BLOCKS] =
        lens->def.circles ? out : in_general(lens->blocks, context->nearest);
    bind_far(lens, &out, bound);
    bind_in_place(lens, &out, bound);
    if (!lens->settings.follow) /* nobody reads it, and it would have to be waited for */
        bound[LENS_BIND_FOCUS] =
            (virga_bound){.buffer = lens->view_ring.buffer->buffer, .range = sizeof(virga_lens_state_gpu)};
    bound[LENS_BIND_ON_SCENE] = virga_bound_or_blank(NULL, lens->blank_color, context->nearest);
    for (uint32_t i = 0; i < VIRGA_LENS_LAYERS; i++) {
        const virga_lens_layer *layer = i < layer_count ? &layers[i] : NULL;
        bound[LENS_BIND_LAYER_COLORS + i] =
            virga_bound_or_blank(layer ? &layer->color : NULL, lens->blank_color, context->nearest);
        if (layer && layer->on_scene)
            bound[LENS_BIND_ON_SCENE] = bound[LENS_BIND_LAYER_COLORS + i];
        const virga_image *depth = layer && layer->on_scene ? &view->depth : layer ? &layer->depth : NULL;
        bound[LENS_BIND_LAYER_DEPTHS + i] = virga_bound_or_blank(depth, lens->blank_depth, context->nearest);
    }
    return virga_bindings_write(context, lens->bindings, index, bound);
}

/* ---- prepare */

#define GROUP 8 /* side of the workgroups of passes over pixels */

/* A pass over a picture, and a barrier after it. */
static void over(virga_lens *lens, VkCommandBuffer cmd, const char *name, const virga_pipeline *pipeline,
                 uint32_t width, uint32_t height)
{
    virga_context *context = lens->base.context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, name);
    virga_dispatch_2d(context, cmd, pipeline, virga_groups_of(width, GROUP), virga_groups_of(height, GROUP));
    virga_compute_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

static bool is_linear(const virga_lens_gpu *view)
{
    return view->color_given != VIRGA_COLOR_SRGB;
}

/* The form of a pass by its layers and one more condition. */
static uint32_t layers_form(const virga_lens_gpu *view, bool other)
{
    return view->layers + (other ? VIRGA_LENS_LAYERS + 1 : 0);
}

/* A pass over one list of tiles. */
static void over_list(virga_lens *lens, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t kind)
{
    virga_dispatch_indirect(lens->base.context, cmd, pipeline, lens->lists->buffer, kind * sizeof(virga_lens_list_gpu));
}

static void record_gather(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view, uint32_t form)
{
    virga_context *context = lens->base.context;
    uint32_t kind = 0; /* the pass always has it pushed, though it reads it at half resolution only */
    context->vk.CmdPushConstants(cmd, lens->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof kind, &kind);
    if (!lens->def.half_resolution) {
        over(lens, cmd, "lens.gather", lens->gather[form], view->columns, view->rows);
        return;
    }
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "lens.gather");
    for (; kind < VIRGA_LENS_TILES_SHARP; kind++) {
        context->vk.CmdPushConstants(cmd, lens->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof kind, &kind);
        over_list(lens, cmd, lens->gather[form | (kind == VIRGA_LENS_TILES_BLURRED ? 0 : VIRGA_LENS_NO_NEAR)], kind);
    }
    virga_compute_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

static void record_combine(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view)
{
    virga_context *context = lens->base.context;
    const uint32_t forms = VIRGA_LENS_LAYERS + 1, layers = lens_layer_form(lens, view->layers);
    const uint32_t linear = is_linear(view) ? VIRGA_LENS_COMBINE_KINDS * forms : 0;
    if (!lens->def.half_resolution || view->all_sharp) {
        const uint32_t kind = view->all_sharp ? VIRGA_LENS_ALL_SHARP : VIRGA_LENS_TILES_BLURRED;
        over(lens, cmd, "lens.combine", lens->combine[linear + kind * forms + layers], view->width, view->height);
        return;
    }
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "lens.combine");
    for (uint32_t kind = 0; kind < VIRGA_LENS_TILE_KINDS; kind++)
        over_list(lens, cmd, lens->combine[linear + kind * forms + layers], kind);
    virga_compute_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

/* The scene as samples: of all tiles, or at half resolution of those whose samples are read. */
static void record_sample(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view)
{
    virga_context *context = lens->base.context;
    const uint32_t form = (is_linear(view) ? VIRGA_LENS_LINEAR : 0) | (view->on_scene ? VIRGA_LENS_ON_SCENE : 0);
    if (!lens->def.half_resolution) {
        over(lens, cmd, "lens.sample", lens->sample[form], view->columns, view->rows);
        return;
    }
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "lens.sample");
    over_list(lens, cmd, lens->sample[form], VIRGA_LENS_TILES_SAMPLED);
    virga_compute_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

/* Blocks of all levels and kinds, of the scene or of a layer. */
static void record_blocks(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view, uint32_t form,
                          uint32_t layer)
{
    virga_context *context = lens->base.context;
    if (!view->levels)
        return;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "lens.blocks");
    context->vk.CmdPushConstants(cmd, lens->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof layer, &layer);
    over_list(lens, cmd, lens->block[form], VIRGA_LENS_LIST_OF_BLOCKS);
    virga_compute_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

static void record_layers(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view, uint32_t shaped)
{
    virga_context *context = lens->base.context;
    for (uint32_t i = 0; i < view->layers; i++) {
        if (i + 1 == view->on_scene || view->sharp_layers >> i & 1)
            continue;
        const uint32_t form = shaped | (view->layer_inv_m[i] > 0 ? 0 : VIRGA_LENS_DEPTHS);
        over(lens, cmd, "lens.layers", lens->layer_sample[i], view->columns, view->rows);
        record_blocks(lens, cmd, view, VIRGA_LENS_BLOCKS_LAYER, i);
        context->vk.CmdPushConstants(cmd, lens->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof i, &i);
        over(lens, cmd, "lens.layers", lens->layer[form], view->columns, view->rows);
    }
}

enum { TILES = 2 }; /* of a workgroup, beside each other */

/* A layer at one scale. It is not waited for. */
static void over_layer(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view, uint32_t layer, uint32_t form)
{
    virga_context *context = lens->base.context;
    const uint32_t side = form & VIRGA_LENS_QUARTER ? 2 : 1; /* of a tile, in those of half resolution */
    const virga_pipeline *pipeline =
        view->layer_inv_m[layer] > 0 ? lens->narrow_plane[form] : lens->narrow_depths[form];
    virga_dispatch_2d(context, cmd, pipeline, virga_groups_of(view->tile_columns, TILES * side),
                      virga_groups_of(view->tile_rows, side));
}

/* All layers that are out of focus. Passes over them and over the scene need nothing of each other. */
static void record_direct_layers(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view, uint32_t shaped)
{
    virga_context *context = lens->base.context;
    if (!(view->fine_layers | view->coarse_layers))
        return;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "lens.layers");
    for (uint32_t i = 0; i < view->layers; i++) {
        context->vk.CmdPushConstants(cmd, lens->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof i, &i);
        if (view->fine_layers >> i & 1)
            over_layer(lens, cmd, view, i, shaped);
        if (view->coarse_layers >> i & 1)
            over_layer(lens, cmd, view, i, shaped | VIRGA_LENS_QUARTER);
    }
    virga_pass_end(context, cmd, scope);
}

/* Reaches, lists and the gather in one pass, or tiles as well. */
static void record_narrow(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view, uint32_t shaped)
{
    virga_context *context = lens->base.context;
    const bool wide = is_wide(lens, view);
    const uint32_t form =
        shaped | (is_linear(view) ? VIRGA_LENS_NARROW_LINEAR : 0) | (is_alone(lens, view) ? VIRGA_LENS_ALONE : 0);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, wide ? "lens.wide" : "lens.narrow");
    const uint32_t side = wide ? 2 : 1; /* of a coarse tile, in tiles */
    virga_dispatch_2d(context, cmd, wide ? lens->wide[form] : lens->narrow[form],
                      virga_groups_of(view->tile_columns, TILES * side), virga_groups_of(view->tile_rows, side));
    virga_indirect_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

/* The aperture as an image. It is not waited for. */
static void record_aperture(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view, uint32_t shaped)
{
    const uint32_t radius = view->levels ? VIRGA_LENS_MAX_RADIUS : (uint32_t)ceilf(view->max_radius) + 1;
    virga_dispatch_2d(lens->base.context, cmd, lens->aperture_reach, virga_groups_of(VIRGA_LENS_APERTURE, GROUP),
                      virga_groups_of(VIRGA_LENS_AREA_ROWS + (shaped ? 2 * radius + 1 : 0), GROUP));
}

/* The fields, if one pass makes each. They need no image of an aperture that is a disc. */
static void record_alone(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view, uint32_t shaped)
{
    virga_context *context = lens->base.context;
    if (shaped) {
        const virga_pass_scope scope = virga_pass_begin(context, cmd, "lens.aperture");
        record_aperture(lens, cmd, view, shaped);
        virga_compute_barrier(context, cmd);
        virga_pass_end(context, cmd, scope);
    }
    record_direct_layers(lens, cmd, view, shaped);
    record_narrow(lens, cmd, view, shaped);
}

/* The fields: what is out of focus, for each texel. */
static void record_fields(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view)
{
    virga_context *context = lens->base.context;
    const uint32_t shaped = view->blades > 0 || view->cats_eye > 0 ? VIRGA_LENS_SHAPED : 0;
    if (is_alone(lens, view)) {
        record_alone(lens, cmd, view, shaped);
        return;
    }
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "lens.tiles");
    record_aperture(lens, cmd, view, shaped);
    const uint32_t layers = is_narrow(lens, view) ? 0 : depth_layers(view);
    virga_dispatch_2d(context, cmd, lens->tile[lens_layer_form(lens, layers)], view->tile_columns, view->tile_rows);
    virga_compute_barrier(context, cmd);
    if (is_narrow(lens, view)) {
        virga_pass_end(context, cmd, scope);
        record_direct_layers(lens, cmd, view, shaped);
        record_narrow(lens, cmd, view, shaped);
        return;
    }
    virga_dispatch_and_barrier(context, cmd, lens->reach, virga_groups_of(view->tile_columns * view->tile_rows, 64));
    virga_pass_end(context, cmd, scope);
    record_sample(lens, cmd, view);
    record_blocks(lens, cmd, view, view->on_scene ? VIRGA_LENS_BLOCKS_ON_SCENE : VIRGA_LENS_BLOCKS_SCENE, 0);
    record_gather(lens, cmd, view, shaped | (view->on_scene ? VIRGA_LENS_ON_SCENE : 0));
    record_layers(lens, cmd, view, shaped);
}

static void record_physical(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view)
{
    if (!view->all_sharp)
        record_fields(lens, cmd, view);
    if (!lens->def.in_place)
        record_combine(lens, cmd, view);
}

static void record_circles(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view)
{
    for (uint32_t part = 0; part <= view->layers; part++)
        over(lens, cmd, "lens.circles", lens->circle[part], view->width, view->height);
}

/* Passes wait for it only if they use what it computes: a focus that follows the picture. */
static void record_focus(virga_lens *lens, VkCommandBuffer cmd, const virga_lens_gpu *view)
{
    virga_context *context = lens->base.context;
    if (!view->follow && lens->settings.style == VIRGA_LENS_STYLE_PHYSICAL && is_alone(lens, view))
        return; /* the pass over the scene keeps it */
    virga_dispatch(context, cmd, lens->focus, 1);
    if (view->follow)
        virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                      VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                      READ_WRITE | VK_ACCESS_UNIFORM_READ_BIT);
}

virga_result virga_lens_prepare(virga_lens *lens, VkCommandBuffer cmd, const virga_view *view,
                                const virga_lens_layer *layers, uint32_t layer_count, double time_s)
{
    return virga_lens_prepare_view(lens, cmd, view, layers, layer_count, time_s, NULL);
}

virga_result virga_lens_prepare_view(virga_lens *lens, VkCommandBuffer cmd, const virga_view *view,
                                     const virga_lens_layer *layers, uint32_t layer_count, double time_s,
                                     virga_prepared *prepared)
{
    if (prepared)
        *prepared = 0;
    if (!lens)
        return VIRGA_ERROR_INVALID;
    virga_context *context = lens->base.context;
    virga_result result = check_prepare(lens, cmd, view, layers, layer_count, time_s);
    if (result)
        return result;
    virga_lens_gpu filled;
    uint32_t index, offset;
    result = push_view(lens, view, layers, layer_count, time_s, &filled, &index, &offset);
    if (result)
        return result;
    const VkDescriptorSet set = write_set(lens, index, view, layers, layer_count);
    virga_effect_begin_step(&lens->base, cmd);
    virga_effect_first_contents(&lens->base, cmd);
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, lens->bindings, set, 1, &offset);
    record_focus(lens, cmd, &filled);
    if (lens->def.circles)
        record_circles(lens, cmd, &filled);
    else if (lens->settings.style == VIRGA_LENS_STYLE_PAPER)
        over(lens, cmd, "lens.paper", lens->paper[layers_form(&filled, is_linear(&filled))], filled.width,
             virga_groups_of(filled.height, VIRGA_LENS_COLUMN));
    else
        record_physical(lens, cmd, &filled);
    const uint32_t draws = lens->def.in_place ? VIRGA_FRAGMENTS | VIRGA_VERTICES | VIRGA_ARGUMENTS : VIRGA_FRAGMENTS;
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_PASSES | VIRGA_COPIES | draws); /* also for the host */
    virga_effect_copy_statistics(&lens->base, cmd, 0, lens->state, 0,
                                 virga_effect_view_index(&lens->base) * sizeof(virga_lens_state_gpu),
                                 sizeof(virga_lens_state_gpu));
    virga_effect_set_view(&lens->base, set, offset, view, prepared);
    return virga_recording_result(context);
}
