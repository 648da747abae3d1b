/* splash/splash_draw.c - what a view sees: selection and shading (prepare), pipelines for
 * a target (attach), drawing. */
#include "splash/splash_internal.h"

#include "gpu/builds.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/target.h"
#include "gpu/timers.h"
#include "gpu/view.h"

#include "shaders/splash_draw_crown_frag.spv.h"
#include "shaders/splash_draw_crown_frag_both.spv.h"
#include "shaders/splash_draw_crown_frag_motion.spv.h"
#include "shaders/splash_draw_crown_frag_reactive.spv.h"
#include "shaders/splash_draw_crown_pyramid_vert.spv.h"
#include "shaders/splash_draw_crown_pyramid_vert_motion.spv.h"
#include "shaders/splash_draw_crown_vert.spv.h"
#include "shaders/splash_draw_crown_vert_motion.spv.h"
#include "shaders/splash_draw_pile_pyramid_vert.spv.h"
#include "shaders/splash_draw_pile_pyramid_vert_motion.spv.h"
#include "shaders/splash_draw_pyramid_frag.spv.h"
#include "shaders/splash_draw_pyramid_frag_both.spv.h"
#include "shaders/splash_draw_pyramid_frag_motion.spv.h"
#include "shaders/splash_draw_pyramid_frag_reactive.spv.h"
#include "shaders/splash_draw_sprite_thin_frag.spv.h"
#include "shaders/splash_draw_sprite_thin_frag_both.spv.h"
#include "shaders/splash_draw_sprite_thin_frag_motion.spv.h"
#include "shaders/splash_draw_sprite_thin_frag_reactive.spv.h"
#include "shaders/splash_draw_sprite_vert.spv.h"
#include "shaders/splash_draw_sprite_vert_motion.spv.h"
#include "shaders/splash_draw_sprite_wide_frag.spv.h"
#include "shaders/splash_draw_sprite_wide_frag_both.spv.h"
#include "shaders/splash_draw_sprite_wide_frag_motion.spv.h"
#include "shaders/splash_draw_sprite_wide_frag_reactive.spv.h"

#include <math.h>
#include <string.h>

typedef struct splash_view_block {
    virga_view_gpu view;
    virga_splash_look_gpu look;
} splash_view_block;

uint32_t splash_view_bytes(void)
{
    return (uint32_t)((sizeof(splash_view_block) + VIRGA_RING_ALIGNMENT - 1) / VIRGA_RING_ALIGNMENT *
                      VIRGA_RING_ALIGNMENT);
}

/* ---- prepare */

/* Which way round triangles come out that are counter-clockwise seen from outside: the sign of the volume that the
 * picture's right, its down and its depth span. */
static float handedness(const float clip_from_rel[16])
{
    const float *m = clip_from_rel; /* columns */
    const float x[3] = {m[0], m[4], m[8]}, y[3] = {m[1], m[5], m[9]}, w[3] = {m[3], m[7], m[11]};
    const float volume =
        x[0] * (y[1] * w[2] - y[2] * w[1]) - x[1] * (y[0] * w[2] - y[2] * w[0]) + x[2] * (y[0] * w[1] - y[1] * w[0]);
    return volume < 0 ? -1.0f : 1.0f;
}

/* Whether any target has motion vectors, so that prepare has to find those of sprites. */
static bool wants_motion(const virga_splash *splash)
{
    for (uint32_t i = 0; i < SPLASH_MAX_TARGETS; i++)
        if (splash->targets[i].serial && splash->targets[i].motion)
            return true;
    return false;
}

/* VIRGA_SPLASH_FORM_... of the passes of a prepare. */
static uint32_t form_wanted(const virga_splash *splash)
{
    const virga_splash_settings *settings = &splash->settings;
    const bool full = settings->lighting.light_count || wants_motion(splash);
    return (settings->style == VIRGA_SPLASH_STYLE_FILM ? VIRGA_SPLASH_FORM_FILM : 0) |
           (full ? VIRGA_SPLASH_FORM_FULL : 0);
}

