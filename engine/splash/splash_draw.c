/* splash/splash_draw.c - renders splashes for a view: prepare selects and shades sprites, draw records the draw calls.
 * A table lists the pipelines of a target (attach). */
#include "splash/splash_internal.h"

#include "gpu/builds.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/target.h"
#include "gpu/timers.h"
#include "gpu/view.h"

#include "shaders/splash_shaders.h"

#include <math.h>
#include <string.h>

/* ---- prepare */

/* The winding on the image of triangles that are counter-clockwise seen from outside. It is the sign of the volume
 * (triple product) of the image's right, down and depth axes. */
static float handedness(const float clip_from_rel[16])
{
    const float *m = clip_from_rel; /* columns */
    const float x[3] = {m[0], m[4], m[8]}, y[3] = {m[1], m[5], m[9]}, w[3] = {m[3], m[7], m[11]};
    const float volume =
        x[0] * (y[1] * w[2] - y[2] * w[1]) - x[1] * (y[0] * w[2] - y[2] * w[0]) + x[2] * (y[0] * w[1] - y[1] * w[0]);
    return volume < 0 ? -1.0f : 1.0f;
}

/* VIRGA_SPLASH_FORM_... bits that select the passes of a prepare. */
static uint32_t choose_form(const virga_splash *splash)
{
    const virga_splash_settings *settings = &splash->settings;
    const bool full = settings->lighting.light_count || virga_effect_wants_motion(&splash->base);
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
    out->view.near_fade_m = settings->near_fade_m;
    out->look = (virga_splash_look_gpu){.tick = splash->last_tick,
                                        .tick_s = (float)splash->def.tick_s,
                                        .style = (uint32_t)settings->style,
                                        .gain = settings->gain,
                                        .max_splashes = splash->def.max_splashes,
                                        .max_droplets = splash->def.max_droplets,
                                        .max_sprites = splash_max_sprites(&splash->def),
                                        .max_crowns = splash_max_crowns(&splash->def),
                                        .physical = settings->mode == VIRGA_SPLASH_MODE_PHYSICAL,
                                        .lines = splash->base.context->lines,
                                        .motion = virga_effect_wants_motion(&splash->base),
                                        .handed = handedness(out->view.clip_from_rel),
                                        .parts_px = settings->parts_px,
                                        .hole_m = 1e-6f * settings->hole_um};
}

/* Lists the visible sprites and sheets. Both lists are made in the same passes. */
static void record_lists(virga_splash *splash, VkCommandBuffer cmd, uint32_t style)
{
    virga_context *context = splash->base.context;
    virga_dispatch_indirect(context, cmd, splash->few_mark[style], splash->state->buffer,
                            offsetof(virga_splash_state_gpu, find_groups));
    virga_dispatch_indirect(context, cmd, splash->droplet_mark[style], splash->state->buffer,
                            offsetof(virga_splash_state_gpu, find_droplet_groups));
    virga_dispatch_indirect(context, cmd, splash->splash_mark[style], splash->state->buffer,
                            offsetof(virga_splash_state_gpu, find_splash_groups));
    virga_compute_barrier(context, cmd);
    virga_dispatch(context, cmd, splash->view_scan, 2);
    virga_indirect_barrier(context, cmd);
    virga_dispatch_indirect(context, cmd, splash->view_compact, splash->prepared_buffer->buffer,
                            offsetof(virga_splash_prepared_gpu, list_groups));
    virga_indirect_barrier(context, cmd);
}

static void record_prepare(virga_splash *splash, VkCommandBuffer cmd, VkDescriptorSet set, uint32_t form)
{
    virga_context *context = splash->base.context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "splash.prepare");
    /* The previous draw, of this or an earlier frame, may still read lists and sprites. */
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES | VIRGA_VERTICES,
               VIRGA_PASSES | VIRGA_ARGUMENTS);
    splash_bind(splash, cmd, set);
    record_lists(splash, cmd, form & VIRGA_SPLASH_FORM_FILM);
    virga_dispatch_indirect(context, cmd, splash->sprite_write[form], splash->lists->buffer, 0);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_ARGUMENTS | VIRGA_COPIES | VIRGA_VERTICES);
    virga_effect_copy_statistics(&splash->base, cmd, SPLASH_PART_PREPARE, splash->prepared_buffer, 0,
                                 offsetof(splash_readback, prepared[virga_effect_view_index(&splash->base)]),
                                 sizeof(virga_splash_prepared_gpu));
    virga_pass_end(context, cmd, scope);
}

virga_result splash_prepare(virga_splash *splash, VkCommandBuffer cmd, const virga_view *view, double time_s,
                            virga_prepared *prepared)
{
    virga_context *context = splash->base.context;
    virga_result result =
        virga_effect_check_prepare(&splash->base, "virga_splash_prepare", cmd, view, time_s, splash->ticks);
    if (result)
        return result;
    virga_timers_reset(context, cmd);
    splash_push_rules(splash);
    splash_view_block block;
    uint32_t index;
    fill_view(splash, view, time_s, &block);
    result = virga_effect_push_view(&splash->base, "virga_splash_prepare", &splash->view_ring, &block, sizeof block,
                                    &index, &splash->view_offset);
    if (result)
        return result;
    const VkDescriptorSet set = splash_write_set(splash, index, splash->current, view);
    splash_first_contents(splash, cmd, set);
    record_prepare(splash, cmd, set, choose_form(splash));
    virga_effect_set_view(&splash->base, set, splash->view_offset, view, prepared);
    splash->prepared[splash->base.slot] =
        (splash_prepared){.tick_offset = splash->tick_offset,
                          .rules_offset = splash->rules_offset,
                          .depth = view->depth.view != VK_NULL_HANDLE,
                          .style = splash->settings.style,
                          .line_px = splash->settings.min_width_px + 1}; /* as wide as quads, see sprite_corner.glsl */
    return virga_recording_result(context);
}

