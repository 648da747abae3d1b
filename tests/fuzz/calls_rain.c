/* calls_rain.c - random calls of the functions that only rain, ground and splashes have. */
#include "calls.h"
#include "calls_list.h"

static void fill_camera(calls *c, double camera_m[3])
{
    calls_doubles(c, camera_m, 3, -3, 3);
    if (calls_once_in(c, 2))
        memset(camera_m, 0, 3 * sizeof *camera_m);
}

/* ---- rain */

void call_virga_rain_draw_occlusion(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_RAIN);
    virga_occluder occluders[2];
    double camera[3];
    VkCommandBuffer cmd;
    const uint32_t count = calls_fill_occluders(c, occluders, 2);
    const bool none = count && calls_once_in(c, 10);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (none ? CALLS_WRONG : 0));
    fill_camera(c, camera);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_rain_draw_occlusion, h.object, cmd, camera, none ? NULL : occluders,
                  count);
}

void call_virga_rain_plan_occlusion(calls *c)
{
    virga_occlusion_view views[VIRGA_RAIN_MAX_MAPS];
    double camera[3];
    fill_camera(c, camera);
    c->made++;
    if (virga_rain_plan_occlusion(calls_pick(c, CALLS_RAIN).object, calls_once_in(c, 10) ? NULL : camera,
                                  calls_once_in(c, 10) ? NULL : views) > VIRGA_RAIN_MAX_MAPS)
        calls_wrong(c, __func__, "more maps than there may be");
}

void call_virga_rain_import_occlusion(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_RAIN);
    virga_image image;
    VkCommandBuffer cmd;
    uint32_t flags = calls_of(h.object, CALLS_OUTSIDE);
    calls_fill_image(c, VK_FORMAT_D32_SFLOAT, &image);
    if (c->device->honest)
        return; /* an array of as many maps as were planned, which the device has not */
    image.extent = (VkExtent3D){calls_below(c, 3) * 32, 32, 1};
    image.layers = calls_below(c, 13);
    const bool wrong = calls_slip(c, 12);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags | (wrong ? CALLS_WRONG : 0), virga_rain_import_occlusion, h.object, cmd,
                  wrong ? NULL : &image);
}

void call_virga_rain_occlusion_map_get(calls *c)
{
    virga_rain_occlusion_map map;
    CALLS_DO(c, virga_rain_occlusion_map_get, calls_pick(c, CALLS_RAIN).object, calls_slip(c, 8) ? NULL : &map);
}

void call_virga_rain_step(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_RAIN);
    virga_rain_step_info info = {.dt_s = calls_number(c, 0, 0.05)};
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    fill_camera(c, info.camera_m);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_rain_step, h.object, cmd, wrong ? NULL : &info);
}

void call_virga_rain_time(calls *c)
{
    c->made++;
    if (!isfinite(virga_rain_time(calls_pick(c, CALLS_RAIN).object)))
        calls_wrong(c, __func__, "is no number");
}

void call_virga_rain_ticks(calls *c)
{
    uint32_t first, count;
    CALLS_DO(c, virga_rain_ticks, calls_pick(c, CALLS_RAIN).object, calls_slip(c, 8) ? NULL : &first,
             calls_slip(c, 8) ? NULL : &count);
}

void call_virga_rain_wind(calls *c)
{
    float wind[3];
    CALLS_DO(c, virga_rain_wind, calls_pick(c, CALLS_RAIN).object, calls_slip(c, 8) ? NULL : wind);
}

void call_virga_rain_rainfall_get(calls *c)
{
    virga_rainfall fall;
    CALLS_DO(c, virga_rain_rainfall_get, calls_pick(c, CALLS_RAIN).object, calls_slip(c, 8) ? NULL : &fall);
}

void call_virga_rain_walls_get(calls *c)
{
    static virga_walls walls;
    CALLS_DO(c, virga_rain_walls_get, calls_pick(c, CALLS_RAIN).object, calls_slip(c, 8) ? NULL : &walls);
}

void call_virga_rain_wall_water_get(calls *c)
{
    virga_wall_water water;
    CALLS_DO(c, virga_rain_wall_water_get, calls_pick(c, CALLS_RAIN).object, calls_below(c, 20), calls_below(c, 40),
             calls_slip(c, 8) ? NULL : &water);
}

void call_virga_rain_prepare(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_RAIN);
    virga_view view;
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    calls_fill_view(c, &view);
    const double time_s = calls_once_in(c, 3) ? calls_number(c, 0, 10) : virga_rain_time(h.object);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_rain_prepare, h.object, cmd, wrong ? NULL : &view, time_s);
}

