/* rain/rain_draw.c - the rain in a view: prepare selects and shades streaks, then they are drawn. */
#include "rain/rain_internal.h"

#include "core/phase.h"
#include "core/settings.h"
#include "gpu/builds.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/target.h"
#include "gpu/timers.h"
#include "gpu/view.h"

#include "shaders/rain_shaders.h"

#include <math.h>
#include <string.h>

/* ---- constants of a view */

/* As in shaders/rain/draw/view.glsl: */
#define MAX_COVERAGE 0.25
#define MIN_COVERAGE (1.0 / 800)
#define WIDE_PX      3.0

/* The width (px) with which a streak is drawn at a distance, from that of its drop. */
static double drawn_width(const virga_view_gpu *view, double width_px, double distance_m)
{
    const double blur_px = (double)view->lens_px * fabs((double)view->inv_focus - 1 / distance_m);
    return fmax(width_px, fmax((double)view->min_width_px, blur_px));
}

/* Coverage (0 to 1) of the streak of one drop at a distance. */
static double streak_coverage(const rain_view_block *block, double diameter_m, double speed_m_s, double distance_m)
{
    const virga_view_gpu *view = &block->view;
    const double width_px = diameter_m / (distance_m * (double)view->pixel_angle);
    const double way = speed_m_s * (double)(view->time_close_s - view->time_open_s) * (double)block->look.parts;
    const double one = (double)block->look.streak_gain * diameter_m / (way > diameter_m ? way : diameter_m);
    return (one < 1 ? one : 1) * width_px / drawn_width(view, width_px, distance_m);
}

/* The share of a class's coverage at a distance that its streaks do not show. */
static double hazy_share_of_class(const rain_view_block *block, const rain_class *c, double drops, double distance_m)
{
    const double one = streak_coverage(block, c->diameter_m, c->terminal_m_s, distance_m);
    const double large = streak_coverage(block, (double)block->look.group_m, (double)block->look.group_m_s, distance_m);
    const double shown = fmin(one * drops, fmax(one, fmin(large, MAX_COVERAGE)));
    const double width_px = c->diameter_m / (distance_m * (double)block->view.pixel_angle);
    const double least = MIN_COVERAGE * fmin(WIDE_PX / drawn_width(&block->view, width_px, distance_m), 1);
    return shown < 1.5 * least ? 1 : 1 - shown / (one * drops);
}

/* Share of the extinction (coverage: number x diameter^2) in a box that streaks do not show. Some drops are too small
 * to be drawn, or too faint to be seen one by one. Some slots represent so many drops that their streak would look like
 * a bar: it shows what one large drop would. This share becomes haze, so that the density of rain looks the same with
 * any budget. */
static double hazy_share(const virga_rain *rain, const rain_view_block *block, uint32_t level)
{
    const rain_classes *classes = rain->classes;
    const double distance = 0.375 * ldexp(classes->side_m, (int)level + 1 - (int)classes->levels);
    double hazy = 0, all = 0;
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        const rain_class *c = &classes->classes[k];
        const double cover = classes->per_m3[k] * c->diameter_m * c->diameter_m;
        const double drops = (double)classes->weights[level * VIRGA_RAIN_CLASSES + k].drops;
        const bool small = c->diameter_m < (double)block->look.streak_min_m || !classes->slot_count[level][k];
        all += cover;
        hazy += cover * (small ? 1 : hazy_share_of_class(block, c, drops, distance));
    }
    return all > 0 ? hazy / all : 0;
}

/* Of the extinction by drops half is light that hits them, the other half is diffracted, which a picture does not lose:
 * see shaders/rain/draw/haze.frag. */
#define HITS_DROPS 0.5

static void fill_haze(const virga_rain *rain, rain_view_block *out)
{
    const double per_m = HITS_DROPS * virga_rain_extinction(rain->classes->rate_mm_h) * (double)rain->settings.haze;
    for (uint32_t level = 0; level < rain->levels; level++)
        out->look.haze_per_m[level] = (float)(per_m * hazy_share(rain, out, level));
    out->look.haze_per_m[rain->levels] = (float)per_m;
    out->look.haze_inner_m = (float)(0.5 * ldexp(rain->classes->side_m, 1 - (int)rain->levels));
}

