/* glass.c - the panes of a shot: settings, pictures and shapes, from the scene file. Where they are:
 * glass_place.c. */
#include "shot/internal.h"

#include "png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SHAPE_POINTS 33 /* along each side of a shape that is made, as many as the library keeps */
#define MESH_POINTS  65 /* of one that is found on a mesh, which has a mask too */

/* ---- settings */

/* The library's time begins with the pre-roll, and the scene's with the first frame. */
static double phase_of(const scene_wiper *from, double preroll_s)
{
    const double pause_s = from->drive == SCENE_WIPER_INTERMITTENT ? from->pause_s : 0;
    const double cycle_s = 2 * from->sweep_s + pause_s, phase_s = fmod(from->phase_s - preroll_s, cycle_s);
    return preroll_s == 0 ? from->phase_s : phase_s < 0 ? phase_s + cycle_s : phase_s;
}

static void fill_wiper(const scene_wiper *from, double preroll_s, double time_s, virga_glass_wiper *to)
{
    *to = virga_default_glass_wiper();
    for (int axis = 0; axis < 2; axis++)
        to->pivot_m[axis] = (float)from->pivot_m[axis];
    to->reach_m = (float)from->reach_m;
    to->blade_m = (float)from->blade_m;
    to->width_m = (float)from->width_m;
    to->low_deg = (float)from->low_deg;
    to->high_deg = (float)from->high_deg;
    to->blade_deg = (float)from->blade_deg;
    to->blade_turn = (float)from->blade_turn;
    to->drive = (virga_glass_drive)from->drive;
    to->sweep_s = (float)from->sweep_s;
    to->pause_s = (float)from->pause_s;
    to->phase_s = (float)phase_of(from, preroll_s);
    to->film_mm = (float)from->film_mm;
    to->wear = (float)from->wear;
    to->host_deg = (float)scene_wiper_angle_deg(from, time_s);
}

/* What the kind of surface says, unless the scene says otherwise. */
static void fill_kind(const scene_pane *from, virga_glass_settings *to)
{
    const struct {
        const double *given;
        float *value;
    } rows[] = {{from->advancing_deg, &to->advancing_deg},
                {from->receding_deg, &to->receding_deg},
                {from->run_hold, &to->run_hold},
                {from->affinity, &to->affinity},
                {from->film_um, &to->film_um},
                {from->tail_mm, &to->tail_mm}};
    virga_glass_settings_of((virga_glass_kind)from->kind, to);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (rows[i].given)
            *rows[i].value = (float)*rows[i].given;
    const bool solid = from->kind == VIRGA_GLASS_KIND_METAL || from->kind == VIRGA_GLASS_KIND_LEAF;
    to->opaque = from->opaque ? *from->opaque : solid;
}

static void fill_motion(const scene_pane *from, virga_glass_settings *to)
{
    to->drag = (float)from->drag;
    to->meander = (float)from->meander;
    to->path_ease = (float)from->path_ease;
    to->path_s = (float)from->path_s;
    to->touch = (float)from->touch;
    to->tail_m = (float)from->tail_m;
    to->tail_s = (float)from->tail_s;
    to->film_break_s = (float)from->film_break_s;
    to->evaporation_mm_h = (float)from->evaporation_mm_h;
    to->mist_mm = (float)from->mist_mm;
    to->air_share = (float)from->air_share;
    to->particle_mm = (float)from->particle_mm;
    to->penalty = (float)from->penalty;
    to->band = (float)from->band;
    to->hold_back_mm = (float)from->hold_back_mm;
    to->hold_back_cells = from->hold_back_cells;
}

static void fill_look(const scene_pane *from, virga_glass_settings *to)
{
    to->density = (virga_glass_density)from->density;
    to->blend = (virga_glass_blend)from->blend;
    to->compress = from->compress;
    to->compress_from = (float)from->compress_from;
    to->compress_step = (float)from->compress_step;
    to->compress_k = (float)from->compress_k;
    to->compress_steps = from->compress_steps;
    to->threshold = (float)from->threshold;
    to->impact_s = (float)from->impact_s;
    to->style = (virga_glass_style)from->style;
    to->paper_shift = (float)from->paper_shift;
    to->thickness_mm = (float)from->thickness_mm;
    for (int c = 0; c < 3; c++)
        to->tint[c] = (float)from->tint[c];
    to->gain = (float)from->gain;
}

