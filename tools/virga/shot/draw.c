/* draw.c - the picture of a shot: the plate, splashes, rain and panes, and a frame as an average of sub-frames. */
#include "shot/internal.h"

#include <math.h>
#include <string.h>

/* A sub-frame's views: with its jitter, and as if it had none. The jitter is what smooths the edges of the average;
 * streaks are smooth by themselves, and one whose parts are all jittered another way is a kinked line. */
typedef struct sample_views {
    virga_view jittered, steady;
} sample_views;

/* Splashes and rain as a view sees them: each into a layer of its own. The worse of the results. */
static virga_result prepare(shot *s, VkCommandBuffer cmd, const sample_views *views, double time_s)
{
    const virga_result splash = s->splash ? virga_splash_prepare(s->splash, cmd, &views->jittered, time_s) : VIRGA_OK;
    return splash < 0 ? splash : virga_rain_prepare(s->rain, cmd, &views->steady, time_s);
}

static virga_result draw_layers(shot *s, VkCommandBuffer cmd)
{
    virga_result result = VIRGA_OK;
    if (s->splash) {
        host_target_begin_splash(&s->target, cmd);
        result = virga_splash_draw(s->splash, cmd, s->layer);
        host_target_end_layer(&s->target, cmd);
    }
    host_target_begin_layer(&s->target, cmd);
    const virga_result rain = virga_rain_draw(s->rain, cmd, s->layer);
    host_target_end_layer(&s->target, cmd);
    return result < 0 ? result : rain;
}

/* Panes show what is behind them: the plate with splashes and rain in it, which are drawn a second time for that. */
static virga_result draw_behind(shot *s, VkCommandBuffer cmd)
{
    host_target_begin_behind(&s->target, cmd);
    const virga_result splash = s->splash ? virga_splash_draw(s->splash, cmd, s->layer) : VIRGA_OK;
    const virga_result rain = virga_rain_draw(s->rain, cmd, s->layer);
    host_target_end_layer(&s->target, cmd);
    return splash < 0 ? splash : rain;
}

/* All panes of a kind of draw, far ones first. */
static virga_result draw_each_pane(shot *s, VkCommandBuffer cmd, const virga_target *target,
                                   virga_result (*draw)(virga_glass *, VkCommandBuffer, const virga_target *))
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < scene_glass_of(s->scene)->pane_count && result >= 0; i++)
        result = draw(s->panes[i].glass, cmd, target);
    host_target_end_layer(&s->target, cmd);
    return result;
}

/* Now and a frame ago. */
static void pose_pane(const shot *s, const scene_pane *pane, double camera_s, virga_glass_pose *pose)
{
    virga_glass_pose before;
    const host_camera_path eye = shot_eye(s);
    const double shot_start = host_camera_shot_start(&eye, camera_s);
    shot_pane_pose(s, pane, camera_s, pose);
    shot_pane_pose(s, pane, fmax(camera_s - 1 / s->scene->frames.fps, shot_start), &before);
    memcpy(pose->before_position_m, before.position_m, sizeof before.position_m);
    memcpy(pose->before_world_from_pane, before.world_from_pane, sizeof before.world_from_pane);
}

/* All that was drawn into layers once more, for its velocity. */
static virga_result draw_moving(shot *s, VkCommandBuffer cmd)
{
    host_target_begin_moving(&s->target, cmd);
    const virga_result splash = s->splash ? virga_splash_draw(s->splash, cmd, s->moving) : VIRGA_OK;
    const virga_result rain = virga_rain_draw(s->rain, cmd, s->moving);
    const virga_result panes = draw_each_pane(s, cmd, s->moving, virga_glass_draw); /* ends the pass */
    return splash < 0 ? splash : rain < 0 ? rain : panes;
}

/* `camera_s` is where the camera is on its path, `late_s` how long before the newest tick the picture is taken. */
static virga_result draw_panes(shot *s, VkCommandBuffer cmd, virga_view view, double camera_s, double late_s)
{
    virga_result result = draw_behind(s, cmd);
    view.color = host_target_behind(&s->target);
    for (uint32_t i = 0; i < scene_glass_of(s->scene)->pane_count && result >= 0; i++) {
        virga_glass_pose pose;
        const shot_pane *pane = &s->panes[i];
        pose_pane(s, pane->from, camera_s, &pose);
        result = virga_glass_prepare(pane->glass, cmd, &view, &pose, virga_glass_time(pane->glass) - late_s);
    }
    if (result < 0)
        return result;
    host_target_begin_glass(&s->target, cmd);
    result = draw_each_pane(s, cmd, s->layer, virga_glass_draw);
    host_target_begin_refraction(&s->target, cmd);
    const virga_result refraction = draw_each_pane(s, cmd, s->layer, virga_glass_draw_refraction);
    return result < 0 ? result : refraction;
}

/* The opaque scene, or footage in its place. */
static bool record_plate(shot *s, VkCommandBuffer cmd, double camera_s, const host_camera *now,
                         const host_camera *frame_ago, char *error, size_t error_size)
{
    if (s->plate.pattern) {
        memcpy(s->plate_buffer.mapped, s->plate.rgba, s->plate_buffer.size);
        host_target_fill_plate(&s->target, cmd, &s->plate_buffer);
        return true;
    }
    if (!shot_panes_move_meshes(s, cmd, camera_s, error, error_size))
        return false;
    if (s->ground) {
        virga_ground_maps maps;
        virga_ground_maps_get(s->ground, &maps);
        host_renderer_set_ground(s->renderer, &maps);
    }
    s->mirror_result = VIRGA_OK;
    host_renderer_plate(s->renderer, cmd, &s->target, now, frame_ago);
    return shot_ok(s, s->mirror_result, "drawing the rain in puddles", error, error_size);
}

