/* scene/scene_effects.c - the effects of a scene and the events between them. The only file that knows all effects.
 *
 *   rain -> impacts -> ground -> spawns -> splash -> returns -> ground, in the next step
 *       \-> hits -> panes
 *
 *   cells of the ground <-> the host's solver of water (virga/fluid.h), whose particles the host gives to water
 *
 *   the host's particles -> water -> droplets that leave it -> splash, which tells water what it took back
 *
 *   the host's particles -> ground and panes that they touch
 *
 *   the host's wheels and feet -> ground -> droplets that they throw -> splash */
#include "scene/scene_internal.h"

#include "core/settings.h"
#include "glass/glass.h"
#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/lanes.h"
#include "ground/ground.h"
#include "rain/rain.h"
#include "splash/splash.h"
#include "water/water.h"

#include <string.h>

/* ---- definitions: values that effects must share are copied from the rain's */

static uint32_t count_ground(const virga_scene_def *def)
{
    return def->with_ground;
}

static void share_ground(const virga_scene_def *def, uint32_t index, void *effect_def)
{
    virga_ground_def *ground = effect_def;
    (void)index;
    ground->seed = def->rain.seed;
    if (def->with_splash && ground->max_returned_droplets < ground->max_spawns)
        ground->max_returned_droplets = ground->max_spawns; /* the number that splash needs */
    ground->tick_s = def->rain.tick_s;
    ground->max_impacts = def->rain.max_impacts;
    ground->max_ticks_per_step = def->rain.max_ticks_per_step;
    memcpy(ground->occluder_strides, def->rain.occluder_strides, sizeof ground->occluder_strides);
}

static uint32_t count_splash(const virga_scene_def *def)
{
    return def->with_splash;
}

#define MAX_HANDED 65536 /* droplets that water hands over in a step, and contacts throw; more wait for the next one */

static void share_splash(const virga_scene_def *def, uint32_t index, void *effect_def)
{
    virga_splash_def *splash = effect_def;
    const uint32_t spawns = def->ground.max_spawns, returned = def->ground.max_returned_droplets;
    (void)index;
    splash->tick_s = def->rain.tick_s;
    splash->max_ticks_per_step = def->rain.max_ticks_per_step;
    splash->max_spawns = spawns;
    splash->max_returned_droplets = returned > spawns ? returned : spawns;
    const bool throws = def->with_contacts || splash->max_drips > 0;
    splash->max_handed = throws ? MAX_HANDED : 0;
    if (def->with_water && !throws)
        splash->max_handed = def->water.max_droplets < MAX_HANDED ? def->water.max_droplets : MAX_HANDED;
}

static uint32_t count_panes(const virga_scene_def *def)
{
    return def->pane_count;
}

static void share_pane(const virga_scene_def *def, uint32_t index, void *effect_def)
{
    virga_glass_def *pane = effect_def;
    *pane = def->panes[index];
    pane->seed = def->rain.seed + index;
    pane->water = pane->water || def->with_water;
    pane->tick_s = def->rain.tick_s;
    pane->max_ticks_per_step = def->rain.max_ticks_per_step;
}

/* ---- rain */

static virga_rain *rain_of(const virga_scene *scene)
{
    return scene_find(scene, &rain_type, 0);
}

static virga_result step_rain(virga_scene *scene, uint32_t index, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    virga_rain *rain = rain_of(scene);
    virga_rain_step_info step = {.dt_s = frame->dt_s, .max_ticks = scene_ticks_in_budget(scene, frame->step_budget_ms)};
    virga_result result = VIRGA_OK;
    (void)index;
    if (frame->occluders)
        result = virga_rain_draw_occlusion(rain, cmd, frame->camera_m, frame->occluders, frame->occluder_count);
    memcpy(step.camera_m, frame->camera_m, sizeof step.camera_m);
    if (result < 0)
        return result;
    const virga_result stepped = virga_rain_step(rain, cmd, &step);
    uint32_t ticks = 0;
    virga_rain_ticks(rain, NULL, &ticks);
    if (stepped >= 0)
        scene_note_ticks(scene, ticks);
    return scene_merge_results(result, stepped);
}

/* ---- ground: impacts come from the rain, rules and returned droplets from the splashes */

