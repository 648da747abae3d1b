/* scene/scene.c - creates, runs and destroys a scene. Every function loops over the effects that scene_effects.c
 * lists. */
#include "scene/scene_internal.h"

#include "core/memory.h"
#include "core/settings.h"
#include "glass/glass.h"
#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/lanes.h"
#include "gpu/view.h"
#include "ground/ground.h"
#include "rain/rain.h"
#include "splash/splash.h"
#include "water/water.h"

#include <math.h>
#include <string.h>

virga_scene_def virga_default_scene_def(void)
{
    return (virga_scene_def){.size = sizeof(virga_scene_def),
                             .cookie = virga_settings_cookie("scene_def"),
                             .rain = virga_default_rain_def(),
                             .ground = virga_default_ground_def(),
                             .splash = virga_default_splash_def(),
                             .water = virga_default_water_def(),
                             .max_views = 1};
}

static virga_result check_def(const virga_log *log, const virga_scene_def *def)
{
    const virga_result result = virga_settings_check(log, "scene_def", def->size, sizeof *def, def->cookie);
    if (result)
        return result;
    if (def->with_splash && !def->with_ground)
        return virga_wrong_argument(log, "scene_def.with_splash: expected with_ground too");
    if (def->with_contacts && !def->with_splash)
        return virga_wrong_argument(log, "scene_def.with_contacts: expected with_splash too");
    if (def->max_views < 1 || def->max_views > VIRGA_MAX_VIEWS)
        return virga_wrong_argument(log, "scene_def.max_views: expected 1 to %d, got %u", VIRGA_MAX_VIEWS,
                                    def->max_views);
    if (def->pane_count > VIRGA_SCENE_MAX_PANES || (def->pane_count && !def->panes))
        return virga_wrong_argument(log, "scene_def.pane_count: expected up to %d and as many panes, got %u%s",
                                    VIRGA_SCENE_MAX_PANES, def->pane_count, def->panes ? "" : " and panes NULL");
    return VIRGA_OK;
}

/* ---- the effects of a definition */

static uint32_t count_of_kind(const virga_scene_def *def, const scene_kind *kind)
{
    return kind->count ? kind->count(def) : 1;
}

static void define_effect(const virga_scene_def *def, const scene_kind *kind, uint32_t index, void *effect_def)
{
    if (kind->def)
        memcpy(effect_def, (const char *)def + kind->def, kind->type->def.size);
    else
        virga_effect_default_def(kind->type, effect_def);
    if (kind->share)
        kind->share(def, index, effect_def);
    if (kind->type->max_views)
        memcpy((char *)effect_def + kind->type->max_views, &def->max_views, sizeof def->max_views);
}

static VkDeviceSize effect_estimate(const virga_scene_def *def, const scene_kind *kind, uint32_t index)
{
    _Alignas(16) char effect_def[VIRGA_EFFECT_MAX_DEF];
    define_effect(def, kind, index, effect_def);
    return virga_effect_estimate(kind->type, effect_def);
}

VkDeviceSize virga_scene_estimate(const virga_scene_def *def)
{
    VkDeviceSize sum = 0;
    if (!def || check_def(NULL, def))
        return 0;
    for (uint32_t i = 0; i < scene_kind_count; i++)
        for (uint32_t index = 0; index < count_of_kind(def, &scene_kinds[i]); index++)
            sum += effect_estimate(def, &scene_kinds[i], index);
    return sum;
}

/* ---- create and destroy */

static virga_result create_effect(virga_scene *scene, const virga_scene_def *def, const scene_kind *kind,
                                  uint32_t index)
{
    _Alignas(16) char effect_def[VIRGA_EFFECT_MAX_DEF];
    void *made = NULL;
    define_effect(def, kind, index, effect_def);
    const virga_result result =
        virga_effect_create(scene->context, kind->type, "virga_scene_create", effect_def, &made);
    if (result < 0)
        return result;
    scene->effects[scene->effect_count++] = (scene_effect){kind, index, made};
    scene->effects[scene->effect_count - 1].effect->of_scene = true;
    return result;
}

/* Creates an effect. If the scene does not fit into the memory budget, the effect gets a share of the memory that is
 * left, in proportion to the estimates of all effects still to be created. So all effects become smaller, and the first
 * ones do not use up the budget. An effect whose minimum size does not fit into its share may use all that is left. */
