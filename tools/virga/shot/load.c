/* load.c - what a scene file names, loaded: meshes, the sky, lamps, the camera's path. */
#include "shot/internal.h"

#include "effect.h"
#include "exr.h"
#include "shot/focus.h"
#include "shot/path.h"
#include "shot/plate.h"
#include "shot/plate_ground.h"
#include "shot/plate_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- meshes */

bool shot_add_mesh(shot *s, bool stops_rain, char *error, size_t error_size)
{
    host_mesh *mesh = &s->meshes[s->meshes_loaded++];
    for (uint32_t k = 0; tool_effects[k]; k++)
        if (tool_effects[k]->mark_mesh)
            tool_effects[k]->mark_mesh(s->scene, mesh);
    const uint32_t room = SHOT_MAX_OCCLUDERS - s->occluder_count;
    const uint32_t more = stops_rain ? host_mesh_occluders(mesh, s->occluders + s->occluder_count, room) : 0;
    s->occluder_count += more < room ? more : room;
    return !s->renderer || host_renderer_add(s->renderer, mesh, error, error_size);
}

static bool read_mesh(shot *s, const host_vertex *vertices, const uint32_t *indices, char *error, size_t error_size)
{
    for (uint32_t k = 0; tool_effects[k]; k++)
        if (tool_effects[k]->read_mesh &&
            !tool_effects[k]->read_mesh(s, &s->meshes[s->meshes_loaded - 1], vertices, indices, error, error_size))
            return false;
    return true;
}

static bool load_mesh(shot *s, uint32_t i, char *error, size_t error_size)
{
    float transform[12];
    host_vertex *vertices;
    uint32_t *indices;
    shot_mesh_transform(&s->scene->meshes[i], transform);
    if (!shot_blame_input(s, host_mesh_load_kept(&s->device, s->scene->meshes[i].file, transform, &s->meshes[i],
                                                 &vertices, &indices, error, error_size)))
        return false;
    const bool ok = shot_add_mesh(s, true, error, error_size) && read_mesh(s, vertices, indices, error, error_size);
    free(vertices);
    free(indices);
    return ok;
}

bool shot_load_meshes(shot *s, char *error, size_t error_size)
{
    s->meshes = calloc(s->scene->mesh_count + plate_ground_meshes(s) + 1, sizeof *s->meshes);
    s->occluders = calloc(SHOT_MAX_OCCLUDERS, sizeof *s->occluders);
    if (!s->meshes || !s->occluders)
        return host_fail(error, error_size, "no memory for meshes");
    for (uint32_t i = 0; i < s->scene->mesh_count; i++)
        if (!load_mesh(s, i, error, error_size))
            return false;
    return plate_ground_load_meshes(s, error, error_size);
}

/* ---- light and camera */

enum { LIGHT_WIDTH = 256, LIGHT_HEIGHT = 128 }; /* of the panorama that is made of a plate */

/* The light of a plate is that of the scene's first frame for all frames, so that a frame does not depend on which
 * frames are drawn. *pixels stays NULL where that picture is not there. */
static bool light_of_plate(shot *s, host_environment_def *def, float **pixels, char *error, size_t error_size)
{
    const uint32_t first = s->scene->frames.first;
    host_camera camera;
    if (!plate_has(s->plate, first)) {
        host_warn(&s->device, "--plate: no picture for frame %u, so drops have the light of environment's colors",
                  first);
        return true;
    }
    if (!shot_blame_input(s, plate_load(s->plate, first, error, error_size)))
        return false;
    *pixels = malloc((size_t)LIGHT_WIDTH * LIGHT_HEIGHT * 3 * sizeof **pixels);
    if (!*pixels)
        return host_fail(error, error_size, "no memory for the light of the plate");
    shot_camera(s, 0, 0, NULL, &camera);
    plate_light_panorama(s->plate->rgba, &camera, *pixels, LIGHT_WIDTH, LIGHT_HEIGHT);
    def->pixels = *pixels;
    def->width = LIGHT_WIDTH;
    def->height = LIGHT_HEIGHT;
    return true;
}