void call_virga_rain_draw_haze(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_RAIN), target = calls_pick(c, CALLS_TARGET);
    virga_view view;
    double plane[4];
    VkCommandBuffer cmd;
    const bool wrong = !target.object || target.context != h.context;
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_INSIDE | (wrong ? CALLS_WRONG : 0));
    calls_fill_view(c, &view);
    calls_doubles(c, plane, 4, -1, 1);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_rain_draw_haze, h.object, cmd, calls_slip(c, 20) ? NULL : &view,
                  calls_once_in(c, 2) ? NULL : plane, target.object);
}

void call_virga_rain_impacts(calls *c)
{
    virga_rain_buffer buffer;
    CALLS_DO(c, virga_rain_impacts, calls_pick(c, CALLS_RAIN).object, calls_slip(c, 8) ? NULL : &buffer);
}

void call_virga_rain_find_hits(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_RAIN);
    virga_rain_pane pane = {.along_u = {1, 0, 0}, .along_v = {0, 1, 0}, .width_m = 1, .height_m = 1};
    virga_rain_buffer hits;
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    CALLS_WILD_ALL(c, &pane);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_rain_find_hits, h.object, cmd, wrong ? NULL : &pane, &hits);
}

void call_virga_rain_drops(calls *c)
{
    virga_rain_buffer drops;
    uint32_t count;
    double origin[3];
    CALLS_DO(c, virga_rain_drops, calls_pick(c, CALLS_RAIN).object, calls_slip(c, 8) ? NULL : &drops,
             calls_slip(c, 8) ? NULL : &count, calls_slip(c, 8) ? NULL : origin);
}

void call_virga_rain_write_points(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_RAIN);
    virga_rain_buffer points;
    uint32_t count;
    double origin[3];
    VkCommandBuffer cmd;
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_rain_write_points, h.object, cmd, calls_slip(c, 8) ? NULL : &points,
                  calls_slip(c, 8) ? NULL : &count, calls_slip(c, 8) ? NULL : origin);
}

/* ---- ground */

/* The lists of a solver of the same context. */
static void fill_exchange(calls *c, uint32_t context, virga_ground_exchange *out)
{
    const calls_handle fluid = calls_pick(c, CALLS_FLUID);
    virga_fluid_exchange exchange = {0};
    if (fluid.object && fluid.context == context)
        virga_fluid_exchange_get(fluid.object, &exchange);
    *out = (virga_ground_exchange){.buffer = exchange.buffer, .offset = exchange.offset, .size = exchange.size};
    for (int axis = 0; axis < 2; axis++) {
        out->low_m[axis] = calls_number(c, -2, 2);
        out->high_m[axis] = calls_number(c, -2, 2);
    }
    if (!c->device->honest)
        CALLS_WILD_ALL(c, out);
    out->buffer = exchange.buffer;
}

/* Lists of other effects of the same context: of some of the steps. */
static void fill_returns_and_water(calls *c, uint32_t context, virga_ground_step_info *info)
{
    const calls_handle splash = calls_pick(c, CALLS_SPLASH), fluid = calls_pick(c, CALLS_FLUID);
    virga_splash_buffer returned = {0};
    virga_fluid_buffer particles = {0};
    if (splash.object && splash.context == context && calls_once_in(c, 2))
        virga_splash_returned_droplets(splash.object, &returned);
    info->returned_droplets = returned.buffer;
    info->returned_droplets_size = returned.size;
    if (fluid.object && fluid.context == context && calls_once_in(c, 2))
        virga_fluid_particles(fluid.object, &particles, &info->water_count);
    info->water = particles.buffer;
    info->water_spacing_m = 0.05f;
}

/* The impacts of the rain that the step stands beside; where handles are not checked, anything. */
static void fill_events(calls *c, uint32_t context, virga_ground_step_info *info)
{
    const calls_handle rain = calls_pick(c, CALLS_RAIN);
    virga_rain_buffer impacts = {0};
    if (rain.object && rain.context == context)
        virga_rain_impacts(rain.object, &impacts);
    info->impacts = impacts.buffer;
    info->impacts_offset = impacts.offset;
    info->impacts_size = impacts.size;
    fill_returns_and_water(c, context, info);
    if (c->device->honest)
        return;
    info->impacts = calls_once_in(c, 3) ? c->device->buffer(c) : info->impacts;
    info->splash_rules = calls_once_in(c, 2) ? c->device->buffer(c) : VK_NULL_HANDLE;
    info->returned_droplets = calls_once_in(c, 2) ? c->device->buffer(c) : VK_NULL_HANDLE;
}

