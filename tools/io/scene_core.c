/* scene_core.c - the keys of scene files that belong to no effect: models, sky, lights, camera, frames. */
#include "png.h"
#include "scene_camera.h"
#include "scene_footage.h"
#include "scene_rows.h"

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
    NUMBER(scene_environment, around, 0, 1, "1", RESTARTS,
           "how much meshes around the camera hide the sky from drops; 0: not at all"),
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

static const scene_keyword curves[] = {
    {"shoulder", PNG_CURVE_SHOULDER}, {"filmic", PNG_CURVE_FILMIC}, {"none", PNG_CURVE_NONE}, {NULL, 0}};
static const scene_row preview_rows[] = {
    NUMBER(scene_preview, exposure_ev, -30, 30, "0", LIVE,
           "brightens what is shown, in stops; layers stay as they are"),
    CHOICE(scene_preview, curve, curves, "shoulder", LIVE,
           "how light becomes what is shown; shoulder: as computed up to 0.6, lamps keep their shape; filmic: contrast "
           "and highlights of film; none: cut at 1. EXR layers stay linear"),
};
static const scene_group preview_group = SCENE_GROUP(scene_preview, preview_rows);

static const scene_row core_rows[] = {
    WHOLE(scene_file, virga, SCENE_FILE_VERSION, SCENE_FILE_VERSION, NULL, RESTARTS,
          "version of the format of scene files"),
    LIST(scene_file, meshes, mesh_count, &mesh_group, 0, 1024, "[]", "models of the opaque scene, which rain falls on"),
    GROUP(scene_file, environment, &environment_group, RESTARTS, "light of the sky and all around"),
    LIST(scene_file, lights, light_count, &light_group, 0, SCENE_FILE_MAX_LIGHTS, "[]",
         "lamps; they light the scene and glitter in drops"),
    GROUP(scene_file, camera, &scene_camera_group, RESTARTS, "the camera and its path"),
    GROUP(scene_file, frames, &frames_group, RESTARTS, "which frames there are"),
    GROUP(scene_file, preview, &preview_group, LIVE, "how previews are shown"),
    GROUP(scene_file, footage, &scene_footage_group, RESTARTS, "what the pictures of a plate mean, see --plate"),
};

/* ---- checks --------------------------------------------------------------------------------------------------- */

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
    return scene_camera_check(scene, error, error_size) && check_lights(scene, error, error_size) &&
           scene_footage_check(scene, error, error_size);
}

const scene_section scene_core_section = {.group = SCENE_GROUP(scene_file, core_rows), .check = check_core};