static void fill_rainfall(const virga_rain *rain, virga_ground_step_info *info)
{
    virga_rain_buffer impacts;
    virga_rainfall fall;
    virga_rain_impacts(rain, &impacts);
    info->impacts = impacts.buffer;
    info->impacts_offset = impacts.offset;
    info->impacts_size = impacts.size;
    virga_rain_ticks(rain, &info->first_tick, &info->ticks);
    virga_rain_rainfall_get(rain, &fall);
    info->open_rain_mm_h = fall.rate_mm_h;
    info->open_drop_m = fall.drop_m;
    info->impacts_reach_m = fall.reach_m;
}

static void fill_splashes(virga_splash *splash, virga_ground_step_info *info)
{
    virga_splash_buffer rules, returned_droplets;
    virga_splash_rules(splash, &rules);
    virga_splash_returned_droplets(splash, &returned_droplets);
    info->splash_rules = rules.buffer;
    info->splash_rules_offset = rules.offset;
    info->returned_droplets = returned_droplets.buffer;
    info->returned_droplets_offset = returned_droplets.offset;
    info->returned_droplets_size = returned_droplets.size;
}

/* Water wets the ground that it touches. */
static void fill_touching(const virga_scene *scene, const virga_scene_frame *frame, virga_ground_step_info *info)
{
    const virga_water *water = scene_find(scene, &water_type, 0);
    virga_water_settings settings;
    if (!water || !frame->water.count || frame->exchange.fluid) /* that water is counted */
        return;
    virga_water_get(water, &settings);
    info->water = frame->water.particles;
    info->water_offset = frame->water.offset;
    info->water_count = frame->water.count;
    info->water_spacing_m = settings.spacing_m;
    memcpy(info->water_origin_m, frame->water.origin_m, sizeof info->water_origin_m);
}

/* Cells and the host's solver give water to each other. */
static void fill_exchange(const virga_scene_frame *frame, virga_ground_step_info *info)
{
    const double *origin = frame->exchange.origin_m;
    virga_fluid_exchange from;
    virga_fluid_exchange_get(frame->exchange.fluid, &from);
    virga_ground_exchange *to = &info->exchange;
    *to = (virga_ground_exchange){.buffer = from.buffer, .offset = from.offset, .size = from.size};
    memcpy(to->origin_m, origin, sizeof to->origin_m);
    for (int axis = 0; axis < 2; axis++) {
        to->low_m[axis] = origin[2 * axis] + (double)from.low_m[axis];
        to->high_m[axis] = origin[2 * axis] + (double)from.high_m[axis];
    }
}

/* Droplets that are handed to the splashes are where they are at the time of the frame, a part of a tick after the
 * newest one: as the water's particles are. */
static void fill_handed(const virga_scene *scene, const virga_scene_frame *frame, double origin_m[3], float *late_s)
{
    const bool water = scene_find(scene, &water_type, 0);
    memcpy(origin_m, water ? frame->water.origin_m : frame->camera_m, sizeof frame->camera_m);
    *late_s = (float)rain_since_tick_s(rain_of(scene));
}

static bool has_handed(const virga_scene *scene)
{
    virga_splash_buffer handed;
    virga_splash_handed(scene_find(scene, &splash_type, 0), &handed);
    return handed.buffer;
}

/* What a frame has on the ground. */
typedef struct scene_contacts {
    virga_wheel wheels[VIRGA_GROUND_MAX_CONTACTS];
    virga_foot feet[VIRGA_GROUND_MAX_CONTACTS];
} scene_contacts;

static void go_back(double at_m[3], const float velocity_m_s[3], double time_s)
{
    for (int axis = 0; axis < 3; axis++)
        at_m[axis] -= time_s * (double)velocity_m_s[axis];
}

