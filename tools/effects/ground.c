/* ground.c - what the program knows of the ground. */
#include "ground.h"

#include "effect.h"
#include "ground/ground_state.h"
#include "materials.h"
#include "png.h"
#include "scene_rows.h"
#include "shaders/frame_gpu.h"
#include "suggest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

/* Ranges and defaults are the library's own: virga/ground.h. */

static const scene_row ground_rule_rows[] = {
    TEXT(scene_ground_rule, match, 200, NULL, RESTARTS, "in the name of a mesh or its material, in any case"),
    OPTIONAL_TEXT(scene_ground_rule, material, 40, RESTARTS, "as asphalt, concrete, stone, ..."),
    SWITCH(scene_ground_rule, walkable, "true", RESTARTS, "false: no cells on it"),
};
static const scene_group ground_rule_group = SCENE_GROUP(scene_ground_rule, ground_rule_rows);

static const scene_row material_map_rows[] = {
    FILE_NAME(scene_material_map, file, 0, "a PNG whose pixels are numbers of materials"),
    NUMBER(scene_material_map, low_m, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "x and z of its first pixel"),
    NUMBER(scene_material_map, high_m, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "x and z of its last pixel"),
    TEXT_LIST(scene_material_map, materials, material_count, 40, 1, SCENE_FILE_MAX_MATERIALS, NULL, "by number"),
};
static const scene_group material_map_group = SCENE_GROUP(scene_material_map, material_map_rows);

static const scene_row ground_rows[] = {
    SWITCH(scene_ground, on, "false", RESTARTS, "there is ground that gets wet"),
    WHOLE(scene_ground, cells, 128, 4096, "1024", RESTARTS,
          "cells along the side of the window around the camera, a power of two; 44 bytes each"),
    NUMBER(scene_ground, cell_m, 0.01, 0.1, "0.05", RESTARTS, "side of a cell"),
    WHOLE(scene_ground, cached_tiles, 0, 65536, "1024", RESTARTS,
          "tiles of 64 x 64 cells that are kept when they leave the window"),
    WHOLE(scene_ground, far_cells, 0, 2048, "512", RESTARTS,
          "cells along the side of the map of wet ground beyond the window, eight times as wide; 0: none"),
    NUMBER(scene_ground, evaporation_mm_h, 0, 100, "0.2", LIVE,
           "water that dries off: 0.1 in rain, 0.5 on a mild day, 5 in sun and wind"),
    NUMBER(scene_ground, start_wetness, 0, 1, "0", RESTARTS,
           "share of their pores that was full before the first frame"),
    NUMBER(scene_ground, start_water_mm, 0, 50, "0", RESTARTS,
           "rain of that depth has gathered in hollows before the first frame"),
    WHOLE(scene_ground, contact_droplets, 0, 64, "12", LIVE,
          "droplets at most that a wheel throws out of a cell in a tick; 0: none"),
    NUMBER(scene_ground, stream_waves, 0, 4, "1", LIVE,
           "height of the waves on water that runs; 1: as they are, 0: none, and no cost"),
    NUMBER(scene_ground, wake_waves, 0, 4, "1", LIVE,
           "height of the waves that wheels and feet make on puddles; 1: as they are, 0: none, and no cost"),
    SWITCH(scene_ground, contact_shade, "true", LIVE,
           "wet ground is darker under cars and at the foot of what stands on it"),
    SWITCH(scene_ground, meniscus, "true", LIVE,
           "standing water climbs walls, posts and kerbs by 3 mm; needs contact_shade"),
    LIST(scene_ground, materials, material_count, &ground_rule_group, 0, 256, "[]",
         "rules: which names of meshes or their materials are of what"),
    OPTIONAL_GROUP(scene_ground, material_map, &material_map_group, RESTARTS,
                   "a picture of materials, over those of meshes"),
};
static const scene_group ground_group = SCENE_GROUP(scene_ground, ground_rows);

/* The section has one key: all of the struct. */
static const scene_row ground_section[] = {SECTION_GROUP("ground", &ground_group, "ground that gets wet")};

TOOL_SECTION_OF(ground)

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

static bool check_material_map(const scene_file *scene, char *error, size_t error_size)
{
    const scene_material_map *map = &scene_ground_of(scene)->material_map;
    for (int axis = 0; map->file && axis < 2; axis++)
        if (map->high_m[axis] <= map->low_m[axis])
            return scene_file_refuse(scene, "ground.material_map.high_m", error, error_size,
                                     "expected more than low_m in %s (%g), got %g", axis ? "z" : "x", map->low_m[axis],
                                     map->high_m[axis]);
    return true;
}

