/* rain/rain_draw.c - what a view sees: selection and shading (prepare), pipelines for a
 * target (attach), and drawing. */
#include "rain/rain_internal.h"

#include "core/phase.h"
#include "core/settings.h"
#include "gpu/builds.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/target.h"
#include "gpu/timers.h"
#include "gpu/view.h"

#include "shaders/rain_draw_glow_frag.spv.h"
#include "shaders/rain_draw_glow_vert.spv.h"
#include "shaders/rain_draw_haze_frag.spv.h"
#include "shaders/rain_draw_haze_vert.spv.h"
#include "shaders/rain_draw_streak_thin_frag.spv.h"
#include "shaders/rain_draw_streak_thin_frag_both.spv.h"
#include "shaders/rain_draw_streak_thin_frag_motion.spv.h"
#include "shaders/rain_draw_streak_thin_frag_reactive.spv.h"
#include "shaders/rain_draw_streak_thin_vert.spv.h"
#include "shaders/rain_draw_streak_thin_vert_motion.spv.h"
#include "shaders/rain_draw_streak_wide_frag.spv.h"
#include "shaders/rain_draw_streak_wide_frag_both.spv.h"
#include "shaders/rain_draw_streak_wide_frag_motion.spv.h"
#include "shaders/rain_draw_streak_wide_frag_reactive.spv.h"
#include "shaders/rain_draw_streak_wide_vert.spv.h"
#include "shaders/rain_draw_streak_wide_vert_motion.spv.h"

#include <math.h>
#include <string.h>

uint32_t rain_view_bytes(void)
{
    return (uint32_t)((sizeof(rain_view_block) + VIRGA_RING_ALIGNMENT - 1) / VIRGA_RING_ALIGNMENT *
                      VIRGA_RING_ALIGNMENT);
}

/* ---- a view in the device's terms */

#define MOST_COVERAGE 0.25 /* as in shaders/rain/draw/streak_write.comp */
#define LEAST_COVERAGE \
    (1.0 / 400) /* as in shaders/rain/draw/view.glsl: what covers less is below what the eye and 8 bits see */

/* Coverage (0 to 1) that a streak of a class would have at a distance, were it not limited. */
static double streak_coverage(const rain_view_block *block, const rain_class *c, double drops, double distance_m)
{
    const virga_view_gpu *view = &block->view;
    const double width_px = c->diameter_m / (distance_m * (double)view->pixel_angle);
    const double blur_px = (double)view->lens_px * fabs((double)view->inv_focus - 1 / distance_m);
    const double drawn_px = fmax(width_px, fmax((double)view->min_width_px, blur_px));
    const double way = c->terminal_m_s * (double)(view->time_close_s - view->time_open_s) * (double)block->look.parts;
    const double one = (double)block->look.streak_gain * c->diameter_m / (way > c->diameter_m ? way : c->diameter_m);
    return (one < 1 ? one : 1) * width_px / drawn_px * drops;
}

/* Share of the extinction (coverage: number x diameter^2) in a box that streaks do not show: of drops that are too
 * small to be drawn or too faint to be seen one by one, and of slots that stand for so many drops that their streak
 * would be a bar. It becomes haze, so that rain is as thick at any budget. */
static double hazy_share(const virga_rain *rain, const rain_view_block *block, uint32_t level)
{
    const rain_classes *classes = rain->classes;
    const double distance = 0.375 * ldexp(classes->side_m, (int)level + 1 - (int)classes->levels);
    double hazy = 0, all = 0;
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        const rain_class *c = &classes->classes[k];
        const double cover = classes->per_m3[k] * c->diameter_m * c->diameter_m;
        const double drops = (double)classes->weights[level * VIRGA_RAIN_CLASSES + k].drops;
        const double would = streak_coverage(block, c, drops, distance);
        const bool small = c->diameter_m < (double)block->look.bodies_min_m || !classes->slot_count[level][k];
        all += cover;
        hazy += cover * (small || would < 1.5 * LEAST_COVERAGE ? 1
                         : would > MOST_COVERAGE && drops > 1  ? 1 - MOST_COVERAGE / would
                                                               : 0);
    }
    return all > 0 ? hazy / all : 0;
}

