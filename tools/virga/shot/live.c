/* live.c - a shot whose time, camera and settings somebody plays with. */
#include "shot/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

host_camera_path shot_eye(const shot *s)
{
    host_camera_path path = s->path;
    if (s->eye_free) {
        path.keys = s->eye_keys;
        path.count = 2;
    }
    return path;
}

/* What may have changed in the scene since the last frame, beside what every step takes from it. */
static bool take_settings(shot *s, char *error, size_t error_size)
{
    if (!shot_load_camera(s))
        return host_fail(error, error_size, "no memory for the camera's path");
    if (s->path.far_m <= s->path.near_m)
        s->path.far_m = 2 * s->path.near_m; /* until the other of the two has been changed as well */
    shot_fill_lights(s);
    return shot_set_ground(s, error, error_size);
}

bool shot_live_record(shot *s, VkCommandBuffer cmd, double dt_s, host_camera *camera, char *error, size_t error_size)
{
    const bool first = !s->began; /* the state is filled, no time passes */
    const double time_s = s->camera_time_s + (first ? 0 : dt_s);
    if (!take_settings(s, error, error_size) ||
        !shot_record_time(s, cmd, time_s, first ? 0 : dt_s, error, error_size) ||
        !shot_record_sample(s, cmd, 0, time_s, error, error_size))
        return false;
    s->began = true;
    s->frame_index = s->scene->frames.first + (uint32_t)(fmax(time_s, 0) * s->scene->frames.fps + 0.5);
    const host_camera_path eye = shot_eye(s);
    host_camera_at(&eye, time_s, s->options.width, s->options.height, NULL, camera);
    return true;
}

bool shot_live_draw(shot *s, uint32_t samples, host_camera *camera, char *error, size_t error_size)
{
    const uint32_t before = s->options.samples;
    s->options.samples = samples;
    const bool drawn = shot_draw_samples(s, s->camera_time_s, camera, error, error_size);
    s->options.samples = before;
    return drawn;
}

/* All that the scene file decides. */
static void close_scene(shot *s)
{
    virga_target_destroy(&s->layer);
    virga_target_destroy(&s->moving);
    virga_target_destroy(&s->mirror);
    virga_scene_destroy(&s->rain_scene);
    host_renderer_destroy(&s->renderer);
    shot_panes_close(s);
    for (uint32_t i = 0; i < s->meshes_loaded; i++)
        host_mesh_destroy(&s->device, &s->meshes[i]);
    host_image_destroy(&s->device, &s->material_image);
    host_environment_destroy(&s->device, &s->environment);
    free(s->meshes);
    free(s->occluders);
    s->meshes = NULL;
    s->occluders = NULL;
    s->meshes_loaded = s->occluder_count = 0;
    s->rain = NULL;
    s->ground = NULL;
    s->splash = NULL;
    memset(&s->materials, 0, sizeof s->materials);
}

bool shot_live_restart(shot *s, char *error, size_t error_size)
{
    if (!host_wait(&s->device, error, error_size))
        return false;
    close_scene(s);
    s->frame_index = s->scene->frames.first - 1;
    s->camera_time_s = -shot_preroll_s(s);
    s->began = false;
    s->warning[0] = 0;
    return host_renderer_create(&s->device, &s->target, &s->renderer, error, error_size) &&
           shot_load_meshes(s, error, error_size) && shot_load_material_map(s, error, error_size) &&
           shot_load_environment(s, error, error_size) && shot_open_rain(s, error, error_size) &&
           shot_set_weather(s, 0, error, error_size);
}

bool shot_live_resize(shot *s, uint32_t width, uint32_t height, char *error, size_t error_size)
{
    if (width == s->options.width && height == s->options.height)
        return true;
    if (!host_wait(&s->device, error, error_size))
        return false;
    host_accumulator_destroy(&s->frame);
    host_target_destroy(&s->device, &s->target);
    s->options.width = width;
    s->options.height = height;
    return shot_make_target(s, error, error_size) && shot_set_mirror(s, error, error_size) &&
           host_accumulator_create(&s->frame, width, height, error, error_size);
}
