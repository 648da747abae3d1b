/* rain/rain_step.c - ticks: moves the drops, and finds those that hit something. */
#include "rain/rain_internal.h"

#include "core/settings.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <math.h>
#include <string.h>

#define MAX_STEP_S 10.0

/* ---- the start of a frame */

static void read_step(virga_rain *rain, const rain_frame_stats *frame, const rain_readback *read)
{
    const virga_impacts_gpu *impacts = &read->impacts;
    virga_rain_stats *stats = &rain->stats;
    stats->time_s = frame->time_s;
    stats->ticks = frame->ticks;
    stats->impacts = frame->ticks ? impacts->count : 0;
    stats->impacts_dropped = frame->ticks ? impacts->dropped : 0;
    stats->impact_water_nl = frame->ticks ? (uint64_t)impacts->water_nl_high << 32 | impacts->water_nl_low : 0;
    stats->total_water_nl = ((uint64_t)read->total.nl_high << 32 | read->total.nl_low) +
                            ((uint64_t)impacts->water_nl_high << 32 | impacts->water_nl_low);
    memcpy(stats->wind_m_s, frame->wind_m_s, sizeof stats->wind_m_s);
    if (stats->impacts_dropped)
        virga_log_write(&rain->base.context->log, VIRGA_LOG_WARNING, VIRGA_LOG_IMPACTS_DROPPED,
                        "%u impacts of a step found no room; max_impacts is %u", stats->impacts_dropped,
                        rain->def.max_impacts);
}

static void read_views(virga_rain_stats *stats, uint32_t views, const virga_prepared_gpu *prepared)
{
    stats->views = views;
    for (uint32_t i = 0; i < VIRGA_MAX_VIEWS; i++)
        stats->view_streaks[i] = i < views ? prepared[i].streaks : 0;
    stats->streaks = prepared[views - 1].streaks;
}

#define UNSEEN_S 3.0 /* time of rain in which some drop is visible to any camera that is in it */

/* The usual causes are a camera in other units or axes than the rain's, or one that is closed in by occluders. Such
 * rain looks as if it did not work. */
static void log_unseen(virga_rain *rain, uint32_t view)
{
    if (rain->unseen_logged)
        return;
    virga_log_write(&rain->base.context->log, VIRGA_LOG_WARNING, VIRGA_LOG_NOT_DRAWN,
                    "rain: in view %u of %u of a frame no drop was visible in %.0f s of rain: is the camera where "
                    "camera_m is, in metres with Y up (virga/world.h), and under the open sky?",
                    view + 1, rain->stats.views, UNSEEN_S);
    rain->unseen_logged = true;
}

/* Each view counts by itself: one half of a split screen may be wrong. Only time in frames with views counts. */
static void count_unseen(virga_rain *rain, bool has_views)
{
    const virga_rain_stats *stats = &rain->stats;
    const double passed = stats->time_s - rain->unseen_at_s;
    rain->unseen_at_s = stats->time_s;
    for (uint32_t i = 0; i < VIRGA_MAX_VIEWS && has_views; i++) {
        const bool seen = i >= stats->views || stats->view_streaks[i] || !(rain->classes->rate_mm_h > 0);
        rain->unseen_s[i] = seen || passed < 0 ? 0 : rain->unseen_s[i] + passed;
        if (rain->unseen_s[i] >= UNSEEN_S)
            log_unseen(rain, i);
    }
}

void rain_read_statistics(void *object, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data)
{
    virga_rain *rain = object;
    rain_readback read;
    memcpy(&read, data, sizeof read);
    rain->stats.frame_index = frame;
    rain->stats.slots = rain->slots;
    if (parts & 1u << RAIN_PART_PREPARE)
        read_views(&rain->stats, rain->base.readback_views[ring_slot], read.prepared);
    if (parts & 1u << RAIN_PART_STEP)
        read_step(rain, &rain->frame_stats[ring_slot], &read);
    count_unseen(rain, parts & 1u << RAIN_PART_PREPARE);
}

/* Drops are where the time says, whatever was lost. Without maps rain falls everywhere until they are drawn again. */
void rain_lost(void *object, uint64_t frame, uint32_t did)
{
    virga_rain *rain = object;
    (void)frame;
    if (did & 1u << RAIN_PART_STEP)
        rain->stepped = false;
    if (!(did & RAIN_DID_MAPS))
        return;
    rain->maps_drawn = false;
    rain->map_count = rain->host_maps ? rain->map_count : 0;
}

