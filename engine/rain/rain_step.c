/* rain/rain_step.c - ticks: where the drops are, and which of them met something. */
#include "rain/rain_internal.h"

#include "core/settings.h"
#include "gpu/builds.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <math.h>
#include <string.h>

#define MOST_STEP_S 10.0

uint32_t rain_tick_bytes(void)
{
    return (uint32_t)((sizeof(rain_tick_block) + VIRGA_RING_ALIGNMENT - 1) / VIRGA_RING_ALIGNMENT *
                      VIRGA_RING_ALIGNMENT);
}

/* ---- a frame's start */

static void take_slot(virga_rain *rain, uint32_t slot)
{
    rain_frame_stats *frame = &rain->frame_stats[slot];
    rain_readback read;
    memcpy(&read, (const char *)rain->readback_ring->memory.block.mapped + slot * sizeof read, sizeof read);
    virga_rain_stats *stats = &rain->stats;
    stats->frame_index = frame->frame_index;
    stats->slots = rain->slots;
    if (frame->prepared)
        stats->streaks = read.prepared.streaks;
    const bool stepped = frame->stepped;
    if (stepped) {
        stats->time_s = frame->time_s;
        stats->ticks = frame->ticks;
        stats->impacts = frame->ticks ? read.impacts.count : 0;
        stats->impacts_dropped = frame->ticks ? read.impacts.dropped : 0;
        stats->impact_water_nl =
            frame->ticks ? (uint64_t)read.impacts.water_nl_high << 32 | read.impacts.water_nl_low : 0;
        stats->total_water_nl += stats->impact_water_nl;
        memcpy(stats->wind_m_s, frame->wind_m_s, sizeof stats->wind_m_s);
    }
    if (stepped && stats->impacts_dropped)
        virga_log_say(&rain->context->log, VIRGA_LOG_WARNING, VIRGA_LOG_IMPACTS_DROPPED,
                      "%u impacts of a step found no room; max_impacts is %u", stats->impacts_dropped,
                      rain->def.max_impacts);
    memset(frame, 0, sizeof *frame);
}

/* Takes in what completed frames have left in the ring, oldest first. */
void rain_take_statistics(virga_rain *rain)
{
    const virga_context *context = rain->context;
    virga_buffer_invalidate(rain->context, rain->readback_ring);
    for (;;) {
        uint32_t oldest = VIRGA_MAX_FRAMES_IN_FLIGHT;
        for (uint32_t i = 0; i < context->frames_in_flight; i++) {
            const uint64_t index = rain->frame_stats[i].frame_index;
            if (index && index <= context->completed_index &&
                (oldest == VIRGA_MAX_FRAMES_IN_FLIGHT || index < rain->frame_stats[oldest].frame_index))
                oldest = i;
        }
        if (oldest == VIRGA_MAX_FRAMES_IN_FLIGHT)
            return;
        take_slot(rain, oldest);
    }
}

/* Images that nothing has been drawn into yet get the layout that descriptors promise. */
static void first_layouts(virga_rain *rain, VkCommandBuffer cmd)
{
    const virga_image_state before = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0};
    const virga_image_state after = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                     VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                     VK_ACCESS_SHADER_READ_BIT};
    virga_mesh_map_first_layouts(rain->context, cmd, rain->map);
    virga_image_barrier(rain->context, cmd, rain->blank->image, VK_IMAGE_ASPECT_DEPTH_BIT, before, after);
    virga_image_barrier(rain->context, cmd, rain->blank_wind->image, VK_IMAGE_ASPECT_COLOR_BIT, before, after);
}

