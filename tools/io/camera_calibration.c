/* camera_calibration.c - knows a kind of file by its first line, finds the camera in it, and reads its numbers. */
#include "camera_calibration.h"

#include "file.h"
#include "text_lines.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_SIZE_PX    65536
#define MAX_FOCAL_PX   1e6
#define MAX_CENTER_PX  1e5
#define MAX_DISTORTION 1e3
#define MAX_RIGHT_M    100.0
#define MAX_JSON_BYTES (1u << 20)

/* ---- checks of numbers, all of the line that was read last ---------------------------------------------------- */

static bool take_size(const text_lines *r, const double size[2], camera_calibration *c)
{
    for (int axis = 0; axis < 2; axis++) {
        if (!(size[axis] >= 1 && size[axis] <= MAX_SIZE_PX && size[axis] == floor(size[axis])))
            return text_lines_wrong_number(r, "width and height as whole numbers from 1 to 65536", "%g", size[axis]);
        c->size_px[axis] = (uint32_t)size[axis];
    }
    return true;
}

/* `corner` is where the file has the middle of the upper left pixel. */
static bool take_pinhole(const text_lines *r, double fx, double fy, double cx, double cy, double corner,
                         camera_calibration *c)
{
    const double focal[2] = {fx, fy}, center[2] = {cx - corner, cy - corner};
    for (int axis = 0; axis < 2; axis++) {
        if (!(focal[axis] > 0 && focal[axis] <= MAX_FOCAL_PX))
            return text_lines_wrong_number(r, "a focal length above 0 and up to 1000000 pixels", "%g", focal[axis]);
        if (!(fabs(center[axis]) <= MAX_CENTER_PX))
            return text_lines_wrong_number(r, "a principal point up to 100000 pixels away", "%g", center[axis]);
    }
    /* A scene's [0, 0] is the middle of the picture. */
    if (center[0] == 0 && center[1] == 0)
        return text_lines_wrong(r, "a principal point beside the upper left pixel", "that pixel");
    memcpy(c->focal_px, focal, sizeof focal);
    memcpy(c->center_px, center, sizeof center);
    return true;
}

static bool take_distortion(const text_lines *r, const double *numbers, uint32_t count, camera_calibration *c)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!(fabs(numbers[i]) <= MAX_DISTORTION))
            return text_lines_wrong_number(r, "distortion from -1000 to 1000", "%g", numbers[i]);
        c->distortion[i] = numbers[i];
    }
    return true;
}

/* ---- which camera --------------------------------------------------------------------------------------------- */

/* A number of at most 9 digits that ends with `end`. NULL: there is none. */
static const char *read_id(const char *text, char end, uint32_t *id)
{
    const size_t digits = strspn(text, "0123456789");
    if (!digits || digits > 9 || text[digits] != end)
        return NULL;
    *id = (uint32_t)strtoul(text, NULL, 10);
    return text + digits;
}

typedef struct cameras {
    uint32_t ids[CAMERA_CALIBRATION_MAX], count;
    const char *form; /* how an id is printed */
} cameras;

static bool add_camera(const text_lines *r, cameras *all, uint32_t id)
{
    for (uint32_t i = 0; i < all->count; i++)
        if (all->ids[i] == id)
            return text_lines_wrong_number(r, "each camera once", "camera %.0f again", id);
    if (all->count == CAMERA_CALIBRATION_MAX)
        return text_lines_wrong_number(r, "the end of the file", "more than %.0f cameras", CAMERA_CALIBRATION_MAX);
    all->ids[all->count++] = id;
    return true;
}

static bool refuse_camera(const text_lines *r, const cameras *all, const char *camera)
{
    char list[160] = "";
    size_t used = 0;
    for (uint32_t i = 0; i < all->count && used < 80; i++) {
        used += (size_t)snprintf(list + used, sizeof list - used, i ? ", " : "");
        used += (size_t)snprintf(list + used, sizeof list - used, all->form, all->ids[i]);
        if (used >= 80 && i + 1 < all->count)
            snprintf(list + used, sizeof list - used, ", ...");
    }
    return file_fail(r->error, r->error_size, "%s: expected camera to be one of %s, got %.40s", r->path, list,
                     camera ? camera : "none");
}

/* The camera of that name, or without a name the only one. */
static bool choose_camera(const text_lines *r, const cameras *all, const char *camera, uint32_t *id)
{
    uint32_t wanted;
    if (!all->count)
        return file_fail(r->error, r->error_size, "%s: expected at least one camera, got none", r->path);
    if (!camera && all->count == 1) {
        *id = all->ids[0];
        return true;
    }
    for (uint32_t i = 0; camera && read_id(camera, 0, &wanted) && i < all->count; i++)
        if (all->ids[i] == wanted) {
            *id = wanted;
            return true;
        }
    return refuse_camera(r, all, camera);
}

/* ---- COLMAP --------------------------------------------------------------------------------------------------- */