/* Wheels and feet, and the list of splashes of the same context. */
static void fill_contacts(calls *c, uint32_t context, virga_wheel wheels[3], virga_foot feet[3],
                          virga_ground_step_info *info)
{
    const calls_handle splash = calls_pick(c, CALLS_SPLASH);
    virga_splash_buffer handed = {0};
    info->wheel_count = calls_fill_wheels(c, wheels, 3);
    info->foot_count = calls_fill_feet(c, feet, 3);
    info->wheels = calls_slip(c, 12) ? NULL : wheels;
    info->feet = calls_slip(c, 12) ? NULL : feet;
    if (splash.object && splash.context == context && calls_once_in(c, 2))
        virga_splash_handed(splash.object, &handed);
    info->handed = handed.buffer;
    info->handed_size = handed.size;
}

void call_virga_default_wheel(calls *c)
{
    if (!(virga_default_wheel().radius_m > 0))
        calls_wrong(c, __func__, "has no radius");
}

void call_virga_default_foot(calls *c)
{
    if (!(virga_default_foot().length_m > 0))
        calls_wrong(c, __func__, "has no length");
}

void call_virga_ground_step(calls *c)
{
    static const calls_member kept[] = {
        CALLS_KEPT(virga_ground_step_info, meshes),       CALLS_KEPT(virga_ground_step_info, mesh_count),
        CALLS_KEPT(virga_ground_step_info, materials),    CALLS_KEPT(virga_ground_step_info, impacts),
        CALLS_KEPT(virga_ground_step_info, splash_rules), CALLS_KEPT(virga_ground_step_info, returned_droplets),
        CALLS_KEPT(virga_ground_step_info, water),        CALLS_KEPT(virga_ground_step_info, exchange),
        CALLS_KEPT(virga_ground_step_info, wheels),       CALLS_KEPT(virga_ground_step_info, feet),
        CALLS_KEPT(virga_ground_step_info, wheel_count),  CALLS_KEPT(virga_ground_step_info, foot_count),
        CALLS_KEPT(virga_ground_step_info, handed),       CALLS_BOOL(virga_ground_step_info, is_unseen)};
    const calls_handle h = calls_pick(c, CALLS_GROUND), rain = calls_pick(c, CALLS_RAIN);
    virga_occluder meshes[2];
    virga_wheel wheels[3];
    virga_foot feet[3];
    VkCommandBuffer cmd;
    virga_ground_step_info info = {.mesh_count = calls_fill_occluders(c, meshes, 2), .meshes = meshes};
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    fill_camera(c, info.camera_m);
    fill_camera(c, info.ripple_center_m);
    virga_rain_ticks(rain.object, &info.first_tick, &info.ticks);
    if (!rain.object)
        info.first_tick = info.ticks = 0;
    fill_events(c, h.context, &info);
    fill_exchange(c, h.context, &info.exchange);
    fill_contacts(c, h.context, wheels, feet, &info);
    if (!c->device->honest) {
        calls_fill_image(c, VK_FORMAT_R8_UINT, &info.materials.image);
        calls_doubles(c, info.materials.high_m, 2, 0, 10);
        CALLS_WILD(c, &info, kept);
        if (calls_slip(c, 12))
            info.meshes = NULL;
    }
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_ground_step, h.object, cmd, wrong ? NULL : &info);
}

void call_virga_ground_refresh_heights(calls *c)
{
    CALLS_DO(c, virga_ground_refresh_heights, calls_pick(c, CALLS_GROUND).object);
}

void call_virga_ground_maps_get(calls *c)
{
    virga_ground_maps maps;
    CALLS_DO(c, virga_ground_maps_get, calls_pick(c, CALLS_GROUND).object, calls_slip(c, 8) ? NULL : &maps);
}

void call_virga_ground_cells_get(calls *c)
{
    virga_ground_cells cells;
    CALLS_DO(c, virga_ground_cells_get, calls_pick(c, CALLS_GROUND).object, calls_slip(c, 8) ? NULL : &cells);
}

#define GROUND_LIST(name)                                                                                       \
    void call_virga_ground_##name(calls *c)                                                                     \
    {                                                                                                           \
        VkBuffer buffer;                                                                                        \
        VkDeviceSize size;                                                                                      \
        CALLS_DO(c, virga_ground_##name, calls_pick(c, CALLS_GROUND).object, calls_slip(c, 8) ? NULL : &buffer, \
                 calls_slip(c, 8) ? NULL : &size);                                                              \
    }
GROUND_LIST(landings)
GROUND_LIST(spawns)

/* ---- splashes */

