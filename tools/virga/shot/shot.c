/* shot.c - a scene file on a device: opened, and stepped frame by frame. */
#include "shot/internal.h"

#include "effect.h"
#include "reuse.h"
#include "shot/checkpoint.h"
#include "shot/distort.h"
#include "shot/focus.h"
#include "shot/lens.h"
#include "shot/place.h"
#include "shot/plate.h"
#include "shot/plate_ground.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- opening and closing */

bool shot_check_scene(const scene_file *scene, char *error, size_t error_size)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->check && !tool_effects[i]->check(scene, error, error_size))
            return false;
    return true;
}

static bool open_color_space(shot *s, char *error, size_t error_size)
{
    const scene_footage *footage = &s->scene->footage;
    char reason[600];
    return !footage->color_space ||
           color_space_open(&s->color_space, footage->ocio_config, footage->color_space, reason, sizeof reason) ||
           scene_file_refuse(s->scene, "footage.color_space", error, error_size, "%s", reason);
}

/* The first picture is read at once: most of what can be wrong with one is wrong with all. */
static bool open_plate(shot *s, char *error, size_t error_size)
{
    if (!s->options.plate)
        return true;
    s->plate = calloc(1, sizeof *s->plate);
    if (!s->plate)
        return host_fail(error, error_size, "no memory for a plate");
    if (!open_color_space(s, error, error_size))
        return false;
    const scene_footage *footage = &s->scene->footage;
    plate_def def = {
        .pictures = s->options.plate,
        .depths = s->options.depth,
        .curve = footage->curve,
        .color_space = s->color_space,
        .depth = {.kind = footage->depth_kind,
                  .scale = footage->depth_scale,
                  .baseline_m = footage->disparity_base_m,
                  .focal_px = footage->disparity_focal_px},
        .depth_m = footage->depth_m,
        .stills = s->options.stills,
        .keeps_depth = footage->ground == SCENE_FOOTAGE_GROUND_PLANE || s->options.stills,
        .near_m = s->scene->camera.near_m,
        .far_m = s->scene->camera.far_m,
        .width = s->options.width,
        .height = s->options.height,
        .distortion = s->distortion,
    };
    if (s->distortion) {
        const distortion_map *map = &s->distortion->map;
        def.width = map->size[0];
        def.height = map->size[1];
        def.depth.lens = map->lens;
        for (int axis = 0; axis < 2; axis++) {
            def.depth.focal[axis] = map->focal_px[axis] / map->size[axis];
            def.depth.center[axis] = map->center_px[axis] / map->size[axis];
        }
    } else {
        host_camera_intrinsics(&s->path, def.width, def.height, def.depth.focal, def.depth.center);
    }
    return plate_open(s->plate, &def, s->scene->frames.first, s->options.frames, error, error_size) &&
           plate_load(s->plate, s->options.frames[0], error, error_size);
}

/* Where the pictures of a plate and their depth go on their way to the device. */
bool shot_open_plate_buffers(shot *s, char *error, size_t error_size)
{
    const VkDeviceSize size = (VkDeviceSize)s->options.width * s->options.height * sizeof(float);
    if (!s->plate || !s->options.draw)
        return true;
    return host_buffer_create(&s->device, 4 * size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD,
                              "plate pixels", &s->plate_buffer, error, error_size) &&
           (!s->plate->has_depth ||
            host_buffer_create(&s->device, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD, "plate depths",
                               &s->plate_depth_buffer, error, error_size));
}

/* A window may have any aspect: it shows the height of the picture. */
static bool check_aspect(const shot *s, char *error, size_t error_size)
{
    const uint32_t *size = s->path.calibration.size_px;
    return !scene_camera_is_calibrated(s->scene) || s->options.live ||
           host_camera_same_aspect(size, s->options.width, s->options.height) ||
           scene_file_refuse(s->scene, "camera.calibration.size_px", error, error_size,
                             "expected the aspect of the picture to be drawn (%u x %u), got %u x %u; see --size",
                             s->options.width, s->options.height, size[0], size[1]);
}

/* Where the lens bends lines, what follows draws the picture of a pinhole that holds all that the lens shows. In a
 * window the lens bends nothing. */
