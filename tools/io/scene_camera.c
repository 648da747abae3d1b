/* scene_camera.c - the key `camera` of scene files: lens, calibration and path. */
#include "scene_camera.h"

#include "camera_poses.h"
#include "scene_rows.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- keys ----------------------------------------------------------------------------------------------------- */

static const scene_row camera_key_rows[] = {
    NUMBER(scene_camera_key, time_s, -MAX_METERS, MAX_METERS, "0", RESTARTS, "when the camera is there"),
    NUMBER(scene_camera_key, position_m, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "where the camera is"),
    NUMBER(scene_camera_key, look_at_m, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "what it looks at"),
    NUMBER(scene_camera_key, roll_deg, -36000, 36000, "0", RESTARTS, "turn about its own axis, clockwise"),
    SWITCH(scene_camera_key, cut, "false", RESTARTS, "a new shot begins here"),
};
static const scene_group camera_key_group = SCENE_GROUP(scene_camera_key, camera_key_rows);

static const scene_row focus_key_rows[] = {
    NUMBER(scene_focus_key, time_s, -MAX_METERS, MAX_METERS, "0", RESTARTS, "when the focus is there"),
    NUMBER(scene_focus_key, focus_m, 0, 1e6, "0", RESTARTS, "distance that is sharp; 0: infinity"),
    OPTIONAL_TEXT(scene_focus_key, focus_on, 95, RESTARTS, "or a part of the name of what is sharp"),
};
static const scene_group focus_key_group = SCENE_GROUP(scene_focus_key, focus_key_rows);

static const scene_row calibration_rows[] = {
    FILE_NAME(
        scene_calibration, file, OPTIONAL,
        "of COLMAP (cameras.txt), KITTI (calib_cam_to_cam.txt, calib.txt) or Cityscapes, in place of the numbers"),
    OPTIONAL_TEXT(scene_calibration, camera, 40, RESTARTS,
                  "its number in the file, as 02; '02 raw' for KITTI's pictures that are not rectified; without it the "
                  "only one"),
    WHOLE(scene_calibration, size_px, 0, 65536, "[0, 0]", RESTARTS,
          "of the picture that the other numbers are for; 0: the plate's, without one frames.size"),
    NUMBER(scene_calibration, focal_px, 0, 1e6, "[0, 0]", RESTARTS,
           "focal length to the side and up (fx, fy); 0: not calibrated"),
    NUMBER(scene_calibration, center_px, -1e5, 1e5, "[0, 0]", RESTARTS,
           "where the camera's axis meets the picture (cx, cy); [0, 0] is the middle of the upper left pixel, and "
           "without it the picture's middle"),
    NUMBER(scene_calibration, distortion, -1e3, 1e3, "[0, 0, 0, 0, 0]", RESTARTS,
           "how the lens bends lines: k1, k2, p1, p2, k3, in OpenCV's order; undone before water is drawn and done "
           "again after"),
};
static const scene_group calibration_group = SCENE_GROUP(scene_calibration, calibration_rows);

static const scene_keyword pose_formats[] = {
    {"kitti", CAMERA_POSES_KITTI}, {"tum", CAMERA_POSES_TUM}, {"colmap", CAMERA_POSES_COLMAP}, {NULL, 0}};
static const scene_keyword pose_ups[] = {{"camera", CAMERA_POSES_UP_CAMERA}, {"y", CAMERA_POSES_UP_Y},
                                         {"z", CAMERA_POSES_UP_Z},           {"-y", CAMERA_POSES_UP_MINUS_Y},
                                         {"-z", CAMERA_POSES_UP_MINUS_Z},    {NULL, 0}};
static const scene_keyword pose_images[] = {
    {"order", CAMERA_POSES_BY_ORDER}, {"number", CAMERA_POSES_BY_NUMBER}, {NULL, 0}};
static const scene_row pose_rows[] = {
    FILE_NAME(scene_poses, file, 0, "where the camera was in each frame; in place of keys"),
    CHOICE(scene_poses, format, pose_formats, "kitti", RESTARTS,
           "kitti: 12 numbers a line; tum: time, position and quaternion; colmap: an images.txt"),
    FILE_NAME(scene_poses, times, OPTIONAL, "a time in seconds a line, for each pose of kitti or image of colmap"),
    NUMBER(scene_poses, rate_hz, 0, 1e5, "0", RESTARTS, "poses a second, where no times are given; 0: frames.fps"),
    CHOICE(scene_poses, images, pose_images, "order", RESTARTS,
           "which frame an image of colmap is: by the order of names, or by the last number in its name"),
    NUMBER(scene_poses, scale, 1e-6, 1e6, "1", RESTARTS, "metres of a unit of the file"),
    CHOICE(scene_poses, up, pose_ups, "camera", RESTARTS,
           "what is up in the file; camera: what is up for the first camera, but for pitch_deg"),
};
static const scene_group poses_group = SCENE_GROUP(scene_poses, pose_rows);

