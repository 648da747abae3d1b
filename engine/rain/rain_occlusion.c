/* rain/rain_occlusion.c - maps of the first surface that falling drops meet.
 *
 * Rain falls along parallel lines. A depth image rendered along these lines stores where each line first meets a
 * surface: above it there is rain, below it there is none, however many roofs lie below one another.
 *
 * The lines lean with the wind, and lean more for small drops. So maps are drawn for a few slants, each for a range of
 * drop sizes. A map is sheared, not rotated: its coordinates are (x + s.x y, z + s.y y), so a texel is a line of fall
 * and depth is height.
 *
 * The maps form cascades around the camera, each with four times the side of the next inner one. */
#include "rain/rain_internal.h"

#include "core/settings.h"
#include "gpu/errors.h"
#include "gpu/timers.h"

#include <math.h>
#include <string.h>

#define CASCADE_FACTOR 4.0
#define MAP_MARGIN     1.3   /* times the range of the drops, so that leaning lines stay inside */
#define MAP_TOP_M      256.0 /* above the camera: higher occluders are ignored */
#define MAP_HEIGHT_M   512.0
#define MAP_LEFT       0.2 /* share of half a map: less than its margin, 0.3 / 1.3 */
#define MAP_CLIMB_M    32.0
#define SLANT_TIME_S   0.5 /* time that a drop has typically fallen along its line when it passes an occluder */
#define MAX_SLANT      8.0 /* horizontal metres per metre of fall: nearly flat, in a storm */

/* The diameters that separate the slants, and the diameter that represents each. */
static const double slant_bounds[VIRGA_RAIN_MAX_SLANTS][VIRGA_RAIN_MAX_SLANTS - 1] = {
    {1, 1, 1}, {1.5e-3, 1, 1}, {1.0e-3, 2.0e-3, 1}, {0.8e-3, 1.4e-3, 2.4e-3}};
static const double slant_middles[VIRGA_RAIN_MAX_SLANTS][VIRGA_RAIN_MAX_SLANTS] = {
    {1.6e-3}, {1.1e-3, 2.2e-3}, {0.8e-3, 1.5e-3, 2.6e-3}, {0.6e-3, 1.1e-3, 1.9e-3, 3.0e-3}};

uint32_t rain_class_slant(const virga_rain *rain, double diameter_m)
{
    const uint32_t slants = rain->def.occlusion_slants;
    uint32_t slant = 0;
    while (slant + 1 < slants && diameter_m >= slant_bounds[slants - 1][slant])
        slant++;
    return slant;
}

/* The current slant of the drops that represent a size range. */
static void slant_now(const virga_rain *rain, uint32_t slant, double out[2])
{
    const double diameter = slant_middles[rain->def.occlusion_slants - 1][slant];
    uint32_t k = 0;
    while (k + 1 < VIRGA_RAIN_CLASSES && rain->classes->classes[k].diameter_m < diameter)
        k++;
    const rain_class *c = &rain->classes->classes[k];
    const double down = c->velocity[1] < -0.05 ? -c->velocity[1] : 0.05;
    for (int i = 0; i < 2; i++) {
        const double s = c->velocity[i * 2] / down;
        out[i] = s < -MAX_SLANT ? -MAX_SLANT : s > MAX_SLANT ? MAX_SLANT : s;
    }
}

void rain_occlusion_tick(virga_rain *rain)
{
    const double share = rain->ticks ? rain->def.tick_s / (SLANT_TIME_S + rain->def.tick_s) : 1;
    for (uint32_t i = 0; i < rain->def.occlusion_slants; i++) {
        double now[2];
        slant_now(rain, i, now);
        for (int axis = 0; axis < 2; axis++)
            rain->slant_smooth[i][axis] += share * (now[axis] - rain->slant_smooth[i][axis]);
    }
}

/* Centres a map on a camera, snapped to its texels, so that it does not shift while the camera moves a little. */
static void plan_map(virga_rain *rain, uint32_t index, const double camera_m[3], double top_m)
{
    rain_map *map = &rain->maps[index];
    const uint32_t inwards = rain->def.occlusion_cascades - 1 - index / rain->def.occlusion_slants;
    map->half_m = 0.5 * rain->classes->side_m * MAP_MARGIN / pow(CASCADE_FACTOR, inwards);
    const double texel = 2 * map->half_m / rain->def.occlusion_size;
    for (int axis = 0; axis < 2; axis++) {
        map->slant[axis] = rain->slant_smooth[index % rain->def.occlusion_slants][axis];
        const double center = camera_m[axis * 2] + map->slant[axis] * camera_m[1];
        map->center[axis] = floor(center / texel) * texel;
    }
    map->top_m = top_m;
    map->height_m = MAP_HEIGHT_M;
    memcpy(map->origin_m, camera_m, sizeof map->origin_m);
}

