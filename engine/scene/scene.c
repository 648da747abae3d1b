/* scene/scene.c - the effects of a place along their events. The only file that knows them all. */
#include "core/settings.h"
#include "glass/glass_internal.h"
#include "gpu/errors.h"
#include "gpu/view.h"

#include <virga/scene.h>

#include <math.h>
#include <string.h>

#define SCENE_COOKIE VIRGA_COOKIE(6)

struct virga_scene {
    virga_context *context;
    virga_rain *rain;
    virga_ground *ground; /* NULL: none */
    virga_splash *splash; /* NULL: none */
    virga_glass *panes[VIRGA_SCENE_MAX_PANES];
    uint32_t pane_count;
    bool told_far;     /* that the view's camera is beyond the rain, since it was within */
    uint32_t catching; /* so many of them, from the first on, catch the rain's drops; the others get its rate */
};

virga_scene_def virga_default_scene_def(void)
{
    return (virga_scene_def){.size = sizeof(virga_scene_def),
                             .cookie = SCENE_COOKIE,
                             .rain = virga_default_rain_def(),
                             .ground = virga_default_ground_def(),
                             .splash = virga_default_splash_def()};
}

/* What must be the same as the rain's is taken from it. */
static virga_ground_def ground_of(const virga_scene_def *def)
{
    virga_ground_def taken = def->ground;
    taken.seed = def->rain.seed;
    if (def->with_splash && taken.max_returns < taken.max_spawns)
        taken.max_returns = taken.max_spawns; /* as splash needs */
    taken.tick_s = def->rain.tick_s;
    taken.max_impacts = def->rain.max_impacts;
    taken.max_ticks_per_step = def->rain.max_ticks_per_step;
    for (int i = 0; i < 4; i++)
        taken.occluder_strides[i] = def->rain.occluder_strides[i];
    return taken;
}

static virga_splash_def splash_of(const virga_scene_def *def)
{
    virga_splash_def taken = def->splash;
    taken.tick_s = def->rain.tick_s;
    taken.max_ticks_per_step = def->rain.max_ticks_per_step;
    taken.max_spawns = def->ground.max_spawns;
    taken.max_returns = def->ground.max_returns > taken.max_spawns ? def->ground.max_returns : taken.max_spawns;
    return taken;
}

static virga_glass_def pane_of(const virga_scene_def *def, uint32_t index)
{
    virga_glass_def taken = def->panes[index];
    taken.seed = def->rain.seed + index;
    taken.tick_s = def->rain.tick_s;
    taken.max_ticks_per_step = def->rain.max_ticks_per_step;
    return taken;
}

/* The first error, else the last remark. */
static virga_result worst(virga_result a, virga_result b)
{
    return a < 0 ? a : b ? b : a;
}

static virga_result check_def(const virga_log *log, const virga_scene_def *def)
{
    const virga_result result =
        virga_settings_check(log, "scene_def", def->size, sizeof *def, def->cookie, SCENE_COOKIE);
    if (result)
        return result;
    if (def->with_splash && !def->with_ground)
        return virga_wrong_argument(log, "scene_def.with_splash: expected with_ground too");
    if (def->pane_count > VIRGA_SCENE_MAX_PANES || (def->pane_count && !def->panes))
        return virga_wrong_argument(log, "scene_def.pane_count: expected up to %d and as many panes, got %u%s",
                                    VIRGA_SCENE_MAX_PANES, def->pane_count, def->panes ? "" : " and panes NULL");
    return VIRGA_OK;
}

/* Parts of a scene, in the order they are made. */
enum { PART_RAIN, PART_GROUND, PART_SPLASH, PART_PANES };

static VkDeviceSize part_estimate(const virga_scene_def *def, uint32_t part)
{
    const virga_ground_def ground = ground_of(def);
    const virga_splash_def splash = splash_of(def);
    if (part == PART_RAIN)
        return virga_rain_estimate(&def->rain);
    if (part == PART_GROUND)
        return def->with_ground ? virga_ground_estimate(&ground) : 0;
    if (part == PART_SPLASH)
        return def->with_splash ? virga_splash_estimate(&splash) : 0;
    const virga_glass_def pane = pane_of(def, part - PART_PANES);
    return virga_glass_estimate(&pane);
}

VkDeviceSize virga_scene_estimate(const virga_scene_def *def)
{
    VkDeviceSize sum = 0;
    if (!def || check_def(NULL, def))
        return 0;
    for (uint32_t part = 0; part < PART_PANES + def->pane_count; part++)
        sum += part_estimate(def, part);
    return sum;
}