/* The ground wants them where they were at the end of the newest tick. */
static void fill_contacts(const virga_scene *scene, const virga_scene_frame *frame, scene_contacts *contacts,
                          virga_ground_step_info *info)
{
    const double late_s = rain_since_tick_s(rain_of(scene));
    virga_splash_buffer handed;
    info->wheels = contacts->wheels;
    info->wheel_count = frame->wheel_count;
    info->feet = contacts->feet;
    info->foot_count = frame->foot_count;
    for (uint32_t i = 0; i < frame->wheel_count; i++) {
        contacts->wheels[i] = frame->wheels[i];
        go_back(contacts->wheels[i].contact_m, contacts->wheels[i].velocity_m_s, late_s);
    }
    for (uint32_t i = 0; i < frame->foot_count; i++) {
        contacts->feet[i] = frame->feet[i];
        go_back(contacts->feet[i].sole_m, contacts->feet[i].velocity_m_s, late_s);
    }
    virga_splash_handed(scene_find(scene, &splash_type, 0), &handed);
    if (!(frame->wheel_count || frame->foot_count))
        return;
    info->handed = handed.buffer;
    info->handed_offset = handed.offset;
    info->handed_size = handed.size;
    fill_handed(scene, frame, info->handed_origin_m, &info->handed_late_s);
}

static virga_result check_ground(const virga_scene *scene, uint32_t index, const virga_scene_frame *frame)
{
    const virga_log *log = &scene->context->log;
    const virga_effect *fluid = (const virga_effect *)frame->exchange.fluid;
    (void)index;
    if (ground_check_wheels_and_feet(log, frame->wheels, frame->wheel_count, frame->feet, frame->foot_count))
        return VIRGA_ERROR_INVALID;
    if (!fluid)
        return VIRGA_OK;
    if (fluid->context != scene->context)
        return virga_wrong_argument(log, "scene_frame.exchange.fluid: expected a solver of the scene's context");
    return virga_settings_check_positions(log, "scene_frame.exchange.origin_m", frame->exchange.origin_m, 3);
}

static virga_result step_ground(virga_scene *scene, uint32_t index, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    virga_splash *splash = scene_find(scene, &splash_type, 0);
    scene_contacts contacts;
    virga_ground_step_info info = {.meshes = frame->occluders,
                                   .mesh_count = frame->occluder_count,
                                   .materials = frame->materials,
                                   .is_unseen = frame->is_unseen};
    memcpy(info.camera_m, frame->camera_m, sizeof info.camera_m);
    memcpy(info.ripple_center_m, frame->ripple_center_m, sizeof info.ripple_center_m);
    fill_rainfall(rain_of(scene), &info);
    fill_touching(scene, frame, &info);
    fill_contacts(scene, frame, &contacts, &info);
    if (frame->exchange.fluid)
        fill_exchange(frame, &info);
    if (splash)
        fill_splashes(splash, &info);
    return virga_ground_step(scene_find(scene, &ground_type, index), cmd, &info);
}

/* ---- panes: the rain finds the drops that hit them, or gives its rate */

/* Transforms a vector from the pane's frame to the world. A pose without axes has the axes of the world. */
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

static uint32_t count_all_panes(const virga_scene *scene)
{
    uint32_t count = 0;
    while (scene_find(scene, &glass_type, count))
        count++;
    return count;
}