static double top_of(const double camera_m[3])
{
    return floor(camera_m[1]) + MAP_TOP_M;
}

static uint32_t planned_count(const virga_rain *rain)
{
    return rain->def.occlusion_cascades * rain->def.occlusion_slants;
}

/* ---- occlusion_interval: a map that is not redrawn keeps the centre and the slant of its last drawing */

/* Whether the camera is so far from the centre of the map that the map may not cover the visible range. */
static bool is_left(const rain_map *map, const double camera_m[3])
{
    for (int axis = 0; axis < 2; axis++) {
        const double off = camera_m[axis * 2] + map->slant[axis] * camera_m[1] - map->center[axis];
        if (fabs(off) > MAP_LEFT * map->half_m)
            return true;
    }
    return fabs(camera_m[1] + MAP_TOP_M - map->top_m) > MAP_CLIMB_M;
}

/* All maps have the same top, so if it changes for one map, all are redrawn. */
static bool all_are_due(const virga_rain *rain, const double camera_m[3])
{
    bool due = rain->settings.occlusion_interval <= 1 || !(rain->maps_drawn || rain->maps_loaded);
    for (uint32_t i = 0; i < planned_count(rain) && !due; i++)
        due = is_left(&rain->maps[i], camera_m);
    return due;
}

/* The centre of a map relative to an origin near the camera; in double precision, because only the difference is
 * small. */
static void center_from(const rain_map *map, const double origin[3], double center[2])
{
    for (int axis = 0; axis < 2; axis++)
        center[axis] = map->center[axis] - origin[axis * 2] - map->slant[axis] * origin[1];
}

void rain_fill_maps(const virga_rain *rain, virga_tick_gpu *tick, virga_map_gpu maps[VIRGA_RAIN_MAX_MAPS])
{
    const double size = rain->host_maps ? rain->host_map_image.extent.width : rain->def.occlusion_size;
    tick->map_texels = (float)size;
    tick->map_top_m = (float)(rain->maps[0].top_m - rain->origin[1]);
    tick->map_height_m = (float)rain->maps[0].height_m;
    memset(maps, 0, VIRGA_RAIN_MAX_MAPS * sizeof maps[0]);
    for (uint32_t i = 0; i < rain->map_count; i++) {
        const rain_map *map = &rain->maps[i];
        const double scale = 0.5 * size / map->half_m;
        double center[2];
        center_from(map, rain->origin, center);
        maps[i].texels_per_m = (float)scale;
        for (int axis = 0; axis < 2; axis++) {
            maps[i].slant[axis] = (float)(map->slant[axis] * scale);
            maps[i].origin[axis] = (float)(0.5 * size - center[axis] * scale);
        }
    }
}

/* ---- maps that the rain draws */

virga_result rain_occlusion_create(virga_rain *rain)
{
    return virga_mesh_map_create(rain->base.context, rain->def.occlusion_size, planned_count(rain),
                                 rain->def.occlusion_keeps, rain->def.occluder_strides, "rain.map", &rain->base.passes,
                                 &rain->map);
}

static virga_map_view view_of(const rain_map *map)
{
    virga_map_view view = {.slant = {map->slant[0], map->slant[1]},
                           .half_m = map->half_m,
                           .top_m = map->top_m - map->origin_m[1],
                           .height_m = map->height_m};
    memcpy(view.origin_m, map->origin_m, sizeof view.origin_m);
    center_from(map, map->origin_m, view.center);
    return view;
}

static void draw_map(virga_rain *rain, VkCommandBuffer cmd, uint32_t index, const virga_occluder *occluders,
                     uint32_t count)
{
    const virga_map_view view = view_of(&rain->maps[index]);
    virga_mesh_map_draw(rain->base.context, cmd, rain->map, index, &view, occluders, count);
}

/* All maps in one call, or as many as settings.occlusion_interval asks for. */
static void draw_all(virga_rain *rain, VkCommandBuffer cmd, const double camera_m[3], const virga_occluder *occluders,
                     uint32_t count)
{
    const bool all = all_are_due(rain, camera_m);
    const double top_m = all ? top_of(camera_m) : rain->maps[0].top_m;
    for (uint32_t i = 0; i < rain->map_count; i++) {
        const bool due = all || (i + rain->next_map) % rain->settings.occlusion_interval == 0;
        if (due)
            plan_map(rain, i, camera_m, top_m);
        /* After a load the others are drawn where they were when the state was saved. */
        if (due || rain->maps_loaded)
            draw_map(rain, cmd, i, occluders, count);
    }
}

/* ---- def.occlusion_keeps: what stands still is kept in layers of its own
 *
 * A map is valid for the slant that it was drawn with. An edge at the height h above the ground shelters it up to
 * h slant beside the edge, so with another slant the map is off by h times their difference. */
