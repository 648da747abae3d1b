/* shape.c - shapes of panes and the pictures on them, from the scene file. */
#include "panes.h"

#include "png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SHAPE_POINTS 33 /* along each side of a shape that is computed, as many as the library keeps */
#define MESH_POINTS  65 /* of one that is found on a mesh, which has a mask too */

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

/* A height map of bumps in metres, rows from below: needs free(). NULL where the pane has none. */
static bool read_bumps(const scene_file *scene, uint32_t pane, uint32_t *columns, uint32_t *rows, float **bumps_m,
                       char *error, size_t error_size)
{
    const scene_glass *glass = scene_glass_of(scene);
    char key[64];
    uint8_t *numbers;
    *bumps_m = NULL;
    if (pane >= glass->pane_count || !glass->panes[pane].bumps.file)
        return true;
    const scene_bumps *from = &glass->panes[pane].bumps;
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

/* The mask of the pane: 0 where it has no glass, rows from below. Needs free(). NULL if it has no mask. */
static bool read_mask(const scene_file *scene, uint32_t pane, uint32_t *columns, uint32_t *rows, uint8_t **mask,
                      char *error, size_t error_size)
{
    char key[64];
    uint8_t *numbers;
    const scene_glass *glass = scene_glass_of(scene);
    *mask = NULL;
    if (pane >= glass->pane_count || !glass->panes[pane].mask)
        return true;
    snprintf(key, sizeof key, "glass.%u.mask", pane);
    if (!read_picture(scene, key, glass->panes[pane].mask, columns, rows, &numbers, error, error_size))
        return false;
    *mask = malloc((size_t)*columns * *rows);
    for (uint32_t row = 0; *mask && row < *rows; row++)
        memcpy(*mask + (size_t)row * *columns, numbers + (size_t)(*rows - 1 - row) * *columns, *columns);
    free(numbers);
    return *mask || host_fail(error, error_size, "no memory for %s", glass->panes[pane].mask);
}

static bool check_pane(const scene_file *scene, uint32_t pane, bool say, char *error, size_t error_size)
{
    const scene_pane *from = &scene_glass_of(scene)->panes[pane];
    uint32_t columns, rows;
    float *bumps = NULL;
    uint8_t *mask = NULL;
    if (!read_bumps(scene, pane, &columns, &rows, &bumps, error, error_size))
        return false;
    if (bumps && say)
        printf("  bumps        %s: %u x %u\n", from->bumps.file, columns, rows);
    free(bumps);
    if (!read_mask(scene, pane, &columns, &rows, &mask, error, error_size))
        return false;
    if (mask && say)
        printf("  mask         %s: %u x %u\n", from->mask, columns, rows);
    free(mask);
    return true;
}

bool glass_check_files(const scene_file *scene, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < scene_glass_of(scene)->pane_count; i++)
        if (!check_pane(scene, i, true, error, error_size))
            return false;
    return true;
}

bool glass_check_pictures(const scene_file *scene, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < scene_glass_of(scene)->pane_count; i++)
        if (!check_pane(scene, i, false, error, error_size))
            return false;
    return true;
}

/* ---- shapes */

