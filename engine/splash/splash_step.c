/* splash/splash_step.c - records a step: spawns become splashes, droplets fly, and fallen droplets return to the
 * ground. */
#include "splash/splash_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <math.h>
#include <string.h>

#define ANCHOR_M 64.0 /* anchors are multiples of it: floats relative to them are exact to some micrometres */

/* ---- statistics */

static uint64_t count_of(const virga_splash_state_gpu *state, uint32_t index)
{
    return (uint64_t)state->counts[index].high << 32 | state->counts[index].low;
}

static void read_state(virga_splash_stats *stats, uint64_t frame, const virga_splash_state_gpu *state)
{
    stats->frame_index = frame;
    for (uint32_t model = 0; model < VIRGA_SPLASH_MODELS; model++)
        for (uint32_t material = 0; material < VIRGA_GROUND_MATERIALS; material++)
            stats->splashes[model][material] =
                count_of(state, VIRGA_SPLASH_BY_MODEL + model * VIRGA_SPLASH_MATERIALS + material);
    stats->droplets = count_of(state, VIRGA_SPLASH_DROPLETS);
    stats->fallen = count_of(state, VIRGA_SPLASH_FALLEN);
    stats->flown_nl = count_of(state, VIRGA_SPLASH_FLOWN);
    stats->returned_nl = count_of(state, VIRGA_SPLASH_RETURNED);
    stats->spray_nl = count_of(state, VIRGA_SPLASH_SPRAY_IN);
    stats->spray_back_nl = count_of(state, VIRGA_SPLASH_SPRAY_BACK);
    stats->spray_returned_nl = count_of(state, VIRGA_SPLASH_SPRAY_RETURNED);
    stats->spray_panes_nl = count_of(state, VIRGA_SPLASH_SPRAY_PANES);
    stats->drips = count_of(state, VIRGA_SPLASH_DRIPS);
    stats->drip_rain_nl = count_of(state, VIRGA_SPLASH_DRIP_IN);
    stats->drip_nl = count_of(state, VIRGA_SPLASH_DRIP_OUT);
    stats->drip_left_nl = count_of(state, VIRGA_SPLASH_DRIP_LEFT);
    stats->splashes_without_droplets = count_of(state, VIRGA_SPLASH_WITHOUT_DROPLETS);
    stats->splashes_cut_short = count_of(state, VIRGA_SPLASH_CUT_SHORT);
    stats->drips_held = count_of(state, VIRGA_SPLASH_DRIPS_HELD);
    stats->droplets_held = count_of(state, VIRGA_SPLASH_DROPLETS_HELD);
    stats->splashes_alive = state->alive;
    stats->droplets_alive = state->staying;
}

static void read_views(virga_splash_stats *stats, uint32_t views, const virga_splash_prepared_gpu *prepared)
{
    const virga_splash_prepared_gpu *newest = &prepared[views - 1];
    stats->views = views;
    for (uint32_t i = 0; i < VIRGA_MAX_VIEWS; i++)
        stats->view_sprites[i] = i < views ? prepared[i].sprites : 0;
    stats->sprites = newest->sprites;
    stats->sprites_dropped = newest->cut[0];
    stats->sheets_dropped = newest->cut[1];
}

/* A frame may have a prepare without a step, or a step without a prepare: `parts` has a bit for each. */
void splash_read_statistics(void *object, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data)
{
    virga_splash_stats *stats = &((virga_splash *)object)->stats;
    splash_readback read;
    memcpy(&read, data, sizeof read);
    if (parts & 1u << SPLASH_PART_STEP)
        read_state(stats, frame, &read.state);
    if (parts & 1u << SPLASH_PART_PREPARE)
        read_views(stats, ((virga_splash *)object)->base.readback_views[ring_slot], read.prepared);
}

/* Goes back to the droplets and the anchor of the lost step. After a later step they can not: then droplets jump by a
 * tick, and those in the air are gone after a second. */
void splash_lost(void *object, uint64_t frame, uint32_t did)
{
    virga_splash *splash = object;
    if (splash->drips.sent_frame == frame)
        splash->drips.sent = false;
    if (!(did & 1u << SPLASH_PART_STEP) || splash->before.frame != frame)
        return;
    splash->current = splash->before.current;
    splash->anchored = splash->before.anchored;
    memcpy(splash->anchor_m, splash->before.anchor_m, sizeof splash->anchor_m);
}

void splash_state_loaded(void *object)
{
    virga_splash *splash = object;
    splash->before.frame = 0;
    splash->drips.sent = false;
}

static void remember(virga_splash *splash)
{
    splash->before.frame = splash->base.context->frame_index;
    splash->before.current = splash->current;
    splash->before.anchored = splash->anchored;
    memcpy(splash->before.anchor_m, splash->anchor_m, sizeof splash->anchor_m);
}

/* ---- ticks */

/* Dispatches indirectly. An earlier scan wrote the group count at `groups` in the state. */
static void over(virga_splash *splash, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t groups)
{
    virga_dispatch_indirect_and_barrier(splash->base.context, cmd, pipeline, splash->state->buffer, groups);
}