/* Where in the parameters a model has its numbers. */
static const struct {
    const char *name;
    uint32_t count, fy, cx, distortion;
} models[] = {
    {"SIMPLE_PINHOLE", 3, 0, 1, 0}, {"PINHOLE", 4, 1, 2, 0}, {"SIMPLE_RADIAL", 4, 0, 1, 1},
    {"RADIAL", 5, 0, 1, 2},         {"OPENCV", 8, 1, 2, 4},
};

/* The rest of a line behind its number: model, width, height, parameters. */
static bool read_model(const text_lines *r, const char *text, camera_calibration *c)
{
    const size_t length = strcspn(text, " ");
    char got[48], expected[96];
    double n[10];
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        if (strlen(models[i].name) != length || strncmp(text, models[i].name, length) != 0)
            continue;
        const double *p = n + 2;
        snprintf(expected, sizeof expected, "%u numbers of a camera %s: width, height, parameters", 2 + models[i].count,
                 models[i].name);
        return text_lines_all_numbers(r, text + length, 2 + models[i].count, expected, n) && take_size(r, n, c) &&
               take_pinhole(r, p[0], p[models[i].fy], p[models[i].cx], p[models[i].cx + 1], 0.5, c) &&
               take_distortion(r, p + models[i].cx + 2, models[i].distortion, c);
    }
    snprintf(got, sizeof got, "'%.*s'", length < 40 ? (int)length : 40, text);
    return text_lines_wrong(r, "a model of SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL and OPENCV", got);
}

static bool read_colmap(text_lines *r, const char *camera, camera_calibration *c)
{
    cameras all = {.form = "%u"};
    uint32_t wanted, id;
    const char *rest;
    text_lines_rewind(r);
    while (text_lines_next_full(r)) {
        rest = read_id(r->line + strspn(r->line, " "), ' ', &id);
        if (!rest)
            return text_lines_wrong(r, "a camera: number, model, width, height, parameters (COLMAP's cameras.txt)",
                                    r->line);
        if (!add_camera(r, &all, id))
            return false;
    }
    if (!choose_camera(r, &all, camera, &wanted))
        return false;
    text_lines_rewind(r);
    while (text_lines_next_full(r)) {
        rest = read_id(r->line + strspn(r->line, " "), ' ', &id);
        if (rest && id == wanted)
            return read_model(r, rest + strspn(rest, " "), c);
    }
    return refuse_camera(r, &all, camera); /* the file was changed meanwhile */
}

/* ---- KITTI ---------------------------------------------------------------------------------------------------- */

/* The numbers of the one line that begins with a name such as "P_rect_02:". What is said next is about that line. */
static bool read_named(text_lines *r, const char *name, uint32_t count, double *numbers)
{
    char expected[64];
    uint32_t found = 0;
    snprintf(expected, sizeof expected, "%u numbers of %.*s (KITTI)", count, (int)strlen(name) - 1, name);
    text_lines_rewind(r);
    while (text_lines_next_full(r)) {
        if (strncmp(r->line, name, strlen(name)) != 0)
            continue;
        if (found)
            return text_lines_wrong(r, "each line once", name);
        found = r->number;
        if (!text_lines_all_numbers(r, r->line + strlen(name), count, expected, numbers))
            return false;
    }
    r->number = found;
    return found || file_fail(r->error, r->error_size, "%s: expected a line %s of the camera, got none", r->path, name);
}

/* Rows of a camera matrix with `columns` columns: fx 0 cx, 0 fy cy, 0 0 1. A fourth column is where the camera is: its
 * first number is -fx times how far it is to the right. */
static bool read_matrix(text_lines *r, const char *name, uint32_t columns, camera_calibration *c)
{
    double m[12];
    if (!read_named(r, name, 3 * columns, m))
        return false;
    const double *row[3] = {m, m + columns, m + 2 * columns};
    if (row[0][1] != 0 || row[1][0] != 0 || row[2][0] != 0 || row[2][1] != 0 || row[2][2] != 1)
        return text_lines_wrong(r, "rows fx 0 cx, 0 fy cy, 0 0 1 of a camera matrix", "another matrix");
    if (!take_pinhole(r, row[0][0], row[1][1], row[0][2], row[1][2], 0, c))
        return false;
    c->right_m = columns > 3 ? -row[0][3] / row[0][0] : 0;
    return fabs(c->right_m) <= MAX_RIGHT_M ||
           text_lines_wrong_number(r, "a camera up to 100 m to the right of camera 0", "%g m", c->right_m);
}

static bool read_size(text_lines *r, const char *name, camera_calibration *c)
{
    double size[2];
    if (!read_named(r, name, 2, size))
        return false;
    return take_size(r, size, c);
}

static bool read_lens(text_lines *r, const char *name, camera_calibration *c)
{
    double lens[5];
    if (!read_named(r, name, 5, lens))
        return false;
    return take_distortion(r, lens, 5, c);
}

/* The cameras for which there are lines "PREFIXnumber:". */
static bool find_cameras(text_lines *r, const char *prefix, cameras *all)
{
    uint32_t id;
    text_lines_rewind(r);
    while (text_lines_next_full(r))
        if (!strncmp(r->line, prefix, strlen(prefix)) && read_id(r->line + strlen(prefix), ':', &id) &&
            !add_camera(r, all, id))
            return false;
    return true;
}

