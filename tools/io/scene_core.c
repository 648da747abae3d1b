/* scene_core.c - the keys of scene files that belong to no effect: models, sky, lights, camera, frames. */
#include "scene_footage.h"
#include "scene_rows.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- keys ----------------------------------------------------------------------------------------------------- */

static const scene_row mesh_rows[] = {
    FILE_NAME(scene_mesh, file, 0, "a model that assimp can open, as glTF or OBJ"),
    NUMBER(scene_mesh, position_m, -MAX_METERS, MAX_METERS, "[0, 0, 0]", RESTARTS, "where its origin lies"),
    NUMBER(scene_mesh, rotation_deg, -36000, 36000, "[0, 0, 0]", RESTARTS, "about the world's X, then Y, then Z axis"),
    NUMBER(scene_mesh, scale, 1e-6, 1e6, "1", RESTARTS, "times its own size"),
};
static const scene_group mesh_group = SCENE_GROUP(scene_mesh, mesh_rows);

static const scene_row environment_rows[] = {
    FILE_NAME(scene_environment, file, OPTIONAL, "a panorama as EXR; without it a sky is made of the three colours"),
    NUMBER(scene_environment, intensity, 0, 1e6, "1", RESTARTS, "times its radiance"),
    NUMBER(scene_environment, rotation_deg, -36000, 36000, "0", RESTARTS,
           "around Y, counter-clockwise seen from above"),
    NUMBER(scene_environment, zenith, 0, 1e6, "[0.75, 0.82, 0.92]", RESTARTS,
           "radiance straight up (where no file is given)"),
    NUMBER(scene_environment, horizon, 0, 1e6, "[1, 1, 1]", RESTARTS,
           "radiance of the horizon (where no file is given)"),
    NUMBER(scene_environment, ground, 0, 1e6, "[0.25, 0.24, 0.22]", RESTARTS,
           "radiance from below (where no file is given)"),
};
static const scene_group environment_group = SCENE_GROUP(scene_environment, environment_rows);

static const scene_keyword light_types[] = {{"point", SCENE_LIGHT_POINT}, {"spot", SCENE_LIGHT_SPOT}, {NULL, 0}};
static const scene_row light_rows[] = {
    CHOICE(scene_light, type, light_types, "point", LIVE, "point: the same to all sides; spot: a cone"),
    NUMBER(scene_light, position_m, -MAX_METERS, MAX_METERS, NULL, LIVE, "where it is in the world"),
    NUMBER(scene_light, color, 0, 1e6, "[1, 1, 1]", LIVE, "linear red, green, blue, times the intensity"),
    NUMBER(scene_light, intensity_w_sr, 0, 1e9, NULL, LIVE,
           "radiant intensity on the axis, in the unit of the scene's radiance"),
    NUMBER(scene_light, range_m, 0, MAX_METERS, "0", LIVE, "its light ends here, faded smoothly; 0: no end"),
    NUMBER(scene_light, direction, -MAX_METERS, MAX_METERS, "[0, -1, 0]", LIVE, "where a spot points, of any length"),
    NUMBER(scene_light, inner_deg, 0, 90, "30", LIVE, "full light inside this angle from the axis"),
    NUMBER(scene_light, outer_deg, 0, 90, "60", LIVE, "no light outside this angle"),
};
static const scene_group light_group = SCENE_GROUP(scene_light, light_rows);

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

static const scene_keyword blurs[] = {{"gather", SCENE_BLUR_GATHER}, {"exact", SCENE_BLUR_EXACT}, {NULL, 0}};
static const scene_row camera_rows[] = {
    NUMBER(scene_camera, fov_deg, 1, 170, "50", LIVE, "angle of view of the picture's height, without focal_mm"),
    NUMBER(scene_camera, focal_mm, 0, 2000, "0", LIVE, "focal length, for the angle of view; 0: from fov_deg"),
    NUMBER(scene_camera, sensor_mm, 1, 1000, "24", LIVE, "height of the sensor"),
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
    LIST(scene_camera, keys, key_count, &camera_key_group, 1, 100000, NULL,
         "positions on the camera's path, in order of time"),
};
static const scene_group camera_group = SCENE_GROUP(scene_camera, camera_rows);