static void fill_view(const virga_splash *splash, const virga_view *view, double time_s, splash_view_block *out)
{
    const virga_splash_settings *settings = &splash->settings;
    virga_view_fill(view, &settings->lighting, splash->anchor_m, virga_splash_time(splash), time_s, &out->view);
    out->view.light_gain = settings->light_gain;
    out->view.min_width_px = settings->min_width_px;
    out->view.soft_m = settings->soft_m;
    out->view.near_m = settings->near_m;
    out->look = (virga_splash_look_gpu){.tick = splash->last_tick,
                                        .tick_s = (float)splash->def.tick_s,
                                        .style = (uint32_t)settings->style,
                                        .gain = settings->gain,
                                        .max_splashes = splash->def.max_splashes,
                                        .max_droplets = splash->def.max_droplets,
                                        .max_sprites = splash_max_sprites(&splash->def),
                                        .max_crowns = splash_max_crowns(&splash->def),
                                        .physical = settings->mode == VIRGA_SPLASH_MODE_PHYSICAL,
                                        .lines = splash->context->lines,
                                        .motion = wants_motion(splash),
                                        .handed = handedness(out->view.clip_from_rel)};
}

/* Worked out here and copied at once: what is mapped may be slow to read. */
static void push_view(virga_splash *splash, const virga_view *view, double time_s)
{
    splash_view_block block;
    fill_view(splash, view, time_s, &block);
    memcpy((char *)splash->view_ring->memory.block.mapped + splash->view_offset, &block, sizeof block);
    virga_buffer_flush(splash->context, splash->view_ring, splash->view_offset, splash_view_bytes());
}

/* What is to be seen of sprites and of sheets, found side by side. */
static void record_lists(virga_splash *splash, VkCommandBuffer cmd, uint32_t style)
{
    virga_context *context = splash->context;
    virga_dispatch_indirect(context, cmd, splash->few_find[style], splash->state->buffer,
                            offsetof(virga_splash_state_gpu, find_groups));
    virga_dispatch_indirect(context, cmd, splash->droplet_find[style], splash->state->buffer,
                            offsetof(virga_splash_state_gpu, find_droplet_groups));
    virga_dispatch_indirect(context, cmd, splash->splash_find[style], splash->state->buffer,
                            offsetof(virga_splash_state_gpu, find_splash_groups));
    virga_compute_barrier(context, cmd);
    virga_dispatch(context, cmd, splash->view_scan, 2);
    virga_indirect_barrier(context, cmd);
    virga_dispatch_indirect(context, cmd, splash->view_list, splash->prepared_buffer->buffer,
                            offsetof(virga_splash_prepared_gpu, list_groups));
    virga_indirect_barrier(context, cmd);
}

static void record_prepare(virga_splash *splash, VkCommandBuffer cmd, uint32_t form)
{
    virga_context *context = splash->context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "splash.prepare");
    /* The draw before, of this or an earlier frame, may still read lists and sprites. */
    virga_barrier(context, cmd,
                  VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT |
                      VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                  READ_WRITE | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
    splash_bind(splash, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, splash->prepared_set);
    record_lists(splash, cmd, form & VIRGA_SPLASH_FORM_FILM);
    virga_dispatch_indirect(context, cmd, splash->sprite_write[form], splash->lists->buffer, 0);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                  VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT |
                      VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT);
    splash_record_prepared(splash, cmd);
    virga_pass_end(context, cmd, scope);
}

virga_result virga_splash_prepare(virga_splash *splash, VkCommandBuffer cmd, const virga_view *view, double time_s)
{
    if (!splash)
        return VIRGA_ERROR_INVALID;
    virga_context *context = splash->context;
    if (!cmd || !view)
        return virga_wrong_argument(&context->log, "virga_splash_prepare: NULL argument");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    splash->prepared = false;
    virga_result result = virga_view_check(context, view, time_s);
    if (!result)
        result = virga_group_ready(&splash->needed);
    if (result)
        return result;
    if (!splash->ticks)
        return VIRGA_NOT_READY;
    if (splash->view_frame != context->frame_index)
        splash->ring_views = 0;
    splash->view_frame = context->frame_index;
    if (splash->ring_views >= SPLASH_MAX_VIEWS)
        return virga_wrong_argument(&context->log, "virga_splash_prepare: more than %d views in a frame",
                                    SPLASH_MAX_VIEWS);
    virga_timers_reset(context, cmd);
    splash_push_rules(splash);
    const uint32_t place = splash->ring_views++;
    splash->view_offset = (context->ring_slot * SPLASH_MAX_VIEWS + place) * splash_view_bytes();
    push_view(splash, view, time_s);
    splash->prepared_depth = view->depth.view != VK_NULL_HANDLE;
    splash->prepared_set = splash_write_set(splash, place, splash_current(splash), view);
    record_prepare(splash, cmd, form_wanted(splash));
    memcpy(splash->prepared_viewport, view->viewport, sizeof splash->prepared_viewport);
    splash->prepared_line_px = splash->settings.min_width_px + 1; /* as corners would be, see sprite_corner.glsl */
    splash->prepared_style = splash->settings.style;
    splash->prepared = true;
    return virga_uploaded(context);
}