bool shot_panes_set(shot *s, double time_s, char *error, size_t error_size)
{
    for (uint32_t i = 0; s->panes && i < scene_glass_of(s->scene)->pane_count; i++) {
        shot_pane *pane = &s->panes[i];
        virga_glass_settings *to = &pane->settings;
        *to = virga_default_glass_settings();
        fill_kind(pane->from, to);
        fill_motion(pane->from, to);
        fill_look(pane->from, to);
        to->wiper_count = pane->from->wiper_count;
        for (uint32_t w = 0; w < to->wiper_count; w++)
            fill_wiper(&pane->from->wipers[w], shot_preroll_s(s), time_s, &to->wipers[w]);
        to->lighting = s->settings.lighting;
        if (!shot_ok(s, virga_glass_set(pane->glass, to), "setting a pane", error, error_size))
            return false;
    }
    return true;
}

/* One of the two angles may be the scene's and the other its kind's. */
bool shot_check_panes(const scene_file *scene, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < scene_glass_of(scene)->pane_count; i++) {
        const scene_pane *pane = &scene_glass_of(scene)->panes[i];
        virga_glass_settings settings = virga_default_glass_settings();
        char key[64];
        fill_kind(pane, &settings);
        if (settings.receding_deg <= settings.advancing_deg)
            continue;
        snprintf(key, sizeof key, "glass.%u.%s", i, pane->receding_deg ? "receding_deg" : "advancing_deg");
        return scene_file_refuse(scene, key, error, error_size, "expected %s (%g), got %g",
                                 pane->receding_deg ? "at most the advancing angle" : "at least the receding angle",
                                 (double)(pane->receding_deg ? settings.advancing_deg : settings.receding_deg),
                                 (double)(pane->receding_deg ? settings.receding_deg : settings.advancing_deg));
    }
    return true;
}

/* ---- pictures */

static bool read_picture(const scene_file *scene, const char *key, const char *file, uint32_t *columns, uint32_t *rows,
                         uint8_t **numbers, char *error, size_t error_size)
{
    char reason[1024];
    *numbers = NULL;
    if (!png_read_numbers(file, columns, rows, numbers, reason, sizeof reason))
        return scene_file_refuse(scene, key, error, error_size, "%s", reason);
    if (*columns >= 2 && *rows >= 2 && *columns <= 8192 && *rows <= 8192)
        return true;
    free(*numbers);
    *numbers = NULL;
    return scene_file_refuse(scene, key, error, error_size, "expected 2 to 8192 pixels a side, got %u x %u", *columns,
                             *rows);
}

bool shot_read_bumps(const scene_file *scene, uint32_t pane, uint32_t *columns, uint32_t *rows, float **bumps_m,
                     char *error, size_t error_size)
{
    const scene_bumps *from = &scene_glass_of(scene)->panes[pane].bumps;
    char key[64];
    uint8_t *numbers;
    *bumps_m = NULL;
    if (!from->file)
        return true;
    snprintf(key, sizeof key, "glass.%u.bumps.file", pane);
    if (!read_picture(scene, key, from->file, columns, rows, &numbers, error, error_size))
        return false;
    *bumps_m = malloc((size_t)*columns * *rows * sizeof **bumps_m);
    for (uint32_t row = 0; *bumps_m && row < *rows; row++)
        for (uint32_t column = 0; column < *columns; column++)
            (*bumps_m)[(size_t)row * *columns + column] =
                (float)(from->depth_mm * 1e-3 / 255 * numbers[(size_t)(*rows - 1 - row) * *columns + column]);
    free(numbers);
    return *bumps_m || host_fail(error, error_size, "no memory for %s", from->file);
}