static void fill_haze(const virga_rain *rain, rain_view_block *out)
{
    const double extinction = virga_rain_extinction(rain->classes->rate_mm_h) * (double)rain->settings.haze;
    for (uint32_t level = 0; level < rain->levels; level++)
        out->look.haze_per_m[level] = (float)(extinction * hazy_share(rain, out, level));
    out->look.haze_per_m[rain->levels] = (float)extinction;
    out->look.haze_inner_m = (float)(0.5 * ldexp(rain->classes->side_m, 1 - (int)rain->levels));
}

/* Whether any target has motion vectors, so that prepare has to find those of streaks. */
static bool wants_motion(const virga_rain *rain)
{
    for (uint32_t i = 0; i < VIRGA_RAIN_MAX_TARGETS; i++)
        if (rain->targets[i].serial && rain->targets[i].motion)
            return true;
    return false;
}

/* Where the glow of lamps takes its light from, see shaders/rain/glow.glsl. */
static void fill_bent(rain_view_block *out)
{
    _Static_assert(VIRGA_RAIN_BENT == VIRGA_PHASE_BINS + 1, "borders of the phase function's bins");
    double sum = 0;
    for (int i = 0; i < VIRGA_RAIN_BENT; i++) {
        out->look.bent[i] = (float)sum;
        sum += i < VIRGA_PHASE_BINS ? virga_phase_table[i] * 3.14159265358979323846 / VIRGA_PHASE_BINS : 0;
    }
}

#define AT_THE_CAMERA 1e20f /* 1 / the depth that haze begins at, see virga_rain_look_gpu */

static void fill_look(const virga_rain *rain, rain_view_block *out)
{
    const virga_rain_settings *settings = &rain->settings;
    out->look.streak_gain = settings->streak_gain;
    out->view.light_gain = settings->light_gain;
    out->view.min_width_px = settings->min_width_px;
    out->view.soft_m = settings->soft_m;
    out->view.near_m = settings->near_m;
    out->look.oscillation = settings->oscillation;
    out->look.bodies_min_m = settings->bodies_min_mm * 1e-3f;
    out->look.sky_m = settings->haze_sky_m;
    out->look.glow = settings->glow;
    fill_haze(rain, out);
    fill_bent(out);
    out->look.begin[3] = AT_THE_CAMERA;
    out->look.max_streaks = rain->def.max_streaks;
    out->look.lines = rain->context->lines;
    out->look.motion = wants_motion(rain);
}

static void fill_view(const virga_rain *rain, const virga_view *view, double time_s, rain_view_block *out)
{
    memset(out, 0, sizeof *out);
    const double at_tick = (double)rain->ticks * rain->def.tick_s;
    virga_view_fill(view, &rain->settings.lighting, rain->origin, at_tick, time_s, &out->view);
    out->look.parts = (float)view->sub_frames; /* fill_haze asks for it */
    fill_look(rain, out);
}

/* For a view without streaks: haze is all of the rain, in every box, and begins where rays cross a plane. */
static void fill_haze_alone(const virga_rain *rain, const virga_view *view, const double begin[4], rain_view_block *out)
{
    for (uint32_t level = 0; level < rain->levels; level++)
        out->look.haze_per_m[level] = out->look.haze_per_m[rain->levels];
    if (!begin)
        return;
    double beyond = begin[3];
    for (int axis = 0; axis < 3; axis++)
        beyond -= begin[axis] * view->position_m[axis];
    if (fabs(beyond) < 1e-6) /* the camera is in it */
        return;
    for (int axis = 0; axis < 3; axis++)
        out->look.begin[axis] = (float)(begin[axis] / beyond);
    out->look.begin[3] = 0;
}