static const scene_keyword blurs[] = {{"gather", SCENE_BLUR_GATHER}, {"exact", SCENE_BLUR_EXACT}, {NULL, 0}};
static const scene_row camera_rows[] = {
    NUMBER(scene_camera, fov_deg, 1, 170, "50", LIVE, "angle of view of the picture's height, without focal_mm"),
    NUMBER(scene_camera, focal_mm, 0, 2000, "0", LIVE, "focal length, for the angle of view; 0: from fov_deg"),
    NUMBER(scene_camera, sensor_mm, 1, 1000, "24", LIVE, "height of the sensor"),
    GROUP(scene_camera, calibration, &calibration_group, RESTARTS,
          "the angle of view of a camera that was calibrated, in pixels; in place of focal_mm and fov_deg"),
    NUMBER(scene_camera, near_m, 1e-4, 1e4, "0.1", LIVE, "what is nearer is not drawn"),
    NUMBER(scene_camera, far_m, 1e-3, MAX_METERS, "2000", LIVE, "what is farther is not drawn"),
    NUMBER(scene_camera, aperture_f, 0, 128, "0", LIVE,
           "f-number: what is out of focus is blurred by a lens this wide; 0: everything is sharp"),
    NUMBER(scene_camera, aperture_mm, 0, 1000, "0", LIVE,
           "width of the lens's opening for streaks alone, e.g. over footage; without aperture_f"),
    NUMBER(scene_camera, focus_m, 0, 1e6, "0", LIVE, "distance that is sharp; 0: infinity"),
    OPTIONAL_TEXT(scene_camera, focus_on, 95, RESTARTS,
                  "a part of the name of what is sharp instead: a mesh, a material or a pane"),
    LIST(scene_camera, focus_keys, focus_key_count, &focus_key_group, 0, 100000, "[]",
         "a rack focus: where the focus is at some times, in order of time"),
    WHOLE(scene_camera, blades, 0, 16, "0", LIVE, "of the aperture; below 3: it is round"),
    NUMBER(scene_camera, blade_roundness, 0, 1, "0", LIVE, "0: straight blades, 1: a circle"),
    NUMBER(scene_camera, blade_rotation_deg, -360, 360, "0", LIVE, "turns the aperture, clockwise"),
    NUMBER(scene_camera, cats_eye, 0, 1, "0", LIVE, "how far the lens cuts discs in the picture's corners"),
    NUMBER(scene_camera, breathing, 0, 1, "0", LIVE,
           "how much the angle of view narrows as the focus comes nearer; 1: as that of a simple lens"),
    CHOICE(scene_camera, blur, blurs, "gather", RESTARTS,
           "gather: each sub-frame is blurred by its depth; exact: each looks from another point of the lens"),
    SWITCH(scene_camera, bloom, "false", RESTARTS, "droplets in the air spread the light of what is bright"),
    NUMBER(scene_camera, bloom_visibility_m, 20, 20000, "500", LIVE,
           "how far one sees through these droplets alone; light from farther away is spread more"),
    NUMBER(scene_camera, bloom_drop_um, 3, 200, "15", LIVE,
           "diameter of the droplets: small ones spread light wide; fog has 10 to 30, drizzle 200"),
    LIST(scene_camera, keys, key_count, &camera_key_group, 0, 100000, "[]",
         "positions on the camera's path, in order of time", .keep_count = 1),
    OPTIONAL_GROUP(scene_camera, poses, &poses_group, RESTARTS, "the camera's path from a file, in place of keys"),
    OPTIONAL_NUMBER(scene_camera, speed_m_s, -1000, 1000, RESTARTS,
                    "the camera moves ahead over the ground at this speed, with one key or none"),
    NUMBER(scene_camera, height_m, 0, 1e5, "1.5", RESTARTS,
           "of the camera above y = 0, for poses (their first) or a speed without keys"),
    NUMBER(scene_camera, pitch_deg, -89, 89, "0", RESTARTS, "how far that camera looks up; below 0: down"),
};
const scene_group scene_camera_group = SCENE_GROUP(scene_camera, camera_rows);

/* ---- the lens ------------------------------------------------------------------------------------------------- */

#define DEGREES (180 / 3.14159265358979323846)

bool scene_camera_is_calibrated(const scene_file *scene)
{
    return scene->camera.calibration.focal_px[1] > 0;
}

