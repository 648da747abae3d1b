/* path.c - makes the keys of the camera's path. */
#include "shot/path.h"

#include "camera_poses.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool no_memory(char *error, size_t error_size)
{
    return host_fail(error, error_size, "no memory for the camera's path");
}

static host_camera_key of_scene(const scene_camera_key *from)
{
    host_camera_key key = {.time_s = from->time_s, .roll_deg = from->roll_deg, .cut = from->cut};
    memcpy(key.position_m, from->position_m, sizeof key.position_m);
    memcpy(key.look_at_m, from->look_at_m, sizeof key.look_at_m);
    return key;
}

static bool given_keys(const scene_camera *camera, host_camera_key **keys, uint32_t *count, char *error,
                       size_t error_size)
{
    *count = camera->key_count;
    *keys = malloc(*count * sizeof **keys);
    if (!*keys)
        return no_memory(error, error_size);
    for (uint32_t i = 0; i < camera->key_count; i++)
        (*keys)[i] = of_scene(&camera->keys[i]);
    return true;
}

/* ---- a speed */

#define AFTER_S 3600 /* the camera goes on so long behind the last frame, for those who watch it live */

/* The scene's one key, or a camera at its height that looks along -Z. */
static host_camera_key standing(const scene_camera *camera)
{
    const double pitch = camera->pitch_deg * M_PI / 180;
    if (camera->key_count)
        return of_scene(&camera->keys[0]);
    return (host_camera_key){.position_m = {0, camera->height_m, 0},
                             .look_at_m = {0, camera->height_m + sin(pitch), -cos(pitch)}};
}

/* Ahead is level, as a car that carries a camera which looks down drives level. The camera moves before the first
 * frame as well. */
static bool speed_keys(const scene_file *scene, host_camera_key **keys, uint32_t *count, char *error, size_t error_size)
{
    const scene_camera *camera = &scene->camera;
    const scene_frames *frames = &scene->frames;
    const host_camera_key at = standing(camera);
    const double ahead[2] = {at.look_at_m[0] - at.position_m[0], at.look_at_m[2] - at.position_m[2]};
    const double length = hypot(ahead[0], ahead[1]);
    *keys = malloc(2 * sizeof **keys);
    if (!*keys)
        return no_memory(error, error_size);
    const double times[2] = {-frames->preroll_s - 10, (frames->last - frames->first) / frames->fps + AFTER_S};
    for (int i = 0; i < 2; i++) {
        const double way = length > 0 ? times[i] * *camera->speed_m_s / length : 0;
        host_camera_key *key = &(*keys)[i];
        *key = at;
        key->time_s = times[i];
        key->cut = false;
        key->position_m[0] += way * ahead[0];
        key->look_at_m[0] += way * ahead[0];
        key->position_m[2] += way * ahead[1];
        key->look_at_m[2] += way * ahead[1];
    }
    *count = 2;
    return true;
}

/* ---- poses */

/* A camera that moves in the first frame has moved before it: so its first shutter blurs as the others do. */
static void add_before(host_camera_key keys[3])
{
    const host_camera_key *a = &keys[1], *b = &keys[2];
    host_camera_key *key = &keys[0];
    key->time_s = 2 * a->time_s - b->time_s;
    for (int c = 0; c < 3; c++) {
        key->position_m[c] = 2 * a->position_m[c] - b->position_m[c];
        key->look_at_m[c] = 2 * a->look_at_m[c] - b->look_at_m[c];
    }
    key->roll_deg = 2 * a->roll_deg - b->roll_deg;
    key->cut = false;
}

static bool pose_keys(const scene_file *scene, host_camera_key **keys, uint32_t *count, char *error, size_t error_size)
{
    const scene_camera *camera = &scene->camera;
    const scene_poses *from = &camera->poses;
    const camera_poses_def def = {.file = from->file,
                                  .times = from->times,
                                  .format = from->format,
                                  .up = from->up,
                                  .images = from->images,
                                  .first_frame = scene->frames.first,
                                  .rate_hz = from->rate_hz > 0 ? from->rate_hz : scene->frames.fps,
                                  .scale = from->scale,
                                  .height_m = camera->height_m,
                                  .pitch_deg = camera->pitch_deg};
    char reason[512];
    camera_pose *poses;
    uint32_t read;
    if (!camera_poses_read(&def, &poses, &read, reason, sizeof reason))
        return scene_file_refuse(scene, "camera.poses.file", error, error_size, "%s", reason);
    *keys = malloc((read + 1) * sizeof **keys);
    /* Rectified cameras of KITTI look the same way, and its poses are those of camera 0. */
    const double right_m = from->format == CAMERA_POSES_KITTI ? camera->calibration.right_m : 0;
    for (uint32_t i = 0; i < read; i++)
        for (int axis = 0; axis < 3; axis++)
            poses[i].position_m[axis] += right_m * poses[i].axes[0][axis];
    for (uint32_t i = 0; *keys && i < read; i++)
        (*keys)[i + 1] = host_camera_key_of_axes(poses[i].time_s, poses[i].position_m, poses[i].axes);
    free(poses);
    if (!*keys)
        return no_memory(error, error_size);
    host_camera_unwrap_rolls(*keys + 1, read);
    if (read > 1)
        add_before(*keys);
    else
        (*keys)[0] = (*keys)[1];
    *count = read > 1 ? read + 1 : 1;
    return true;
}

bool path_keys(const scene_file *scene, host_camera_key **keys, uint32_t *count, char *error, size_t error_size)
{
    const scene_camera *camera = &scene->camera;
    *keys = NULL;
    if (camera->poses.file)
        return pose_keys(scene, keys, count, error, error_size);
    if (camera->speed_m_s)
        return speed_keys(scene, keys, count, error, error_size);
    return given_keys(camera, keys, count, error, error_size);
}