/* Spray of water, and the floor below it. */
static void fill_spray(calls *c, uint32_t context, virga_splash_step_info *info)
{
    const calls_handle water = calls_pick(c, CALLS_WATER), ground = calls_pick(c, CALLS_GROUND);
    virga_water_leavers leavers = {0};
    virga_ground_cells cells;
    if (water.object && water.context == context && calls_once_in(c, 2))
        virga_water_leavers_get(water.object, &leavers);
    info->leavers = leavers.leavers;
    info->leaver_table = leavers.table;
    if (!ground.object || ground.context != context || calls_once_in(c, 2))
        return;
    virga_ground_cells_get(ground.object, &cells);
    info->floors =
        (virga_splash_floors){cells.floors, cells.tiles, {cells.low_tile[0], cells.low_tile[1]}, 0.05f, cells.base_m};
}

void call_virga_splash_step(calls *c)
{
    static const calls_member kept[] = {
        CALLS_KEPT(virga_splash_step_info, spawns), CALLS_KEPT(virga_splash_step_info, leavers),
        CALLS_KEPT(virga_splash_step_info, leaver_table), CALLS_KEPT(virga_splash_step_info, floors),
        CALLS_KEPT(virga_splash_step_info, panes)};
    const calls_handle h = calls_pick(c, CALLS_SPLASH), rain = calls_pick(c, CALLS_RAIN),
                       ground = calls_pick(c, CALLS_GROUND);
    virga_splash_step_info info = {.wind_m_s = {1, 0, 0}};
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    fill_camera(c, info.camera_m);
    if (ground.context == h.context && ground.object)
        virga_ground_spawns(ground.object, &info.spawns, &info.spawns_size);
    fill_spray(c, h.context, &info);
    virga_rain_ticks(rain.object, &info.first_tick, &info.ticks);
    if (!rain.object)
        info.first_tick = info.ticks = 0;
    if (!c->device->honest) {
        info.spawns = calls_once_in(c, 3) ? c->device->buffer(c) : info.spawns;
        CALLS_WILD(c, &info, kept);
    }
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_splash_step, h.object, cmd, wrong ? NULL : &info);
}

/* Up to as many as a definition of these tests has room for, and one more. */
void call_virga_splash_set_drips(calls *c)
{
    static virga_drip_site sites[65];
    const calls_handle h = calls_pick(c, CALLS_SPLASH);
    const bool wrong = calls_slip(c, 20);
    const uint32_t count = wrong ? UINT32_MAX : calls_below(c, 66);
    for (uint32_t i = 0; i < 65; i++) {
        calls_doubles(c, sites[i].position_m, 3, -10, 10);
        calls_floats(c, &sites[i].catch_m2, 1, 0.001, 4);
        calls_floats(c, &sites[i].width_m, 1, 0.005, 1);
        calls_floats(c, &sites[i].slope, 1, 0.005, 1);
        calls_floats(c, sites[i].velocity_m_s, 3, -20, 20);
        calls_floats(c, &sites[i].drops, 1, 0, 64);
        sites[i].moves = calls_slip(c, 3);
        sites[i].place = calls_below(c, 4);
    }
    CALLS_TRY(c, h.context, calls_of(h.object, wrong ? CALLS_WRONG : CALLS_PLAIN), virga_splash_set_drips, h.object,
              calls_slip(c, 12) ? NULL : sites, count);
}

void call_virga_splash_prepare(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_SPLASH);
    virga_view view;
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    calls_fill_view(c, &view);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_splash_prepare, h.object, cmd, wrong ? NULL : &view,
                  calls_number(c, 0, 4));
}

void call_virga_splash_time(calls *c)
{
    c->made++;
    if (!isfinite(virga_splash_time(calls_pick(c, CALLS_SPLASH).object)))
        calls_wrong(c, __func__, "is no number");
}

void call_virga_splash_rules(calls *c)
{
    virga_splash_buffer rules;
    CALLS_DO(c, virga_splash_rules, calls_pick(c, CALLS_SPLASH).object, calls_slip(c, 8) ? NULL : &rules);
}

void call_virga_splash_returned_droplets(calls *c)
{
    virga_splash_buffer list;
    CALLS_DO(c, virga_splash_returned_droplets, calls_pick(c, CALLS_SPLASH).object, calls_slip(c, 8) ? NULL : &list);
}

void call_virga_splash_droplets(calls *c)
{
    virga_splash_buffer droplets;
    uint32_t count;
    double anchor[3];
    CALLS_DO(c, virga_splash_droplets, calls_pick(c, CALLS_SPLASH).object, calls_slip(c, 8) ? NULL : &droplets,
             calls_slip(c, 8) ? NULL : &count, calls_slip(c, 8) ? NULL : anchor);
}

void call_virga_splash_handed(calls *c)
{
    virga_splash_buffer handed;
    CALLS_DO(c, virga_splash_handed, calls_pick(c, CALLS_SPLASH).object, calls_slip(c, 8) ? NULL : &handed);
}