void scene_camera_calibrated_size(const scene_file *scene, uint32_t size_px[2])
{
    const scene_calibration *calibration = &scene->camera.calibration;
    const uint32_t *from = calibration->size_px[0]      ? calibration->size_px
                           : scene->footage.plate_px[0] ? scene->footage.plate_px
                                                        : scene->frames.size;
    memcpy(size_px, from, 2 * sizeof *size_px);
}

void scene_camera_calibrated_center(const scene_file *scene, double center_px[2])
{
    const double *given = scene->camera.calibration.center_px;
    uint32_t size_px[2];
    scene_camera_calibrated_size(scene, size_px);
    for (int axis = 0; axis < 2; axis++)
        center_px[axis] = given[0] != 0 || given[1] != 0 ? given[axis] + 0.5 : 0.5 * size_px[axis];
}

distortion scene_camera_distortion(const scene_file *scene)
{
    const double *k = scene->camera.calibration.distortion;
    return (distortion){.k1 = k[0], .k2 = k[1], .p1 = k[2], .p2 = k[3], .k3 = k[4]};
}

/* Half the height of what the camera shows at a distance of 1. */
static double half_height(const scene_file *scene)
{
    const scene_camera *camera = &scene->camera;
    uint32_t size_px[2];
    if (!scene_camera_is_calibrated(scene))
        return camera->focal_mm > 0 ? 0.5 * camera->sensor_mm / camera->focal_mm : tan(0.5 * camera->fov_deg / DEGREES);
    scene_camera_calibrated_size(scene, size_px);
    return 0.5 * size_px[1] / camera->calibration.focal_px[1];
}

double scene_camera_fov_deg(const scene_file *scene)
{
    const scene_camera *camera = &scene->camera;
    if (scene_camera_is_calibrated(scene))
        return 2 * DEGREES * atan(half_height(scene));
    return camera->focal_mm > 0 ? 2 * DEGREES * atan(0.5 * camera->sensor_mm / camera->focal_mm) : camera->fov_deg;
}

double scene_camera_focal_m(const scene_file *scene)
{
    const scene_camera *camera = &scene->camera;
    const bool by_mm = camera->focal_mm > 0 && !scene_camera_is_calibrated(scene);
    return 1e-3 * (by_mm ? camera->focal_mm : 0.5 * camera->sensor_mm / half_height(scene));
}

double scene_camera_aperture_m(const scene_file *scene)
{
    const scene_camera *camera = &scene->camera;
    return camera->aperture_f > 0 ? scene_camera_focal_m(scene) / camera->aperture_f : 0;
}

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

/* Whether the lens can be undone over the whole picture. The shot looks itself where its size is not known here. */
static bool check_distortion(const scene_file *scene, char *error, size_t error_size)
{
    const scene_calibration *c = &scene->camera.calibration;
    distortion_map map = {.lens = scene_camera_distortion(scene)};
    char reason[256];
    if (!c->size_px[0] || !distortion_is_given(&map.lens))
        return true;
    memcpy(map.size, c->size_px, sizeof map.size);
    memcpy(map.focal_px, c->focal_px, sizeof map.focal_px);
    scene_camera_calibrated_center(scene, map.center_px);
    return distortion_map_open(&map, reason, sizeof reason) ||
           scene_file_refuse(scene, "camera.calibration.distortion", error, error_size, "%s", reason);
}

static bool check_calibration(const scene_file *scene, char *error, size_t error_size)
{
    const scene_calibration *c = &scene->camera.calibration;
    const char *focal = "camera.calibration.focal_px", *size = "camera.calibration.size_px";
    const distortion lens = scene_camera_distortion(scene);
    const bool is_given =
        c->size_px[0] || c->size_px[1] || c->center_px[0] != 0 || c->center_px[1] != 0 || distortion_is_given(&lens);
    const double fov_deg = scene_camera_fov_deg(scene);
    if ((c->focal_px[0] > 0) != (c->focal_px[1] > 0) || (is_given && !scene_camera_is_calibrated(scene)))
        return scene_file_refuse(scene, focal, error, error_size, "expected two numbers above 0, got [%g, %g]",
                                 c->focal_px[0], c->focal_px[1]);
    if (!c->size_px[0] != !c->size_px[1])
        return scene_file_refuse(scene, size, error, error_size, "expected two numbers above 0, got [%u, %u]",
                                 c->size_px[0], c->size_px[1]);
    if (!scene_camera_is_calibrated(scene))
        return true;
    if (scene->camera.focal_mm > 0)
        return scene_file_refuse(scene, "camera.focal_mm", error, error_size, "expected it without %s", focal);
    if (fov_deg < 1 || fov_deg > 170)
        return scene_file_refuse(scene, focal, error, error_size,
                                 "expected an angle of view of 1 to 170 degrees, got %.3g", fov_deg);
    return check_distortion(scene, error, error_size);
}