/* Takes the next place of the frame's ring. Blocks are copied into it at once: what is mapped may be slow to read. */
static virga_result push_view(virga_rain *rain, const rain_view_block *block, uint32_t *place)
{
    if (rain->ring_views >= VIRGA_RAIN_MAX_VIEWS)
        return virga_wrong_argument(&rain->context->log, "rain: more than %d views in a frame", VIRGA_RAIN_MAX_VIEWS);
    rain_keep_tick(rain);
    *place = rain->ring_views++;
    rain->view_offset = (rain->context->ring_slot * VIRGA_RAIN_MAX_VIEWS + *place) * rain_view_bytes();
    memcpy((char *)rain->view_ring->memory.block.mapped + rain->view_offset, block, sizeof *block);
    virga_buffer_flush(rain->context, rain->view_ring, rain->view_offset, rain_view_bytes());
    return VIRGA_OK;
}

/* ---- prepare */

static void record_prepare(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set)
{
    virga_context *context = rain->context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "rain.prepare");
    /* The draw before, of this or an earlier frame, may still read the streaks. */
    virga_barrier(context, cmd,
                  VK_PIPELINE_STAGE_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                      VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                      VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, READ_WRITE);
    rain_bind(rain, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, set);
    virga_record_list(context, cmd, rain->prepare_find, rain->prepare_scan, rain->list, rain->groups);
    virga_dispatch_indirect(context, cmd, rain->prepare_write, rain->list_buffer->buffer, 0);
    virga_compute_barrier(context, cmd);
    virga_dispatch_indirect(context, cmd, rain->prepare_order_count, rain->list_buffer->buffer, 0);
    virga_compute_barrier(context, cmd);
    virga_dispatch(context, cmd, rain->prepare_order_scan, VIRGA_RAIN_BUCKETS / VIRGA_RAIN_ORDER_LANES);
    virga_compute_barrier(context, cmd);
    virga_dispatch_indirect(context, cmd, rain->prepare_order, rain->list_buffer->buffer, 0);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                  VK_PIPELINE_STAGE_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                      VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_INDEX_READ_BIT | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT |
                      VK_ACCESS_TRANSFER_READ_BIT);
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

static bool hazes(const virga_rain *rain)
{
    return rain->settings.haze > 0 && rain->classes->rate_mm_h > 0;
}

static uint32_t glowing_lamps(const virga_rain *rain)
{
    const virga_rain_settings *settings = &rain->settings;
    return settings->glow > 0 && settings->light_gain > 0 ? settings->lighting.light_count : 0;
}

virga_result virga_rain_prepare(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view, double time_s)
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    if (!cmd || !view)
        return virga_wrong_argument(&rain->context->log, "virga_rain_prepare: NULL argument");
    if (rain->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    rain->prepared = false;
    virga_result result = virga_view_check(rain->context, view, time_s);
    if (!result)
        result = virga_group_ready(&rain->needed);
    if (result)
        return result;
    if (!rain->stepped)
        return VIRGA_NOT_READY;
    rain_begin_frame(rain, cmd);
    uint32_t place;
    rain_view_block block;
    fill_view(rain, view, time_s, &block);
    result = push_view(rain, &block, &place);
    if (result)
        return result;
    rain->view_frame = rain->context->frame_index;
    const bool has_depth = view->depth.view != VK_NULL_HANDLE;
    rain->prepared_set = rain_write_set(rain, place, has_depth ? &view->depth : NULL);
    record_prepare(rain, cmd, rain->prepared_set);
    memcpy(rain->prepared_viewport, view->viewport, sizeof rain->prepared_viewport);
    rain->frame_stats[rain->context->ring_slot].frame_index = rain->context->frame_index;
    rain->frame_stats[rain->context->ring_slot].prepared = true;
    rain->prepared_depth = has_depth;
    rain->prepared_line_px = rain->settings.min_width_px + 1; /* as their corners would be, see streak.glsl */
    rain->prepared_haze = has_depth && hazes(rain);
    rain->prepared_glows = rain->prepared_haze ? glowing_lamps(rain) : 0;
    rain->prepared = true;
    return virga_uploaded(rain->context);
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
        VIRGA_RETIRE(rain->context, target->lines[depth]);
        VIRGA_RETIRE(rain->context, target->wide[depth]);
    }
    VIRGA_RETIRE(rain->context, target->haze);
    VIRGA_RETIRE(rain->context, target->glow);
    target->serial = 0;
}