static virga_result create_in_share(virga_scene *scene, const virga_scene_def *def, const scene_kind *kind,
                                    uint32_t index, VkDeviceSize to_come)
{
    virga_context *context = scene->context;
    const VkDeviceSize budget = context->memory_budget, used = context->device_bytes;
    const VkDeviceSize left = budget > used ? budget - used : 0;
    if (!budget || to_come <= left)
        return create_effect(scene, def, kind, index);
    const double share = (double)effect_estimate(def, kind, index) / (double)to_come;
    context->budget_share = used + (VkDeviceSize)((double)left * share);
    context->share_is_wish = true;
    virga_result result = create_effect(scene, def, kind, index);
    context->budget_share = 0;
    context->share_is_wish = false;
    if (result == VIRGA_ERROR_DEVICE_MEMORY && context->over_budget)
        result = create_effect(scene, def, kind, index);
    return result;
}

static virga_result create_effects(virga_scene *scene, const virga_scene_def *def)
{
    VkDeviceSize to_come = virga_scene_estimate(def);
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < scene_kind_count; i++)
        for (uint32_t index = 0; index < count_of_kind(def, &scene_kinds[i]) && result >= 0; index++) {
            const virga_result made = create_in_share(scene, def, &scene_kinds[i], index, to_come);
            result = scene_merge_results(result, made);
            to_come -= effect_estimate(def, &scene_kinds[i], index);
        }
    return result;
}

/* A stable sort: panes keep the order of their definitions. */
static void sort_draws(virga_scene *scene)
{
    for (uint32_t i = 0; i < scene->effect_count; i++) {
        uint32_t at = i;
        while (at > 0 &&
               scene->effects[scene->draw_order[at - 1]].kind->draw_order > scene->effects[i].kind->draw_order) {
            scene->draw_order[at] = scene->draw_order[at - 1];
            at--;
        }
        scene->draw_order[at] = i;
    }
}

virga_result virga_scene_create(virga_context *context, const virga_scene_def *def, virga_scene **scene)
{
    if (scene)
        *scene = NULL;
    virga_result result = virga_context_check_create(context, def && scene, "virga_scene_create");
    if (!result)
        result = check_def(&context->log, def);
    if (result)
        return result;
    virga_scene *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, "a scene");
    made->context = context;
    virga_context_join(context);
    made->catching_panes = def->rain.max_panes;
    made->max_views = def->max_views;
    result = create_effects(made, def);
    sort_draws(made);
    if (result < 0)
        virga_scene_destroy(&made);
    *scene = made;
    return result;
}

void virga_scene_destroy(virga_scene **scene)
{
    if (!scene || !*scene)
        return;
    virga_context *context = (*scene)->context;
    for (uint32_t i = (*scene)->effect_count; i-- > 0;)
        virga_effect_destroy((*scene)->effects[i].effect);
    virga_free(&context->heap, *scene);
    *scene = NULL;
    virga_context_leave(context);
}

/* ---- settings of all effects */

virga_result virga_scene_lighting_set(virga_scene *scene, const virga_lighting *lighting)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    if (!lighting)
        return virga_wrong_argument(&scene->context->log, "virga_scene_lighting_set: NULL argument");
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < scene->effect_count && result >= 0; i++)
        result = scene_merge_results(result, virga_effect_set_lighting(scene->effects[i].effect, lighting));
    return result;
}

/* ---- a frame */

static virga_result check_positions(const virga_log *log, const virga_scene_frame *frame)
{
    if (virga_settings_check_positions(log, "scene_frame.camera_m", frame->camera_m, 3) ||
        virga_settings_check_positions(log, "scene_frame.ripple_center_m", frame->ripple_center_m, 3) ||
        virga_settings_check_positions(log, "scene_frame.materials.low_m", frame->materials.low_m, 2) ||
        virga_settings_check_positions(log, "scene_frame.materials.high_m", frame->materials.high_m, 2))
        return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

/* The views of a frame, as an array. */
static const virga_view *views_of(const virga_scene_frame *frame, uint32_t *count)
{
    *count = frame->views ? frame->view_count : frame->view ? 1 : 0;
    return frame->views ? frame->views : frame->view;
}

/* VIRGA_NOT_READY: all are valid, but one has no pixels. */
static virga_result check_views(const virga_scene *scene, const virga_scene_frame *frame)
{
    const virga_log *log = &scene->context->log;
    const virga_rain *rain = scene_find(scene, &rain_type, 0);
    if (frame->views && frame->view)
        return virga_wrong_argument(log, "scene_frame.view: expected NULL, as there are scene_frame.views");
    if (frame->view_count && !frame->views)
        return virga_wrong_argument(log, "scene_frame.views: expected %u, got NULL", frame->view_count);
    uint32_t count;
    const virga_view *views = views_of(frame, &count);
    if (count > scene->max_views)
        return virga_wrong_argument(log, "scene_frame.view_count: expected up to scene_def.max_views = %u, got %u",
                                    scene->max_views, count);
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < count && result >= 0; i++)
        result = scene_merge_results(result, virga_view_check(scene->context, &views[i], virga_rain_time(rain)));
    return result;
}