/* Cumulative integral of the phase function, for the glow of lamps, see shaders/rain/glow.glsl. */
static void fill_bent(rain_view_block *out)
{
    _Static_assert(VIRGA_RAIN_BENT == VIRGA_PHASE_BINS + 1, "borders of the phase function's bins");
    double sum = 0;
    for (int i = 0; i < VIRGA_RAIN_BENT; i++) {
        out->look.bent[i] = (float)sum;
        sum += i < VIRGA_PHASE_BINS ? virga_phase_table[i] * 3.14159265358979323846 / VIRGA_PHASE_BINS : 0;
    }
}

#define AT_THE_CAMERA 1e20f /* 1 / the depth at which haze begins, see virga_rain_look_gpu */

static void fill_look(const virga_rain *rain, rain_view_block *out)
{
    const virga_rain_settings *settings = &rain->settings;
    out->look.streak_gain = settings->streak_gain;
    out->view.light_gain = settings->light_gain;
    out->view.min_width_px = settings->min_width_px;
    out->view.soft_m = settings->soft_m;
    out->view.near_fade_m = settings->near_fade_m;
    out->look.oscillation = settings->oscillation;
    out->look.streak_min_m = settings->streak_min_mm * 1e-3f;
    out->look.group_m = settings->streak_group_mm * 1e-3f;
    out->look.group_m_s = (float)virga_drop_terminal_speed((double)out->look.group_m, (double)settings->air_density);
    out->look.sky_m = settings->haze_sky_m;
    out->look.glow = settings->glow;
    fill_haze(rain, out);
    fill_bent(out);
    out->look.begin[3] = AT_THE_CAMERA;
    out->look.max_streaks = rain->def.max_streaks;
    out->look.lines = rain->base.context->lines;
    out->look.motion = virga_effect_wants_motion(&rain->base);
}

static void fill_view(const virga_rain *rain, const virga_view *view, double time_s, rain_view_block *out)
{
    memset(out, 0, sizeof *out);
    const double at_tick = (double)rain->ticks * rain->def.tick_s;
    virga_view_fill(view, &rain->settings.lighting, rain->origin, at_tick, time_s, &out->view);
    out->look.parts = (float)view->sub_frames; /* fill_haze reads it */
    fill_look(rain, out);
}

/* For a view without streaks: haze represents all of the rain, in every box. It begins where rays cross a plane. */
static void fill_haze_alone(const virga_rain *rain, const virga_view *view, const double begin[4], rain_view_block *out)
{
    for (uint32_t level = 0; level < rain->levels; level++)
        out->look.haze_per_m[level] = out->look.haze_per_m[rain->levels];
    if (!begin)
        return;
    double beyond = begin[3];
    for (int axis = 0; axis < 3; axis++)
        beyond -= begin[axis] * view->position_m[axis];
    if (fabs(beyond) < 1e-6) /* the camera is on the plane */
        return;
    for (int axis = 0; axis < 3; axis++)
        out->look.begin[axis] = (float)(begin[axis] / beyond);
    out->look.begin[3] = 0;
}

static virga_result push_view(virga_rain *rain, const char *call, const rain_view_block *block, uint32_t *index,
                              uint32_t *offset)
{
    rain_keep_tick(rain);
    return virga_effect_push_view(&rain->base, call, &rain->view_ring, block, sizeof *block, index, offset);
}

/* ---- prepare */