static virga_result create_part(virga_scene *scene, const virga_scene_def *def, uint32_t part)
{
    virga_context *context = scene->context;
    const virga_ground_def ground = ground_of(def);
    const virga_splash_def splash = splash_of(def);
    if (part == PART_RAIN)
        return virga_rain_create(context, &def->rain, &scene->rain);
    if (part == PART_GROUND)
        return def->with_ground ? virga_ground_create(context, &ground, &scene->ground) : VIRGA_OK;
    if (part == PART_SPLASH)
        return def->with_splash ? virga_splash_create(context, &splash, &scene->splash) : VIRGA_OK;
    const virga_glass_def pane = pane_of(def, part - PART_PANES);
    const virga_result result = virga_glass_create(context, &pane, &scene->panes[part - PART_PANES]);
    scene->pane_count += result >= 0;
    return result;
}

/* Parts that are still to come keep their share of what the budget has left, by what they ask for: a scene over the
 * budget is then smaller in all of its parts, instead of having first ones that leave nothing. A share is a wish: a
 * part whose smallest does not fit into it may have all that is left. */
static virga_result create_in_share(virga_scene *scene, const virga_scene_def *def, uint32_t part, VkDeviceSize to_come)
{
    virga_context *context = scene->context;
    const VkDeviceSize budget = context->memory_budget, taken = context->device_bytes;
    const VkDeviceSize left = budget > taken ? budget - taken : 0;
    if (!budget || to_come <= left)
        return create_part(scene, def, part);
    context->budget_share = taken + (VkDeviceSize)((double)left * (double)part_estimate(def, part) / (double)to_come);
    context->share_is_wish = true;
    virga_result result = create_part(scene, def, part);
    context->budget_share = 0;
    context->share_is_wish = false;
    if (result == VIRGA_ERROR_DEVICE_MEMORY && context->over_budget)
        result = create_part(scene, def, part);
    return result;
}

static virga_result create_effects(const virga_scene_def *def, virga_scene *scene)
{
    const uint32_t parts = PART_PANES + def->pane_count;
    VkDeviceSize to_come = virga_scene_estimate(def);
    virga_result result = VIRGA_OK;
    for (uint32_t part = 0; part < parts && result >= 0; part++) {
        result = worst(result, create_in_share(scene, def, part, to_come));
        to_come -= part_estimate(def, part);
    }
    scene->catching = def->rain.max_panes;
    return result;
}

virga_result virga_scene_create(virga_context *context, const virga_scene_def *def, virga_scene **scene)
{
    if (scene)
        *scene = NULL;
    if (!context || !def || !scene)
        return virga_wrong_argument(context ? &context->log : NULL, "virga_scene_create: NULL argument");
    virga_result result = check_def(&context->log, def);
    if (result)
        return result;
    virga_scene *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, "a scene");
    made->context = context;
    result = create_effects(def, made);
    if (result < 0)
        virga_scene_destroy(&made);
    *scene = made;
    return result;
}

void virga_scene_destroy(virga_scene **scene)
{
    if (!scene || !*scene)
        return;
    for (uint32_t i = 0; i < (*scene)->pane_count; i++)
        virga_glass_destroy(&(*scene)->panes[i]);
    virga_splash_destroy(&(*scene)->splash);
    virga_ground_destroy(&(*scene)->ground);
    virga_rain_destroy(&(*scene)->rain);
    virga_free(&(*scene)->context->heap, *scene);
    *scene = NULL;
}

virga_rain *virga_scene_rain(virga_scene *scene)
{
    return scene ? scene->rain : NULL;
}

virga_ground *virga_scene_ground(virga_scene *scene)
{
    return scene ? scene->ground : NULL;
}

virga_splash *virga_scene_splash(virga_scene *scene)
{
    return scene ? scene->splash : NULL;
}

virga_glass *virga_scene_glass(virga_scene *scene, uint32_t index)
{
    return scene && index < scene->pane_count ? scene->panes[index] : NULL;
}

virga_result virga_scene_light(virga_scene *scene, const virga_lighting *lighting)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    if (!lighting)
        return virga_wrong_argument(&scene->context->log, "virga_scene_light: NULL argument");
    virga_rain_settings rain;
    virga_rain_get(scene->rain, &rain);
    rain.lighting = *lighting;
    virga_result result = virga_rain_set(scene->rain, &rain);
    if (scene->splash && result >= 0) {
        virga_splash_settings splash;
        virga_splash_get(scene->splash, &splash);
        splash.lighting = *lighting;
        result = worst(result, virga_splash_set(scene->splash, &splash));
    }
    for (uint32_t i = 0; i < scene->pane_count && result >= 0; i++) {
        virga_glass_settings glass;
        virga_glass_get(scene->panes[i], &glass);
        glass.lighting = *lighting;
        result = worst(result, virga_glass_set(scene->panes[i], &glass));
    }
    return result;
}