/* VIRGA_NOT_READY: all is valid, but a view has no pixels. */
static virga_result check_frame(const virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    const virga_log *log = &scene->context->log;
    if (!cmd || !frame)
        return virga_wrong_argument(log, "virga_scene_record: NULL argument");
    if (scene->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!(frame->dt_s >= 0 && frame->dt_s <= 10))
        return virga_wrong_argument(log, "scene_frame.dt_s: expected 0 to 10 s, got %g", frame->dt_s);
    if (!(frame->step_budget_ms >= 0 && frame->step_budget_ms <= 1000))
        return virga_wrong_argument(log, "scene_frame.step_budget_ms: expected 0 to 1000, got %g",
                                    (double)frame->step_budget_ms);
    if (frame->occluder_count && !frame->occluders)
        return virga_wrong_argument(log, "scene_frame.occluders: expected %u, got NULL", frame->occluder_count);
    if (check_positions(log, frame))
        return VIRGA_ERROR_INVALID;
    for (uint32_t i = 0; i < scene->effect_count; i++) {
        const scene_effect *effect = &scene->effects[i];
        if (effect->kind->check_frame && effect->kind->check_frame(scene, effect->index, frame))
            return VIRGA_ERROR_INVALID;
    }
    return check_views(scene, frame);
}

/* Logs a camera that is beyond the rain. The usual causes are a camera_m that was not set, or one in other units than
 * the view's. The rain then looks as if it does not work. */
static void log_if_far(virga_scene *scene, const virga_scene_frame *frame, const virga_view *view)
{
    virga_rainfall fall;
    double distance2 = 0;
    virga_rain_rainfall_get(scene_find(scene, &rain_type, 0), &fall);
    for (int axis = 0; axis < 3; axis++)
        distance2 += pow(view->position_m[axis] - frame->camera_m[axis], 2);
    const bool is_far = sqrt(distance2) > (double)fall.reach_m;
    if (is_far && !scene->far_logged)
        virga_log_write(&scene->context->log, VIRGA_LOG_WARNING, VIRGA_LOG_NOT_DRAWN,
                        "scene_frame.camera_m: is %g m from view.position_m, where no drops are: they reach %g m",
                        sqrt(distance2), (double)fall.reach_m);
    scene->far_logged = is_far;
}

virga_result virga_scene_ready(const virga_scene *scene)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < scene->effect_count; i++)
        result = scene_merge_results(result, virga_effect_ready(scene->effects[i].effect));
    return result;
}

/* Steps an effect that exchanges no events with others. */
static virga_result step_alone(virga_scene *scene, virga_effect *effect, VkCommandBuffer cmd,
                               const virga_scene_frame *frame)
{
    const virga_rain *rain = scene_find(scene, &rain_type, 0);
    virga_effect_step step;
    if (!effect->type->step)
        return VIRGA_OK;
    virga_rain_ticks(rain, &step.first_tick, &step.ticks);
    virga_rain_wind(rain, step.wind_m_s);
    memcpy(step.camera_m, frame->camera_m, sizeof step.camera_m);
    return effect->type->step(effect, cmd, &step);
}

/* The rain comes first: all others read what it writes. Then what is on the ground and what is on panes is recorded in
 * lanes of their own. */
static virga_result step_all(virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < scene->effect_count && result >= 0; i++) {
        const scene_effect *effect = &scene->effects[i];
        const bool on_pane = effect->kind->lane == SCENE_ON_PANES, first = effect->kind->lane == SCENE_FIRST;
        const uint32_t lane = on_pane ? scene_lane_of_pane(scene, effect->index, frame) : 0;
        const VkCommandBuffer to = first ? cmd : virga_lane(scene->context, cmd, lane);
        const virga_result stepped = effect->kind->step ? effect->kind->step(scene, effect->index, to, frame)
                                                        : step_alone(scene, effect->effect, to, frame);
        result = scene_merge_results(result, stepped);
    }
    virga_lanes_join(scene->context, cmd);
    return result;
}

enum { LANE_RAIN, LANE_GROUND, LANE_PANES }; /* to prepare. Each effect writes what it draws, and reads its own */

static VkCommandBuffer lane_to_prepare(const virga_scene *scene, VkCommandBuffer cmd, scene_lane of)
{
    return virga_lane(scene->context, cmd,
                      of == SCENE_FIRST      ? LANE_RAIN
                      : of == SCENE_ON_PANES ? LANE_PANES
                                             : LANE_GROUND);
}

