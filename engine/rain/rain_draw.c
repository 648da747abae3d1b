/* rain/rain_draw.c - what a view sees: selection and shading (prepare), pipelines for a target (attach), and drawing. */
#include "rain/rain_internal.h"

#include "core/phase.h"

#include "shaders/rain_haze_frag.spv.h"
#include "shaders/rain_haze_vert.spv.h"
#include "shaders/rain_streak_thin_frag.spv.h"
#include "shaders/rain_streak_thin_vert.spv.h"
#include "shaders/rain_streak_wide_frag.spv.h"
#include "shaders/rain_streak_wide_vert.spv.h"

#include <math.h>
#include <string.h>

#define VIEW_COOKIE VIRGA_COOKIE(4)
#define READ_WRITE  (VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT)

uint32_t rain_view_bytes(void)
{
    return (uint32_t)((sizeof(virga_view_gpu) + VIRGA_RING_ALIGNMENT - 1) / VIRGA_RING_ALIGNMENT *
                      VIRGA_RING_ALIGNMENT);
}

virga_view virga_default_view(void)
{
    static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    virga_view view = {.size = sizeof view, .cookie = VIEW_COOKIE, .shutter_s = 1.0 / 96};
    memcpy(view.view_from_world, identity, sizeof identity);
    memcpy(view.clip_from_view, identity, sizeof identity);
    memcpy(view.open_view_from_world, identity, sizeof identity);
    memcpy(view.open_clip_from_view, identity, sizeof identity);
    return view;
}

/* ---- a view in the device's terms */

/* out = projection x rotation x translation(offset), column-major. */
static void clip_from_relative(const float clip_from_view[16], const float view_from_world[16], const double offset[3],
                               float out[16])
{
    double view[16] = {0};
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            view[column * 4 + row] = (double)view_from_world[column * 4 + row];
    for (int row = 0; row < 3; row++)
        view[12 + row] = view[row] * offset[0] + view[4 + row] * offset[1] + view[8 + row] * offset[2];
    view[15] = 1;
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            double sum = 0;
            for (int i = 0; i < 4; i++)
                sum += (double)clip_from_view[i * 4 + row] * view[column * 4 + i];
            out[column * 4 + row] = (float)sum;
        }
}

/* The axes of the camera in the world, scaled to rays: a pixel at ndc (x, y) looks along right x + up y + ahead. With
 * a projection clip.x = a x + c z, clip.w = -z that is x = (ndc + c) / a at depth 1, jitter and shift included. */
static void fill_rays(const virga_view *view, virga_view_gpu *out)
{
    const float *m = view->view_from_world, *p = view->clip_from_view;
    for (int i = 0; i < 3; i++) {
        const float x = m[i * 4], y = m[i * 4 + 1], z = -m[i * 4 + 2]; /* rows of the rotation */
        out->right[i] = x / p[0];
        out->up[i] = y / p[5];
        out->ahead[i] = z + x * p[8] / p[0] + y * p[9] / p[5];
    }
    /* clip.z = p10 z + p14 and clip.w = -z, so depth = -p10 + p14 / w. */
    out->depth_a = p[10];
    out->depth_b = p[14];
    out->pixel_angle = 2 / (fabsf(p[5]) * view->viewport[3]);
}

static void fill_lights(const virga_rain *rain, const double camera[3], virga_view_gpu *out)
{
    out->light_count = rain->settings.lighting.light_count;
    for (uint32_t i = 0; i < out->light_count; i++) {
        const virga_light *light = &rain->settings.lighting.lights[i];
        virga_light_gpu *to = &out->lights[i];
        const float *d = light->direction;
        const float length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int axis = 0; axis < 3; axis++) {
            to->position[axis] = (float)(light->position_m[axis] - camera[axis]);
            to->intensity[axis] = light->intensity[axis];
            to->direction[axis] = length > 0 ? d[axis] / length : 0;
        }
        to->inv_range = light->range_m > 0 ? 1 / light->range_m : 0;
        const float width = light->cos_inner - light->cos_outer;
        /* A point light has no cone: a cosine that is always passed. */
        to->cos_outer = length > 0 ? light->cos_outer : -2;
        to->inv_cos_width = length > 0 && width > 1e-4f ? 1 / width : 1e4f;
    }
}

#define MOST_COVERAGE 0.25 /* as in shaders/rain/prepare_write.comp */
#define LEAST_COVERAGE \
    (1.0 / 400) /* as in shaders/rain/view.glsl: what covers less is below what the eye and 8 bits see */

