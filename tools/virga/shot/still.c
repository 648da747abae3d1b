/* still.c - see still.h. */
#include "shot/still.h"

#include "shot/distort.h"
#include "shot/internal.h"
#include "shot/plate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the picture and its depth */

static bool resize(shot *s, uint32_t width, uint32_t height, char *error, size_t error_size)
{
    const uint32_t *now = s->distortion ? s->distortion->map.size : (uint32_t[]){s->options.width, s->options.height};
    if (width == now[0] && height == now[1])
        return true;
    if (s->distortion) {
        scene_file_refuse(s->scene, "camera.calibration.distortion", error, error_size,
                          "expected pictures of one size, as the lens bends lines");
        return shot_blame_input(s, false);
    }
    const uint32_t limit = s->device.properties.limits.maxImageDimension2D;
    if (!shot_blame_input(s, width <= limit && height <= limit))
        return host_fail(error, error_size, "expected up to %u x %u pixels, as the device has them, got %u x %u", limit,
                         limit, width, height);
    host_buffer_destroy(&s->device, &s->plate_buffer);
    host_buffer_destroy(&s->device, &s->plate_depth_buffer);
    return shot_live_resize(s, width, height, error, error_size);
}

static bool replace_plate(shot *s, const shot_still *still, char *error, size_t error_size)
{
    plate_def def = s->plate->def;
    def.pictures = still->picture;
    def.depths = still->depth;
    def.fills_depth = still->fills_depth;
    if (!s->distortion) {
        def.width = still->decoded->width;
        def.height = still->decoded->height;
    }
    if (still->has_depth_def)
        def.depth = still->depth_def;
    if (!s->distortion)
        host_camera_intrinsics(&s->path, def.width, def.height, def.depth.focal, def.depth.center);
    s->options.plate = still->picture;
    s->options.depth = still->depth;
    const picture given = *still->decoded;
    still->decoded->rgb = NULL;
    return plate_replace(s->plate, &def, &given, error, error_size) &&
           (s->plate_buffer.buffer || shot_open_plate_buffers(s, error, error_size));
}

/* ---- the camera */

/* Ahead at its speed, through the place of the picture at that time. */
static bool move_camera(shot *s, const shot_still *still, double time_s, char *error, size_t error_size)
{
    const double around_s[2] = {-1, 1};
    const host_camera_calibration pinhole = s->path.calibration;
    if (!shot_load_camera(s, error, error_size)) /* the scene's, from before the picture that was shown last */
        return false;
    host_camera_key *keys = malloc(2 * sizeof *keys);
    if (!keys)
        return host_fail(error, error_size, "no memory for the camera's path");
    host_camera_key at = s->camera_keys[0];
    const double ahead[2] = {at.look_at_m[0] - at.position_m[0], at.look_at_m[2] - at.position_m[2]};
    const double length = fmax(hypot(ahead[0], ahead[1]), 1e-9);
    at.cut = false;
    for (int i = 0; i < 2; i++) {
        const double way = around_s[i] * still->speed_m_s / length;
        const double moved[2] = {still->at_m[0] + way * ahead[0] - still->right_m * ahead[1] / length,
                                 still->at_m[1] + way * ahead[1] + still->right_m * ahead[0] / length};
        keys[i] = at;
        keys[i].time_s = time_s + around_s[i];
        for (int axis = 0; axis < 2; axis++) {
            keys[i].position_m[2 * axis] += moved[axis];
            keys[i].look_at_m[2 * axis] += moved[axis];
        }
    }
    free(s->camera_keys);
    s->camera_keys = keys;
    s->camera_key_count = 2;
    s->keys_from_file = false;
    s->path.keys = keys;
    s->path.count = 2;
    if (s->distortion)
        s->path.calibration = pinhole;
    else if (still->calibration.focal_px[0] > 0)
        s->path.calibration = still->calibration;
    return true;
}

bool shot_show(shot *s, const shot_still *still, uint32_t frame, char *error, size_t error_size)
{
    s->input_wrong = false;
    if (!host_wait(&s->device, error, error_size) ||
        !resize(s, still->decoded->width, still->decoded->height, error, error_size) ||
        !move_camera(s, still, shot_time(s, frame), error, error_size) || !replace_plate(s, still, error, error_size) ||
        !shot_blame_input(s, plate_load(s->plate, frame, error, error_size)))
        return false;
    host_environment_destroy(&s->device, &s->environment);
    return shot_load_environment(s, error, error_size);
}