void rain_targets_destroy(virga_rain *rain)
{
    for (uint32_t i = 0; i < VIRGA_RAIN_MAX_TARGETS; i++) {
        target_clear(rain, &rain->targets[i]);
    }
}

/* Of thin streaks, but as lines. */
static virga_result line_pipeline(const virga_target *target, virga_graphics_def def, virga_pipeline **pipeline)
{
    def.lines = true;
    def.constant |= VIRGA_RAIN_STREAKS_LINES;
    def.name = "rain.line_streaks";
    return virga_target_pipeline(target, def, pipeline);
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
    const virga_target_outputs outputs = virga_target_outputs_of(target);
    virga_graphics_def def = {
        .layout = rain->bindings->layout, .blend_premultiplied = true, .depth_test = true, .outputs = outputs};
    for (uint32_t depth = 0; depth < 2; depth++) {
        def.constant = depth ? VIRGA_RAIN_STREAKS_DEPTH : 0;
        def.vertex = VIRGA_VERTEX_FORM(rain_draw_streak_thin_vert, outputs);
        def.fragment = VIRGA_FRAGMENT_FORM(rain_draw_streak_thin_frag, outputs);
        def.name = "rain.thin_streaks";
        TRY(virga_target_pipeline(target, def, &slot->thin[depth]));
        if (rain->context->lines)
            TRY(line_pipeline(target, def, &slot->lines[depth]));
        def.vertex = VIRGA_VERTEX_FORM(rain_draw_streak_wide_vert, outputs);
        def.fragment = VIRGA_FRAGMENT_FORM(rain_draw_streak_wide_frag, outputs);
        def.name = "rain.wide_streaks";
        TRY(virga_target_pipeline(target, def, &slot->wide[depth]));
    }
    def.vertex = VIRGA_SPIRV(rain_draw_haze_vert);
    def.fragment = VIRGA_SPIRV(rain_draw_haze_frag);
    def.outputs = VIRGA_OUTPUTS_COLOR; /* haze moves with what it lies over */
    def.depth_test = false;
    def.name = "rain.haze";
    TRY(virga_target_pipeline(target, def, &slot->haze));
    def.vertex = VIRGA_SPIRV(rain_draw_glow_vert);
    def.fragment = VIRGA_SPIRV(rain_draw_glow_frag);
    def.name = "rain.glow";
    TRY(virga_target_pipeline(target, def, &slot->glow));
    slot->motion = outputs & VIRGA_OUTPUTS_MOTION;
    slot->serial = target->serial;
    return VIRGA_OK;
error:
    target_clear(rain, slot);
    return result;
}