/* Coverage (0 to 1) that a streak of a class would have at a distance, were it not limited. */
static double streak_coverage(const virga_view_gpu *view, const rain_class *c, double drops, double distance_m)
{
    const double width_px = c->diameter_m / (distance_m * (double)view->pixel_angle);
    const double narrow = width_px < (double)view->min_width_px ? width_px / (double)view->min_width_px : 1;
    const double way = c->terminal_m_s * (double)(view->time_close_s - view->time_open_s);
    const double one = (double)view->streak_gain * c->diameter_m / (way > c->diameter_m ? way : c->diameter_m);
    return (one < 1 ? one : 1) * narrow * drops;
}

/* Share of the extinction (coverage: number x diameter^2) in a box that streaks do not show: of drops that are too
 * small to be drawn or too faint to be seen one by one, and of slots that stand for so many drops that their streak would be a bar. It becomes haze, so
 * that rain is as thick at any budget. */
static double hazy_share(const virga_rain *rain, const virga_view_gpu *view, uint32_t level)
{
    const rain_classes *classes = rain->classes;
    const double distance = 0.375 * ldexp(classes->side_m, (int)level + 1 - (int)classes->levels);
    double hazy = 0, all = 0;
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        const rain_class *c = &classes->classes[k];
        const double cover = classes->per_m3[k] * c->diameter_m * c->diameter_m;
        const double drops = (double)classes->weights[level * VIRGA_RAIN_CLASSES + k].drops;
        const double would = streak_coverage(view, c, drops, distance);
        const bool small = c->diameter_m < (double)view->bodies_min_m || !classes->slot_count[level][k];
        all += cover;
        hazy += cover * (small || would < 1.5 * LEAST_COVERAGE ? 1
                         : would > MOST_COVERAGE && drops > 1  ? 1 - MOST_COVERAGE / would
                                                               : 0);
    }
    return all > 0 ? hazy / all : 0;
}

static void fill_haze(const virga_rain *rain, virga_view_gpu *out)
{
    const double extinction = virga_rain_extinction(rain->classes->rate_mm_h) * (double)rain->settings.haze;
    for (uint32_t level = 0; level < rain->levels; level++)
        out->haze_per_m[level] = (float)(extinction * hazy_share(rain, out, level));
    out->haze_per_m[rain->levels] = (float)extinction;
    out->haze_inner_m = (float)(0.5 * ldexp(rain->classes->side_m, 1 - (int)rain->levels));
}

static void fill_look(const virga_rain *rain, virga_view_gpu *out)
{
    const virga_rain_settings *settings = &rain->settings;
    out->streak_gain = settings->streak_gain;
    out->light_gain = settings->light_gain;
    out->min_width_px = settings->min_width_px;
    out->soft_m = settings->soft_m;
    out->near_m = settings->near_m;
    out->oscillation = settings->oscillation;
    out->bodies_min_m = settings->bodies_min_mm * 1e-3f;
    fill_haze(rain, out);
    out->max_streaks = rain->def.max_streaks;
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            out->sh[i * 3 + c] = settings->lighting.environment_sh[i][c];
    double moments[3];
    virga_drop_phase_moments(moments);
    for (int i = 0; i < 3; i++)
        out->phase_moment[i] = (float)moments[i];
    for (int i = 0; i < 64; i++)
        out->phase[i] = (float)virga_phase_table[i];
}

static void fill_view(const virga_rain *rain, const virga_view *view, double time_s, virga_view_gpu *out)
{
    memset(out, 0, sizeof *out);
    const double none[3] = {0, 0, 0};
    clip_from_relative(view->clip_from_view, view->view_from_world, none, out->clip_from_rel);
    /* The open camera may be another time away than the shutter: take the part of its way that the shutter sees. */
    const double share = view->open_camera_s > 0 ? view->shutter_s / view->open_camera_s : 1;
    double moved[3];
    for (int i = 0; i < 3; i++)
        moved[i] = (view->position_m[i] - view->open_position_m[i]);
    float open[16];
    clip_from_relative(view->open_clip_from_view, view->open_view_from_world, moved, open);
    for (int i = 0; i < 16; i++)
        out->open_clip_from_rel[i] = out->clip_from_rel[i] + (float)share * (open[i] - out->clip_from_rel[i]);
    fill_rays(view, out);
    for (int i = 0; i < 3; i++)
        out->origin_offset[i] = (float)(rain->origin[i] - view->position_m[i]);
    const double at_tick = (double)rain->ticks * rain->def.tick_s;
    out->time_close_s = (float)(time_s - at_tick);
    out->time_open_s = (float)(time_s - at_tick - view->shutter_s);
    memcpy(out->viewport, view->viewport, sizeof out->viewport);
    out->far_depth = view->reversed_depth ? 0.0f : 1.0f;
    out->depth_given = view->depth.view != VK_NULL_HANDLE;
    fill_lights(rain, view->position_m, out);
    fill_look(rain, out);
}