/* ---- materials ------------------------------------------------------------------------------------------------ */

#define MATERIAL_OF_MESH 255 /* in a map of materials: the mesh's own */

static bool check_material(const scene_file *scene, const char *key, const char *name, char *error, size_t error_size)
{
    const char *names[VIRGA_GROUND_MATERIALS];
    char all[256] = "";
    uint32_t material, count = 0;
    size_t used = 0;
    if (host_material_find(name, &material))
        return true;
    for (; count < VIRGA_GROUND_MATERIALS && used < sizeof all; count++) {
        names[count] = host_material_name(count);
        if (count && names[count] == names[0])
            break;
        used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", count ? ", " : "", names[count]);
    }
    const char *near = suggest_nearest(name, names, count);
    return scene_file_refuse(scene, key, error, error_size, "expected one of %s, got '%.40s'%s%s%s", all, name,
                             near ? ", did you mean '" : "", near ? near : "", near ? "'?" : "");
}

/* Whether the names of materials that the scene gives are known. */
static bool check(const scene_file *scene, char *error, size_t error_size)
{
    char key[64];
    const scene_ground *ground = scene_ground_of(scene);
    for (uint32_t i = 0; i < ground->material_count; i++) {
        snprintf(key, sizeof key, "ground.materials.%u.material", i);
        if (ground->materials[i].material &&
            !check_material(scene, key, ground->materials[i].material, error, error_size))
            return false;
    }
    for (uint32_t i = 0; i < ground->material_map.material_count; i++) {
        snprintf(key, sizeof key, "ground.material_map.materials.%u", i);
        if (!check_material(scene, key, ground->material_map.materials[i], error, error_size))
            return false;
    }
    return true;
}

/* Rules of the scene over what the words in names say: the first that matches a primitive or its material. */
static void mark_mesh(const scene_file *scene, host_mesh *mesh)
{
    const scene_ground *ground = scene_ground_of(scene);
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        host_primitive *primitive = &mesh->primitives[i];
        const scene_ground_rule *rule = ground->materials, *end = rule + ground->material_count;
        while (rule < end && !host_name_contains(primitive->name, rule->match) &&
               !host_name_contains(mesh->materials[primitive->material].name, rule->match))
            rule++;
        if (rule == end)
            continue;
        if (rule->material)
            host_material_find(rule->material, &primitive->surface);
        primitive->ground = rule->walkable;
    }
}

/* The picture of ground.material_map as materials, one byte a texel: needs free(). NULL where the scene has no map. */
static bool read_material_map(const scene_file *scene, uint32_t *width, uint32_t *height, uint8_t **texels, char *error,
                              size_t error_size)
{
    const scene_material_map *map = &scene_ground_of(scene)->material_map;
    uint8_t material_of[256];
    char reason[1024];
    *texels = NULL;
    if (!map->file)
        return true;
    if (!png_read_numbers(map->file, width, height, texels, reason, sizeof reason))
        return scene_file_refuse(scene, "ground.material_map.file", error, error_size, "%s", reason);
    memset(material_of, MATERIAL_OF_MESH, sizeof material_of);
    for (uint32_t i = 0; i < map->material_count; i++) {
        uint32_t material = MATERIAL_OF_MESH;
        host_material_find(map->materials[i], &material);
        material_of[i] = (uint8_t)material;
    }
    for (size_t i = 0; i < (size_t)*width * *height; i++)
        (*texels)[i] = material_of[(*texels)[i]];
    return true;
}

static bool check_pictures(const scene_file *scene, char *error, size_t error_size)
{
    uint32_t width, height;
    uint8_t *texels;
    const bool good = read_material_map(scene, &width, &height, &texels, error, error_size);
    free(texels);
    return good;
}

static bool check_files(const scene_file *scene, char *error, size_t error_size)
{
    uint32_t width, height;
    uint8_t *texels;
    const scene_material_map *map = &scene_ground_of(scene)->material_map;
    if (!read_material_map(scene, &width, &height, &texels, error, error_size))
        return false;
    if (!texels)
        return true;
    size_t mapped = 0;
    const size_t count = (size_t)width * height;
    for (size_t i = 0; i < count; i++)
        mapped += texels[i] != MATERIAL_OF_MESH;
    printf("  material map %s: %u x %u, %u materials on %.3g %% of it\n", map->file, width, height, map->material_count,
           100 * (double)mapped / (double)count);
    free(texels);
    return true;
}