static bool open_distortion(shot *s, char *error, size_t error_size)
{
    host_camera_calibration *c = &s->path.calibration;
    distortion_map map = {.lens = scene_camera_distortion(s->scene), .size = {s->options.width, s->options.height}};
    char reason[256];
    double focal[2], center[2];
    if (!distortion_is_given(&map.lens) || s->options.live)
        return true;
    host_camera_intrinsics(&s->path, map.size[0], map.size[1], focal, center);
    for (int axis = 0; axis < 2; axis++) {
        map.focal_px[axis] = focal[axis] * map.size[axis];
        map.center_px[axis] = center[axis] * map.size[axis];
    }
    if (!distortion_map_open(&map, reason, sizeof reason))
        return scene_file_refuse(s->scene, "camera.calibration.distortion", error, error_size, "%s", reason);
    s->distortion = calloc(1, sizeof *s->distortion);
    if (!s->distortion)
        return host_fail(error, error_size, "no memory for the distortion of a lens");
    memcpy(c->size_px, map.pinhole_size, sizeof c->size_px);
    memcpy(c->focal_px, map.pinhole_focal_px, sizeof c->focal_px);
    memcpy(c->center_px, map.pinhole_center_px, sizeof c->center_px);
    s->options.width = map.pinhole_size[0];
    s->options.height = map.pinhole_size[1];
    return shot_distortion_open(s->distortion, &map, error, error_size);
}

static bool check_pictures(const scene_file *scene, char *error, size_t error_size)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->check_pictures && !tool_effects[i]->check_pictures(scene, error, error_size))
            return false;
    return true;
}

static bool check_input(shot *s, char *error, size_t error_size)
{
    return shot_blame_input(s, host_camera_path_check(&s->path, error, error_size) &&
                                   check_aspect(s, error, error_size) && open_distortion(s, error, error_size) &&
                                   shot_check_scene(s->scene, error, error_size) &&
                                   check_pictures(s->scene, error, error_size) && open_plate(s, error, error_size) &&
                                   plate_ground_open(s, error, error_size));
}

static bool shares_shading(const shot_options *options)
{
    return host_reuse_share(options->samples) > 1;
}

static bool open_renderer(shot *s, char *error, size_t error_size)
{
    if (!shot_create_target(s, error, error_size) ||
        !host_renderer_create(&s->device, &s->renderer, error, error_size) ||
        (shares_shading(&s->options) && !host_renderer_set_reuse(s->renderer, &s->target, error, error_size)))
        return false;
    if (!s->plate)
        host_renderer_set_parts(s->renderer, s->options.parts);
    return true;
}

bool shot_open_scene(shot *s, char *error, size_t error_size)
{
    s->lighting = virga_default_lighting();
    if (s->options.draw && !open_renderer(s, error, error_size))
        return false;
    shot_load_lights(s);
    return shot_load_meshes(s, error, error_size) && shot_load_environment(s, error, error_size) &&
           shot_open_place(s, error, error_size) && shot_open_effects(s, error, error_size) &&
           shot_apply_settings(s, 0, error, error_size) && shot_check_focus(s, error, error_size) &&
           shot_open_lens(s, error, error_size);
}

void shot_close_scene(shot *s)
{
    shot_close_place(s);
    host_renderer_destroy(&s->renderer);
    shot_close_lens(s);
    shot_close_effects(s);
    for (uint32_t i = 0; i < s->meshes_loaded; i++)
        host_mesh_destroy(&s->device, &s->meshes[i]);
    host_environment_destroy(&s->device, &s->environment);
    host_buffer_destroy(&s->device, &s->state);
    if (s->target.width)
        host_target_destroy(&s->device, &s->target);
    free(s->meshes);
    free(s->occluders);
    s->meshes = NULL;
    s->occluders = NULL;
    s->meshes_loaded = s->occluder_count = 0;
}

bool shot_create_picture(shot *s, char *error, size_t error_size)
{
    const uint32_t width = s->options.width, height = s->options.height;
    const uint32_t *size = s->distortion ? s->distortion->map.size : (const uint32_t[]){width, height};
    return host_accumulator_create(&s->device, width, height, &s->sums, error, error_size) &&
           (!s->distortion || host_drawn_create(width, height, &s->pinhole, error, error_size)) &&
           host_drawn_create(size[0], size[1], &s->frame, error, error_size);
}

static bool open_all(shot *s, char *error, size_t error_size)
{
    return shot_load_camera(s, error, error_size) && check_input(s, error, error_size) &&
           shot_open_device(s, error, error_size) && shot_open_plate_buffers(s, error, error_size) &&
           (!s->options.draw || shot_create_picture(s, error, error_size)) && shot_open_scene(s, error, error_size);
}

