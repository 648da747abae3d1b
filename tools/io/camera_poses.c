/* camera_poses.c - reads lines of numbers as poses, and turns them into a world with Y up. */
#include "camera_poses.h"

#include "file.h"
#include "text_lines.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI         3.14159265358979323846
#define TOLERANCE  0.01 /* of the length of quaternions and axes; files round them to a few digits */
#define FARTHEST_M 1e6
#define SHORTEST_S 1e-6 /* between two poses */

/* ---- poses ---------------------------------------------------------------------------------------------------- */

/* A pose as the file has it: place and axes of the camera in the file's world, right, down, ahead. */
typedef struct raw_pose {
    double time_s, position[3], axes[3][3];
    uint32_t line;
    char *image; /* (COLMAP) */
} raw_pose;

typedef struct raw_poses {
    raw_pose *list;
    uint32_t count, capacity;
} raw_poses;

static raw_pose *add_pose(const text_lines *r, raw_poses *poses)
{
    if (poses->count == CAMERA_POSES_MAX) {
        text_lines_wrong_number(r, "the end of the file", "more than %.0f poses", CAMERA_POSES_MAX);
        return NULL;
    }
    if (poses->count == poses->capacity) {
        const uint32_t more = poses->capacity ? 2 * poses->capacity : 64;
        raw_pose *grown = realloc(poses->list, more * sizeof *grown);
        if (!grown) {
            file_fail(r->error, r->error_size, "cannot read %s: no more memory", r->path);
            return NULL;
        }
        poses->list = grown;
        poses->capacity = more;
    }
    raw_pose *pose = &poses->list[poses->count++];
    *pose = (raw_pose){.line = r->number};
    return pose;
}

static void free_poses(raw_poses *poses)
{
    for (uint32_t i = 0; i < poses->count; i++)
        free(poses->list[i].image);
    free(poses->list);
}

/* ---- rotations ------------------------------------------------------------------------------------------------ */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Makes three axes that are nearly so of unit length and at right angles. */
static bool straighten(double axes[3][3])
{
    for (int i = 0; i < 3; i++) {
        const double length = sqrt(dot(axes[i], axes[i]));
        if (!(fabs(length - 1) < TOLERANCE))
            return false;
        for (int k = 0; k < i; k++) {
            const double along = dot(axes[i], axes[k]);
            if (!(fabs(along) < TOLERANCE))
                return false;
            for (int c = 0; c < 3; c++)
                axes[i][c] -= along * axes[k][c];
        }
        const double left = sqrt(dot(axes[i], axes[i]));
        for (int c = 0; c < 3; c++)
            axes[i][c] /= left;
    }
    double turned = 0; /* of the third by the first two: -1 for axes of a mirror */
    for (int c = 0; c < 3; c++)
        turned +=
            axes[2][c] * (axes[0][(c + 1) % 3] * axes[1][(c + 2) % 3] - axes[0][(c + 2) % 3] * axes[1][(c + 1) % 3]);
    return turned > 0;
}

/* The columns of the matrix of a quaternion x y z w. */
static bool turn_by(const text_lines *r, const double given[4], double columns[3][3])
{
    double q[4], length = 0;
    for (int i = 0; i < 4; i++)
        length += given[i] * given[i];
    length = sqrt(length);
    if (!(fabs(length - 1) < TOLERANCE))
        return text_lines_wrong_number(r, "a quaternion of length 1", "one of length %.3g", length);
    for (int i = 0; i < 4; i++)
        q[i] = given[i] / length;
    for (int c = 0; c < 3; c++) {
        const int a = (c + 1) % 3, b = (c + 2) % 3;
        columns[c][c] = 1 - 2 * (q[a] * q[a] + q[b] * q[b]);
        columns[c][a] = 2 * (q[c] * q[a] + q[3] * q[b]);
        columns[c][b] = 2 * (q[c] * q[b] - q[3] * q[a]);
    }
    return true;
}

/* ---- formats -------------------------------------------------------------------------------------------------- */

static bool read_kitti(text_lines *r, raw_poses *poses, double rate_hz)
{
    while (text_lines_next_full(r)) {
        double n[12];
        raw_pose *pose = add_pose(r, poses);
        if (!pose || !text_lines_all_numbers(r, r->line, 12, "12 numbers of a pose (KITTI)", n))
            return false;
        for (int row = 0; row < 3; row++) {
            pose->position[row] = n[row * 4 + 3];
            for (int axis = 0; axis < 3; axis++)
                pose->axes[axis][row] = n[row * 4 + axis];
        }
        if (!straighten(pose->axes))
            return text_lines_wrong(r, "a rotation in the first 3 columns", "another matrix");
        pose->time_s = (poses->count - 1) / rate_hz;
    }
    return true;
}