static void draw_plain(virga_rain *rain, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t corners,
                       uint32_t count, const char *name)
{
    virga_context *context = rain->context;
    const virga_pass_scope scope = virga_draw_begin(context, cmd, name);
    context->vk.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->pipeline);
    context->vk.CmdDraw(cmd, corners, count, 0, 0);
    virga_pass_end(context, cmd, scope);
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
    if (target->context != rain->context) /* whose numbers of targets are others */
        return virga_wrong_argument(&rain->context->log, "virga_rain_draw: expected a target of the same context");
    if (rain->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    const rain_target *found = find_target(rain, target->serial);
    /* What was prepared for an earlier frame lies where a later one writes. */
    if (!found || !rain->prepared || rain->view_frame != rain->context->frame_index)
        return virga_not_drawn(rain->context, "virga_rain_draw", found != NULL, virga_group_ready(&rain->needed),
                               &rain->told_not_drawn);
    const virga_pipeline *thin = found->thin[rain->prepared_depth], *wide = found->wide[rain->prepared_depth],
                         *lines = found->lines[rain->prepared_depth];
    const virga_pipeline *used[] = {found->haze, found->glow, thin, wide, lines ? lines : thin};
    const virga_result result = virga_pipelines_ready(used, sizeof used / sizeof used[0]);
    rain->told_not_drawn = false;
    if (result)
        return result;
    virga_context *context = rain->context;
    virga_draw_area(context, cmd, rain->prepared_viewport);
    rain_bind(rain, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, rain->prepared_set);
    if (rain->prepared_haze)
        draw_plain(rain, cmd, found->haze, 3, 1, "rain.haze");
    if (rain->prepared_glows)
        draw_plain(rain, cmd, found->glow, 6, rain->prepared_glows, "rain.glow");
    const virga_pass_scope scope = virga_draw_begin(context, cmd, "rain.streaks");
    context->vk.CmdBindIndexBuffer(cmd, rain->order_buffer->buffer, 0, VK_INDEX_TYPE_UINT32);
    if (lines) {
        context->vk.CmdSetLineWidth(cmd, rain->prepared_line_px);
        draw_streaks(rain, cmd, lines, offsetof(virga_prepared_gpu, lines));
    }
    draw_streaks(rain, cmd, thin, offsetof(virga_prepared_gpu, thin));
    draw_streaks(rain, cmd, wide, offsetof(virga_prepared_gpu, wide));
    virga_pass_end(context, cmd, scope);
    return VIRGA_OK;
}

/* ---- haze alone */

static virga_result check_haze_alone(virga_rain *rain, VkCommandBuffer cmd, const virga_view *view,
                                     const double begin[4], const virga_target *target)
{
    const virga_log *log = &rain->context->log;
    if (!cmd || !view || !target)
        return virga_wrong_argument(log, "virga_rain_draw_haze: NULL argument");
    if (target->context != rain->context)
        return virga_wrong_argument(log, "virga_rain_draw_haze: expected a target of the same context");
    if (rain->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (begin && virga_settings_finite_double(log, "virga_rain_draw_haze: begin", begin, 4))
        return VIRGA_ERROR_INVALID;
    const virga_result result = virga_view_check(rain->context, view, 0);
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
    virga_result result = check_haze_alone(rain, cmd, view, begin, target);
    if (result)
        return result;
    const rain_target *found = find_target(rain, target->serial);
    /* Inside rendering a frame can not be begun. */
    if (!found || !rain->stepped || rain->ring_frame != rain->context->frame_index)
        return VIRGA_NOT_READY;
    const virga_pipeline *used[] = {found->haze, found->glow};
    result = virga_pipelines_ready(used, sizeof used / sizeof used[0]);
    if (result || !hazes(rain))
        return result;
    uint32_t place;
    rain_view_block block;
    const uint32_t prepared_offset = rain->view_offset;
    fill_view(rain, view, virga_rain_time(rain), &block);
    fill_haze_alone(rain, view, begin, &block);
    result = push_view(rain, &block, &place);
    if (result)
        return result;
    virga_draw_area(rain->context, cmd, view->viewport);
    rain_bind(rain, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, rain_write_set(rain, place, &view->depth));
    draw_plain(rain, cmd, found->haze, 3, 1, "rain.haze_alone");
    if (glowing_lamps(rain))
        draw_plain(rain, cmd, found->glow, 6, glowing_lamps(rain), "rain.glow_alone");
    rain->view_offset = prepared_offset; /* virga_rain_draw may still come */
    return virga_uploaded(rain->context);
}
