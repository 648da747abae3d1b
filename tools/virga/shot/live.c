/* live.c - steps and draws a shot whose time, camera and settings a user controls. */
#include "shot/internal.h"

#include "shot/checkpoint.h"
#include "shot/focus.h"
#include "shot/lens.h"
#include "shot/place.h"

#include <math.h>
#include <stdio.h>

/* What may have changed in the scene since the last frame, beside the settings that every step applies. */
static bool follow_scene(shot *s, char *error, size_t error_size)
{
    if (!shot_load_camera(s, error, error_size))
        return false;
    if (s->path.far_m <= s->path.near_m)
        s->path.far_m = 2 * s->path.near_m; /* until the other of the two has been changed as well */
    return true;
}

bool shot_live_light(shot *s, double dt_s, char *error, size_t error_size)
{
    shot_load_lights(s); /* as a user has just set them */
    return shot_find_light(s, s->camera_time_s + (s->began ? dt_s : 0), error, error_size);
}

bool shot_live_record(shot *s, VkCommandBuffer cmd, double dt_s, host_camera *camera, char *error, size_t error_size)
{
    const bool first = !s->began; /* the state is filled, no time passes */
    const double time_s = s->camera_time_s + (first ? 0 : dt_s);
    if (!follow_scene(s, error, error_size) || !shot_record_time(s, cmd, time_s, first ? 0 : dt_s, error, error_size) ||
        !shot_record_sample(s, cmd, 0, time_s, error, error_size))
        return false;
    s->began = true;
    s->frame_index = s->scene->frames.first + (uint32_t)(fmax(time_s, 0) * s->scene->frames.fps + 0.5);
    shot_camera(s, time_s, shot_focus_inv_m(s, time_s), NULL, camera);
    return true;
}

/* The user may open the aperture at any time. A lens has more pipelines than the rain, so it is not built before. */
static bool open_lens(shot *s, char *error, size_t error_size)
{
    return s->lens || !shot_gathers(s) ||
           (host_wait(&s->device, error, error_size) && shot_open_lens(s, error, error_size));
}

bool shot_live_draw(shot *s, uint32_t samples, host_camera *camera, char *error, size_t error_size)
{
    const uint32_t before = s->options.samples;
    s->options.samples = samples;
    const bool drawn =
        open_lens(s, error, error_size) && shot_draw_samples(s, s->camera_time_s, camera, error, error_size);
    s->options.samples = before;
    return drawn;
}

bool shot_live_restart(shot *s, char *error, size_t error_size)
{
    if (!host_wait(&s->device, error, error_size))
        return false;
    shot_close_scene(s);
    s->frame_index = s->scene->frames.first - 1;
    s->camera_time_s = -shot_preroll_s(s);
    s->began = false;
    s->warning[0] = 0;
    s->keys_from_file = false;
    return shot_load_camera(s, error, error_size) && shot_open_scene(s, error, error_size);
}

/* The nearest checkpoint before a frame, if it saves steps. One that can not be loaded is only slower. */
static bool load_nearest(shot *s, const char *folder, uint32_t frame, uint32_t *from, char *error, size_t error_size)
{
    const uint32_t before_first = s->scene->frames.first - 1;
    const bool began = s->began, ahead = began && s->camera_time_s <= shot_time(s, frame);
    char reason[1024];
    bool torn = false;
    uint32_t found;
    s->began = false; /* also those before the current frame */
    const bool has = folder && checkpoint_find(s, folder, frame + 1, &found);
    s->began = began;
    if (!has || (ahead && s->camera_time_s >= 0 && found - before_first <= s->frame_index - before_first))
        return true;
    if (checkpoint_load(s, folder, found, &torn, reason, sizeof reason))
        *from = found;
    else if (torn)
        return host_fail(error, error_size, "the checkpoint of frame %u is damaged, delete it: %s", found, reason);
    else
        fprintf(stderr, "virga view: a checkpoint is not used: %s\n", reason);
    return true;
}

/* To the next time that is that of a frame. The first step fills the state, and no time passes in it. */
static bool step_ahead(shot *s, char *error, size_t error_size)
{
    VkCommandBuffer cmd;
    const double fps = s->scene->frames.fps, now = s->camera_time_s * fps;
    const double next = s->began ? floor(now + 1e-6) + 1 : now, time_s = s->began ? next / fps : s->camera_time_s;
    const double dt_s = !s->began ? 0 : next - now > 1 - 1e-6 ? 1 / fps : (next - now) / fps;
    if (!shot_find_light(s, time_s, error, error_size) || !shot_begin(s, &cmd, error, error_size) ||
        !shot_record_time(s, cmd, time_s, dt_s, error, error_size) || !host_submit(&s->device, error, error_size))
        return false;
    s->began = true;
    return true;
}

bool shot_live_seek(shot *s, const char *checkpoints, uint32_t frame, uint32_t *from, char *error, size_t error_size)
{
    const double target_s = shot_time(s, frame), close_s = 1e-6 / s->scene->frames.fps;
    *from = UINT32_MAX;
    if (!host_wait(&s->device, error, error_size) || !load_nearest(s, checkpoints, frame, from, error, error_size))
        return false;
    if (s->camera_time_s > target_s + close_s && !shot_live_restart(s, error, error_size))
        return false;
    while (!s->began || s->camera_time_s < target_s - close_s)
        if (!step_ahead(s, error, error_size))
            return false;
    s->frame_index = frame;
    return host_wait(&s->device, error, error_size);
}

bool shot_live_resize(shot *s, uint32_t width, uint32_t height, char *error, size_t error_size)
{
    if (width == s->options.width && height == s->options.height)
        return open_lens(s, error, error_size);
    if (!host_wait(&s->device, error, error_size))
        return false;
    host_accumulator_destroy(&s->sums);
    host_drawn_destroy(&s->frame);
    shot_close_lens(s);
    host_target_destroy(&s->device, &s->target);
    s->options.width = width;
    s->options.height = height;
    return shot_create_target(s, error, error_size) && shot_resize_effects(s, error, error_size) &&
           shot_renew_targets(s, error, error_size) && shot_open_lens(s, error, error_size) &&
           shot_create_picture(s, error, error_size);
}