static virga_result step_ground(virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    virga_rain_buffer impacts;
    virga_rain_impacts(scene->rain, &impacts);
    virga_ground_step_info info = {.meshes = frame->occluders,
                                   .mesh_count = frame->occluder_count,
                                   .materials = frame->materials,
                                   .impacts = impacts.buffer,
                                   .impacts_offset = impacts.offset,
                                   .impacts_size = impacts.size};
    for (int axis = 0; axis < 3; axis++) {
        info.camera_m[axis] = frame->camera_m[axis];
        info.focus_m[axis] = frame->focus_m[axis];
    }
    virga_rain_ticks(scene->rain, &info.first_tick, &info.ticks);
    virga_rain_fall fall;
    virga_rain_fall_get(scene->rain, &fall);
    info.open_rain_mm_h = fall.rate_mm_h;
    info.open_drop_m = fall.drop_m;
    info.impacts_reach_m = fall.reach_m;
    if (scene->splash) {
        virga_splash_buffer rules, returns;
        virga_splash_rules(scene->splash, &rules);
        virga_splash_returns(scene->splash, &returns);
        info.splash_rules = rules.buffer;
        info.splash_rules_offset = rules.offset;
        info.returns = returns.buffer;
        info.returns_offset = returns.offset;
        info.returns_size = returns.size;
    }
    return virga_ground_step(scene->ground, cmd, &info);
}

static virga_result step_splash(virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    virga_splash_step_info info = {.spawns_offset = 0};
    for (int axis = 0; axis < 3; axis++)
        info.camera_m[axis] = frame->camera_m[axis];
    virga_ground_spawns(scene->ground, &info.spawns, &info.spawns_size);
    virga_rain_ticks(scene->rain, &info.first_tick, &info.ticks);
    virga_rain_wind(scene->rain, info.wind_m_s);
    return virga_splash_step(scene->splash, cmd, &info);
}

/* From the pane's own frame to the world; a pose without axes has the world's. */
static void turn_to_world(const virga_glass_pose *pose, const float local[3], float world[3])
{
    bool none = true;
    for (int i = 0; i < 9; i++)
        none = none && pose->world_from_pane[i] == 0;
    for (int i = 0; i < 3; i++)
        world[i] = none ? local[i]
                        : pose->world_from_pane[i] * local[0] + pose->world_from_pane[3 + i] * local[1] +
                              pose->world_from_pane[6 + i] * local[2];
}

/* ---- what a host says of a frame, before any of it is recorded */