/* Prepares the effects at the time of the rain. Panes are prepared separately, see virga_scene_prepare_panes. */
static virga_result prepare_all(virga_scene *scene, VkCommandBuffer cmd, const virga_view *view, uint32_t index)
{
    const double time_s = virga_rain_time(scene_find(scene, &rain_type, 0));
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < scene->effect_count && result >= 0; i++) {
        const uint32_t at = scene->draw_order[i];
        virga_effect *effect = scene->effects[at].effect;
        if (!effect->type->prepare)
            continue;
        const VkCommandBuffer to = lane_to_prepare(scene, cmd, scene->effects[at].kind->lane);
        result = scene_merge_results(result, effect->type->prepare(effect, to, view, time_s, &scene->views[index][at]));
    }
    return result;
}

/* A view of no pixels, which was logged, is left out. */
static virga_result prepare_view(virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame,
                                 const virga_view *view, uint32_t index)
{
    if (!(view->viewport[2] >= 1 && view->viewport[3] >= 1))
        return VIRGA_OK;
    virga_result result = prepare_all(scene, cmd, view, index);
    if (result < 0 || frame->defer_panes)
        return result;
    const VkCommandBuffer to = lane_to_prepare(scene, cmd, SCENE_ON_PANES);
    return scene_merge_results(result, virga_scene_prepare_panes_view(scene, to, index, view, frame->panes));
}

/* Each effect steps once in a frame. A second call is refused as a whole. Logged once for a frame. */
static virga_result check_once(virga_scene *scene)
{
    const uint64_t frame = scene->context->frame_index;
    if (!frame || scene->recorded_frame != frame)
        return VIRGA_OK;
    if (scene->twice_frame != frame)
        virga_wrong_argument(&scene->context->log,
                             "virga_scene_record: called again in frame %llu: expected virga_frame_begin before it",
                             (unsigned long long)frame);
    scene->twice_frame = frame;
    return VIRGA_ERROR_INVALID;
}

virga_result virga_scene_record(virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    /* Nothing steps until all pipelines are built. Otherwise rain would fall before its ground exists, and the result
     * would depend on build times. */
    const virga_result ready = virga_scene_ready(scene);
    const virga_result checked = check_frame(scene, cmd, frame);
    if (checked < 0)
        return checked;
    if (ready)
        return ready;
    if (check_once(scene))
        return VIRGA_ERROR_INVALID;
    scene->recorded_frame = scene->context->frame_index;
    const virga_view *views = views_of(frame, &scene->view_count);
    memset(scene->views, 0, sizeof scene->views);
    for (uint32_t i = 0; i < scene->view_count; i++)
        log_if_far(scene, frame, &views[i]);
    virga_result result = scene_merge_results(checked, step_all(scene, cmd, frame));
    for (uint32_t i = 0; i < scene->view_count && result >= 0; i++)
        result = scene_merge_results(result, prepare_view(scene, cmd, frame, &views[i], i));
    virga_lanes_join(scene->context, cmd);
    return result;
}

virga_result virga_scene_attach(virga_scene *scene, const virga_target *target)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < scene->effect_count && result >= 0; i++) {
        virga_effect *effect = scene->effects[scene->draw_order[i]].effect;
        if (effect->type->draw) /* wet ground is drawn by hosts that attach it themselves */
            result = scene_merge_results(result, virga_effect_attach(effect, "virga_scene_attach", target));
    }
    return result;
}

/* Draws a view of each effect. NULL: the newest ones. */
static virga_result draw_all(virga_scene *scene, VkCommandBuffer cmd, const virga_target *target,
                             const virga_prepared *views)
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < scene->effect_count && result >= 0; i++) {
        const uint32_t at = scene->draw_order[i];
        virga_effect *effect = scene->effects[at].effect;
        const virga_prepared prepared = views ? views[at] : VIRGA_PREPARED_NEWEST;
        if (effect->type->draw)
            result = scene_merge_results(result, effect->type->draw(effect, cmd, target, prepared));
    }
    return result;
}

static uint32_t views_of_this_frame(const virga_scene *scene)
{
    return scene->recorded_frame == scene->context->frame_index ? scene->view_count : 0;
}

virga_result virga_scene_draw(virga_scene *scene, VkCommandBuffer cmd, const virga_target *target)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    const uint32_t count = views_of_this_frame(scene);
    if (count > 1)
        return virga_wrong_argument(&scene->context->log,
                                    "virga_scene_draw: the frame has %u views: expected virga_scene_draw_view", count);
    return draw_all(scene, cmd, target, NULL);
}

virga_result virga_scene_draw_view(virga_scene *scene, VkCommandBuffer cmd, const virga_target *target, uint32_t index)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    const uint32_t count = views_of_this_frame(scene);
    if (index >= count)
        return virga_wrong_argument(&scene->context->log,
                                    "virga_scene_draw_view: there is no view %u, as this frame was recorded with %u",
                                    index, count);
    return draw_all(scene, cmd, target, scene->views[index]);
}