static void print(const scene_file *scene)
{
    const scene_ground *ground = scene_ground_of(scene);
    if (ground->on)
        printf("  ground       %u x %u cells of %g m\n", ground->cells, ground->cells, ground->cell_m);
    else
        printf("  ground       off\n");
}

/* ---- life ----------------------------------------------------------------------------------------------------- */

static bool is_used(const scene_file *scene)
{
    return scene_ground_of(scene)->on;
}

/* Height of the ground (m) below a point: the highest top below it of the scene's ground meshes that lie under it. 0
 * where there is none. */
static double ground_below(const shot *s, const double at_m[3])
{
    double height_m = -INFINITY;
    for (uint32_t i = 0; i < s->meshes_loaded; i++)
        for (uint32_t j = 0; j < s->meshes[i].primitive_count; j++) {
            const host_primitive *p = &s->meshes[i].primitives[j];
            const bool under = (double)p->low[0] <= at_m[0] && at_m[0] <= (double)p->high[0] &&
                               (double)p->low[2] <= at_m[2] && at_m[2] <= (double)p->high[2];
            if (p->ground && under && (double)p->high[1] < at_m[1])
                height_m = fmax(height_m, (double)p->high[1]);
        }
    return isfinite(height_m) ? height_m : 0;
}

/* Distance (m) over the ground from the camera to what the lower edge of the picture shows. At most 10 m: where it
 * shows no ground, or very distant ground, ripples are not seen one by one. */
static double seen_from(const shot *s, const host_camera *camera)
{
    const float *m = camera->view_from_world; /* its second row points up, its third back */
    const float *clip = camera->clip_from_view_plain;
    const double down = (1 + (double)clip[9]) / fabs((double)clip[5]);
    double ray[3];
    for (int axis = 0; axis < 3; axis++)
        ray[axis] = -(double)m[2 + 4 * axis] - down * (double)m[1 + 4 * axis];
    const double height_m = camera->position_m[1] - ground_below(s, camera->position_m);
    return ray[1] < 0 ? fmin(fmax(height_m, 0) * hypot(ray[0], ray[2]) / -ray[1], 10) : 10;
}

/* A close-up sees finer waves of a smaller area. */
static double ripple_texel(const shot *s)
{
    host_camera camera;
    host_camera_at(&s->path, 0, s->options.width, s->options.height, NULL, &camera);
    return fmin(fmax(0.0055 * sqrt(seen_from(s, &camera)), 0.002), 0.006);
}

static bool define(shot *s, void *state, virga_scene_def *def, char *error, size_t error_size)
{
    const scene_ground *from = scene_ground_of(s->scene);
    (void)state, (void)error, (void)error_size;
    def->with_ground = from->on;
    def->ground.cells = from->cells;
    def->ground.cell_m = (float)from->cell_m;
    def->ground.cached_tiles = from->cached_tiles;
    def->ground.far_cells = from->far_cells;
    def->ground.ripple_texel_m = (float)ripple_texel(s);
    return true;
}

static bool upload_materials(shot *s, ground_state *g, uint32_t width, uint32_t height, const uint8_t *texels,
                             char *error, size_t error_size)
{
    const uint32_t limit = s->device.properties.limits.maxImageDimension2D;
    const host_image_def def = {.format = VK_FORMAT_R8_UINT,
                                .extent = {width, height, 1},
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .name = "material map"};
    if (!shot_blame_input(s, width <= limit && height <= limit))
        return scene_file_refuse(s->scene, "ground.material_map.file", error, error_size,
                                 "%u x %u pixels are more than this device's %u on a side", width, height, limit);
    return host_image_create(&s->device, &def, &g->material_image, error, error_size) &&
           host_image_upload(&s->device, &g->material_image, texels, (VkDeviceSize)width * height, 1, error,
                             error_size);
}

static bool open_material_map(shot *s, ground_state *g, char *error, size_t error_size)
{
    const scene_material_map *map = &scene_ground_of(s->scene)->material_map;
    const virga_image_state read = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                    VK_ACCESS_SHADER_READ_BIT};
    uint32_t width, height;
    uint8_t *texels;
    if (!shot_blame_input(s, read_material_map(s->scene, &width, &height, &texels, error, error_size)))
        return false;
    if (!texels)
        return true;
    const bool uploaded = upload_materials(s, g, width, height, texels, error, error_size);
    free(texels);
    g->materials.image = (virga_image){.image = g->material_image.image,
                                       .view = g->material_image.view,
                                       .format = VK_FORMAT_R8_UINT,
                                       .extent = {width, height, 1},
                                       .before = read,
                                       .after = read};
    memcpy(g->materials.low_m, map->low_m, sizeof g->materials.low_m);
    memcpy(g->materials.high_m, map->high_m, sizeof g->materials.high_m);
    return uploaded;
}