/* ---- draw */

#define LINES VIRGA_SPLASH_SPRITES_LINES
#define PUFFS VIRGA_SPLASH_SPRITES_PUFFS
#define DEPTH VIRGA_SPLASH_SPRITES_DEPTH

static const uint32_t plain[2] = {0, DEPTH}, lines[2] = {LINES, LINES | DEPTH}, puffs[2] = {PUFFS, PUFFS | DEPTH};

#define SPRITE_VERTEX    VIRGA_VERTEX_FORMS(splash_draw_sprite_vert)
#define THIN_FRAGMENT    VIRGA_FRAGMENT_FORMS(splash_draw_sprite_thin_frag)
#define WIDE_FRAGMENT    VIRGA_FRAGMENT_FORMS(splash_draw_sprite_wide_frag)
#define PYRAMID_FRAGMENT VIRGA_FRAGMENT_FORMS(splash_draw_pyramid_frag)

/* In the order of the SPLASH_DRAW_... indices. */
const virga_effect_draw splash_draws[SPLASH_DRAW_ROWS] = {
    {"splash.lines", SPRITE_VERTEX, THIN_FRAGMENT, lines, 2, .lines = true},
    {"splash.thin", SPRITE_VERTEX, THIN_FRAGMENT, plain, 2},
    {"splash.puffs", SPRITE_VERTEX, THIN_FRAGMENT, puffs, 2},
    {"splash.wide", SPRITE_VERTEX, WIDE_FRAGMENT, plain, 2},
    {"splash.sheets", VIRGA_VERTEX_FORMS(splash_draw_crown_vert), VIRGA_FRAGMENT_FORMS(splash_draw_crown_frag), plain,
     2},
    {"splash.pile_pyramids", VIRGA_VERTEX_FORMS(splash_draw_pile_pyramid_vert), PYRAMID_FRAGMENT, plain, 2,
     .cull_back = true},
    {"splash.crown_pyramids", VIRGA_VERTEX_FORMS(splash_draw_crown_pyramid_vert), PYRAMID_FRAGMENT, plain, 2,
     .cull_back = true},
};

static void draw(virga_splash *splash, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t arguments)
{
    virga_draw_indexed_indirect(splash->base.context, cmd, pipeline, splash->prepared_buffer->buffer, arguments);
}

virga_result splash_draw(virga_splash *splash, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                         const char *call)
{
    virga_context *context = splash->base.context;
    const virga_effect_target *found;
    virga_result result = virga_effect_check_draw(&splash->base, call, cmd, target, prepared, splash->ticks, &found);
    if (result)
        return result;
    const splash_prepared *seen = &splash->prepared[splash->base.slot];
    const bool film = seen->style == VIRGA_SPLASH_STYLE_FILM;
    const int depth = seen->depth;
    const virga_pipeline *used[] = {found->draws[(film ? SPLASH_DRAW_SHEETS : SPLASH_DRAW_CROWNS) + depth],
                                    found->draws[(film ? SPLASH_DRAW_WIDE : SPLASH_DRAW_PILES) + depth],
                                    found->draws[(SPLASH_DRAW_THIN) + depth], found->draws[(SPLASH_DRAW_PUFFS) + depth],
                                    found->draws[(SPLASH_DRAW_LINES) + depth]};
    const bool has_lines = used[4];
    result = virga_pipelines_ready(used, has_lines ? 5 : 4);
    if (result)
        return result;
    const virga_pass_scope scope = virga_draw_begin(context, cmd, "splash.draw");
    virga_set_draw_area(context, cmd, virga_effect_selected(&splash->base)->viewport);
    splash_bind_view(splash, cmd);
    context->vk.CmdBindIndexBuffer(cmd, splash->index_buffer->buffer, 0, VK_INDEX_TYPE_UINT32);
    draw(splash, cmd, used[0], offsetof(virga_splash_prepared_gpu, crowns));
    draw(splash, cmd, used[1], offsetof(virga_splash_prepared_gpu, wide_quads));
    if (has_lines) {
        context->vk.CmdSetLineWidth(cmd, seen->line_px);
        draw(splash, cmd, used[4], offsetof(virga_splash_prepared_gpu, lines));
    }
    draw(splash, cmd, used[2], offsetof(virga_splash_prepared_gpu, thin_quads));
    draw(splash, cmd, used[3], offsetof(virga_splash_prepared_gpu, puffs));
    if (film)
        draw(splash, cmd, used[3], offsetof(virga_splash_prepared_gpu, puff_crowns));
    virga_pass_end(context, cmd, scope);
    return VIRGA_OK;
}