/* The part of a model that is the pane: the first mesh of the scene that has one of that name. */
static bool find_mesh(shot *s, const scene_pane *from, host_vertex **vertices, uint32_t **indices, uint32_t *count,
                      char *error, size_t error_size)
{
    *count = 0;
    for (uint32_t i = 0; i < s->scene->mesh_count; i++) {
        float transform[12];
        shot_mesh_transform(&s->scene->meshes[i], transform);
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
                             uint32_t count, glass_pane *pane, uint8_t *mask)
{
    float *positions = malloc((size_t)count * 3 * sizeof *positions), *uvs = malloc((size_t)count * 2 * sizeof *uvs);
    for (uint32_t i = 0; positions && uvs && i < count; i++) {
        memcpy(positions + 3 * i, vertices[i].position, 3 * sizeof *positions);
        uvs[2 * i] = vertices[i].uv[0];
        uvs[2 * i + 1] = 1 - vertices[i].uv[1];
    }
    const virga_result result =
        positions && uvs
            ? virga_glass_fill_from_mesh(positions, uvs, count, indices, count, (float)from->width_m,
                                         (float)from->height_m, pane->columns, pane->rows, pane->positions, mask)
            : VIRGA_ERROR_HOST_MEMORY;
    free(positions);
    free(uvs);
    return result;
}

static bool shape_of_mesh(shot *s, glass_pane *pane, uint32_t index, uint8_t *mask, char *error, size_t error_size)
{
    const scene_pane *from = pane->from;
    host_vertex *vertices = NULL;
    uint32_t *indices = NULL, count;
    char key[64];
    snprintf(key, sizeof key, "glass.%u.mesh", index);
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

/* Gives the library the shape; `found` is the mask of a mesh, or of round glass. */
static bool set_shape(shot *s, glass_pane *pane, uint32_t index, const uint8_t *found, char *error, size_t error_size)
{
    virga_glass_shape shape = virga_default_glass_shape();
    float *bumps = NULL;
    uint8_t *mask = NULL;
    if (!shot_blame_input(
            s, read_bumps(s->scene, index, &shape.bump_columns, &shape.bump_rows, &bumps, error, error_size)))
        return false;
    if (!shot_blame_input(
            s, read_mask(s->scene, index, &shape.mask_columns, &shape.mask_rows, &mask, error, error_size))) {
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
        shape.bump_affinity = (float)pane->from->bumps.affinity;
    }
    const virga_result result = virga_glass_shape_set(pane->glass, &shape);
    free(bumps);
    free(mask);
    shot_blame_input(s, result != VIRGA_ERROR_INVALID);
    return shot_ok(s, result, "shaping a pane", error, error_size);
}

static void cut_round(uint8_t *mask, uint32_t points)
{
    for (uint32_t i = 0; i < points * points; i++) {
        const double x = 2.0 * (i % points) / (points - 1) - 1, y = 2.0 * (double)(i / points) / (points - 1) - 1;
        mask[i] = x * x + y * y <= 1;
    }
}

bool glass_create_shape(shot *s, glass_pane *pane, uint32_t index, char *error, size_t error_size)
{
    const scene_pane *from = pane->from;
    const bool bent = from->shape == SCENE_PANE_WINDSHIELD, meshed = from->shape == SCENE_PANE_MESH;
    uint8_t *mask = NULL;
    const bool masked = meshed || pane->round;
    pane->columns = pane->rows = masked ? MESH_POINTS : SHAPE_POINTS;
    pane->positions = calloc((size_t)pane->columns * pane->rows, 3 * sizeof *pane->positions);
    if (masked)
        mask = malloc((size_t)pane->columns * pane->rows);
    if (!pane->positions || (masked && !mask)) {
        free(mask);
        return host_fail(error, error_size, "no memory for a pane");
    }
    if (pane->round)
        cut_round(mask, pane->columns);
    if (!meshed)
        virga_glass_fill_windshield((float)from->width_m, (float)from->height_m, bent ? (float)from->rake_deg : 0,
                                    bent ? (float)from->bend_m : 0, pane->columns, pane->rows, pane->positions);
    const bool made = (!meshed || shape_of_mesh(s, pane, index, mask, error, error_size)) &&
                      set_shape(s, pane, index, mask, error, error_size);
    free(mask);
    return made;
}

/* ---- points on the surface */

static const float *node(const glass_pane *pane, uint32_t column, uint32_t row)
{
    return pane->positions + 3 * ((size_t)row * pane->columns + column);
}

/* The grid cell that contains a point, or the nearest one, and the point's coordinates relative to it. */
static uint32_t find_square(double share, uint32_t points, double *inside)
{
    const double at = share * (points - 1);
    const uint32_t low = (uint32_t)fmin(fmax(floor(at), 0), points - 2);
    *inside = at - low;
    return low;
}

void glass_point(const glass_pane *pane, double u, double v, double point[3], double normal[3])
{
    double s, t, across[3], up[3];
    const uint32_t column = find_square(u / pane->from->width_m, pane->columns, &s);
    const uint32_t row = find_square(v / pane->from->height_m, pane->rows, &t);
    const float *a = node(pane, column, row), *b = node(pane, column + 1, row), *c = node(pane, column, row + 1),
                *d = node(pane, column + 1, row + 1);
    for (int i = 0; i < 3; i++) {
        point[i] =
            (1 - t) * ((1 - s) * (double)a[i] + s * (double)b[i]) + t * ((1 - s) * (double)c[i] + s * (double)d[i]);
        across[i] = (1 - t) * ((double)b[i] - (double)a[i]) + t * ((double)d[i] - (double)c[i]);
        up[i] = (1 - s) * ((double)c[i] - (double)a[i]) + s * ((double)d[i] - (double)b[i]);
    }
    double length = 0;
    for (int i = 0; i < 3; i++) {
        const int y = (i + 1) % 3, z = (i + 2) % 3;
        normal[i] = across[y] * up[z] - across[z] * up[y];
        length += normal[i] * normal[i];
    }
    for (int i = 0; i < 3; i++)
        normal[i] /= sqrt(fmax(length, 1e-24));
}