static bool open_state(shot *s, void *state, char *error, size_t error_size)
{
    ground_state *g = state;
    g->ground = virga_scene_ground(s->simulation);
    g->rain = virga_scene_rain(s->simulation);
    return open_material_map(s, g, error, error_size);
}

/* Sets the mirror plane: the lowest height of the largest ground primitive below the camera's first look-at point. */
static bool resize(shot *s, void *state, char *error, size_t error_size)
{
    const ground_state *g = state;
    const double *at = s->camera_keys[0].look_at_m;
    double widest = 0, height_m = 0;
    for (uint32_t m = 0; m < s->meshes_loaded; m++) {
        for (uint32_t i = 0; i < s->meshes[m].primitive_count; i++) {
            const host_primitive *p = &s->meshes[m].primitives[i];
            const double area = ((double)p->high[0] - (double)p->low[0]) * ((double)p->high[2] - (double)p->low[2]);
            const bool under = at[0] >= (double)p->low[0] && at[0] <= (double)p->high[0] &&
                               at[2] >= (double)p->low[2] && at[2] <= (double)p->high[2];
            if (area <= widest || !under || !host_is_ground(p->name, p->surface))
                continue;
            widest = area;
            height_m = (double)p->low[1];
        }
    }
    return !g->ground || host_renderer_set_mirror(s->renderer, &s->target, height_m, error, error_size);
}

static void close_state(shot *s, void *state)
{
    ground_state *g = state;
    host_image_destroy(&s->device, &g->material_image);
}

/* ---- time ----------------------------------------------------------------------------------------------------- */

static bool apply(shot *s, void *state, double time_s, char *error, size_t error_size)
{
    const ground_state *g = state;
    const scene_ground *from = scene_ground_of(s->scene);
    virga_ground_settings settings = virga_default_ground_settings();
    (void)time_s;
    settings.evaporation_mm_h = (float)from->evaporation_mm_h;
    settings.start_wetness = (float)from->start_wetness;
    settings.start_water_mm = (float)from->start_water_mm;
    settings.contact_droplets = from->contact_droplets;
    settings.stream_waves = (float)from->stream_waves;
    settings.wake_waves = (float)from->wake_waves;
    settings.measure = s->options.stats && !s->is_unseen;
    return !g->ground || shot_ok(s, virga_ground_set(g->ground, &settings), "setting the ground", error, error_size);
}

/* The map of ripples begins where the picture does. */
static bool fill_frame(shot *s, void *state, double time_s, const host_camera *camera, virga_scene_frame *frame,
                       char *error, size_t error_size)
{
    const ground_state *g = state;
    const virga_ground_def def = virga_default_ground_def();
    const double side_m = def.ripple_texels * ripple_texel(s);
    const double ahead_m = seen_from(s, camera) + (0.5 - HOST_RIPPLES_FADE) * side_m;
    const float *m = camera->view_from_world; /* its third row points back */
    const double back[2] = {(double)m[2], (double)m[10]}, length = hypot(back[0], back[1]);
    (void)time_s, (void)error, (void)error_size;
    frame->materials = g->materials;
    memcpy(frame->ripple_center_m, camera->position_m, sizeof frame->ripple_center_m);
    for (int axis = 0; axis < 2 && length > 1e-3; axis++)
        frame->ripple_center_m[axis * 2] -= back[axis] / length * ahead_m;
    return true;
}

/* ---- picture -------------------------------------------------------------------------------------------------- */

static bool before_plate(shot *s, void *state, VkCommandBuffer cmd, double camera_s, char *error, size_t error_size)
{
    const ground_state *g = state;
    virga_ground_maps maps;
    (void)cmd, (void)camera_s, (void)error, (void)error_size;
    if (!g->ground)
        return true;
    virga_ground_maps_get(g->ground, &maps);
    host_renderer_set_ground(s->renderer, &maps);
    host_renderer_set_contact(s->renderer, scene_ground_of(s->scene)->contact_shade);
    host_renderer_set_meniscus(s->renderer, scene_ground_of(s->scene)->meniscus);
    return true;
}