static const scene_row frames_rows[] = {
    NUMBER(scene_frames, fps, 1, 1000, "24", RESTARTS, "frames a second; ticks of the simulation divide them"),
    WHOLE(scene_frames, first, 0, 1000000, "1", RESTARTS, "number of the first frame, at time 0"),
    WHOLE(scene_frames, last, 0, 1000000, "48", RESTARTS, "number of the last frame"),
    NUMBER(scene_frames, shutter_deg, 0, 360, "180", LIVE,
           "how long the shutter is open: 360 is a whole frame, 180 the half of film"),
    WHOLE(scene_frames, size, 16, 16384, "[1280, 720]", RESTARTS, "pixels of the picture"),
    NUMBER(scene_frames, preroll_s, 0, 3600, "0", RESTARTS,
           "rain falls so long before the first frame, so that a shot begins wet"),
    SWITCH(scene_frames, warm_start, "true", RESTARTS,
           "on ground that is wet from the start, it has rained for a second: the first frame has splashes and rings"),
};
static const scene_group frames_group = SCENE_GROUP(scene_frames, frames_rows);

static const scene_row preview_rows[] = {
    NUMBER(scene_preview, exposure_ev, -30, 30, "0", LIVE,
           "brightens what is shown, in stops; layers stay as they are"),
};
static const scene_group preview_group = SCENE_GROUP(scene_preview, preview_rows);

static const scene_row core_rows[] = {
    WHOLE(scene_file, virga, SCENE_FILE_VERSION, SCENE_FILE_VERSION, NULL, RESTARTS,
          "version of the format of scene files"),
    LIST(scene_file, meshes, mesh_count, &mesh_group, 0, 1024, "[]", "models of the opaque scene, which rain falls on"),
    GROUP(scene_file, environment, &environment_group, RESTARTS, "light of the sky and all around"),
    LIST(scene_file, lights, light_count, &light_group, 0, SCENE_FILE_MAX_LIGHTS, "[]",
         "lamps; they light the scene and glitter in drops"),
    GROUP(scene_file, camera, &camera_group, RESTARTS, "the camera and its path"),
    GROUP(scene_file, frames, &frames_group, RESTARTS, "which frames there are"),
    GROUP(scene_file, preview, &preview_group, LIVE, "how previews are shown"),
    GROUP(scene_file, footage, &scene_footage_group, RESTARTS, "what the pictures of a plate mean, see --plate"),
};

/* ---- the lens ------------------------------------------------------------------------------------------------- */

#define DEGREES (180 / 3.14159265358979323846)

double scene_camera_fov_deg(const scene_camera *camera)
{
    return camera->focal_mm > 0 ? 2 * DEGREES * atan(0.5 * camera->sensor_mm / camera->focal_mm) : camera->fov_deg;
}

double scene_camera_focal_m(const scene_camera *camera)
{
    const double focal_mm =
        camera->focal_mm > 0 ? camera->focal_mm : 0.5 * camera->sensor_mm / tan(0.5 * camera->fov_deg / DEGREES);
    return 1e-3 * focal_mm;
}

double scene_camera_aperture_m(const scene_camera *camera)
{
    return camera->aperture_f > 0 ? scene_camera_focal_m(camera) / camera->aperture_f : 0;
}

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

static bool check_lens(const scene_file *scene, char *error, size_t error_size)
{
    const scene_camera *camera = &scene->camera;
    char key[64];
    const double fov_deg = scene_camera_fov_deg(camera);
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

static bool check_camera(const scene_file *scene, char *error, size_t error_size)
{
    const scene_camera *camera = &scene->camera;
    char key[64];
    if (camera->far_m <= camera->near_m)
        return scene_file_refuse(scene, "camera.far_m", error, error_size, "expected more than near_m (%g), got %g",
                                 camera->near_m, camera->far_m);
    if (!check_lens(scene, error, error_size))
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

static bool check_lights(const scene_file *scene, char *error, size_t error_size)
{
    char key[64];
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const scene_light *light = &scene->lights[i];
        if (light->type != SCENE_LIGHT_SPOT)
            continue;
        if (light->direction[0] == 0 && light->direction[1] == 0 && light->direction[2] == 0) {
            snprintf(key, sizeof key, "lights.%u.direction", i);
            return scene_file_refuse(scene, key, error, error_size, "expected a direction, got all zero");
        }
        if (light->outer_deg <= light->inner_deg) {
            snprintf(key, sizeof key, "lights.%u.outer_deg", i);
            return scene_file_refuse(scene, key, error, error_size, "expected more than inner_deg (%g), got %g",
                                     light->inner_deg, light->outer_deg);
        }
    }
    return true;
}

static bool check_core(const scene_file *scene, char *error, size_t error_size)
{
    if (scene->frames.last < scene->frames.first)
        return scene_file_refuse(scene, "frames.last", error, error_size, "expected at least frames.first (%u), got %u",
                                 scene->frames.first, scene->frames.last);
    return check_camera(scene, error, error_size) && check_lights(scene, error, error_size) &&
           scene_footage_check(scene, error, error_size);
}

const scene_section scene_core_section = {.group = SCENE_GROUP(scene_file, core_rows), .check = check_core};
