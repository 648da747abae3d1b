/* splash/splash_step.c - a step: spawns become splashes, droplets fly, and what fell is given back. */
#include "splash/splash_internal.h"

#include "core/settings.h"
#include "gpu/builds.h"
#include "gpu/checks.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <math.h>
#include <string.h>

#define ANCHOR_M 64.0 /* anchors lie on multiples of it: floats around them are exact to some micrometres */

static uint32_t ring_bytes(size_t size)
{
    return (uint32_t)((size + VIRGA_RING_ALIGNMENT - 1) / VIRGA_RING_ALIGNMENT * VIRGA_RING_ALIGNMENT);
}

uint32_t splash_tick_bytes(void)
{
    return ring_bytes(sizeof(virga_splash_tick_gpu));
}

uint32_t splash_rules_bytes(void)
{
    return ring_bytes(sizeof(virga_splash_rules_gpu));
}

/* ---- statistics */

static uint64_t count_of(const virga_splash_state_gpu *state, uint32_t index)
{
    return (uint64_t)state->counts[index].high << 32 | state->counts[index].low;
}

static void take_state(virga_splash *splash, uint32_t slot)
{
    virga_splash_state_gpu state;
    const char *mapped = splash->readback_ring->memory.block.mapped;
    memcpy(&state, mapped + slot * sizeof(splash_readback), sizeof state);
    virga_splash_stats *stats = &splash->stats;
    stats->frame_index = splash->frame_of_slot[slot];
    for (uint32_t model = 0; model < VIRGA_SPLASH_MODELS; model++)
        for (uint32_t material = 0; material < VIRGA_GROUND_MATERIALS; material++)
            stats->splashes[model][material] =
                count_of(&state, VIRGA_SPLASH_BY_MODEL + model * VIRGA_SPLASH_MATERIALS + material);
    stats->droplets = count_of(&state, VIRGA_SPLASH_DROPLETS);
    stats->fallen = count_of(&state, VIRGA_SPLASH_FALLEN);
    stats->flown_nl = count_of(&state, VIRGA_SPLASH_FLOWN);
    stats->returned_nl = count_of(&state, VIRGA_SPLASH_RETURNED);
    stats->crowded = count_of(&state, VIRGA_SPLASH_CROWDED);
    stats->splashes_alive = state.end_splash - state.first_splash;
    stats->droplets_alive = state.staying;
    splash->frame_of_slot[slot] = 0;
}

static void take_states(virga_splash *splash)
{
    const virga_context *context = splash->context;
    for (;;) {
        uint32_t oldest = VIRGA_MAX_FRAMES_IN_FLIGHT;
        for (uint32_t i = 0; i < context->frames_in_flight; i++) {
            const uint64_t frame = splash->frame_of_slot[i];
            if (frame && frame <= context->completed_index &&
                (oldest == VIRGA_MAX_FRAMES_IN_FLIGHT || frame < splash->frame_of_slot[oldest]))
                oldest = i;
        }
        if (oldest == VIRGA_MAX_FRAMES_IN_FLIGHT)
            break;
        take_state(splash, oldest);
    }
}

/* A frame may draw without a step, so what prepares found is taken apart from it: the newest. */
static void take_prepared(virga_splash *splash)
{
    uint64_t newest = 0;
    for (uint32_t i = 0; i < splash->context->frames_in_flight; i++) {
        const uint64_t frame = splash->prepared_of_slot[i];
        if (frame <= newest || frame > splash->context->completed_index)
            continue;
        newest = frame;
        virga_splash_prepared_gpu found;
        const char *mapped = splash->readback_ring->memory.block.mapped;
        memcpy(&found, mapped + i * sizeof(splash_readback) + offsetof(splash_readback, prepared), sizeof found);
        splash->stats.sprites = found.sprites;
        splash->stats.sprites_cut = found.cut[0];
        splash->stats.sheets_cut = found.cut[1];
    }
}

void splash_take_statistics(virga_splash *splash)
{
    virga_buffer_invalidate(splash->context, splash->readback_ring);
    take_states(splash);
    take_prepared(splash);
}

static void record_readback(virga_splash *splash, VkCommandBuffer cmd)
{
    virga_context *context = splash->context;
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    const VkBufferCopy copy = {0, context->ring_slot * sizeof(splash_readback), sizeof(virga_splash_state_gpu)};
    context->vk.CmdCopyBuffer(cmd, splash->state->buffer, splash->readback_ring->buffer, 1, &copy);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    splash->frame_of_slot[context->ring_slot] = context->frame_index;
}