static const tool_layer layers[] = {
    {"wetness", {"wetness.Y"}, EXR_SAMPLE_HALF, "of the ground, 0 to 1", .plate = HOST_WATER, .value = 0},
    {"waterdepth",
     {"waterdepth.Y"},
     EXR_SAMPLE_FLOAT,
     "metres of water on the ground",
     .plate = HOST_WATER,
     .value = 1},
};

/* ---- statistics ----------------------------------------------------------------------------------------------- */

/* start + rained_total + spray + spray_off_ground + touched + given = taken + thrown + off_ground + absorbed + film +
 * puddle + run_off + evaporated + cached + evicted + in_air, to the last nanolitre. `in_air` is water that flew up in
 * splashes and has not fallen back yet; spray is of simulated water, wheels and feet, and has landed; `touched` is what
 * ground took from such water, `taken` and `given` is what a solver of water took from the ground and gave to it, and
 * `thrown` is what wheels and feet threw. */
static void write_water(const virga_ground_stats *now, jsonl *stats)
{
    jsonl_number(stats, "start", (double)now->start_nl * 1e-3);
    jsonl_number(stats, "off_ground", (double)now->off_ground_nl * 1e-3);
    jsonl_number(stats, "absorbed", (double)(now->held_nl + now->infiltrated_nl) * 1e-3);
    jsonl_number(stats, "film", (double)now->film_nl * 1e-3);
    jsonl_number(stats, "puddle", (double)now->puddles_nl * 1e-3);
    jsonl_number(stats, "run_off", (double)now->run_off_nl * 1e-3);
    jsonl_number(stats, "evaporated", (double)now->evaporated_nl * 1e-3);
    jsonl_number(stats, "cached", (double)now->cached_nl * 1e-3);
    jsonl_number(stats, "evicted", (double)now->evicted_nl * 1e-3);
    jsonl_number(stats, "touched", (double)now->touched_nl * 1e-3);
    jsonl_number(stats, "taken", (double)now->taken_nl * 1e-3);
    jsonl_number(stats, "given", (double)now->given_nl * 1e-3);
    jsonl_number(stats, "given_off_ground", (double)now->given_off_ground_nl * 1e-3);
    jsonl_number(stats, "thrown", (double)now->thrown_nl * 1e-3);
    jsonl_number(stats, "spray", (double)now->spray_nl * 1e-3);
    jsonl_number(stats, "spray_off_ground", (double)now->spray_off_ground_nl * 1e-3);
    jsonl_number(stats, "in_air", (double)(now->flown_nl - now->returned_nl) * 1e-3);
}

/* The budget of water, and the ground's cells by what is on them. */
static void write_totals(shot *s, void *state, jsonl *stats)
{
    static const char *const states[VIRGA_GROUND_STATES] = {"none",       "dry",        "wet",
                                                            "puddle_3mm", "puddle_5mm", "puddle_10mm"};
    const ground_state *g = state;
    virga_rain_stats rain;
    virga_ground_stats now;
    (void)s;
    virga_rain_stats_get(g->rain, &rain);
    virga_ground_stats_get(g->ground, &now);
    jsonl_begin_object(stats, "water_ul");
    jsonl_number(stats, "rained", (double)rain.impact_water_nl * 1e-3);
    jsonl_number(stats, "rained_total", (double)rain.total_water_nl * 1e-3);
    if (g->ground)
        write_water(&now, stats);
    jsonl_end(stats);
    if (!g->ground)
        return;
    jsonl_begin_object(stats, "cells");
    for (uint32_t i = 0; i < VIRGA_GROUND_STATES; i++)
        jsonl_uint64(stats, states[i], now.cells[i]);
    jsonl_end(stats);
}

/* ---- the effect ----------------------------------------------------------------------------------------------- */

const tool_effect ground_effect = {
    TOOL_EFFECT(ground, "Ground"),
    .scene = {.group = SCENE_GROUP(scene_ground, ground_section), .check = check_material_map},
    TOOL_USED_IF(is_used, "ground; expected ground.on: true"),
    .check = check,
    .check_pictures = check_pictures,
    .check_files = check_files,
    .mark_mesh = mark_mesh,
    .resize = resize,
    .apply = apply,
    .fill_frame = fill_frame,
    .before_plate = before_plate,
    .write_totals = write_totals,
    TOOL_ROWS(view, ground_views),
    .fill_budget = ground_fill_budget,
};