bool shot_open(shot *s, const scene_file *scene, const shot_options *options, char *error, size_t error_size)
{
    memset(s, 0, sizeof *s);
    s->scene = scene;
    s->options = *options;
    s->options.samples = options->samples ? options->samples : 1;
    /* Where sub-frames share shading, colors decide which pixels do, and normals follow. Water on footage is drawn as a
     * whole. */
    if (options->parts == HOST_PLATE_DATA && (options->plate || shares_shading(&s->options)))
        s->options.parts = HOST_PLATE_WHOLE;
    s->frame_index = scene->frames.first - 1;
    s->preroll = (uint32_t)lround(shot_preroll_s(s) * scene->frames.fps);
    s->camera_time_s = -shot_preroll_s(s);
    if (open_all(s, error, error_size))
        return true;
    const bool input_wrong = s->input_wrong;
    shot_close(s);
    s->input_wrong = input_wrong;
    return false;
}

void shot_close(shot *s)
{
    char ignored[256];
    if (s->device.device) {
        host_wait(&s->device, ignored, sizeof ignored);
        shot_close_scene(s);
        host_accumulator_destroy(&s->sums);
        virga_context_destroy(&s->context);
        host_buffer_destroy(&s->device, &s->plate_buffer);
        host_buffer_destroy(&s->device, &s->plate_depth_buffer);
        host_device_destroy(&s->device);
    }
    host_drawn_destroy(&s->frame);
    host_drawn_destroy(&s->pinhole);
    if (s->instance.instance)
        host_instance_destroy(&s->instance);
    if (s->plate)
        plate_close(s->plate);
    free(s->plate);
    color_space_close(&s->color_space);
    if (s->plate_ground)
        plate_ground_close(s->plate_ground);
    free(s->plate_ground);
    if (s->distortion)
        shot_distortion_close(s->distortion);
    free(s->distortion);
    free(s->camera_keys);
    memset(s, 0, sizeof *s);
}

/* ---- stepping */

/* Time passes to `time_s`, by one frame. */
static bool record_step(shot *s, VkCommandBuffer cmd, double time_s, char *error, size_t error_size)
{
    if (!shot_record_time(s, cmd, time_s, s->began ? 1 / s->scene->frames.fps : 0, error, error_size))
        return false;
    s->began = true;
    s->step_frame = s->device.frame;
    return !s->options.points || shot_record_points(s, cmd, error, error_size);
}

static bool step_to(shot *s, double time_s, char *error, size_t error_size)
{
    VkCommandBuffer cmd;
    return shot_find_light(s, time_s, error, error_size) && shot_begin(s, &cmd, error, error_size) &&
           record_step(s, cmd, time_s, error, error_size) && host_submit(&s->device, error, error_size);
}

/* After the step of every frame whose number, counted from the first, is a multiple; and after the pre-roll. */
static bool save_if_due(shot *s, char *error, size_t error_size)
{
    const uint32_t every = s->options.checkpoint_every, number = s->frame_index + 1 - s->scene->frames.first;
    return !every || s->preroll || number % every || checkpoint_save(s, s->options.checkpoints, error, error_size);
}

/* Steps frame by frame, as for drawn frames. So a shot with a longer pre-roll gives the same result as a shot that
 * draws these frames. */
bool shot_step_preroll(shot *s, char *error, size_t error_size)
{
    s->is_unseen = true;
    const bool done = step_to(s, -(double)s->preroll / s->scene->frames.fps, error, error_size);
    s->is_unseen = false;
    if (!done)
        return false;
    s->preroll--;
    return save_if_due(s, error, error_size);
}

static bool step_frame(shot *s, bool unseen, char *error, size_t error_size)
{
    s->is_unseen = unseen;
    const bool done = step_to(s, shot_time(s, s->frame_index + 1), error, error_size);
    s->is_unseen = false;
    if (!done)
        return false;
    s->frame_index++;
    return save_if_due(s, error, error_size);
}

bool shot_step(shot *s, uint32_t frame, char *error, size_t error_size)
{
    while (s->preroll)
        if (!shot_step_preroll(s, error, error_size))
            return false;
    while (s->frame_index < frame || s->frame_index + 1 == s->scene->frames.first) {
        if (!step_frame(s, s->frame_index + 1 < frame, error, error_size))
            return false;
        if (s->frame_index >= frame)
            break;
    }
    return true;
}

bool shot_step_unseen(shot *s, char *error, size_t error_size)
{
    while (s->preroll)
        if (!shot_step_preroll(s, error, error_size))
            return false;
    return step_frame(s, true, error, error_size);
}

bool shot_draw(shot *s, uint32_t frame, host_camera *camera, char *error, size_t error_size)
{
    return shot_step(s, frame, error, error_size) && (!s->plate || plate_load(s->plate, frame, error, error_size)) &&
           plate_ground_load(s, frame, error, error_size) &&
           shot_draw_samples(s, shot_time(s, frame), camera, error, error_size);
}