/* When a picture is taken. */
typedef struct moment {
    double camera_s; /* on the camera's path */
    double late_s;   /* before the newest tick */
} moment;

static bool record_picture(shot *s, VkCommandBuffer cmd, const sample_views *views, moment at, const host_camera *now,
                           const host_camera *frame_ago, char *error, size_t error_size)
{
    if (!shot_ok(s, prepare(s, cmd, views, virga_rain_time(s->rain) - at.late_s), "preparing the rain", error,
                 error_size) ||
        !record_plate(s, cmd, at.camera_s, now, frame_ago, error, error_size) ||
        !shot_ok(s, draw_layers(s, cmd), "drawing the rain", error, error_size))
        return false;
    if (scene_glass_of(s->scene)->pane_count &&
        !shot_ok(s, draw_panes(s, cmd, views->jittered, at.camera_s, at.late_s), "drawing panes", error, error_size))
        return false;
    return !s->moving || shot_ok(s, draw_moving(s, cmd), "drawing the velocity of water", error, error_size);
}

/* Motion vectors as the layer of velocities has them: from a frame ago on, in pixels. */
static void set_frame_ago(const shot *s, const host_camera *frame_ago, virga_view *view)
{
    virga_temporal *temporal = &view->temporal;
    memcpy(temporal->position_m, frame_ago->position_m, sizeof frame_ago->position_m);
    memcpy(temporal->view_from_world, frame_ago->view_from_world, sizeof frame_ago->view_from_world);
    memcpy(temporal->clip_from_view, frame_ago->clip_from_view, sizeof frame_ago->clip_from_view);
    temporal->ago_s = fmin(1 / s->scene->frames.fps, 1);
    temporal->motion_scale[0] = temporal->motion_scale[1] = -1;
    if (s->options.water_velocity)
        temporal->motion_coverage = 0.01f * (float)s->options.water_velocity;
}

/* The cameras of a sub-frame, where its shutter closes and opens and a frame before, and the view that they make. */
typedef struct sample_cameras {
    host_camera now, open, frame_ago;
} sample_cameras;

static virga_view look_through(const shot *s, double close_s, double part_s, double shot_start, const float *jitter,
                               sample_cameras *cameras)
{
    const host_camera_path eye = shot_eye(s);
    const uint32_t width = s->options.width, height = s->options.height;
    host_camera_at(&eye, fmax(close_s, shot_start), width, height, jitter, &cameras->now);
    cameras->now.samples = s->options.samples;
    host_camera_at(&eye, fmax(close_s - part_s, shot_start), width, height, jitter, &cameras->open);
    host_camera_at(&eye, fmax(close_s - 1 / s->scene->frames.fps, shot_start), width, height, jitter,
                   &cameras->frame_ago);
    virga_view view = virga_default_view();
    view.depth = host_target_depth(&s->target);
    view.color = host_target_color(&s->target);
    host_camera_view(&cameras->now, &cameras->open, part_s, &view);
    view.sub_frames = s->options.samples;
    set_frame_ago(s, &cameras->frame_ago, &view);
    view.aperture_m = (float)(s->scene->camera.aperture_mm * 1e-3);
    view.focus_m = (float)s->scene->camera.focus_m;
    return view;
}

/* The shutter closes at the frame's time. */
bool shot_record_sample(shot *s, VkCommandBuffer cmd, uint32_t sample, double time_s, char *error, size_t error_size)
{
    const host_camera_path eye = shot_eye(s);
    const double shutter_s = s->scene->frames.shutter_deg / 360 / s->scene->frames.fps;
    const double part_s = shutter_s / s->options.samples;
    const double close_s = time_s - part_s * (s->options.samples - 1 - sample);
    const double shot_start = host_camera_shot_start(&eye, time_s);
    float jitter[2];
    sample_cameras steady, cameras;
    host_camera_jitter(sample, s->options.samples, jitter);
    const sample_views views = {.steady = look_through(s, close_s, part_s, shot_start, NULL, &steady),
                                .jittered = look_through(s, close_s, part_s, shot_start, jitter, &cameras)};
    const moment at = {fmax(close_s, shot_start), time_s - close_s};
    return record_picture(s, cmd, &views, at, &cameras.now, &cameras.frame_ago, error, error_size);
}

static bool draw_sample(shot *s, uint32_t sample, double time_s, char *error, size_t error_size)
{
    VkCommandBuffer cmd;
    if (!shot_begin(s, &cmd, error, error_size) || !shot_record_sample(s, cmd, sample, time_s, error, error_size))
        return false;
    host_target_copy_out(&s->target, cmd, (1u << HOST_OUTPUT_COUNT) - 1);
    if (!host_submit(&s->device, error, error_size) || !host_wait(&s->device, error, error_size))
        return false;
    host_accumulator_add(&s->frame, &s->device, &s->target, sample == s->options.samples / 2);
    return true;
}

bool shot_draw_samples(shot *s, double time_s, host_camera *camera, char *error, size_t error_size)
{
    const host_camera_path eye = shot_eye(s);
    host_camera_at(&eye, time_s, s->options.width, s->options.height, NULL, camera);
    host_accumulator_reset(&s->frame);
    for (uint32_t sample = 0; sample < s->options.samples; sample++)
        if (!draw_sample(s, sample, time_s, error, error_size))
            return false;
    host_accumulator_finish(&s->frame);
    return true;
}

bool shot_draw(shot *s, uint32_t frame, host_camera *camera, char *error, size_t error_size)
{
    if (!shot_step(s, frame, error, error_size) ||
        (s->plate.pattern && !plate_load(&s->plate, frame, error, error_size)))
        return false;
    return shot_draw_samples(s, shot_time(s, frame), camera, error, error_size);
}