void splash_record_prepared(virga_splash *splash, VkCommandBuffer cmd)
{
    virga_context *context = splash->context;
    const VkBufferCopy copy = {0, context->ring_slot * sizeof(splash_readback) + offsetof(splash_readback, prepared),
                               sizeof(virga_splash_prepared_gpu)};
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    context->vk.CmdCopyBuffer(cmd, splash->prepared_buffer->buffer, splash->readback_ring->buffer, 1, &copy);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_HOST_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    splash->prepared_of_slot[context->ring_slot] = context->frame_index;
}

/* ---- ticks */

static void push_tick(virga_splash *splash, const virga_splash_step_info *info, uint32_t tick_in_step,
                      const double shift[3])
{
    const virga_splash_settings *settings = &splash->settings;
    const uint32_t per_frame = splash->def.max_ticks_per_step + 1;
    const uint32_t place = splash->context->ring_slot * per_frame + splash->ring_ticks++;
    splash->tick_offset = place * splash_tick_bytes();
    char *mapped = splash->tick_ring->memory.block.mapped;
    virga_splash_tick_gpu *out = (virga_splash_tick_gpu *)(mapped + splash->tick_offset);
    *out = (virga_splash_tick_gpu){.tick = info->first_tick + tick_in_step,
                                   .tick_in_step = tick_in_step,
                                   .tick_s = (float)splash->def.tick_s,
                                   .air_density = settings->air_density,
                                   .bounce = settings->bounce,
                                   .pile_s = settings->pile_s,
                                   .pile_m = settings->pile_m,
                                   .max_splashes = splash->def.max_splashes,
                                   .max_droplets = splash->def.max_droplets,
                                   .max_returns = splash->def.max_returns,
                                   .max_spawns = splash->def.max_spawns};
    for (int axis = 0; axis < 3; axis++) {
        out->anchor[axis] = (float)splash->anchor_m[axis];
        out->shift[axis] = (float)shift[axis];
        out->wind[axis] = settings->wind_share * info->wind_m_s[axis];
    }
    virga_buffer_flush(splash->context, splash->tick_ring, splash->tick_offset, splash_tick_bytes());
}

/* As large as a scan before it has written at `groups` in the state. */
static void over(virga_splash *splash, VkCommandBuffer cmd, const virga_pipeline *pipeline, size_t groups)
{
    virga_dispatch_indirect_and_barrier(splash->context, cmd, pipeline, splash->state->buffer, groups);
}

static void run_tick(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info, uint32_t i)
{
    virga_context *context = splash->context;
    const double still[3] = {0, 0, 0};
    push_tick(splash, info, i, still);
    splash_bind(splash, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, splash->step_sets[splash_current(splash)]);
    virga_pass_scope scope = virga_pass_begin(context, cmd, "splash.spawn");
    virga_dispatch_and_barrier(splash->context, cmd, splash->spawn_scan, 1);
    over(splash, cmd, splash->spawn, offsetof(virga_splash_state_gpu, spawn_groups));
    virga_pass_end(context, cmd, scope);
    scope = virga_pass_begin(context, cmd, "splash.step");
    over(splash, cmd, splash->step, offsetof(virga_splash_state_gpu, droplet_groups));
    virga_dispatch_and_barrier(splash->context, cmd, splash->fall_scan, 1);
    over(splash, cmd, splash->fall, offsetof(virga_splash_state_gpu, fall_groups));
    virga_pass_end(context, cmd, scope);
    splash->droplets = splash->droplet_buffers[splash_current(splash) ^ 1];
    splash->ticks++;
    splash->last_tick = info->first_tick + i;
}

/* Positions count from an anchor that follows the camera in wide steps. */
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
        const uint32_t most =
            splash->def.max_droplets > splash->def.max_splashes ? splash->def.max_droplets : splash->def.max_splashes;
        push_tick(splash, info, 0, shift);
        splash_bind(splash, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, splash->step_sets[splash_current(splash)]);
        virga_dispatch_and_barrier(splash->context, cmd, splash->rebase,
                                   (most + VIRGA_SPLASH_GROUP - 1) / VIRGA_SPLASH_GROUP);
    }
    splash->anchored = true;
}

/* ---- a step */