bool shot_load_environment(shot *s, char *error, size_t error_size)
{
    const scene_environment *from = &s->scene->environment;
    host_environment_def def = host_default_environment();
    def.rotation_deg = (float)from->rotation_deg;
    def.intensity = (float)from->intensity;
    for (int c = 0; c < 3; c++) {
        def.zenith[c] = (float)from->zenith[c];
        def.horizon[c] = (float)from->horizon[c];
        def.ground[c] = (float)from->ground[c];
    }
    float *pixels = NULL;
    if (from->file) {
        uint64_t repaired = 0;
        if (!shot_blame_input(s,
                              exr_read_rgb(from->file, &def.width, &def.height, &pixels, &repaired, error, error_size)))
            return false;
        if (repaired)
            host_warn(&s->device, "%s: %llu values were not finite or below zero and count as 0", from->file,
                      (unsigned long long)repaired);
        def.pixels = pixels;
    }
    if (!from->file && s->plate && s->scene->footage.light == SCENE_LIGHT_OF_PLATE &&
        !light_of_plate(s, &def, &pixels, error, error_size))
        return false;
    const bool made = host_environment_create(&s->device, &def, &s->environment, error, error_size);
    free(pixels);
    memcpy(s->lighting.environment_sh, s->environment.sh, sizeof s->lighting.environment_sh);
    return made && (!s->renderer || host_renderer_set_environment(s->renderer, &s->environment, error, error_size));
}

void shot_load_lights(shot *s)
{
    s->lighting.light_count = s->scene->light_count;
    for (uint32_t i = 0; i < s->scene->light_count; i++) {
        const scene_light *from = &s->scene->lights[i];
        virga_light *to = &s->lighting.lights[i];
        memset(to, 0, sizeof *to);
        for (int c = 0; c < 3; c++) {
            to->position_m[c] = from->position_m[c];
            to->intensity[c] = (float)(from->color[c] * from->intensity_w_sr);
            to->direction[c] = from->type == SCENE_LIGHT_SPOT ? (float)from->direction[c] : 0;
        }
        to->range_m = (float)from->range_m;
        to->cos_inner = (float)cos(from->inner_deg * M_PI / 180);
        /* In a file the outer angle is larger than the inner. While a user changes the two, it can be smaller. */
        to->cos_outer = (float)cos(fmax(from->outer_deg, from->inner_deg + 0.1) * M_PI / 180);
    }
    if (s->renderer)
        host_renderer_set_lights(s->renderer, s->lighting.lights, s->lighting.light_count);
}

/* The file of poses is read once, until the scene is loaded again. */
static bool load_keys(shot *s, char *error, size_t error_size)
{
    host_camera_key *keys;
    uint32_t count;
    const bool from_file = s->scene->camera.poses.file;
    if (s->camera_keys && s->keys_from_file && from_file)
        return true;
    if (!shot_blame_input(s, path_keys(s->scene, &keys, &count, error, error_size)))
        return false;
    free(s->camera_keys);
    s->camera_keys = keys;
    s->camera_key_count = count;
    s->keys_from_file = from_file;
    return true;
}

bool shot_load_camera(shot *s, char *error, size_t error_size)
{
    const scene_camera *from = &s->scene->camera;
    if (!load_keys(s, error, error_size))
        return false;
    s->path = (host_camera_path){.keys = s->camera_keys,
                                 .count = s->camera_key_count,
                                 .fov_deg = scene_camera_fov_deg(s->scene),
                                 .near_m = from->near_m,
                                 .far_m = from->far_m};
    if (scene_camera_is_calibrated(s->scene)) {
        host_camera_calibration *to = &s->path.calibration;
        scene_camera_calibrated_size(s->scene, to->size_px);
        scene_camera_calibrated_center(s->scene, to->center_px);
        memcpy(to->focal_px, from->calibration.focal_px, sizeof to->focal_px);
    }
    return true;
}