static void record_prepare(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set)
{
    virga_context *context = rain->base.context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "rain.prepare");
    /* An earlier draw, of this or an earlier frame, may still read the streaks. */
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES | VIRGA_VERTICES, VIRGA_PASSES);
    rain_bind(rain, cmd, set);
    virga_record_list(context, cmd, rain->streak_mark, rain->streak_scan, rain->compact, rain->groups);
    virga_dispatch_indirect(context, cmd, rain->streak_write, rain->list_buffer->buffer, 0);
    virga_compute_barrier(context, cmd);
    virga_dispatch_indirect(context, cmd, rain->order_count, rain->list_buffer->buffer, 0);
    virga_compute_barrier(context, cmd);
    virga_dispatch(context, cmd, rain->order_scan,
                   context->for_software ? VIRGA_RAIN_BUCKETS / VIRGA_RAIN_ORDER_LANES : VIRGA_RAIN_BUCKETS);
    virga_compute_barrier(context, cmd);
    virga_dispatch_indirect(context, cmd, rain->order_indices, rain->list_buffer->buffer, 0);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_ARGUMENTS | VIRGA_COPIES | VIRGA_VERTICES);
    virga_effect_copy_statistics(&rain->base, cmd, RAIN_PART_PREPARE, rain->prepared_buffer, 0,
                                 offsetof(rain_readback, prepared[virga_effect_view_index(&rain->base)]),
                                 sizeof(virga_prepared_gpu));
    virga_pass_end(context, cmd, scope);
}

static bool hazes(const virga_rain *rain)
{
    return rain->settings.haze > 0 && rain->classes->rate_mm_h > 0;
}

static uint32_t glowing_lamps(const virga_rain *rain)
{
    const virga_rain_settings *settings = &rain->settings;
    return settings->glow > 0 && settings->light_gain > 0 ? settings->lighting.light_count : 0;
}

virga_result rain_prepare(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view, double time_s,
                          virga_prepared *prepared)
{
    virga_result result =
        virga_effect_check_prepare(&rain->base, "virga_rain_prepare", cmd, view, time_s, rain->stepped);
    if (result)
        return result;
    rain_begin_frame(rain, cmd);
    uint32_t index;
    rain_view_block block;
    fill_view(rain, view, time_s, &block);
    result = push_view(rain, "virga_rain_prepare", &block, &index, &rain->view_offset);
    if (result)
        return result;
    const bool has_depth = view->depth.view != VK_NULL_HANDLE;
    const VkDescriptorSet set = rain_write_set(rain, index, has_depth ? &view->depth : NULL);
    record_prepare(rain, cmd, set);
    virga_effect_set_view(&rain->base, set, rain->view_offset, view, prepared);
    const bool has_haze = has_depth && hazes(rain);
    rain->prepared[rain->base.slot] =
        (rain_prepared){.tick_offset = rain->tick_offset,
                        .line_px = rain->settings.min_width_px + 1, /* the width of quads in streak.glsl */
                        .haze = has_haze,
                        .depth = has_depth,
                        .lens = has_depth && view->aperture_m > 0,
                        .glows = has_haze ? glowing_lamps(rain) : 0};
    return virga_recording_result(rain->base.context);
}

/* ---- draw */

static const uint32_t plain[2] = {0, VIRGA_RAIN_STREAKS_DEPTH};
static const uint32_t wide[3] = {0, VIRGA_RAIN_STREAKS_DEPTH, VIRGA_RAIN_STREAKS_DEPTH | VIRGA_RAIN_STREAKS_LENS};
static const uint32_t lines[2] = {VIRGA_RAIN_STREAKS_LINES, VIRGA_RAIN_STREAKS_LINES | VIRGA_RAIN_STREAKS_DEPTH};