bool shot_read_mask(const scene_file *scene, uint32_t pane, uint32_t *columns, uint32_t *rows, uint8_t **mask,
                    char *error, size_t error_size)
{
    char key[64];
    uint8_t *numbers;
    *mask = NULL;
    if (!scene_glass_of(scene)->panes[pane].mask)
        return true;
    snprintf(key, sizeof key, "glass.%u.mask", pane);
    if (!read_picture(scene, key, scene_glass_of(scene)->panes[pane].mask, columns, rows, &numbers, error, error_size))
        return false;
    *mask = malloc((size_t)*columns * *rows);
    for (uint32_t row = 0; *mask && row < *rows; row++)
        memcpy(*mask + (size_t)row * *columns, numbers + (size_t)(*rows - 1 - row) * *columns, *columns);
    free(numbers);
    return *mask || host_fail(error, error_size, "no memory for %s", scene_glass_of(scene)->panes[pane].mask);
}

/* ---- shapes */

/* The part of a model that is the pane: the first mesh of the scene that has one of that name. */
static bool find_mesh(shot *s, const scene_pane *from, host_vertex **vertices, uint32_t **indices, uint32_t *count,
                      char *error, size_t error_size)
{
    *count = 0;
    for (uint32_t i = 0; i < s->scene->mesh_count; i++) {
        float transform[12];
        shot_place_mesh(&s->scene->meshes[i], transform);
        if (!host_mesh_read(&s->device, s->scene->meshes[i].file, transform, from->mesh, vertices, indices, count,
                            error, error_size))
            return false;
        if (*count)
            return true;
        free(*vertices);
        free(*indices);
    }
    return true;
}

/* UVs are metres as programs for modelling show them, v upwards. */
static virga_result lay_grid(const scene_pane *from, const host_vertex *vertices, const uint32_t *indices,
                             uint32_t count, shot_pane *pane, uint8_t *mask)
{
    float *positions = malloc((size_t)count * 3 * sizeof *positions), *uvs = malloc((size_t)count * 2 * sizeof *uvs);
    for (uint32_t i = 0; positions && uvs && i < count; i++) {
        memcpy(positions + 3 * i, vertices[i].position, 3 * sizeof *positions);
        uvs[2 * i] = vertices[i].uv[0];
        uvs[2 * i + 1] = 1 - vertices[i].uv[1];
    }
    const virga_result result =
        positions && uvs
            ? virga_glass_from_mesh(positions, uvs, count, indices, count, (float)from->width_m, (float)from->height_m,
                                    pane->columns, pane->rows, pane->positions, mask)
            : VIRGA_ERROR_HOST_MEMORY;
    free(positions);
    free(uvs);
    return result;
}

static bool shape_of_mesh(shot *s, shot_pane *pane, uint8_t *mask, char *error, size_t error_size)
{
    const scene_pane *from = pane->from;
    host_vertex *vertices = NULL;
    uint32_t *indices = NULL, count;
    char key[64];
    snprintf(key, sizeof key, "glass.%u.mesh", (uint32_t)(pane - s->panes));
    if (!find_mesh(s, from, &vertices, &indices, &count, error, error_size))
        return false;
    if (!shot_blame_input(s, count))
        return scene_file_refuse(s->scene, key, error, error_size,
                                 "no mesh or material of the scene has '%s' in its name", from->mesh);
    const virga_result result = lay_grid(from, vertices, indices, count, pane, mask);
    free(vertices);
    free(indices);
    if (result == VIRGA_OK)
        return true;
    shot_blame_input(s, result != VIRGA_ERROR_INVALID);
    return scene_file_refuse(s->scene, key, error, error_size,
                             "no UVs of '%s' lie on a pane of %g x %g m, from (0, 0); expected UVs in metres",
                             from->mesh, from->width_m, from->height_m);
}