static void upload_tables(virga_rain *rain, VkCommandBuffer cmd)
{
    virga_context *context = rain->context;
    const VkBufferCopy slots = {0, 0, rain->slot_buffer->size};
    context->vk.CmdCopyBuffer(cmd, rain->slot_upload->buffer, rain->slot_buffer->buffer, 1, &slots);
    if (rain->sway_buffer)
        context->vk.CmdFillBuffer(cmd, rain->sway_buffer->buffer, 0, VK_WHOLE_SIZE, 0);
    context->vk.CmdFillBuffer(cmd, rain->impact_buffer->buffer, 0, sizeof(virga_impacts_gpu), 0);
    context->vk.CmdFillBuffer(cmd, rain->prepared_buffer->buffer, 0, VK_WHOLE_SIZE, 0);
    virga_barrier(
        context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
        READ_WRITE | VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    /* The staging buffer waits in the graveyard until this frame has completed. */
    VIRGA_RETIRE(context, rain->slot_upload);
}

void rain_begin_frame(virga_rain *rain, VkCommandBuffer cmd)
{
    virga_context *context = rain->context;
    virga_timers_reset(context, cmd);
    if (!rain->images_ready) {
        first_layouts(rain, cmd);
        upload_tables(rain, cmd);
        rain->images_ready = true;
    }
    if (rain->ring_frame == context->frame_index)
        return;
    rain->ring_frame = context->frame_index;
    rain->ring_ticks = 0;
    rain->ring_views = 0;
    rain_take_statistics(rain);
}

/* ---- a tick */

static void split64(int64_t value, uint32_t *low, uint32_t *high)
{
    *low = (uint32_t)(uint64_t)value;
    *high = (uint32_t)((uint64_t)value >> 32);
}

static void fill_classes(const virga_rain *rain, rain_tick_block *block)
{
    const double unit = 4294967296.0 / rain->classes->side_m;
    int64_t camera[3];
    for (int axis = 0; axis < 3; axis++)
        camera[axis] = llround(rain->origin[axis] * unit);
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        const rain_class *c = &rain->classes->classes[k];
        virga_class_gpu *out = &block->tables.classes[k];
        virga_travel_gpu *travel = &block->travels[k];
        memset(travel, 0, sizeof *travel);
        for (int axis = 0; axis < 3; axis++) {
            split64(c->travel[axis] - camera[axis], &travel->low[axis], &travel->high[axis]);
            out->velocity[axis] = (float)c->velocity[axis];
        }
        out->drag = (float)c->drag;
        out->diameter_m = (float)c->diameter_m;
        out->terminal_m_s = (float)c->terminal_m_s;
        out->slant = rain_class_slant(rain, c->diameter_m);
    }
    memcpy(block->weights, rain->classes->weights, sizeof block->weights);
}

static void fill_wind(const virga_rain *rain, virga_tick_gpu *tick)
{
    const virga_rain_settings *settings = &rain->settings;
    tick->sway = rain->sway_on;
    tick->wind_given = settings->wind_texture != NULL;
    for (int axis = 0; axis < 3; axis++) {
        tick->wind_mean[axis] = (float)rain->wind_now[axis];
        tick->wind_min[axis] = (float)(settings->wind_min_m[axis] - rain->origin[axis]);
        const double size = settings->wind_max_m[axis] - settings->wind_min_m[axis];
        tick->wind_scale[axis] = size > 0 ? (float)(1 / size) : 0;
    }
}

static void fill_tick(const virga_rain *rain, uint32_t tick_in_step, rain_tick_block *block)
{
    virga_tick_gpu *tick = &block->tables.tick;
    memset(tick, 0, sizeof *tick);
    for (int axis = 0; axis < 3; axis++)
        tick->origin[axis] = (float)rain->origin[axis];
    tick->side_m = (float)rain->classes->side_m;
    tick->levels = rain->levels;
    tick->levels_per_group = 1 / (float)rain->groups_per_level;
    tick->groups = rain->groups;
    tick->seed = rain->def.seed;
    tick->tick = (uint32_t)rain->ticks;
    tick->tick_s = (float)rain->def.tick_s;
    tick->tick_in_step = tick_in_step;
    tick->max_impacts = rain->def.max_impacts;
    tick->maps = rain->map_count;
    tick->slants = rain->def.occlusion_slants;
    tick->cascades = rain->def.occlusion_cascades;
    tick->default_material = rain->settings.default_material;
    tick->host_depth = rain->host_maps;
    tick->gravity = (float)VIRGA_GRAVITY;
    fill_wind(rain, tick);
    rain_fill_maps(rain, tick, block->tables.maps);
    fill_classes(rain, block);
}

/* Writes the block of a tick at a place of the frame's ring and points the dynamic offset at it. */
static void write_tick(virga_rain *rain, uint32_t place, uint32_t tick_in_step)
{
    const uint32_t per_frame = rain->def.max_ticks_per_step + 1;
    rain->tick_offset = (rain->context->ring_slot * per_frame + place) * rain_tick_bytes();
    rain->tick_frame = rain->context->frame_index;
    fill_tick(rain, tick_in_step,
              (rain_tick_block *)((char *)rain->tick_ring->memory.block.mapped + rain->tick_offset));
    virga_buffer_flush(rain->context, rain->tick_ring, rain->tick_offset, rain_tick_bytes());
}

static void push_tick(virga_rain *rain, uint32_t tick_in_step)
{
    write_tick(rain, rain->ring_ticks++, tick_in_step);
}