/* ---- prepare */

static virga_result check_view(const virga_rain *rain, const virga_view *view, double time_s)
{
    const virga_log *log = &rain->context->log;
    const virga_result result = virga_settings_check(log, "view", view->size, sizeof *view, view->cookie, VIEW_COOKIE);
    if (result)
        return result;
    if (virga_settings_finite_double(log, "view.position_m", view->position_m, 3) ||
        virga_settings_finite_double(log, "view.open_position_m", view->open_position_m, 3) ||
        virga_settings_finite(log, "view.view_from_world", view->view_from_world, 16) ||
        virga_settings_finite(log, "view.clip_from_view", view->clip_from_view, 16) ||
        virga_settings_finite(log, "view.open_view_from_world", view->open_view_from_world, 16) ||
        virga_settings_finite(log, "view.open_clip_from_view", view->open_clip_from_view, 16) ||
        virga_settings_finite(log, "view.viewport", view->viewport, 4))
        return VIRGA_ERROR_INVALID;
    if (!(view->shutter_s >= 0 && view->shutter_s <= 1) || !(view->open_camera_s >= 0) || !isfinite(time_s))
        return virga_wrong_argument(log, "view.shutter_s: expected 0 to 1 s, got %g", view->shutter_s);
    if (view->clip_from_view[0] == 0 || view->clip_from_view[5] == 0 || view->clip_from_view[11] != -1)
        return virga_wrong_argument(log, "view.clip_from_view: expected a perspective projection with w = -z");
    return VIRGA_OK;
}

static void record_prepare(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set)
{
    virga_context *context = rain->context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "rain.prepare");
    /* The draw before, of this or an earlier frame, may still read the streaks. */
    virga_barrier(context, cmd,
                  VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT |
                      VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, READ_WRITE);
    rain_bind(rain, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, set);
    rain_record_list(rain, cmd, rain->prepare_find, rain->prepare_scan);
    rain_dispatch_list(rain, cmd, rain->prepare_write);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                  VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT |
                      VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferCopy copy = {0, context->ring_slot * sizeof(rain_readback) + offsetof(rain_readback, prepared),
                               sizeof(virga_prepared_gpu)};
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    context->vk.CmdCopyBuffer(cmd, rain->prepared_buffer->buffer, rain->readback_ring->buffer, 1, &copy);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_HOST_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    virga_pass_end(context, cmd, scope);
}

virga_result virga_rain_prepare(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view, double time_s)
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    if (!cmd || !view)
        return virga_wrong_argument(&rain->context->log, "virga_rain_prepare: NULL argument");
    if (rain->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    const virga_result result = check_view(rain, view, time_s);
    if (result)
        return result;
    rain->prepared = false;
    if (!rain->stepped || view->viewport[2] < 1 || view->viewport[3] < 1)
        return VIRGA_NOT_READY;
    rain_begin_frame(rain, cmd);
    if (rain->ring_views >= VIRGA_RAIN_MAX_VIEWS)
        return virga_wrong_argument(&rain->context->log, "virga_rain_prepare: more than %d views in a frame",
                                    VIRGA_RAIN_MAX_VIEWS);
    const uint32_t place = rain->ring_views++;
    rain->view_offset = (rain->context->ring_slot * VIRGA_RAIN_MAX_VIEWS + place) * rain_view_bytes();
    char *mapped = rain->view_ring->memory.block.mapped;
    fill_view(rain, view, time_s, (virga_view_gpu *)(mapped + rain->view_offset));
    virga_buffer_flush(rain->context, rain->view_ring, rain->view_offset, rain_view_bytes());
    const bool has_depth = view->depth.view != VK_NULL_HANDLE;
    rain->prepared_set = rain_write_set(rain, place, has_depth ? &view->depth : NULL);
    record_prepare(rain, cmd, rain->prepared_set);
    memcpy(rain->prepared_viewport, view->viewport, sizeof rain->prepared_viewport);
    rain->frame_stats[rain->context->ring_slot].frame_index = rain->context->frame_index;
    rain->frame_stats[rain->context->ring_slot].prepared = true;
    rain->prepared_depth = has_depth;
    rain->prepared_haze = has_depth && rain->settings.haze > 0 && rain->classes->rate_mm_h > 0;
    rain->prepared = true;
    return VIRGA_OK;
}

/* ---- attach and draw */