/* All that the library wants to know of a pane. */
static bool set_shape(shot *s, shot_pane *pane, const uint8_t *found, char *error, size_t error_size)
{
    const uint32_t index = (uint32_t)(pane - s->panes);
    virga_glass_shape shape = virga_default_glass_shape();
    float *bumps = NULL;
    uint8_t *mask = NULL;
    if (!shot_blame_input(
            s, shot_read_bumps(s->scene, index, &shape.bump_columns, &shape.bump_rows, &bumps, error, error_size)))
        return false;
    if (!shot_blame_input(
            s, shot_read_mask(s->scene, index, &shape.mask_columns, &shape.mask_rows, &mask, error, error_size))) {
        free(bumps);
        return false;
    }
    shape.positions = pane->positions;
    shape.columns = pane->columns;
    shape.rows = pane->rows;
    shape.mask = mask;
    if (!mask && found) {
        shape.mask = found;
        shape.mask_columns = pane->columns;
        shape.mask_rows = pane->rows;
    }
    shape.bumps_m = bumps;
    if (bumps) {
        shape.bump_width_m = (float)(pane->from->bumps.size_mm[0] * 1e-3);
        shape.bump_height_m = (float)(pane->from->bumps.size_mm[1] * 1e-3);
        shape.bump_pull = (float)pane->from->bumps.pull;
    }
    const virga_result result = virga_glass_shape_set(pane->glass, &shape);
    free(bumps);
    free(mask);
    shot_blame_input(s, result != VIRGA_ERROR_INVALID);
    return shot_ok(s, result, "shaping a pane", error, error_size);
}

static bool make_shape(shot *s, shot_pane *pane, char *error, size_t error_size)
{
    const scene_pane *from = pane->from;
    const bool bent = from->shape == SCENE_PANE_WINDSHIELD, meshed = from->shape == SCENE_PANE_MESH;
    uint8_t *mask = NULL;
    pane->columns = pane->rows = meshed ? MESH_POINTS : SHAPE_POINTS;
    pane->positions = calloc((size_t)pane->columns * pane->rows, 3 * sizeof *pane->positions);
    if (meshed)
        mask = malloc((size_t)pane->columns * pane->rows);
    if (!pane->positions || (meshed && !mask))
        return host_fail(error, error_size, "no memory for a pane");
    if (!meshed)
        virga_glass_windshield((float)from->width_m, (float)from->height_m, bent ? (float)from->rake_deg : 0,
                               bent ? (float)from->bend_m : 0, pane->columns, pane->rows, pane->positions);
    const bool made =
        (!meshed || shape_of_mesh(s, pane, mask, error, error_size)) && set_shape(s, pane, mask, error, error_size);
    free(mask);
    return made;
}

/* ---- opening and closing */

virga_glass_def *shot_panes_define(const shot *s)
{
    const uint32_t count = scene_glass_of(s->scene)->pane_count;
    virga_glass_def *defs = count ? calloc(count, sizeof *defs) : NULL;
    for (uint32_t i = 0; defs && i < count; i++) {
        const scene_pane *from = &scene_glass_of(s->scene)->panes[i];
        defs[i] = virga_default_glass_def();
        defs[i].width_m = (float)from->width_m;
        defs[i].height_m = (float)from->height_m;
        defs[i].cell_m = (float)from->cell_m;
        defs[i].max_drops = from->max_drops;
        defs[i].affinity_m = (float)from->affinity_m;
        defs[i].max_texels = from->max_texels;
        defs[i].height_map = s->options.height_maps;
    }
    return defs;
}

bool shot_panes_open(shot *s, char *error, size_t error_size)
{
    const uint32_t count = scene_glass_of(s->scene)->pane_count;
    s->panes = calloc(count ? count : 1, sizeof *s->panes);
    if (!s->panes)
        return host_fail(error, error_size, "no memory for panes");
    for (uint32_t i = 0; i < count; i++) {
        s->panes[i].from = &scene_glass_of(s->scene)->panes[i];
        s->panes[i].glass = virga_scene_glass(s->rain_scene, i);
        if (!make_shape(s, &s->panes[i], error, error_size) || !shot_pane_make_mesh(s, &s->panes[i], error, error_size))
            return false;
    }
    return true;
}

void shot_panes_close(shot *s)
{
    for (uint32_t i = 0; s->panes && i < scene_glass_of(s->scene)->pane_count; i++) {
        host_buffer_destroy(&s->device, &s->panes[i].read.buffer);
        host_mesh_destroy(&s->device, &s->panes[i].mesh);
        free(s->panes[i].positions);
    }
    free(s->panes);
    s->panes = NULL;
}