static virga_result check_pane(const virga_log *log, const virga_scene_pane *pane)
{
    if (!(pane->shelter >= 0 && pane->shelter <= 1))
        return virga_wrong_argument(log, "scene_pane.shelter: expected 0 to 1, got %g", (double)pane->shelter);
    if (glass_pose_check(log, &pane->pose) ||
        virga_settings_finite(log, "scene_pane.velocity_m_s", pane->velocity_m_s, 3) ||
        virga_settings_finite(log, "scene_pane.acceleration_m_s2", pane->acceleration_m_s2, 3) ||
        virga_settings_finite(log, "scene_pane.turn_rad_s", pane->turn_rad_s, 3))
        return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

static virga_result check_places(const virga_log *log, const virga_scene_frame *frame)
{
    if (virga_settings_places(log, "scene_frame.camera_m", frame->camera_m, 3) ||
        virga_settings_places(log, "scene_frame.focus_m", frame->focus_m, 3) ||
        virga_settings_places(log, "scene_frame.materials.low_m", frame->materials.low_m, 2) ||
        virga_settings_places(log, "scene_frame.materials.high_m", frame->materials.high_m, 2))
        return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

/* VIRGA_NOT_READY: all but the view, which has no pixels. */
static virga_result check_frame(const virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    const virga_log *log = &scene->context->log;
    if (!cmd || !frame)
        return virga_wrong_argument(log, "virga_scene_record: NULL argument");
    if (scene->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!(frame->dt_s >= 0 && frame->dt_s <= 10))
        return virga_wrong_argument(log, "scene_frame.dt_s: expected 0 to 10 s, got %g", frame->dt_s);
    if (frame->occluder_count && !frame->occluders)
        return virga_wrong_argument(log, "scene_frame.occluders: expected %u, got NULL", frame->occluder_count);
    if (scene->pane_count && !frame->panes)
        return virga_wrong_argument(log, "scene_frame.panes: expected %u, got NULL", scene->pane_count);
    if (check_places(log, frame))
        return VIRGA_ERROR_INVALID;
    for (uint32_t i = 0; i < scene->pane_count; i++)
        if (check_pane(log, &frame->panes[i]))
            return VIRGA_ERROR_INVALID;
    return frame->view ? virga_view_check(scene->context, frame->view, virga_rain_time(scene->rain)) : VIRGA_OK;
}

/* camera_m that was forgotten, or is in other units than the view's, looks like rain that does not work. */
static void tell_far(virga_scene *scene, const virga_scene_frame *frame)
{
    virga_rain_fall fall;
    double far2 = 0;
    virga_rain_fall_get(scene->rain, &fall);
    for (int axis = 0; axis < 3; axis++)
        far2 += pow(frame->view->position_m[axis] - frame->camera_m[axis], 2);
    const bool beyond = sqrt(far2) > (double)fall.reach_m;
    if (beyond && !scene->told_far)
        virga_log_say(&scene->context->log, VIRGA_LOG_WARNING, VIRGA_LOG_NOT_DRAWN,
                      "scene_frame.camera_m: is %g m from view.position_m, where no drops are: they reach %g m",
                      sqrt(far2), (double)fall.reach_m);
    scene->told_far = beyond;
}

/* ---- panes */

/* The rain's own drops, as long as there is room for them to be caught and nothing keeps a share of them off. */
static virga_result catch_drops(virga_scene *scene, VkCommandBuffer cmd, uint32_t index, const virga_scene_pane *pane,
                                virga_glass_step_info *info)
{
    virga_rain_pane caught;
    virga_rain_buffer hits;
    float corner[3], along_u[3], along_v[3], offset[3];
    if (index >= scene->catching || pane->shelter > 0)
        return VIRGA_OK;
    virga_glass_rectangle(scene->panes[index], corner, along_u, along_v, &caught.width_m, &caught.height_m);
    turn_to_world(&pane->pose, corner, offset);
    turn_to_world(&pane->pose, along_u, caught.along_u);
    turn_to_world(&pane->pose, along_v, caught.along_v);
    for (int axis = 0; axis < 3; axis++)
        caught.corner_m[axis] = pane->pose.position_m[axis] + (double)offset[axis];
    memcpy(caught.velocity_m_s, pane->velocity_m_s, sizeof caught.velocity_m_s);
    const virga_result result = virga_rain_hits(scene->rain, cmd, &caught, &hits);
    if (result < 0 || result == VIRGA_NOT_READY)
        return result;
    info->rate_mm_h = 0;
    info->impacts = hits.buffer;
    info->impacts_offset = hits.offset;
    return result;
}

/* Rain lands on a pane as it does on the ground under the same sky. */
static virga_result step_pane(virga_scene *scene, VkCommandBuffer cmd, uint32_t index, const virga_scene_pane *given)
{
    bool changed = false;
    virga_scene_pane taken = *given;
    const virga_scene_pane *pane = &taken;
    const virga_log *log = &scene->context->log;
    virga_clamp_vector(log, "scene_pane.velocity_m_s", taken.velocity_m_s, VIRGA_FASTEST_M_S, &changed);
    virga_clamp_vector(log, "scene_pane.acceleration_m_s2", taken.acceleration_m_s2, VIRGA_STRONGEST_M_S2, &changed);
    virga_clamp_vector(log, "scene_pane.turn_rad_s", taken.turn_rad_s, VIRGA_QUICKEST_RAD_S, &changed);
    virga_rain_settings rain;
    virga_rain_get(scene->rain, &rain);
    virga_glass_step_info info = {
        .rate_mm_h = rain.rate_mm_h * (1 - pane->shelter), .sizes = &rain.sizes, .air_density = rain.air_density};
    memcpy(info.world_from_pane, pane->pose.world_from_pane, sizeof info.world_from_pane);
    memcpy(info.velocity_m_s, pane->velocity_m_s, sizeof info.velocity_m_s);
    memcpy(info.acceleration_m_s2, pane->acceleration_m_s2, sizeof info.acceleration_m_s2);
    memcpy(info.turn_rad_s, pane->turn_rad_s, sizeof info.turn_rad_s);
    virga_rain_ticks(scene->rain, &info.first_tick, &info.ticks);
    virga_rain_wind(scene->rain, info.wind_m_s);
    virga_result result = catch_drops(scene, cmd, index, pane, &info);
    if (result >= 0)
        result = virga_glass_step(scene->panes[index], cmd, &info);
    return result ? result : changed ? VIRGA_DEGRADED : VIRGA_OK;
}

static virga_result step_panes(virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < scene->pane_count && result >= 0; i++)
        result = worst(result, step_pane(scene, cmd, i, &frame->panes[i]));
    return result;
}

/* At the panes' own time: what rain has left over of a tick they do not know of. */
virga_result virga_scene_prepare_panes(virga_scene *scene, VkCommandBuffer cmd, const virga_view *view,
                                       const virga_scene_pane *panes)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    if (scene->pane_count && (!view || !panes))
        return virga_wrong_argument(&scene->context->log, "virga_scene_prepare_panes: %s is NULL",
                                    view ? "panes" : "view");
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < scene->pane_count && result >= 0; i++)
        result = worst(
            result, virga_glass_prepare(scene->panes[i], cmd, view, &panes[i].pose, virga_glass_time(scene->panes[i])));
    return result;
}