static rain_target *find_target(virga_rain *rain, uint64_t serial)
{
    for (uint32_t i = 0; i < VIRGA_RAIN_MAX_TARGETS; i++)
        if (rain->targets[i].serial == serial)
            return &rain->targets[i];
    return NULL;
}

static void target_clear(virga_rain *rain, rain_target *target)
{
    for (int depth = 0; depth < 2; depth++) {
        VIRGA_RETIRE(rain->context, target->thin[depth]);
        VIRGA_RETIRE(rain->context, target->wide[depth]);
    }
    VIRGA_RETIRE(rain->context, target->haze);
    target->serial = 0;
}

void rain_targets_destroy(virga_rain *rain)
{
    for (uint32_t i = 0; i < VIRGA_RAIN_MAX_TARGETS; i++) {
        target_clear(rain, &rain->targets[i]);
    }
}

virga_result virga_rain_attach(virga_rain *rain, const virga_target *target)
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    if (!target || target->context != rain->context)
        return virga_wrong_argument(&rain->context->log, "virga_rain_attach: expected a target of the same context");
    if (rain->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (find_target(rain, target->serial))
        return VIRGA_OK;
    rain_target *slot = find_target(rain, 0);
    if (!slot)
        return virga_wrong_argument(&rain->context->log, "virga_rain_attach: more than %d targets",
                                    VIRGA_RAIN_MAX_TARGETS);
    virga_result result = VIRGA_OK;
    virga_graphics_def def = {.layout = rain->bindings->layout, .blend_premultiplied = true, .depth_test = true};
    for (uint32_t depth = 0; depth < 2; depth++) {
        def.constant = depth;
        def.vertex = VIRGA_SPIRV(rain_streak_thin_vert);
        def.fragment = VIRGA_SPIRV(rain_streak_thin_frag);
        def.name = "rain.thin_streaks";
        TRY(virga_target_pipeline(target, def, &slot->thin[depth]));
        def.vertex = VIRGA_SPIRV(rain_streak_wide_vert);
        def.fragment = VIRGA_SPIRV(rain_streak_wide_frag);
        def.name = "rain.wide_streaks";
        TRY(virga_target_pipeline(target, def, &slot->wide[depth]));
    }
    def.vertex = VIRGA_SPIRV(rain_haze_vert);
    def.fragment = VIRGA_SPIRV(rain_haze_frag);
    def.depth_test = false;
    def.name = "rain.haze";
    TRY(virga_target_pipeline(target, def, &slot->haze));
    slot->serial = target->serial;
    return VIRGA_OK;
error:
    target_clear(rain, slot);
    return result;
}

static void draw_streaks(virga_rain *rain, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t arguments)
{
    const virga_functions *vk = &rain->context->vk;
    vk->CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->pipeline);
    vk->CmdDrawIndexedIndirect(cmd, rain->prepared_buffer->buffer, arguments, 1, sizeof(virga_draw_gpu));
}

virga_result virga_rain_draw(virga_rain *rain, VkCommandBuffer cmd, const virga_target *target)
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    if (!cmd || !target)
        return virga_wrong_argument(&rain->context->log, "virga_rain_draw: NULL argument");
    if (rain->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    const rain_target *found = find_target(rain, target->serial);
    if (!found || !rain->prepared)
        return VIRGA_NOT_READY;
    virga_context *context = rain->context;
    const float *box = rain->prepared_viewport;
    const VkViewport viewport = {box[0], box[1], box[2], box[3], 0, 1};
    const VkRect2D scissor = {{(int32_t)box[0], (int32_t)box[1]}, {(uint32_t)box[2], (uint32_t)box[3]}};
    context->vk.CmdSetViewport(cmd, 0, 1, &viewport);
    context->vk.CmdSetScissor(cmd, 0, 1, &scissor);
    rain_bind(rain, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, rain->prepared_set);
    if (rain->prepared_haze) {
        const virga_pass_scope scope = virga_draw_begin(context, cmd, "rain.haze");
        context->vk.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, found->haze->pipeline);
        context->vk.CmdDraw(cmd, 3, 1, 0, 0);
        virga_pass_end(context, cmd, scope);
    }
    const virga_pass_scope scope = virga_draw_begin(context, cmd, "rain.streaks");
    context->vk.CmdBindIndexBuffer(cmd, rain->index_buffer->buffer, 0, VK_INDEX_TYPE_UINT32);
    draw_streaks(rain, cmd, found->thin[rain->prepared_depth], offsetof(virga_prepared_gpu, thin));
    draw_streaks(rain, cmd, found->wide[rain->prepared_depth], offsetof(virga_prepared_gpu, wide));
    virga_pass_end(context, cmd, scope);
    return VIRGA_OK;
}