/* Behind those of steps, so that a step after it in the frame has all of its own. */
void rain_keep_tick(virga_rain *rain)
{
    if (rain->tick_frame != rain->context->frame_index)
        write_tick(rain, rain->def.max_ticks_per_step, 0);
}

static void record_tick(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set)
{
    virga_context *context = rain->context;
    rain_bind(rain, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, set);
    virga_pass_scope scope;
    if (rain->sway_on) {
        scope = virga_pass_begin(context, cmd, "rain.sway");
        virga_dispatch(context, cmd, rain->sway, rain->groups);
        virga_compute_barrier(context, cmd);
        virga_pass_end(context, cmd, scope);
    }
    scope = virga_pass_begin(context, cmd, "rain.step");
    virga_dispatch(context, cmd, rain->step, rain->groups);
    virga_compute_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
    scope = virga_pass_begin(context, cmd, "rain.impacts");
    const VkBuffer list = rain->list_buffer->buffer;
    virga_record_list(context, cmd, rain->impact_near, rain->impact_near_scan, rain->list, rain->groups);
    virga_dispatch_indirect_and_barrier(context, cmd, rain->impact_find, list, 0);
    virga_dispatch_and_barrier(context, cmd, rain->impact_scan, 1);
    virga_dispatch_indirect(context, cmd, rain->impact_write, list, 0);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, READ_WRITE);
    virga_pass_end(context, cmd, scope);
}

/* The state of the field at the newest tick, seen from a new place: no time passes, nothing lands. */
static void record_refresh(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set)
{
    virga_context *context = rain->context;
    push_tick(rain, 0);
    rain_bind(rain, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, set);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "rain.step");
    virga_dispatch(context, cmd, rain->step, rain->groups);
    virga_compute_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

static void advance(virga_rain *rain)
{
    rain_wind_tick(&rain->wind, rain->def.tick_s, (double)rain->settings.gust_time_s);
    rain_wind_at(&rain->wind, &rain->settings, rain->def.seed, rain->wind_now);
    rain_classes_tick(rain->classes, rain->wind_now, rain->def.tick_s);
    rain_occlusion_tick(rain);
    rain->ticks++;
}

/* Whole ticks that host time completes; the rest is kept, or dropped where a step can not run that many. */
static uint32_t take_ticks(virga_rain *rain, double dt_s, bool *dropped)
{
    rain->left_over_s += dt_s;
    /* A tick that is short by rounding alone counts, or 1/24 s at a tick of 1/48 s would run 1, 2, 3, 2, ... */
    double whole = floor(rain->left_over_s / rain->def.tick_s + 1e-9);
    if (whole > rain->def.max_ticks_per_step - rain->ring_ticks) {
        whole = rain->def.max_ticks_per_step - rain->ring_ticks;
        virga_log_say(&rain->context->log, VIRGA_LOG_WARNING, VIRGA_LOG_TICKS_DROPPED,
                      "a step of %g s at ticks of %g s: only %g are run (max_ticks_per_step)", dt_s, rain->def.tick_s,
                      whole);
        rain->left_over_s = whole * rain->def.tick_s;
        *dropped = true;
    }
    rain->left_over_s -= whole * rain->def.tick_s;
    rain->left_over_s = rain->left_over_s < 0 ? 0 : rain->left_over_s;
    return (uint32_t)whole;
}

static virga_result check_step(virga_rain *rain, VkCommandBuffer cmd, const virga_rain_step_info *info)
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &rain->context->log;
    if (!cmd || !info)
        return virga_wrong_argument(log, "virga_rain_step: NULL argument");
    if (rain->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!rain->context->frame_index)
        return virga_wrong_argument(log, "virga_rain_step: expected virga_frame_begin before it");
    if (virga_settings_places(log, "step_info.camera_m", info->camera_m, 3))
        return VIRGA_ERROR_INVALID;
    if (!(info->dt_s >= 0 && info->dt_s <= MOST_STEP_S))
        return virga_wrong_argument(log, "step_info.dt_s: expected 0 to 10 s, got %g", info->dt_s);
    if (rain->ring_frame == rain->context->frame_index && rain->ring_ticks >= rain->def.max_ticks_per_step)
        return virga_wrong_argument(log, "virga_rain_step: this frame has run all of max_ticks_per_step");
    return virga_group_ready(&rain->needed);
}

