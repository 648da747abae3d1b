/* layouts.c - where two well known data sets have the depth, the calibration and the speed of a picture.
 *
 * KITTI raw (Geiger et al. 2013), as it is unpacked, with the depth set (Uhrig et al. 2017) in the drives or beside:
 *     DATE/calib_cam_to_cam.txt
 *     DATE/DRIVE/image_02/data/0000000005.png                  cameras 00 to 03
 *     DATE/DRIVE/oxts/data/0000000005.txt                      the ninth number is the speed ahead
 *     DATE/DRIVE/proj_depth/groundtruth/image_02/0000000005.png
 *     DEPTHS/DRIVE/proj_depth/..., DEPTHS/train/DRIVE/..., DEPTHS/val/DRIVE/...
 *
 * Cityscapes (Cordts et al. 2016):
 *     leftImg8bit/SPLIT/CITY/NAME_leftImg8bit.png              and the same with disparity, camera and vehicle:
 *     disparity/SPLIT/CITY/NAME_disparity.png, camera/.../NAME_camera.json, vehicle/.../NAME_vehicle.json */
#include "dataset/list.h"

#include "file.h"
#include "host.h"
#include "text_lines.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MAX_JSON_BYTES (1u << 20)

bool dataset_layout_parse(const char *word, dataset_layout *layout)
{
    *layout = DATASET_FOLDER;
    if (word && !strcmp(word, "kitti-raw"))
        *layout = DATASET_KITTI_RAW;
    else if (word && !strcmp(word, "cityscapes"))
        *layout = DATASET_CITYSCAPES;
    return !word || *layout != DATASET_FOLDER;
}

/* The last place in a path where there is a part such as "/leftImg8bit/". */
static const char *find_last(const char *path, const char *part)
{
    const char *found = NULL;
    for (const char *at = strstr(path, part); at; at = strstr(at + 1, part))
        found = at;
    return found;
}

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), wanted = strlen(end);
    return length >= wanted && !strcmp(text + length - wanted, end);
}

/* ---- KITTI */

/* The drive's folder, the camera's number and the name without its ending. */
typedef struct kitti_name {
    int drive;  /* length of the path of the drive's folder */
    int camera; /* 0 to 3 */
    char number[64];
} kitti_name;

static bool split_kitti(const char *path, kitti_name *name)
{
    const char *image = find_last(path, "/image_0");
    int end = 0;
    if (!image || image == path || sscanf(image, "/image_0%1d/data/%n", &name->camera, &end) != 1 || !end ||
        name->camera > 3 || strchr(image + end, '/'))
        return false;
    name->drive = (int)(image - path);
    snprintf(name->number, sizeof name->number, "%.*s", (int)strcspn(image + end, "."), image + end);
    return true;
}

/* The ninth number of the line is the speed to the front (m/s). A drive may lack the file. */
static bool read_oxts(const char *path, double *speed_m_s, char *error, size_t error_size)
{
    text_lines r;
    double numbers[9];
    const char *rest;
    if (access(path, F_OK))
        return true;
    if (!text_lines_open(&r, path, error, error_size))
        return false;
    const bool read = (text_lines_next_full(&r) || text_lines_wrong(&r, "numbers of an OXTS record (KITTI)", "none")) &&
                      text_lines_numbers(&r, r.line, 9, "30 numbers of an OXTS record (KITTI)", numbers, &rest);
    if (read)
        *speed_m_s = numbers[8];
    return text_lines_close(&r, read);
}

/* In the drive, or in a folder that has only depths. */
static bool find_kitti_depth(const dataset_list_def *def, dataset_picture *p, const kitti_name *name)
{
    static const char *const below[] = {"", "/train", "/val"};
    char path[4096], drive[4096];
    snprintf(drive, sizeof drive, "%.*s", name->drive, p->path);
    const char *slash = strrchr(drive, '/'), *last = slash ? slash + 1 : drive;
    for (int i = -1; i < (def->depths ? 3 : 0); i++) {
        char folder[4096];
        int length = i < 0 ? snprintf(folder, sizeof folder, "%s", drive)
                           : snprintf(folder, sizeof folder, "%s%s/%s", def->depths, below[i], last);
        length += snprintf(path, sizeof path, "%s/proj_depth/groundtruth/image_%02d/%s.png", folder, name->camera,
                           name->number);
        if (length >= 4096 || access(path, R_OK))
            continue;
        p->depth = strdup(path);
        return p->depth;
    }
    return true;
}