bool scene_camera_check_lens(const scene_file *scene, char *error, size_t error_size)
{
    const scene_camera *camera = &scene->camera;
    char key[64];
    const double fov_deg = scene_camera_fov_deg(scene);
    if (!check_calibration(scene, error, error_size))
        return false;
    if (fov_deg < 1 || fov_deg > 170)
        return scene_file_refuse(scene, "camera.focal_mm", error, error_size,
                                 "expected an angle of view of 1 to 170 degrees, got %.3g on a sensor of %g mm",
                                 fov_deg, camera->sensor_mm);
    if (camera->aperture_f > 0 && camera->aperture_mm > 0)
        return scene_file_refuse(scene, "camera.aperture_mm", error, error_size,
                                 "expected it without aperture_f, which also blurs streaks");
    for (uint32_t i = 1; i < camera->focus_key_count; i++) {
        const scene_focus_key *now = &camera->focus_keys[i];
        if (now->time_s > now[-1].time_s)
            continue;
        snprintf(key, sizeof key, "camera.focus_keys.%u.time_s", i);
        return scene_file_refuse(scene, key, error, error_size, "expected more than the key before has (%g), got %g",
                                 now[-1].time_s, now->time_s);
    }
    return true;
}

/* One of three ways to give a path. */
static bool check_path(const scene_file *scene, char *error, size_t error_size)
{
    const scene_camera *c = &scene->camera;
    const scene_poses *poses = &c->poses;
    if (!c->key_count && !poses->file && !c->speed_m_s)
        return scene_file_refuse(scene, "camera.keys", error, error_size,
                                 "is missing; expected one of keys, poses and speed_m_s");
    if (c->key_count && poses->file)
        return scene_file_refuse(scene, "camera.poses", error, error_size, "expected it without camera.keys");
    if (c->speed_m_s && poses->file)
        return scene_file_refuse(scene, "camera.speed_m_s", error, error_size, "expected it without camera.poses");
    if (c->speed_m_s && c->key_count > 1)
        return scene_file_refuse(scene, "camera.speed_m_s", error, error_size,
                                 "expected one entry in camera.keys, or none, got %u", c->key_count);
    if (c->speed_m_s && c->key_count && c->keys[0].position_m[0] == c->keys[0].look_at_m[0] &&
        c->keys[0].position_m[2] == c->keys[0].look_at_m[2])
        return scene_file_refuse(scene, "camera.keys.0.look_at_m", error, error_size,
                                 "expected a direction that is not straight up or down, with camera.speed_m_s");
    if (c->pitch_deg != 0 && (c->key_count || (poses->file && poses->up != CAMERA_POSES_UP_CAMERA)))
        return scene_file_refuse(scene, "camera.pitch_deg", error, error_size,
                                 "expected it with poses.up: camera, or with speed_m_s without keys");
    if (!poses->times || (poses->format != CAMERA_POSES_TUM &&
                          !(poses->format == CAMERA_POSES_COLMAP && poses->images == CAMERA_POSES_BY_NUMBER)))
        return true;
    return scene_file_refuse(scene, "camera.poses.times", error, error_size,
                             "expected it with format kitti, or colmap with images: order");
}

bool scene_camera_check(const scene_file *scene, char *error, size_t error_size)
{
    const scene_camera *camera = &scene->camera;
    char key[64];
    if (camera->far_m <= camera->near_m)
        return scene_file_refuse(scene, "camera.far_m", error, error_size, "expected more than near_m (%g), got %g",
                                 camera->near_m, camera->far_m);
    if (!scene_camera_check_lens(scene, error, error_size) || !check_path(scene, error, error_size))
        return false;
    for (uint32_t i = 0; i < camera->key_count; i++) {
        const scene_camera_key *now = &camera->keys[i];
        if (i > 0 && now->time_s <= now[-1].time_s) {
            snprintf(key, sizeof key, "camera.keys.%u.time_s", i);
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected more than the key before has (%g), got %g", now[-1].time_s, now->time_s);
        }
        if (!memcmp(now->position_m, now->look_at_m, sizeof now->position_m)) {
            snprintf(key, sizeof key, "camera.keys.%u.look_at_m", i);
            return scene_file_refuse(scene, key, error, error_size, "expected another position than position_m");
        }
    }
    return true;
}