#define SHELTER_M 10.0 /* h: houses and trees are about so high */

static bool has_turned(const virga_rain *rain, uint32_t index)
{
    const rain_map *map = &rain->maps[index];
    const double texel_m = 2 * map->half_m / rain->def.occlusion_size;
    const double *now = rain->slant_smooth[index % rain->def.occlusion_slants];
    const double off_m = SHELTER_M * hypot(now[0] - map->slant[0], now[1] - map->slant[1]);
    return off_m > (double)rain->settings.occlusion_tolerance * texel_m;
}

static uint64_t hash_on(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 29;
}

/* Of all that decides what a mesh looks like from above, but for what is in its buffers. */
static uint64_t hash_mesh(uint64_t hash, const virga_occluder *mesh)
{
    uint32_t words[14] = {0};
    memcpy(words, mesh->world_from_mesh, sizeof mesh->world_from_mesh);
    memcpy(words + 12, &mesh->cover, sizeof mesh->cover);
    words[13] = mesh->material;
    for (int i = 0; i < 14; i += 2)
        hash = hash_on(hash, (uint64_t)words[i] << 32 | words[i + 1]);
    hash = hash_on(hash, (uint64_t)(uintptr_t)mesh->vertices ^ mesh->vertex_offset << 40);
    hash = hash_on(hash, (uint64_t)(uintptr_t)mesh->indices ^ mesh->index_offset << 40);
    hash = hash_on(hash, (uint64_t)mesh->vertex_stride << 32 | (uint32_t)mesh->index_type);
    return hash_on(hash, (uint64_t)mesh->index_count << 32 | (uint32_t)mesh->vertex_base);
}

/* Brings the kept maps up to date. Returns whether some were drawn. What changes where a map lies is part of the state;
 * what changes what is in it is not, so that a run that goes on from a saved state draws the same. */
static bool draw_kept(virga_rain *rain, VkCommandBuffer cmd, const double camera_m[3], const virga_occluder *occluders,
                      uint32_t count)
{
    const bool none = !(rain->maps_drawn || rain->maps_loaded);
    bool all = none, changed = none || rain->maps_loaded, drawn = false;
    uint64_t still = 1;
    for (uint32_t i = 0; i < count; i++)
        still = occluders[i].is_dynamic ? still : hash_mesh(still, &occluders[i]);
    changed = changed || still != rain->still;
    rain->still = still;
    for (uint32_t i = 0; i < rain->map_count && !all; i++)
        all = is_left(&rain->maps[i], camera_m);
    const double top_m = all ? top_of(camera_m) : rain->maps[0].top_m;
    for (uint32_t i = 0; i < rain->map_count; i++) {
        const bool turn = (i + rain->next_map) % rain->settings.occlusion_interval == 0;
        const bool due = all || (turn && has_turned(rain, i));
        if (due)
            plan_map(rain, i, camera_m, top_m);
        if (!due && !changed)
            continue;
        virga_map_view view = view_of(&rain->maps[i]);
        view.still_only = true;
        virga_mesh_map_draw(rain->base.context, cmd, rain->map, rain->map_count + i, &view, occluders, count);
        drawn = true;
    }
    return drawn;
}

static void draw_moving(virga_rain *rain, VkCommandBuffer cmd, const double camera_m[3],
                        const virga_occluder *occluders, uint32_t count)
{
    bool moving = false;
    const bool drawn = draw_kept(rain, cmd, camera_m, occluders, count);
    for (uint32_t i = 0; i < count && !moving; i++)
        moving = occluders[i].is_dynamic && occluders[i].index_count;
    if (drawn || moving || rain->maps_moving)
        virga_mesh_map_restore(rain->base.context, cmd, rain->map);
    rain->maps_moving = moving;
    for (uint32_t i = 0; i < rain->map_count && moving; i++) {
        virga_map_view view = view_of(&rain->maps[i]);
        view.moving_only = true;
        virga_mesh_map_draw(rain->base.context, cmd, rain->map, i, &view, occluders, count);
    }
}

static virga_result check_call(const virga_rain *rain, const double camera_m[3])
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    if (rain->base.context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!rain->def.occlusion_size)
        return VIRGA_NOT_READY;
    return camera_m ? virga_settings_check_positions(&rain->base.context->log, "camera_m", camera_m, 3) : VIRGA_OK;
}

/* The same for calls that record: these need a frame. */
static virga_result check_recording(const virga_rain *rain, const double camera_m[3])
{
    const virga_result result = check_call(rain, camera_m);
    if (result || rain->base.context->frame_index)
        return result;
    return virga_frame_not_begun(&rain->base.context->log, "occlusion");
}