static bool fill_kitti(const dataset_list_def *def, dataset_picture *p, char *error, size_t error_size)
{
    kitti_name name;
    char path[4096], camera[8];
    if (!split_kitti(p->path, &name))
        return host_fail(error, error_size, "%s: not a picture of KITTI's raw data", p->path);
    const char *date_end = memrchr(p->path, '/', (size_t)name.drive);
    snprintf(path, sizeof path, "%.*s/calib_cam_to_cam.txt", date_end ? (int)(date_end - p->path) : 1,
             date_end ? p->path : ".");
    snprintf(camera, sizeof camera, "%02d", name.camera);
    if (!camera_calibration_read(path, camera, &p->calibration, error, error_size))
        return false;
    p->right_m = p->calibration.right_m;
    snprintf(path, sizeof path, "%.*s/oxts/data/%s.txt", name.drive, p->path, name.number);
    if (!read_oxts(path, &p->speed_m_s, error, error_size))
        return false;
    /* All cameras of a frame are in the same rain. */
    const char *drive = memrchr(p->path, '/', (size_t)name.drive);
    const int begin = drive ? (int)(drive + 1 - p->path) : 0;
    if (asprintf(&p->place, "%.*s/%s", name.drive - begin, p->path + begin, name.number) < 0)
        p->place = NULL;
    if (!p->place || !find_kitti_depth(def, p, &name))
        return host_fail(error, error_size, "no memory for a list of pictures");
    p->has_depth_def = p->fills_depth = true;
    p->depth_def = (depth_map_def){.kind = DEPTH_MAP_AXIS};
    return true;
}

/* ---- Cityscapes */

#define CITYSCAPES_END "_leftImg8bit.png"

/* The path of a picture's file of another kind. False: it is not there. */
static bool find_beside(const char *picture, const char *kind, const char *ending, char path[4096])
{
    const char *part = find_last(picture, "/leftImg8bit/"), *below = part + strlen("/leftImg8bit/");
    const int length = (int)(strlen(below) - strlen(CITYSCAPES_END));
    return snprintf(path, 4096, "%.*s/%s/%.*s_%s", (int)(part - picture), picture, kind, length, below, ending) <
               4096 &&
           !access(path, R_OK);
}

/* One number of a JSON file: "speed", or "extrinsic" and "baseline". */
static bool read_number(const char *path, const char *group, const char *key, double *number, char *error,
                        size_t error_size)
{
    json_error_t reason;
    void *text;
    size_t size;
    if (!file_read(path, MAX_JSON_BYTES, &text, &size, error, error_size))
        return false;
    json_t *root = json_loadb(text, size, 0, &reason);
    free(text);
    const json_t *value = json_object_get(group ? json_object_get(root, group) : root, key);
    const bool good = json_is_number(value) && isfinite(json_number_value(value));
    if (good)
        *number = json_number_value(value);
    json_decref(root);
    return good || host_fail(error, error_size, "%s: expected a number %s%s%s (Cityscapes)", path, group ? group : "",
                             group ? "." : "", key);
}

static bool fill_cityscapes(dataset_picture *p, char *error, size_t error_size)
{
    char path[4096];
    double baseline_m = 0;
    if (find_beside(p->path, "vehicle", "vehicle.json", path) &&
        !read_number(path, NULL, "speed", &p->speed_m_s, error, error_size))
        return false;
    if (!find_beside(p->path, "camera", "camera.json", path))
        return true;
    if (!camera_calibration_read(path, NULL, &p->calibration, error, error_size) ||
        !read_number(path, "extrinsic", "baseline", &baseline_m, error, error_size))
        return false;
    if (!find_beside(p->path, "disparity", "disparity.png", path))
        return true;
    if (!(baseline_m > 0))
        return host_fail(error, error_size, "%s: expected extrinsic.baseline above 0 in its camera.json", p->path);
    p->depth = strdup(path);
    p->has_depth_def = p->fills_depth = true;
    p->depth_def =
        (depth_map_def){.kind = DEPTH_MAP_DISPARITY, .baseline_m = baseline_m, .focal_px = p->calibration.focal_px[0]};
    return p->depth || host_fail(error, error_size, "no memory for a list of pictures");
}

/* ---- both */

bool dataset_layout_takes(dataset_layout layout, const char *path)
{
    kitti_name name;
    if (layout == DATASET_KITTI_RAW)
        return split_kitti(path, &name);
    return layout == DATASET_FOLDER || (find_last(path, "/leftImg8bit/") && ends_with(path, CITYSCAPES_END));
}

bool dataset_layout_fill(const dataset_list_def *def, dataset_picture *p, char *error, size_t error_size)
{
    if (def->layout == DATASET_KITTI_RAW)
        return fill_kitti(def, p, error, error_size);
    return def->layout != DATASET_CITYSCAPES || fill_cityscapes(p, error, error_size);
}