static void run_tick(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info, uint32_t i)
{
    virga_context *context = splash->base.context;
    const double still[3] = {0, 0, 0};
    splash_push_tick(splash, info, i, still);
    splash_bind(splash, cmd, splash->step_sets[splash->current]);
    virga_pass_scope scope = virga_pass_begin(context, cmd, "splash.spawn");
    virga_dispatch_and_barrier(splash->base.context, cmd, splash->spawn_scan, 1);
    over(splash, cmd, splash->spawn, offsetof(virga_splash_state_gpu, spawn_groups));
    virga_pass_end(context, cmd, scope);
    scope = virga_pass_begin(context, cmd, "splash.step");
    over(splash, cmd, splash->fly, offsetof(virga_splash_state_gpu, droplet_groups));
    virga_dispatch_and_barrier(splash->base.context, cmd, splash->fall_scan, 1);
    over(splash, cmd, splash->fall_compact, offsetof(virga_splash_state_gpu, fall_groups));
    virga_pass_end(context, cmd, scope);
    splash->current ^= 1;
    splash->ticks++;
    splash->last_tick = info->first_tick + i;
}

/* Positions are relative to an anchor. When the camera is more than ANCHOR_M away, the anchor moves near it. */
static void follow(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info)
{
    double shift[3];
    bool far = !splash->anchored;
    for (int axis = 0; axis < 3; axis++)
        far = far || fabs(info->camera_m[axis] - splash->anchor_m[axis]) > ANCHOR_M;
    if (!far)
        return;
    for (int axis = 0; axis < 3; axis++) {
        const double anchor = round(info->camera_m[axis] / ANCHOR_M) * ANCHOR_M;
        shift[axis] = splash->anchor_m[axis] - anchor;
        splash->anchor_m[axis] = anchor;
    }
    if (splash->anchored) {
        const uint32_t max =
            splash->def.max_droplets > splash->def.max_splashes ? splash->def.max_droplets : splash->def.max_splashes;
        splash_push_tick(splash, info, 0, shift);
        splash_bind(splash, cmd, splash->step_sets[splash->current]);
        virga_dispatch_and_barrier(splash->base.context, cmd, splash->rebase,
                                   (max + VIRGA_SPLASH_GROUP - 1) / VIRGA_SPLASH_GROUP);
    }
    splash->anchored = true;
}

/* ---- a step */

void splash_first_contents(virga_splash *splash, VkCommandBuffer cmd, VkDescriptorSet set)
{
    virga_context *context = splash->base.context;
    const uint32_t sprites = splash_max_sprites(&splash->def);
    if (!virga_effect_first_contents(&splash->base, cmd))
        return;
    splash_bind(splash, cmd, set);
    context->vk.CmdPushConstants(cmd, splash->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof sprites, &sprites);
    virga_dispatch(context, cmd, splash->indices, 1024);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_VERTICES);
}

static virga_result check_step(const virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info)
{
    if (!splash)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &splash->base.context->log;
    const virga_result result =
        virga_effect_check_one_step(&splash->base, "virga_splash_step", cmd, info && info->spawns ? info : NULL);
    if (result)
        return result;
    const virga_tick_range ticks = {info->first_tick, info->ticks, splash->def.max_ticks_per_step};
    if (virga_effect_check_ticks(&splash->base, &ticks, splash->ticks ? &splash->last_tick : NULL) ||
        virga_settings_check_positions(log, "step_info.camera_m", info->camera_m, 3) ||
        virga_settings_check_finite(log, "step_info.wind_m_s", info->wind_m_s, 3) ||
        virga_host_list_check(splash->base.context, "step_info.spawns", info->spawns, info->spawns_offset,
                              info->spawns_size, sizeof(virga_spawns_gpu)) ||
        splash_spray_check(splash, info))
        return VIRGA_ERROR_INVALID;
    return virga_effect_ready(&splash->base);
}

virga_result virga_splash_step(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *given)
{
    const virga_result result = check_step(splash, cmd, given);
    if (result)
        return result;
    bool changed = false;
    virga_splash_step_info next = *given;
    const virga_splash_step_info *info = &next;
    virga_clamp_vector(&splash->base.context->log, "step_info.wind_m_s", next.wind_m_s, VIRGA_MAX_SPEED_M_S, &changed);
    virga_context *context = splash->base.context;
    virga_effect_begin_step(&splash->base, cmd);
    splash_push_rules(splash);
    virga_effect_forget_views(&splash->base, 0);
    splash->spawns = info->spawns;
    splash->spawns_offset = info->spawns_offset;
    splash->spawns_range = virga_host_list_range(
        context, info->spawns_size, sizeof(virga_spawns_gpu) + splash->def.max_spawns * sizeof(virga_spawn_gpu));
    splash->info = info;
    for (uint32_t i = 0; i < 2; i++)
        splash->step_sets[i] = splash_write_set(splash, SPLASH_STEP_SET + i, i, NULL);
    splash->info = NULL;
    splash->spawns = VK_NULL_HANDLE; /* the host owns it and may destroy it */
    splash_first_contents(splash, cmd, splash->step_sets[0]);
    virga_effect_reads(&splash->base, cmd, info->spawns);
    virga_effect_reads(&splash->base, cmd, info->leavers);
    virga_effect_reads(&splash->base, cmd, info->leaver_table);
    virga_effect_reads(&splash->base, cmd, info->floors.floors);
    remember(splash);
    follow(splash, cmd, info);
    for (uint32_t i = 0; i < info->ticks; i++)
        run_tick(splash, cmd, info, i);
    if (info->ticks)
        over(splash, cmd, splash->alive, offsetof(virga_splash_state_gpu, splash_groups));
    splash_spray_record(splash, cmd, info);
    virga_effect_copy_statistics(&splash->base, cmd, SPLASH_PART_STEP, splash->state, 0,
                                 offsetof(splash_readback, state), sizeof(virga_splash_state_gpu));
    const virga_result uploaded = virga_recording_result(context);
    return uploaded ? uploaded : changed ? VIRGA_DEGRADED : VIRGA_OK;
}