/* Copies the heads of the buffers to where the host reads them when the frame has completed. */
static void record_impact_readback(virga_rain *rain, VkCommandBuffer cmd)
{
    virga_context *context = rain->context;
    const VkBufferCopy copy = {0, context->ring_slot * sizeof(rain_readback), sizeof(virga_impacts_gpu)};
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                      VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                  VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_READ_BIT |
                      VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
    context->vk.CmdCopyBuffer(cmd, rain->impact_buffer->buffer, rain->readback_ring->buffer, 1, &copy);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

virga_result virga_rain_step(virga_rain *rain, VkCommandBuffer cmd, const virga_rain_step_info *info)
{
    const virga_result result = check_step(rain, cmd, info);
    if (result)
        return result;
    virga_context *context = rain->context;
    rain_begin_frame(rain, cmd);
    for (int axis = 0; axis < 3; axis++)
        rain->origin[axis] = (double)(float)info->camera_m[axis];
    if (rain->step_set_frame != context->frame_index) {
        rain->step_set = rain_write_set(rain, RAIN_STEP_SET, NULL);
        rain->step_set_frame = context->frame_index;
    }
    const VkDescriptorSet set = rain->step_set;

    /* Passes and copies of the frame before may still read what this one writes. */
    virga_barrier(context, cmd,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                      VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, READ_WRITE);
    bool dropped = false;
    const uint32_t ticks = take_ticks(rain, info->dt_s, &dropped);
    for (uint32_t i = 0; i < ticks; i++) {
        advance(rain);
        push_tick(rain, i);
        record_tick(rain, cmd, set);
    }
    if (!ticks)
        record_refresh(rain, cmd, set);
    rain->stepped = true;
    record_impact_readback(rain, cmd);
    rain_frame_stats *frame = &rain->frame_stats[context->ring_slot];
    frame->frame_index = context->frame_index;
    frame->stepped = true;
    frame->time_s = virga_rain_time(rain);
    frame->ticks = ticks;
    rain->ticks_of_step = ticks;
    for (int axis = 0; axis < 3; axis++)
        frame->wind_m_s[axis] = (float)rain->wind_now[axis];
    const virga_result uploaded = virga_uploaded(context);
    return uploaded ? uploaded : dropped ? VIRGA_DEGRADED : VIRGA_OK;
}

virga_result virga_rain_points(virga_rain *rain, VkCommandBuffer cmd, virga_rain_buffer *points, uint32_t *count,
                               double origin_m[3])
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    virga_context *context = rain->context;
    if (!cmd || !points || !count || !origin_m)
        return virga_wrong_argument(&context->log, "virga_rain_points: NULL argument");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!rain->point_buffer || !rain->stepped || rain->step_set_frame != context->frame_index)
        return VIRGA_NOT_READY;
    virga_barrier(context, cmd,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                      VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, READ_WRITE);
    rain_bind(rain, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, rain->step_set);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "rain.points");
    virga_dispatch(context, cmd, rain->points, rain->groups);
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                      VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT);
    virga_pass_end(context, cmd, scope);
    *points = (virga_rain_buffer){rain->point_buffer->buffer, 0, rain->point_buffer->size};
    *count = rain->slots;
    memcpy(origin_m, rain->origin, sizeof rain->origin);
    return VIRGA_OK;
}

double virga_rain_time(const virga_rain *rain)
{
    return rain ? (double)rain->ticks * rain->def.tick_s + rain->left_over_s : 0;
}

void virga_rain_ticks(const virga_rain *rain, uint32_t *first, uint32_t *count)
{
    const uint32_t run = rain ? rain->ticks_of_step : 0;
    if (count)
        *count = run;
    if (first)
        *first = rain ? (uint32_t)rain->ticks - (run ? run - 1 : 0) : 0;
}

void virga_rain_fall_get(const virga_rain *rain, virga_rain_fall *fall)
{
    if (!fall)
        return;
    *fall = (virga_rain_fall){0};
    if (!rain)
        return;
    double squares = 0, cubes = 0;
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        const rain_class *c = &rain->classes->classes[k];
        const double landing = rain->classes->per_m3[k] * c->terminal_m_s * c->diameter_m * c->diameter_m;
        squares += landing;
        cubes += landing * c->diameter_m;
    }
    fall->rate_mm_h = (float)rain->classes->rate_mm_h;
    fall->reach_m = rain->def.range_m;
    fall->drop_m = squares > 0 ? (float)(cubes / squares) : 0;
}

void virga_rain_wind(const virga_rain *rain, float wind_m_s[3])
{
    for (int axis = 0; wind_m_s && axis < 3; axis++)
        wind_m_s[axis] = rain ? (float)rain->wind_now[axis] : 0;
}