static bool read_tum(text_lines *r, raw_poses *poses)
{
    while (text_lines_next_full(r)) {
        double n[8];
        raw_pose *pose = add_pose(r, poses);
        if (!pose || !text_lines_all_numbers(r, r->line, 8, "8 numbers: time, position, quaternion (TUM)", n))
            return false;
        memcpy(pose->position, &n[1], sizeof pose->position);
        pose->time_s = n[0];
        if (!turn_by(r, &n[4], pose->axes))
            return false;
        if (poses->count > 1 && !(pose->time_s > pose[-1].time_s + SHORTEST_S))
            return text_lines_wrong_number(r, "a time after the one before", "%.17g", pose->time_s);
    }
    return true;
}

/* From world to camera: its columns are the world's axes seen by the camera, its rows the camera's axes. */
static bool read_colmap_image(const text_lines *r, raw_pose *pose)
{
    const char *expected = "an image: 9 numbers and a name (COLMAP's images.txt)", *name;
    double n[9], world[3][3];
    if (r->is_long)
        return text_lines_wrong(r, expected, "a very long line");
    if (!text_lines_numbers(r, r->line, 9, expected, n, &name))
        return false;
    if (!*name)
        return text_lines_wrong(r, expected, "no name");
    if (!turn_by(r, (const double[4]){n[2], n[3], n[4], n[1]}, world))
        return false;
    for (int axis = 0; axis < 3; axis++)
        for (int c = 0; c < 3; c++) {
            pose->axes[axis][c] = world[c][axis];
            pose->position[c] -= pose->axes[axis][c] * n[5 + axis];
        }
    pose->image = strdup(name);
    return pose->image || file_fail(r->error, r->error_size, "cannot read %s: no more memory", r->path);
}

/* Behind each image comes a line of its points: threes of numbers, or nothing. A file from which empty lines were
 * removed would lose every second image. */
static bool skip_points(text_lines *r)
{
    double n[10];
    const char *rest;
    text_lines quiet = {.path = r->path};
    if (!text_lines_next(r) || r->is_long)
        return true;
    memcpy(quiet.line, r->line, sizeof quiet.line);
    return !text_lines_numbers(&quiet, quiet.line, 9, "", n, &rest) || !*rest ||
           text_lines_numbers(&quiet, quiet.line, 10, "", n, &rest) ||
           text_lines_wrong(r, "the points of the image before (the line may be empty)", "an image");
}

static bool read_colmap(text_lines *r, raw_poses *poses)
{
    while (text_lines_next_full(r)) {
        raw_pose *pose = add_pose(r, poses);
        if (!pose || !read_colmap_image(r, pose) || !skip_points(r))
            return false;
    }
    return true;
}

/* ---- times ---------------------------------------------------------------------------------------------------- */

static int by_name(const void *a, const void *b)
{
    return strcmp(((const raw_pose *)a)->image, ((const raw_pose *)b)->image);
}

static int by_time(const void *a, const void *b)
{
    const double x = ((const raw_pose *)a)->time_s, y = ((const raw_pose *)b)->time_s;
    return (x > y) - (x < y);
}

/* The last number in a name; false where there is none that a frame can have. */
static bool number_in(const char *name, double *number)
{
    const char *end = name + strlen(name);
    while (end > name && !(end[-1] >= '0' && end[-1] <= '9'))
        end--;
    const char *start = end;
    while (start > name && start[-1] >= '0' && start[-1] <= '9')
        start--;
    *number = strtod(start, NULL);
    return end > start && *number <= 1e6;
}

static bool order_images(text_lines *r, const camera_poses_def *def, raw_poses *poses)
{
    const bool by_number = def->images == CAMERA_POSES_BY_NUMBER;
    qsort(poses->list, poses->count, sizeof *poses->list, by_name);
    for (uint32_t i = 0; i < poses->count; i++) {
        raw_pose *pose = &poses->list[i];
        double number = i + def->first_frame;
        r->number = pose->line;
        if (by_number && !number_in(pose->image, &number))
            return text_lines_wrong(r, "a number up to 1000000 in the image's name", pose->image);
        pose->time_s = (number - def->first_frame) / def->rate_hz;
    }
    if (by_number)
        qsort(poses->list, poses->count, sizeof *poses->list, by_time);
    for (uint32_t i = 1; i < poses->count; i++) {
        r->number = poses->list[i].line;
        if (by_number ? poses->list[i].time_s <= poses->list[i - 1].time_s
                      : !by_name(&poses->list[i], &poses->list[i - 1]))
            return text_lines_wrong(r, "each frame once", poses->list[i].image);
    }
    return true;
}