static void write_indices(virga_splash *splash, VkCommandBuffer cmd)
{
    virga_context *context = splash->context;
    const uint32_t sprites = splash_max_sprites(&splash->def);
    splash_bind(splash, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, splash->step_sets[0]);
    context->vk.CmdPushConstants(cmd, splash->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof sprites, &sprites);
    virga_dispatch(context, cmd, splash->indices, 1024);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                  VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, VK_ACCESS_INDEX_READ_BIT);
}

static void first_contents(virga_splash *splash, VkCommandBuffer cmd)
{
    virga_context *context = splash->context;
    const virga_image_state before = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0};
    const virga_image_state after = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                     VK_ACCESS_SHADER_READ_BIT};
    virga_image_barrier(context, cmd, splash->blank_depth->image, VK_IMAGE_ASPECT_DEPTH_BIT, before, after);
    virga_image_barrier(context, cmd, splash->blank_color->image, VK_IMAGE_ASPECT_COLOR_BIT, before, after);
    write_indices(splash, cmd);
    virga_buffer *const zero[] = {
        splash->state, splash->splashes, splash->droplet_buffers[0], splash->droplet_buffers[1],
        splash->marks, splash->returns};
    for (size_t i = 0; i < sizeof zero / sizeof zero[0]; i++)
        context->vk.CmdFillBuffer(cmd, zero[i]->buffer, 0, VK_WHOLE_SIZE, 0);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                  READ_WRITE | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
    splash->started = true;
}

static virga_result check_step(const virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info)
{
    if (!splash)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &splash->context->log;
    if (!cmd || !info || !info->spawns)
        return virga_wrong_argument(log, "virga_splash_step: NULL argument");
    if (splash->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!splash->context->frame_index)
        return virga_wrong_argument(log, "virga_splash_step: expected virga_frame_begin before it");
    if (splash->ring_frame == splash->context->frame_index)
        return virga_wrong_argument(log, "virga_splash_step: expected one step a frame");
    if (info->ticks > splash->def.max_ticks_per_step)
        return virga_wrong_argument(log, "step_info.ticks: expected up to max_ticks_per_step = %u, got %u",
                                    splash->def.max_ticks_per_step, info->ticks);
    if (virga_ticks_check(log, info->first_tick, info->ticks, splash->ticks ? &splash->last_tick : NULL) ||
        virga_settings_places(log, "step_info.camera_m", info->camera_m, 3) ||
        virga_settings_finite(log, "step_info.wind_m_s", info->wind_m_s, 3) ||
        virga_host_list_check(splash->context, "step_info.spawns", info->spawns_offset, info->spawns_size,
                              sizeof(virga_spawns_gpu)))
        return VIRGA_ERROR_INVALID;
    return virga_group_ready(&splash->needed);
}

virga_result virga_splash_step(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *given)
{
    const virga_result result = check_step(splash, cmd, given);
    if (result)
        return result;
    bool changed = false;
    virga_splash_step_info taken = *given;
    const virga_splash_step_info *info = &taken;
    virga_clamp_vector(&splash->context->log, "step_info.wind_m_s", taken.wind_m_s, VIRGA_FASTEST_M_S, &changed);
    virga_context *context = splash->context;
    virga_timers_reset(context, cmd);
    splash_take_statistics(splash);
    splash_push_rules(splash);
    splash->ring_frame = context->frame_index;
    splash->ring_ticks = 0;
    splash->prepared = false;
    splash->spawns = info->spawns;
    splash->spawns_offset = info->spawns_offset;
    splash->spawns_range = virga_host_list_range(
        context, info->spawns_size, sizeof(virga_spawns_gpu) + splash->def.max_spawns * sizeof(virga_spawn_gpu));
    for (uint32_t i = 0; i < 2; i++)
        splash->step_sets[i] = splash_write_set(splash, SPLASH_STEP_SET + i, i, NULL);
    splash->spawns = VK_NULL_HANDLE; /* the host's, and not to be looked at again */
    /* What read splashes and droplets in the frame before is done with them; the ground may still read the returns. */
    virga_barrier(context, cmd,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                      VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT |
                      VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT |
                      VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                  READ_WRITE | VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
    if (!splash->started)
        first_contents(splash, cmd);
    follow(splash, cmd, info);
    for (uint32_t i = 0; i < info->ticks; i++)
        run_tick(splash, cmd, info, i);
    record_readback(splash, cmd);
    const virga_result uploaded = virga_uploaded(context);
    return uploaded ? uploaded : changed ? VIRGA_DEGRADED : VIRGA_OK;
}