/* In the order of RAIN_DRAW_... Haze moves with the surface behind it, so it writes no motion. */
const virga_effect_draw rain_draws[RAIN_DRAW_ROWS] = {
    {"rain.line_streaks", VIRGA_VERTEX_FORMS(rain_draw_streak_thin_vert),
     VIRGA_FRAGMENT_FORMS(rain_draw_streak_thin_frag), lines, 2, .lines = true},
    {"rain.thin_streaks", VIRGA_VERTEX_FORMS(rain_draw_streak_thin_vert),
     VIRGA_FRAGMENT_FORMS(rain_draw_streak_thin_frag), plain, 2},
    {"rain.wide_streaks", VIRGA_VERTEX_FORMS(rain_draw_streak_wide_vert),
     VIRGA_FRAGMENT_FORMS(rain_draw_streak_wide_frag), wide, 3},
    {"rain.haze", VIRGA_VERTEX_FORM(rain_draw_haze_vert), VIRGA_FORM(rain_draw_haze_frag), .no_depth = true},
    {"rain.glow", VIRGA_VERTEX_FORM(rain_draw_glow_vert), VIRGA_FORM(rain_draw_glow_frag), .no_depth = true},
};

static void draw_plain(virga_rain *rain, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t corners,
                       uint32_t count, const char *name)
{
    virga_context *context = rain->base.context;
    const virga_pass_scope scope = virga_draw_begin(context, cmd, name);
    virga_bind_pipeline(context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    context->vk.CmdDraw(cmd, corners, count, 0, 0);
    virga_pass_end(context, cmd, scope);
}

static void draw_streaks(virga_rain *rain, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t arguments)
{
    virga_draw_indexed_indirect(rain->base.context, cmd, pipeline, rain->prepared_buffer->buffer, arguments);
}

static void draw_all_streaks(virga_rain *rain, VkCommandBuffer cmd, float line_px, const virga_pipeline *line,
                             const virga_pipeline *thin_quads, const virga_pipeline *wide_quads)
{
    virga_context *context = rain->base.context;
    const virga_pass_scope scope = virga_draw_begin(context, cmd, "rain.streaks");
    context->vk.CmdBindIndexBuffer(cmd, rain->order_buffer->buffer, 0, VK_INDEX_TYPE_UINT32);
    if (line) {
        context->vk.CmdSetLineWidth(cmd, line_px);
        draw_streaks(rain, cmd, line, offsetof(virga_prepared_gpu, lines));
    }
    draw_streaks(rain, cmd, thin_quads, offsetof(virga_prepared_gpu, thin_quads));
    draw_streaks(rain, cmd, wide_quads, offsetof(virga_prepared_gpu, wide_quads));
    virga_pass_end(context, cmd, scope);
}

static virga_result draw_parts(virga_rain *rain, const char *call, VkCommandBuffer cmd, const virga_target *target,
                               virga_prepared prepared, uint32_t parts)
{
    const virga_effect_target *found;
    virga_result result = virga_effect_check_draw(&rain->base, call, cmd, target, prepared, true, &found);
    if (result)
        return result;
    const virga_effect_view *view = virga_effect_selected(&rain->base);
    const rain_prepared *seen = &rain->prepared[rain->base.slot];
    const virga_pipeline *thin_quads = found->draws[RAIN_DRAW_THIN + seen->depth],
                         *wide_quads = found->draws[RAIN_DRAW_WIDE + seen->depth + seen->lens],
                         *line = found->draws[RAIN_DRAW_LINES + seen->depth], *haze = found->draws[RAIN_DRAW_HAZE],
                         *glow = found->draws[RAIN_DRAW_GLOW];
    const virga_pipeline *used[] = {haze, glow, thin_quads, wide_quads, line ? line : thin_quads};
    result = virga_pipelines_ready(used, sizeof used / sizeof used[0]);
    if (result)
        return result;
    virga_set_draw_area(rain->base.context, cmd, view->viewport);
    rain_bind_view(rain, cmd, view->set, seen->tick_offset, view->offset);
    if ((parts & VIRGA_RAIN_HAZE) && seen->haze)
        draw_plain(rain, cmd, haze, 3, 1, "rain.haze");
    if ((parts & VIRGA_RAIN_HAZE) && seen->glows)
        draw_plain(rain, cmd, glow, 6, seen->glows, "rain.glow");
    if (parts & VIRGA_RAIN_STREAKS)
        draw_all_streaks(rain, cmd, seen->line_px, line, thin_quads, wide_quads);
    return VIRGA_OK;
}

virga_result rain_draw(virga_rain *rain, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                       const char *call)
{
    return draw_parts(rain, call, cmd, target, prepared, VIRGA_RAIN_HAZE | VIRGA_RAIN_STREAKS);
}

static virga_result check_parts(const virga_rain *rain, const char *call, uint32_t parts)
{
    if (!parts || (parts & ~(uint32_t)(VIRGA_RAIN_HAZE | VIRGA_RAIN_STREAKS)))
        return virga_wrong_argument(&rain->base.context->log, "%s: expected bits of virga_rain_parts, got %u", call,
                                    parts);
    return VIRGA_OK;
}

virga_result virga_rain_draw_parts(virga_rain *rain, VkCommandBuffer cmd, const virga_target *target, uint32_t parts)
{
    if (!rain || check_parts(rain, "virga_rain_draw_parts", parts))
        return VIRGA_ERROR_INVALID;
    return draw_parts(rain, "virga_rain_draw_parts", cmd, target, virga_effect_newest(&rain->base), parts);
}

virga_result virga_rain_draw_parts_view(virga_rain *rain, VkCommandBuffer cmd, const virga_target *target,
                                        virga_prepared prepared, uint32_t parts)
{
    if (!rain || check_parts(rain, "virga_rain_draw_parts_view", parts))
        return VIRGA_ERROR_INVALID;
    return draw_parts(rain, "virga_rain_draw_parts_view", cmd, target, prepared, parts);
}

/* ---- haze alone */

static virga_result check_haze_alone(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view,
                                     const double begin[4], const virga_target *target,
                                     const virga_effect_target **found)
{
    const virga_log *log = &rain->base.context->log;
    virga_result result =
        virga_effect_find_target(&rain->base, "virga_rain_draw_haze", view ? cmd : VK_NULL_HANDLE, target, found);
    if (result)
        return result;
    if (begin && virga_settings_check_finite_double(log, "virga_rain_draw_haze: begin", begin, 4))
        return VIRGA_ERROR_INVALID;
    result = virga_view_check(rain->base.context, view, 0);
    if (result)
        return result;
    result = virga_effect_check_multiview(&rain->base, "virga_rain_draw_haze", target, view->multiview_index);
    if (result)
        return result;
    if (view->depth.view == VK_NULL_HANDLE)
        return virga_wrong_argument(log, "virga_rain_draw_haze: expected a view with depth");
    return VIRGA_OK;
}

virga_result virga_rain_draw_haze(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view, const double begin[4],
                                  const virga_target *target)
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    const virga_effect_target *found;
    virga_result result = check_haze_alone(rain, cmd, view, begin, target, &found);
    if (result)
        return result;
    /* A frame can not begin inside rendering. */
    if (!found || !rain->stepped || rain->base.step_frame != rain->base.context->frame_index)
        return VIRGA_NOT_READY;
    const virga_pipeline *used[] = {found->draws[RAIN_DRAW_HAZE], found->draws[RAIN_DRAW_GLOW]};
    result = virga_pipelines_ready(used, sizeof used / sizeof used[0]);
    if (result || !hazes(rain))
        return result;
    uint32_t index, offset;
    rain_view_block block;
    fill_view(rain, view, virga_rain_time(rain), &block);
    fill_haze_alone(rain, view, begin, &block);
    result = push_view(rain, "virga_rain_draw_haze", &block, &index, &offset);
    if (result)
        return result;
    virga_set_draw_area(rain->base.context, cmd, view->viewport);
    rain_bind_view(rain, cmd, rain_write_set(rain, index, &view->depth), rain->tick_offset, offset);
    draw_plain(rain, cmd, used[0], 3, 1, "rain.haze_alone");
    if (glowing_lamps(rain))
        draw_plain(rain, cmd, used[1], 6, glowing_lamps(rain), "rain.glow_alone");
    return virga_recording_result(rain->base.context);
}