static bool read_times(const char *path, raw_poses *poses, char *error, size_t error_size)
{
    text_lines r;
    uint32_t count = 0;
    bool good = text_lines_open(&r, path, error, error_size);
    if (!good)
        return false;
    while (good && text_lines_next_full(&r)) {
        double time_s;
        good = text_lines_all_numbers(&r, r.line, 1, "a time in seconds", &time_s);
        if (good && count == poses->count)
            good = text_lines_wrong_number(&r, "the end of the file", "more than %.0f times, one for each pose",
                                           poses->count);
        if (good && count && !(time_s > poses->list[count - 1].time_s + SHORTEST_S))
            good = text_lines_wrong_number(&r, "a time after the one before", "%.17g", time_s);
        if (good)
            poses->list[count++].time_s = time_s;
    }
    if (good && !ferror(r.file) && count < poses->count)
        good =
            file_fail(error, error_size, "%s: expected %u times, one for each pose, got %u", path, poses->count, count);
    return text_lines_close(&r, good);
}

/* ---- the world ------------------------------------------------------------------------------------------------ */

/* Rows of the rotation from the file's world to ours. */
static void world_from_file(const camera_poses_def *def, const raw_pose *first, double rows[3][3])
{
    static const double worlds[][3][3] = {
        [CAMERA_POSES_UP_Y] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
        [CAMERA_POSES_UP_Z] = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
        [CAMERA_POSES_UP_MINUS_Y] = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
        [CAMERA_POSES_UP_MINUS_Z] = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    };
    const double c = cos(def->pitch_deg * PI / 180), s = sin(def->pitch_deg * PI / 180);
    if (def->up != CAMERA_POSES_UP_CAMERA) {
        memcpy(rows, worlds[def->up], sizeof worlds[0]);
        return;
    }
    const double own[3][3] = {{1, 0, 0}, {0, -c, -s}, {0, s, -c}}; /* right, down and ahead of the first camera */
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            rows[row][column] = 0;
            for (int axis = 0; axis < 3; axis++)
                rows[row][column] += own[axis][row] * first->axes[axis][column];
        }
}

static bool convert(const text_lines *r, const camera_poses_def *def, const raw_poses *raw, camera_pose *poses)
{
    const double start_s = def->format == CAMERA_POSES_COLMAP && !def->times ? 0 : raw->list[0].time_s;
    const raw_pose *first = &raw->list[0];
    double rows[3][3];
    world_from_file(def, first, rows);
    for (uint32_t i = 0; i < raw->count; i++) {
        const raw_pose *from = &raw->list[i];
        camera_pose *to = &poses[i];
        double moved[3];
        to->time_s = from->time_s - start_s;
        for (int c = 0; c < 3; c++)
            moved[c] = (from->position[c] - first->position[c]) * def->scale;
        for (int c = 0; c < 3; c++) {
            to->position_m[c] = dot(rows[c], moved) + (c == 1 ? def->height_m : 0);
            for (int axis = 0; axis < 3; axis++)
                to->axes[axis][c] = (axis ? -1 : 1) * dot(rows[c], from->axes[axis]);
        }
        if (!(dot(moved, moved) < FARTHEST_M * FARTHEST_M) || !(fabs(to->time_s) < FARTHEST_M))
            return file_fail(r->error, r->error_size,
                             "%s:%u: expected a pose less than 1000 km and 1000000 s from the first", r->path,
                             from->line);
        /* Rotations of large worlds are rounded. */
        if (!straighten(to->axes))
            return file_fail(r->error, r->error_size, "%s:%u: expected a rotation", r->path, from->line);
    }
    return true;
}

static bool read_format(text_lines *r, const camera_poses_def *def, raw_poses *poses)
{
    switch (def->format) {
    case CAMERA_POSES_KITTI: return read_kitti(r, poses, def->rate_hz);
    case CAMERA_POSES_TUM: return read_tum(r, poses);
    case CAMERA_POSES_COLMAP: break;
    }
    return read_colmap(r, poses);
}

bool camera_poses_read(const camera_poses_def *def, camera_pose **poses, uint32_t *count, char *error,
                       size_t error_size)
{
    text_lines r;
    raw_poses raw = {.list = NULL};
    *poses = NULL;
    *count = 0;
    if (!text_lines_open(&r, def->file, error, error_size))
        return false;
    bool good = text_lines_close(&r, read_format(&r, def, &raw));
    if (good && !raw.count)
        good = file_fail(error, error_size, "%s: expected at least one pose, got none", def->file);
    if (good && def->format == CAMERA_POSES_COLMAP)
        good = order_images(&r, def, &raw);
    if (good && def->times)
        good = read_times(def->times, &raw, error, error_size);
    *poses = good ? malloc(raw.count * sizeof **poses) : NULL;
    if (good && !*poses)
        good = file_fail(error, error_size, "cannot read %s: no more memory", def->file);
    good = good && convert(&r, def, &raw, *poses);
    if (good) {
        *count = raw.count;
    } else {
        free(*poses);
        *poses = NULL;
    }
    free_poses(&raw);
    return good;
}