/* What a view sees, at the time of the rain. */
static virga_result prepare(virga_scene *scene, VkCommandBuffer cmd, const virga_view *view)
{
    virga_result result = VIRGA_OK;
    const double time_s = virga_rain_time(scene->rain);
    if (scene->splash)
        result = virga_splash_prepare(scene->splash, cmd, view, time_s);
    return result < 0 ? result : worst(result, virga_rain_prepare(scene->rain, cmd, view, time_s));
}

virga_result virga_scene_ready(const virga_scene *scene)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    virga_result result = virga_rain_ready(scene->rain);
    if (scene->ground)
        result = worst(result, virga_ground_ready(scene->ground));
    if (scene->splash)
        result = worst(result, virga_splash_ready(scene->splash));
    for (uint32_t i = 0; i < scene->pane_count; i++)
        result = worst(result, virga_glass_ready(scene->panes[i]));
    return result;
}

virga_result virga_scene_record(virga_scene *scene, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    /* Rain that falls while its ground is not there yet would make a run depend on how fast pipelines were built. */
    const virga_result ready = virga_scene_ready(scene);
    const virga_result checked = check_frame(scene, cmd, frame);
    if (checked < 0)
        return checked;
    if (ready)
        return ready;
    const bool seen = frame->view && !checked;
    virga_result result = checked;
    if (seen)
        tell_far(scene, frame);
    if (frame->occluders)
        result = worst(
            result, virga_rain_occlusion(scene->rain, cmd, frame->camera_m, frame->occluders, frame->occluder_count));
    virga_rain_step_info step = {.dt_s = frame->dt_s};
    for (int axis = 0; axis < 3; axis++)
        step.camera_m[axis] = frame->camera_m[axis];
    if (result >= 0)
        result = worst(result, virga_rain_step(scene->rain, cmd, &step));
    if (result >= 0 && scene->ground)
        result = worst(result, step_ground(scene, cmd, frame));
    if (result >= 0 && scene->splash)
        result = worst(result, step_splash(scene, cmd, frame));
    if (result >= 0)
        result = worst(result, step_panes(scene, cmd, frame));
    if (result >= 0 && seen)
        result = worst(result, prepare(scene, cmd, frame->view));
    if (result >= 0 && seen && !frame->panes_later)
        result = worst(result, virga_scene_prepare_panes(scene, cmd, frame->view, frame->panes));
    return result;
}

virga_result virga_scene_attach(virga_scene *scene, const virga_target *target)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    virga_result result = scene->splash ? virga_splash_attach(scene->splash, target) : VIRGA_OK;
    if (result >= 0)
        result = worst(result, virga_rain_attach(scene->rain, target));
    for (uint32_t i = 0; i < scene->pane_count && result >= 0; i++)
        result = worst(result, virga_glass_attach(scene->panes[i], target));
    return result;
}

virga_result virga_scene_draw(virga_scene *scene, VkCommandBuffer cmd, const virga_target *target)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    virga_result result = scene->splash ? virga_splash_draw(scene->splash, cmd, target) : VIRGA_OK;
    if (result >= 0)
        result = worst(result, virga_rain_draw(scene->rain, cmd, target));
    for (uint32_t i = 0; i < scene->pane_count && result >= 0; i++)
        result = worst(result, virga_glass_draw(scene->panes[i], cmd, target));
    return result;
}