void rain_state_loaded(void *object)
{
    virga_rain *rain = object;
    rain->stepped = false;
    if (rain->host_maps)
        return;
    rain->maps_loaded = rain->map_count > 0;
    rain->maps_drawn = false;
    rain->map_count = 0;
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

static void push_tick(virga_rain *rain, uint32_t tick_in_step)
{
    rain_tick_block block;
    fill_tick(rain, tick_in_step, &block);
    rain->tick_frame = rain->base.context->frame_index;
    rain->tick_offset = virga_ring_push(rain->base.context, &rain->tick_ring, &block, sizeof block);
}

/* It has its own block after those of the ticks, so that a later step in this frame still has all of them. */
void rain_keep_tick(virga_rain *rain)
{
    rain_tick_block block;
    virga_context *context = rain->base.context;
    if (rain->tick_frame == context->frame_index)
        return;
    fill_tick(rain, 0, &block);
    rain->tick_frame = context->frame_index;
    rain->tick_offset = virga_ring_write(context, &rain->tick_ring, rain->def.max_ticks_per_step, &block, sizeof block);
}

static void record_tick(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set)
{
    virga_context *context = rain->base.context;
    rain_bind(rain, cmd, set);
    virga_pass_scope scope;
    if (rain->sway_on) {
        scope = virga_pass_begin(context, cmd, "rain.wind");
        virga_dispatch(context, cmd, rain->sway, rain->groups);
        virga_compute_barrier(context, cmd);
        virga_pass_end(context, cmd, scope);
    }
    scope = virga_pass_begin(context, cmd, "rain.step");
    virga_dispatch(context, cmd, rain->move, rain->groups);
    virga_compute_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
    scope = virga_pass_begin(context, cmd, "rain.impacts");
    const VkBuffer list = rain->list_buffer->buffer;
    virga_record_list(context, cmd, rain->impact_near_mark, rain->impact_near_scan, rain->compact, rain->groups);
    virga_dispatch_indirect_and_barrier(context, cmd, rain->impact_mark, list, 0);
    virga_dispatch_and_barrier(context, cmd, rain->impact_scan, 1);
    virga_dispatch_indirect(context, cmd, rain->impact_write, list, 0);
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_ARGUMENTS, VIRGA_PASSES);
    virga_pass_end(context, cmd, scope);
}

/* Recomputes the newest tick relative to a new origin. No time passes, and no drop lands. */
static void record_refresh(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set)
{
    virga_context *context = rain->base.context;
    push_tick(rain, 0);
    rain_bind(rain, cmd, set);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "rain.step");
    virga_dispatch(context, cmd, rain->move, rain->groups);
    virga_compute_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

static void advance(virga_rain *rain)
{
    rain_wind_tick(&rain->wind, rain->def.tick_s, (double)rain->settings.gust_time_s);
    rain_wind_at(&rain->wind, &rain->settings, rain->def.seed, rain->wind_now);
    rain_classes_tick(rain->classes, rain->wind_now, rain->def.tick_s);
    rain_occlusion_tick(rain);
    if (rain->settings.walls.on && !rain->ticks)
        rain_walls_begin(&rain->walls, rain->classes, &rain->settings);
    if (rain->settings.walls.on)
        rain_walls_tick(&rain->walls, rain->classes, &rain->settings, rain->def.tick_s);
    rain->ticks++;
}

/* The number of whole ticks in the host's time. The rest is left for the next step, or dropped if a step may not run
 * that many ticks. */