/* ---- attach */

static splash_target *find_target(virga_splash *splash, uint64_t serial)
{
    for (uint32_t i = 0; i < SPLASH_MAX_TARGETS; i++)
        if (splash->targets[i].serial == serial)
            return &splash->targets[i];
    return NULL;
}

static void target_clear(virga_splash *splash, splash_target *target)
{
    for (int depth = 0; depth < 2; depth++)
        for (int draw = 0; draw < SPLASH_DRAWS; draw++)
            VIRGA_RETIRE(splash->context, target->draws[draw][depth]);
    target->serial = 0;
}

void splash_targets_destroy(virga_splash *splash)
{
    for (uint32_t i = 0; i < SPLASH_MAX_TARGETS; i++)
        target_clear(splash, &splash->targets[i]);
}

typedef struct draw_row {
    virga_spirv vertex, fragment;
    const char *name;
    uint32_t sprites; /* VIRGA_SPLASH_SPRITES_... beside the depth */
    bool cull_back;
} draw_row;

static void list_draws(virga_target_outputs outputs, draw_row rows[SPLASH_DRAWS])
{
    const virga_spirv sprite = VIRGA_VERTEX_FORM(splash_draw_sprite_vert, outputs);
    const virga_spirv thin = VIRGA_FRAGMENT_FORM(splash_draw_sprite_thin_frag, outputs);
    const virga_spirv wide = VIRGA_FRAGMENT_FORM(splash_draw_sprite_wide_frag, outputs);
    const virga_spirv sheet = VIRGA_FRAGMENT_FORM(splash_draw_crown_frag, outputs);
    const virga_spirv pyramid = VIRGA_FRAGMENT_FORM(splash_draw_pyramid_frag, outputs);
    const uint32_t puffs = VIRGA_SPLASH_SPRITES_PUFFS, lines = VIRGA_SPLASH_SPRITES_LINES;
    rows[SPLASH_DRAW_LINES] = (draw_row){sprite, thin, "splash.lines", lines, false};
    rows[SPLASH_DRAW_THIN] = (draw_row){sprite, thin, "splash.thin", 0, false};
    rows[SPLASH_DRAW_PUFFS] = (draw_row){sprite, thin, "splash.puffs", puffs, false};
    rows[SPLASH_DRAW_WIDE] = (draw_row){sprite, wide, "splash.wide", 0, false};
    rows[SPLASH_DRAW_SHEETS] =
        (draw_row){VIRGA_VERTEX_FORM(splash_draw_crown_vert, outputs), sheet, "splash.sheets", 0, false};
    rows[SPLASH_DRAW_PILES] =
        (draw_row){VIRGA_VERTEX_FORM(splash_draw_pile_pyramid_vert, outputs), pyramid, "splash.pile_pyramids", 0, true};
    rows[SPLASH_DRAW_CROWNS] = (draw_row){VIRGA_VERTEX_FORM(splash_draw_crown_pyramid_vert, outputs), pyramid,
                                          "splash.crown_pyramids", 0, true};
}