virga_result virga_rain_draw_occlusion(virga_rain *rain, VkCommandBuffer cmd, const double camera_m[3],
                                       const virga_occluder *occluders, uint32_t count)
{
    if (rain && (!cmd || !camera_m || (count && !occluders)))
        return virga_wrong_argument(&rain->base.context->log, "virga_rain_draw_occlusion: NULL argument");
    virga_result result = check_recording(rain, camera_m);
    if (result)
        return result;
    result = virga_mesh_map_check(rain->base.context, rain->map, occluders, count);
    if (!result)
        result = virga_effect_ready(&rain->base);
    if (result)
        return result;
    rain_begin_frame(rain, cmd);
    if (!rain->ticks)
        rain_occlusion_tick(rain);
    rain->map_count = planned_count(rain);
    rain->next_map++;
    const virga_pass_scope scope = virga_pass_begin(rain->base.context, cmd, "rain.occlusion");
    if (rain->def.occlusion_keeps)
        draw_moving(rain, cmd, camera_m, occluders, count);
    else
        draw_all(rain, cmd, camera_m, occluders, count);
    rain->host_maps = false;
    rain->maps_drawn = true;
    rain->maps_loaded = false;
    virga_pass_end(rain->base.context, cmd, scope);
    virga_effect_note(&rain->base, cmd, RAIN_DID_MAPS);
    const virga_result recorded = virga_recording_result(rain->base.context);
    if (recorded) { /* some are not drawn: rain falls everywhere until all are */
        rain->maps_drawn = false;
        rain->map_count = 0;
    }
    return recorded;
}

/* ---- maps that the host draws */

uint32_t virga_rain_plan_occlusion(virga_rain *rain, const double camera_m[3], virga_occlusion_view *views)
{
    if (!camera_m || !views || check_call(rain, camera_m))
        return 0;
    if (!rain->ticks)
        rain_occlusion_tick(rain);
    const uint32_t count = planned_count(rain);
    rain->maps_drawn = false;
    for (uint32_t i = 0; i < count; i++) {
        plan_map(rain, i, camera_m, top_of(camera_m));
        const rain_map *map = &rain->maps[i];
        double center[2];
        center_from(map, camera_m, center);
        const float scale = (float)(1 / map->half_m), down = (float)(1 / map->height_m);
        /* Columns are the images of x, y, z and 1: x and z are scaled, y is sheared into both and becomes depth. */
        const float matrix[16] = {scale,
                                  0,
                                  0,
                                  0,
                                  scale * (float)map->slant[0],
                                  scale * (float)map->slant[1],
                                  -down,
                                  0,
                                  0,
                                  scale,
                                  0,
                                  0,
                                  -scale * (float)center[0],
                                  -scale * (float)center[1],
                                  (float)(map->top_m - camera_m[1]) * down,
                                  1};
        memcpy(views[i].clip_from_world, matrix, sizeof matrix);
        memcpy(views[i].origin_m, camera_m, sizeof views[i].origin_m);
        views[i].layer = i;
    }
    return count;
}

virga_result virga_rain_import_occlusion(virga_rain *rain, VkCommandBuffer cmd, const virga_image *depth)
{
    if (rain && (!cmd || !depth))
        return virga_wrong_argument(&rain->base.context->log, "virga_rain_import_occlusion: NULL argument");
    const virga_result result = check_recording(rain, NULL);
    if (result)
        return result;
    const uint32_t count = planned_count(rain);
    if (!depth->view || depth->extent.width != depth->extent.height || depth->layers < count)
        return virga_wrong_argument(&rain->base.context->log,
                                    "virga_rain_import_occlusion: expected a square image with %u layers", count);
    const virga_result ready = virga_effect_ready(&rain->base);
    if (ready)
        return ready;
    rain_begin_frame(rain, cmd);
    rain->map_count = count;
    rain->host_maps = true;
    rain->host_map_image = *depth;
    virga_effect_note(&rain->base, cmd, 0);
    return VIRGA_OK;
}

void virga_rain_occlusion_map_get(const virga_rain *rain, virga_rain_occlusion_map *map)
{
    if (!map)
        return;
    memset(map, 0, sizeof *map);
    if (!rain || !rain->map_count)
        return;
    const uint32_t slants = rain->def.occlusion_slants;
    *map = (virga_rain_occlusion_map){
        .depth = rain->host_maps ? rain->host_map_image.view : virga_mesh_map_depth(rain->map)->view,
        .layout = rain->host_maps ? rain->host_map_image.before.layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        .size = rain->host_maps ? rain->host_map_image.extent.width : rain->def.occlusion_size,
        .cascades = rain->def.occlusion_cascades,
        .slants = slants,
        .top_m = rain->maps[0].top_m,
        .height_m = (float)rain->maps[0].height_m};
    for (uint32_t i = 0; i < rain->def.occlusion_cascades; i++)
        map->half_m[i] = (float)rain->maps[i * slants].half_m;
}