static uint32_t whole_ticks(virga_rain *rain, const virga_rain_step_info *info, bool *dropped)
{
    const bool limited = info->max_ticks && info->max_ticks < rain->def.max_ticks_per_step;
    const uint32_t max = limited ? info->max_ticks : rain->def.max_ticks_per_step;
    rain->left_over_s += info->dt_s;
    /* Ticks that are short only by rounding count. Otherwise 1/24 s with ticks of 1/48 s would run 1, 2, 3, 2, ... */
    double whole = floor(rain->left_over_s / rain->def.tick_s + 1e-9);
    if (whole > max) {
        rain->stats.ticks_dropped += (uint64_t)whole - max;
        whole = max;
        virga_log_write(&rain->base.context->log, VIRGA_LOG_WARNING, VIRGA_LOG_TICKS_DROPPED,
                        "a step of %g s at ticks of %g s: only %g are run (%s)", info->dt_s, rain->def.tick_s, whole,
                        limited ? "the frame's max_ticks or step_budget_ms" : "max_ticks_per_step");
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
    const virga_log *log = &rain->base.context->log;
    const virga_result result =
        virga_effect_check_step_after(&rain->base, "virga_rain_step", cmd, info, rain->step_set_frame);
    if (result)
        return result;
    if (virga_settings_check_positions(log, "step_info.camera_m", info->camera_m, 3))
        return VIRGA_ERROR_INVALID;
    if (!(info->dt_s >= 0 && info->dt_s <= MAX_STEP_S))
        return virga_wrong_argument(log, "step_info.dt_s: expected 0 to 10 s, got %g", info->dt_s);
    return virga_effect_ready(&rain->base);
}

/* Copies the head of the impacts for the host. Later readers of the impacts wait for the passes here. */
static void record_readback(virga_rain *rain, VkCommandBuffer cmd)
{
    virga_wait(rain->base.context, cmd, VIRGA_PASSES | VIRGA_COPIES, VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_VERTICES);
    virga_effect_copy_statistics(&rain->base, cmd, RAIN_PART_STEP, rain->total_buffer, 0,
                                 offsetof(rain_readback, total), sizeof(virga_rain_total_gpu));
    virga_effect_copy_statistics(&rain->base, cmd, RAIN_PART_STEP, rain->impact_buffer, 0,
                                 offsetof(rain_readback, impacts), sizeof(virga_impacts_gpu));
}

virga_result virga_rain_step(virga_rain *rain, VkCommandBuffer cmd, const virga_rain_step_info *info)
{
    const virga_result result = check_step(rain, cmd, info);
    if (result)
        return result;
    virga_context *context = rain->base.context;
    rain_begin_frame(rain, cmd);
    for (int axis = 0; axis < 3; axis++)
        rain->origin[axis] = (double)(float)info->camera_m[axis];
    rain->step_set = rain_write_set(rain, RAIN_STEP_SET, NULL);
    rain->step_set_frame = context->frame_index;
    const VkDescriptorSet set = rain->step_set;

    /* Passes and copies of the previous frame may still read what this frame writes. */
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES | VIRGA_VERTICES, VIRGA_PASSES);
    bool dropped = false;
    const uint32_t ticks = whole_ticks(rain, info, &dropped);
    for (uint32_t i = 0; i < ticks; i++) {
        advance(rain);
        push_tick(rain, i);
        record_tick(rain, cmd, set);
    }
    if (!ticks)
        record_refresh(rain, cmd, set);
    rain->stepped = true;
    record_readback(rain, cmd);
    rain_frame_stats *frame = &rain->frame_stats[context->ring_slot];
    frame->time_s = virga_rain_time(rain);
    frame->ticks = ticks;
    rain->ticks_of_step = ticks;
    for (int axis = 0; axis < 3; axis++)
        frame->wind_m_s[axis] = (float)rain->wind_now[axis];
    const virga_result uploaded = virga_recording_result(context);
    return uploaded ? uploaded : dropped ? VIRGA_DEGRADED : VIRGA_OK;
}

virga_result virga_rain_write_points(virga_rain *rain, VkCommandBuffer cmd, virga_rain_buffer *points, uint32_t *count,
                                     double origin_m[3])
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    virga_context *context = rain->base.context;
    if (!cmd || !points || !count || !origin_m)
        return virga_wrong_argument(&context->log, "virga_rain_write_points: NULL argument");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!rain->point_buffer || !rain->stepped || rain->step_set_frame != context->frame_index)
        return VIRGA_NOT_READY;
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_COPIES | VIRGA_VERTICES, VIRGA_PASSES);
    rain_bind(rain, cmd, rain->step_set);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "rain.points");
    virga_dispatch(context, cmd, rain->points, rain->groups);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_PASSES | VIRGA_COPIES | VIRGA_VERTICES);
    virga_pass_end(context, cmd, scope);
    const virga_result recorded = virga_recording_result(context);
    if (recorded)
        return recorded;
    *points = (virga_rain_buffer){rain->point_buffer->buffer, 0, rain->point_buffer->size};
    *count = rain->slots;
    memcpy(origin_m, rain->origin, sizeof rain->origin);
    return VIRGA_OK;
}

double virga_rain_time(const virga_rain *rain)
{
    return rain ? (double)rain->ticks * rain->def.tick_s + rain->left_over_s : 0;
}

double rain_since_tick_s(const virga_rain *rain)
{
    return rain->left_over_s;
}

void virga_rain_ticks(const virga_rain *rain, uint32_t *first, uint32_t *count)
{
    const uint32_t run = rain ? rain->ticks_of_step : 0;
    if (count)
        *count = run;
    if (first)
        *first = rain ? (uint32_t)rain->ticks - (run ? run - 1 : 0) : 0;
}

void virga_rain_rainfall_get(const virga_rain *rain, virga_rainfall *fall)
{
    if (!fall)
        return;
    *fall = (virga_rainfall){0};
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