virga_result virga_splash_attach(virga_splash *splash, const virga_target *target)
{
    if (!splash)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &splash->context->log;
    if (!target || target->context != splash->context)
        return virga_wrong_argument(log, "virga_splash_attach: expected a target of the same context");
    if (splash->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (find_target(splash, target->serial))
        return VIRGA_OK;
    splash_target *slot = find_target(splash, 0);
    if (!slot)
        return virga_wrong_argument(log, "virga_splash_attach: more than %d targets", SPLASH_MAX_TARGETS);
    const virga_target_outputs outputs = virga_target_outputs_of(target);
    draw_row rows[SPLASH_DRAWS];
    list_draws(outputs, rows);
    virga_result result = VIRGA_OK;
    virga_graphics_def def = {
        .layout = splash->bindings->layout, .blend_premultiplied = true, .depth_test = true, .outputs = outputs};
    for (uint32_t i = 0; i < SPLASH_DRAWS * 2; i++) {
        const draw_row *row = &rows[i / 2];
        def.lines = row->sprites == VIRGA_SPLASH_SPRITES_LINES;
        if (def.lines && !splash->context->lines)
            continue;
        def.constant = row->sprites | (i % 2 ? VIRGA_SPLASH_SPRITES_DEPTH : 0);
        def.vertex = row->vertex;
        def.fragment = row->fragment;
        def.name = row->name;
        def.cull_back = row->cull_back;
        TRY(virga_target_pipeline(target, def, &slot->draws[i / 2][i % 2]));
    }
    slot->motion = outputs & VIRGA_OUTPUTS_MOTION;
    slot->serial = target->serial;
    return VIRGA_OK;
error:
    target_clear(splash, slot);
    return result;
}

/* ---- draw */

static void draw(virga_splash *splash, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t arguments)
{
    const virga_functions *vk = &splash->context->vk;
    vk->CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->pipeline);
    vk->CmdDrawIndexedIndirect(cmd, splash->prepared_buffer->buffer, arguments, 1, sizeof(virga_splash_draw_gpu));
}

virga_result virga_splash_draw(virga_splash *splash, VkCommandBuffer cmd, const virga_target *target)
{
    if (!splash)
        return VIRGA_ERROR_INVALID;
    virga_context *context = splash->context;
    if (!cmd || !target)
        return virga_wrong_argument(&context->log, "virga_splash_draw: NULL argument");
    if (target->context != context) /* whose numbers of targets are others */
        return virga_wrong_argument(&context->log, "virga_splash_draw: expected a target of the same context");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    const splash_target *found = find_target(splash, target->serial);
    /* What was prepared for an earlier frame or step is not what the buffers hold now. */
    if (!found || !splash->prepared || splash->view_frame != context->frame_index)
        return virga_not_drawn(context, "virga_splash_draw", found != NULL,
                               splash->ticks ? virga_group_ready(&splash->needed) : VIRGA_NOT_READY,
                               &splash->told_not_drawn);
    const bool film = splash->prepared_style == VIRGA_SPLASH_STYLE_FILM;
    const int depth = splash->prepared_depth;
    const virga_pipeline *used[] = {found->draws[film ? SPLASH_DRAW_SHEETS : SPLASH_DRAW_CROWNS][depth],
                                    found->draws[film ? SPLASH_DRAW_WIDE : SPLASH_DRAW_PILES][depth],
                                    found->draws[SPLASH_DRAW_THIN][depth], found->draws[SPLASH_DRAW_PUFFS][depth],
                                    found->draws[SPLASH_DRAW_LINES][depth]};
    const bool lines = used[4];
    const virga_result result = virga_pipelines_ready(used, lines ? 5 : 4);
    splash->told_not_drawn = false;
    if (result)
        return result;
    const virga_pass_scope scope = virga_draw_begin(context, cmd, "splash.draw");
    virga_draw_area(context, cmd, splash->prepared_viewport);
    splash_bind(splash, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, splash->prepared_set);
    context->vk.CmdBindIndexBuffer(cmd, splash->index_buffer->buffer, 0, VK_INDEX_TYPE_UINT32);
    draw(splash, cmd, used[0], offsetof(virga_splash_prepared_gpu, crowns));
    draw(splash, cmd, used[1], offsetof(virga_splash_prepared_gpu, wide));
    if (lines) {
        context->vk.CmdSetLineWidth(cmd, splash->prepared_line_px);
        draw(splash, cmd, used[4], offsetof(virga_splash_prepared_gpu, lines));
    }
    draw(splash, cmd, used[2], offsetof(virga_splash_prepared_gpu, thin));
    draw(splash, cmd, used[3], offsetof(virga_splash_prepared_gpu, puffs));
    virga_pass_end(context, cmd, scope);
    return VIRGA_OK;
}