static bool read_kitti_raw(text_lines *r, const char *camera, camera_calibration *c)
{
    cameras all = {.form = "%02u"};
    uint32_t id;
    char name[24], bare[48] = "";
    const char *space = camera ? strchr(camera, ' ') : NULL;
    const bool raw = space && !strcmp(space, " raw");
    if (raw)
        snprintf(bare, sizeof bare, "%.*s", space - camera < 40 ? (int)(space - camera) : 40, camera);
    if (!find_cameras(r, "S_", &all) || !choose_camera(r, &all, raw ? bare : camera, &id))
        return false;
    snprintf(name, sizeof name, raw ? "S_%02u:" : "S_rect_%02u:", id);
    if (!read_size(r, name, c))
        return false;
    snprintf(name, sizeof name, raw ? "K_%02u:" : "P_rect_%02u:", id);
    if (!read_matrix(r, name, raw ? 3 : 4, c))
        return false;
    snprintf(name, sizeof name, "D_%02u:", id);
    return !raw || read_lens(r, name, c);
}

static bool read_kitti_odometry(text_lines *r, const char *camera, camera_calibration *c)
{
    cameras all = {.form = "%u"};
    uint32_t id;
    char name[24];
    if (!find_cameras(r, "P", &all) || !choose_camera(r, &all, camera, &id))
        return false;
    snprintf(name, sizeof name, "P%u:", id);
    return read_matrix(r, name, 4, c);
}

/* ---- Cityscapes ----------------------------------------------------------------------------------------------- */

static bool take_intrinsic(text_lines *r, const json_t *root, camera_calibration *c)
{
    static const char *const keys[] = {"fx", "fy", "u0", "v0"};
    const json_t *intrinsic = json_object_get(root, "intrinsic");
    double n[4];
    for (int i = 0; i < 4; i++) {
        const json_t *value = json_object_get(intrinsic, keys[i]);
        if (!json_is_number(value))
            return file_fail(r->error, r->error_size, "%s: expected a number intrinsic.%s (Cityscapes), got %s",
                             r->path, keys[i], value ? "something else" : "none");
        n[i] = json_number_value(value);
    }
    r->number = 0; /* JSON does not say where a number is */
    c->size_px[0] = 2048;
    c->size_px[1] = 1024;
    return take_pinhole(r, n[0], n[1], n[2], n[3], 0, c);
}

static bool read_cityscapes(text_lines *r, const char *camera, camera_calibration *c)
{
    json_error_t reason;
    void *text;
    size_t size;
    if (camera)
        return file_fail(r->error, r->error_size, "%s: expected no camera, as the file has one, got %.40s", r->path,
                         camera);
    if (!file_read(r->path, MAX_JSON_BYTES, &text, &size, r->error, r->error_size))
        return false;
    json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &reason);
    free(text);
    if (!root) {
        for (char *p = reason.text; *p; p++)
            *p = *p < ' ' || *p > '~' ? '?' : *p;
        return file_fail(r->error, r->error_size, "%s:%d: expected JSON of Cityscapes: %s", r->path, reason.line,
                         reason.text);
    }
    const bool good = take_intrinsic(r, root, c);
    json_decref(root);
    return good;
}

/* ---- all ------------------------------------------------------------------------------------------------------ */

static bool begins_with_any(const char *line, const char *const *words)
{
    for (; *words; words++)
        if (!strncmp(line, *words, strlen(*words)))
            return true;
    return false;
}

static bool read_any(text_lines *r, const char *camera, camera_calibration *c)
{
    static const char *const raw[] = {"calib_time:", "corner_dist:", "S_", "K_", "D_", "R_", "T_", "P_", NULL};
    char got[48];
    uint32_t id;
    if (!text_lines_next_full(r))
        return ferror(r->file) || file_fail(r->error, r->error_size, "%s: expected a calibration, got none", r->path);
    const char *text = r->line + strspn(r->line, " ");
    if (*text == '{')
        return read_cityscapes(r, camera, c);
    if (begins_with_any(text, raw))
        return read_kitti_raw(r, camera, c);
    if (*text == 'P' && read_id(text + 1, ':', &id))
        return read_kitti_odometry(r, camera, c);
    if (read_id(text, ' ', &id))
        return read_colmap(r, camera, c);
    snprintf(got, sizeof got, "'%.40s'", text);
    return text_lines_wrong(
        r, "COLMAP's cameras.txt, KITTI's calib_cam_to_cam.txt or calib.txt, or a camera of Cityscapes", got);
}

bool camera_calibration_read(const char *path, const char *camera, camera_calibration *calibration, char *error,
                             size_t error_size)
{
    text_lines r;
    *calibration = (camera_calibration){.size_px = {0}};
    const bool good =
        text_lines_open(&r, path, error, error_size) && text_lines_close(&r, read_any(&r, camera, calibration));
    if (!good)
        *calibration = (camera_calibration){.size_px = {0}};
    return good;
}