static virga_result check_pane(const virga_scene *scene, uint32_t index, const virga_scene_frame *frame)
{
    const virga_log *log = &scene->context->log;
    if (!frame->panes)
        return virga_wrong_argument(log, "scene_frame.panes: expected %u, got NULL", count_all_panes(scene));
    const virga_scene_pane *pane = &frame->panes[index];
    if (!(pane->shelter >= 0 && pane->shelter <= 1))
        return virga_wrong_argument(log, "scene_pane.shelter: expected 0 to 1, got %g", (double)pane->shelter);
    if (glass_pose_check(log, &pane->pose) ||
        virga_settings_check_finite(log, "scene_pane.velocity_m_s", pane->velocity_m_s, 3) ||
        virga_settings_check_finite(log, "scene_pane.acceleration_m_s2", pane->acceleration_m_s2, 3) ||
        virga_settings_check_finite(log, "scene_pane.angular_velocity_rad_s", pane->angular_velocity_rad_s, 3))
        return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

/* Whether a pane can catch the rain's own drops, and spray: it is one of the catching panes and has no shelter. */
static bool catches(const virga_scene *scene, uint32_t index, const virga_scene_frame *frame)
{
    return index < scene->catching_panes && !(frame->panes[index].shelter > 0);
}

uint32_t scene_lane_of_pane(const virga_scene *scene, uint32_t index, const virga_scene_frame *frame)
{
    if (!catches(scene, index, frame))
        return 1 + index % (VIRGA_MAX_LANES - 1);
    return has_handed(scene) ? 0 : 1;
}

/* Its rectangle, as the rain takes it. */
static virga_rain_pane rectangle_of(const virga_scene *scene, uint32_t index, const virga_scene_pane *pane)
{
    virga_rain_pane caught;
    float corner[3], along_u[3], along_v[3], offset[3];
    virga_glass_rectangle(scene_find(scene, &glass_type, index), corner, along_u, along_v, &caught.width_m,
                          &caught.height_m);
    turn_to_world(&pane->pose, corner, offset);
    turn_to_world(&pane->pose, along_u, caught.along_u);
    turn_to_world(&pane->pose, along_v, caught.along_v);
    for (int axis = 0; axis < 3; axis++)
        caught.corner_m[axis] = pane->pose.position_m[axis] + (double)offset[axis];
    memcpy(caught.velocity_m_s, pane->velocity_m_s, sizeof caught.velocity_m_s);
    return caught;
}

/* Gives spray to a pane that catches it, behind the rain's drops. Among the panes of the splashes it has the number of
 * those that catch before it. */
static virga_result catch_spray(virga_scene *scene, VkCommandBuffer cmd, uint32_t index, const virga_scene_frame *frame,
                                const virga_rain_buffer *hits)
{
    virga_splash *splash = scene_find(scene, &splash_type, 0);
    uint32_t number = 0, ticks;
    for (uint32_t i = 0; i < index; i++)
        number += catches(scene, i, frame);
    virga_rain_ticks(rain_of(scene), NULL, &ticks);
    if (!splash || !has_handed(scene) || !ticks || number >= VIRGA_SPLASH_MAX_PANES)
        return VIRGA_OK;
    return virga_splash_give_hits(splash, cmd, number, hits->buffer, hits->offset, hits->size);
}

/* Uses the rain's own drops if this pane can catch them. */
static virga_result catch_drops(virga_scene *scene, VkCommandBuffer cmd, uint32_t index, const virga_scene_pane *pane,
                                const virga_scene_frame *frame, virga_glass_step_info *info)
{
    virga_rain_buffer hits;
    if (!catches(scene, index, frame))
        return VIRGA_OK;
    const virga_rain_pane caught = rectangle_of(scene, index, pane);
    const virga_result result = virga_rain_find_hits(rain_of(scene), cmd, &caught, &hits);
    if (result < 0 || result == VIRGA_NOT_READY)
        return result;
    info->rate_mm_h = 0;
    info->impacts = hits.buffer;
    info->impacts_offset = hits.offset;
    return scene_merge_results(result, catch_spray(scene, cmd, index, frame, &hits));
}

/* Water touches panes, too. It is not counted against that of an exchange with the ground. */
static void fill_striking(const virga_scene *scene, const virga_scene_frame *frame, const virga_scene_pane *pane,
                          virga_glass_step_info *info)
{
    const virga_water *water = scene_find(scene, &water_type, 0);
    virga_water_settings settings;
    if (!water || !frame->water.count)
        return;
    virga_water_get(water, &settings);
    info->water = frame->water.particles;
    info->water_offset = frame->water.offset;
    info->water_count = frame->water.count;
    info->water_spacing_m = settings.spacing_m;
    memcpy(info->water_origin_m, frame->water.origin_m, sizeof info->water_origin_m);
    memcpy(info->position_m, pane->pose.position_m, sizeof info->position_m);
}

/* The pane gets the rain that falls on the ground, reduced by the pane's shelter. */
static virga_result step_pane(virga_scene *scene, uint32_t index, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    bool changed = false;
    virga_scene_pane moved = frame->panes[index];
    const virga_scene_pane *pane = &moved;
    const virga_log *log = &scene->context->log;
    virga_clamp_vector(log, "scene_pane.velocity_m_s", moved.velocity_m_s, VIRGA_MAX_SPEED_M_S, &changed);
    virga_clamp_vector(log, "scene_pane.acceleration_m_s2", moved.acceleration_m_s2, VIRGA_MAX_ACCELERATION_M_S2,
                       &changed);
    virga_clamp_vector(log, "scene_pane.angular_velocity_rad_s", moved.angular_velocity_rad_s,
                       VIRGA_MAX_ANGULAR_SPEED_RAD_S, &changed);
    virga_rain_settings rain;
    virga_rain_get(rain_of(scene), &rain);
    virga_glass_step_info info = {
        .rate_mm_h = rain.rate_mm_h * (1 - pane->shelter), .sizes = &rain.sizes, .air_density = rain.air_density};
    memcpy(info.world_from_pane, pane->pose.world_from_pane, sizeof info.world_from_pane);
    memcpy(info.velocity_m_s, pane->velocity_m_s, sizeof info.velocity_m_s);
    memcpy(info.acceleration_m_s2, pane->acceleration_m_s2, sizeof info.acceleration_m_s2);
    memcpy(info.angular_velocity_rad_s, pane->angular_velocity_rad_s, sizeof info.angular_velocity_rad_s);
    virga_rain_ticks(rain_of(scene), &info.first_tick, &info.ticks);
    virga_rain_wind(rain_of(scene), info.wind_m_s);
    fill_striking(scene, frame, pane, &info);
    virga_result result = catch_drops(scene, cmd, index, pane, frame, &info);
    if (result >= 0)
        result = virga_glass_step(scene_find(scene, &glass_type, index), cmd, &info);
    return result ? result : changed ? VIRGA_DEGRADED : VIRGA_OK;
}

/* Prepares panes at their own time: unlike the rain's, it does not include the part of a tick that has not run yet. */
virga_result virga_scene_prepare_panes(virga_scene *scene, VkCommandBuffer cmd, const virga_view *view,
                                       const virga_scene_pane *panes)
{
    return virga_scene_prepare_panes_view(scene, cmd, 0, view, panes);
}

/* The index of a pane among the scene's effects. */
static uint32_t effect_of_pane(const virga_scene *scene, uint32_t pane)
{
    uint32_t at = 0;
    while (scene->effects[at].kind->type != &glass_type || scene->effects[at].index != pane)
        at++;
    return at;
}

virga_result virga_scene_prepare_panes_view(virga_scene *scene, VkCommandBuffer cmd, uint32_t index,
                                            const virga_view *view, const virga_scene_pane *panes)
{
    if (!scene)
        return VIRGA_ERROR_INVALID;
    const uint32_t count = count_all_panes(scene);
    if (index >= scene->max_views)
        return virga_wrong_argument(&scene->context->log,
                                    "virga_scene_prepare_panes_view: expected an index below scene_def.max_views = %u, "
                                    "got %u",
                                    scene->max_views, index);
    if (count && (!view || !panes))
        return virga_wrong_argument(&scene->context->log, "virga_scene_prepare_panes: %s is NULL",
                                    view ? "panes" : "view");
    virga_result result = VIRGA_OK;
    glass_plate plate = {0};
    for (uint32_t i = 0; i < count && result >= 0; i++) {
        virga_glass *glass = scene_find(scene, &glass_type, i);
        const virga_result prepared = glass_prepare_sharing(glass, cmd, view, &panes[i].pose, virga_glass_time(glass),
                                                            &plate, &scene->views[index][effect_of_pane(scene, i)]);
        result = scene_merge_results(result, prepared);
    }
    return result;
}

/* ---- splashes: the ground emits them, and water hands droplets over */

static void fill_floors(const virga_ground *ground, virga_splash_floors *floors)
{
    virga_ground_cells cells;
    virga_ground_maps maps;
    virga_ground_cells_get(ground, &cells);
    virga_ground_maps_get(ground, &maps);
    *floors = (virga_splash_floors){
        cells.floors, cells.tiles, {cells.low_tile[0], cells.low_tile[1]}, maps.cell_m, cells.base_m};
}

static void fill_spray(const virga_scene *scene, const virga_scene_frame *frame, virga_splash_step_info *info)
{
    virga_water_leavers leavers;
    virga_water_leavers_get(scene_find(scene, &water_type, 0), &leavers);
    info->leavers = leavers.leavers;
    info->leaver_table = leavers.table;
    fill_handed(scene, frame, info->handed_origin_m, &info->handed_late_s);
}

/* The panes that catch the rain's drops catch spray, too. */
static uint32_t fill_panes(const virga_scene *scene, const virga_scene_frame *frame,
                           virga_splash_pane panes[VIRGA_SPLASH_MAX_PANES])
{
    const uint32_t all = count_all_panes(scene);
    uint32_t count = 0;
    for (uint32_t i = 0; i < all && count < VIRGA_SPLASH_MAX_PANES; i++) {
        if (!catches(scene, i, frame))
            continue;
        const virga_rain_pane from = rectangle_of(scene, i, &frame->panes[i]);
        virga_splash_pane *to = &panes[count++];
        *to = (virga_splash_pane){.width_m = from.width_m, .height_m = from.height_m};
        memcpy(to->corner_m, from.corner_m, sizeof to->corner_m);
        memcpy(to->along_u, from.along_u, sizeof to->along_u);
        memcpy(to->along_v, from.along_v, sizeof to->along_v);
        memcpy(to->velocity_m_s, from.velocity_m_s, sizeof to->velocity_m_s);
    }
    return count;
}

static virga_result step_splash(virga_scene *scene, uint32_t index, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    virga_splash_step_info info = {.spawns_offset = 0};
    virga_splash_pane panes[VIRGA_SPLASH_MAX_PANES];
    memcpy(info.camera_m, frame->camera_m, sizeof info.camera_m);
    virga_ground_spawns(scene_find(scene, &ground_type, 0), &info.spawns, &info.spawns_size);
    virga_rain_ticks(rain_of(scene), &info.first_tick, &info.ticks);
    virga_rain_wind(rain_of(scene), info.wind_m_s);
    virga_rainfall rain;
    virga_rain_rainfall_get(rain_of(scene), &rain);
    info.rain_mm_h = rain.rate_mm_h;
    fill_floors(scene_find(scene, &ground_type, 0), &info.floors);
    if (has_handed(scene)) {
        fill_spray(scene, frame, &info);
        info.panes = panes;
        info.pane_count = fill_panes(scene, frame, panes);
    }
    return virga_splash_step(scene_find(scene, &splash_type, index), cmd, &info);
}

/* ---- water: the host has its particles */

static uint32_t count_water(const virga_scene_def *def)
{
    return def->with_water;
}

static virga_result step_water(virga_scene *scene, uint32_t index, VkCommandBuffer cmd, const virga_scene_frame *frame)
{
    virga_water_step_info info = frame->water;
    virga_splash_buffer handed;
    virga_splash_handed(scene_find(scene, &splash_type, 0), &handed);
    if (!info.handed) {
        info.handed = handed.buffer;
        info.handed_offset = handed.offset;
        info.handed_size = handed.size;
    }
    return virga_water_step(scene_find(scene, &water_type, index), cmd, &info);
}

/* ---- the table */

enum { DRAW_SPLASH, DRAW_GROUND, DRAW_WATER, DRAW_RAIN, DRAW_PANES };

#define DEF(member) offsetof(virga_scene_def, member)

/* Water is the first, as it is the one whose step has arguments of the host: if they are wrong nothing is recorded. */
const scene_kind scene_kinds[] = {
    {&water_type, DRAW_WATER, count_water, DEF(water), .step = step_water, .lane = SCENE_FIRST},
    {&rain_type, DRAW_RAIN, .def = DEF(rain), .step = step_rain, .lane = SCENE_FIRST},
    {&ground_type, DRAW_GROUND, count_ground, DEF(ground), share_ground, .check_frame = check_ground,
     .step = step_ground},
    {&splash_type, DRAW_SPLASH, count_splash, DEF(splash), share_splash, .step = step_splash},
    {&glass_type, DRAW_PANES, count_panes, .share = share_pane, .check_frame = check_pane, .step = step_pane,
     .lane = SCENE_ON_PANES},
#ifdef SCENE_EXTRA_KINDS /* an effect of the tests */
    SCENE_EXTRA_KINDS,
#endif
};

const uint32_t scene_kind_count = sizeof scene_kinds / sizeof scene_kinds[0];
