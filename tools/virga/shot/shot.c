/* shot.c - a scene file brought to life: opened on a device, and stepped frame by frame. */
#include "shot/internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the device */

static void take_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    shot *s = user;
    (void)id;
    if (level == VIRGA_LOG_INFO)
        return;
    snprintf(s->warning, sizeof s->warning, "%s", text);
    if (level == VIRGA_LOG_WARNING)
        fprintf(stderr, "virga: %s\n", text);
}

bool shot_ok(const shot *s, virga_result result, const char *what, char *error, size_t error_size)
{
    if (result >= 0)
        return true;
    return host_fail(error, error_size, "%s: %s%s%s", what, virga_result_name(result), s->warning[0] ? ": " : "",
                     s->warning);
}

/* Notes that what fails here is wrong input. A file that this machine has no room for counts as such too: it will not
 * have it the next time either. */
bool shot_blame_input(shot *s, bool right)
{
    s->input_wrong = !right;
    return right;
}

static bool open_device(shot *s, char *error, size_t error_size)
{
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index = 0;
    if (!host_instance_create_for_window(&s->instance, false, s->options.window_extensions,
                                         s->options.window_extension_count, error, error_size))
        return false;
    const uint32_t count = host_devices_list(&s->instance, infos, HOST_MAX_DEVICES);
    if (!host_device_pick(infos, count, s->options.device, &index, error, error_size)) {
        s->input_wrong = count && s->options.device;
        return false;
    }
    s->info = infos[index];
    if (!host_device_create(&s->device, &s->instance, &infos[index], error, error_size))
        return false;
    /* The anisotropic filter of software Vulkan (Mesa 22.3) takes ten seconds over a pixel whose gradients are unlucky,
     * and three times as long as the plain one over the others. Sub-frames (--samples) make up for it. */
    if (s->info.type == VK_PHYSICAL_DEVICE_TYPE_CPU)
        s->device.anisotropy = 0;
    virga_context_def def = virga_default_context_def();
    def.instance = s->instance.instance;
    def.physical_device = s->device.physical;
    def.device = s->device.device;
    def.queue_family = s->device.queue_family;
    def.get_instance_proc_addr = vkGetInstanceProcAddr;
    def.wide_lines = s->device.wide_lines;
    def.frames_in_flight = HOST_FRAMES + 1;
    def.log = take_log;
    def.log_user = s;
    return shot_ok(s, virga_context_create(&def, &s->context), "taking the device into use", error, error_size);
}

/* ---- opening and closing */

bool shot_make_target(shot *s, char *error, size_t error_size)
{
    const uint32_t width = s->options.width, height = s->options.height;
    const uint32_t limit = s->device.properties.limits.maxImageDimension2D;
    const bool made = host_target_create(&s->device, width, height, &s->target, error, error_size);
    s->input_wrong = !made && (width > limit || height > limit);
    return made &&
           ((!scene_splash_of(s->scene)->on && !s->options.live) ||
            host_target_add_splash(&s->device, &s->target, error, error_size)) &&
           (!scene_glass_of(s->scene)->pane_count ||
            host_target_add_glass(&s->device, &s->target, error, error_size)) &&
           (!s->options.water_velocity || host_target_add_moving(&s->device, &s->target, error, error_size));
}

/* The first picture is read at once: most of what can be wrong with one is wrong with all. */
static bool open_plate(shot *s, char *error, size_t error_size)
{
    return plate_open(&s->plate, s->options.plate, s->scene->frames.first, s->options.frames, s->options.width,
                      s->options.height, error, error_size) &&
           (!s->plate.pattern || plate_load(&s->plate, s->options.frames[0], error, error_size));
}

/* Where the pictures of a plate go on their way to the device. */
static bool open_plate_buffer(shot *s, char *error, size_t error_size)
{
    const VkDeviceSize size = (VkDeviceSize)s->options.width * s->options.height * 4 * sizeof(float);
    return !s->plate.pattern || !s->options.draw ||
           host_buffer_create(&s->device, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD, "plate pixels",
                              &s->plate_buffer, error, error_size);
}

static bool open_all(shot *s, char *error, size_t error_size)
{
    if (!shot_load_camera(s))
        return host_fail(error, error_size, "no memory for the camera's path");
    if (!shot_blame_input(s, host_camera_path_check(&s->path, error, error_size) &&
                                 shot_check_materials(s->scene, error, error_size) &&
                                 shot_check_panes(s->scene, error, error_size) && open_plate(s, error, error_size)) ||
        !open_device(s, error, error_size))
        return false;
    if (s->options.draw &&
        (!shot_make_target(s, error, error_size) ||
         !host_renderer_create(&s->device, &s->target, &s->renderer, error, error_size) ||
         !host_accumulator_create(&s->frame, s->options.width, s->options.height, error, error_size)))
        return false;
    return open_plate_buffer(s, error, error_size) && shot_load_meshes(s, error, error_size) &&
           shot_load_material_map(s, error, error_size) && shot_load_environment(s, error, error_size) &&
           shot_open_rain(s, error, error_size) && shot_set_weather(s, 0, error, error_size);
}

bool shot_open(shot *s, const scene_file *scene, const shot_options *options, char *error, size_t error_size)
{
    memset(s, 0, sizeof *s);
    s->scene = scene;
    s->options = *options;
    s->options.samples = options->samples ? options->samples : 1;
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
    if (s->device.device)
        host_wait(&s->device, ignored, sizeof ignored);
    virga_target_destroy(&s->layer);
    virga_target_destroy(&s->moving);
    virga_target_destroy(&s->mirror);
    virga_scene_destroy(&s->rain_scene);
    virga_context_destroy(&s->context);
    host_renderer_destroy(&s->renderer);
    host_accumulator_destroy(&s->frame);
    if (s->device.device) {
        for (uint32_t i = 0; i < s->meshes_loaded; i++)
            host_mesh_destroy(&s->device, &s->meshes[i]);
        host_image_destroy(&s->device, &s->material_image);
        host_environment_destroy(&s->device, &s->environment);
        if (s->target.width)
            host_target_destroy(&s->device, &s->target);
        shot_panes_close(s);
        host_buffer_destroy(&s->device, &s->plate_buffer);
        host_buffer_destroy(&s->device, &s->drops_read.buffer);
        host_buffer_destroy(&s->device, &s->droplets_read.buffer);
        host_device_destroy(&s->device);
    }
    if (s->instance.instance)
        host_instance_destroy(&s->instance);
    plate_close(&s->plate);
    free(s->meshes);
    free(s->occluders);
    free(s->camera_keys);
    memset(s, 0, sizeof *s);
}

/* ---- frames */

double shot_time(const shot *s, uint32_t frame)
{
    return (double)(frame - s->scene->frames.first) / s->scene->frames.fps;
}

double shot_preroll_s(const shot *s)
{
    return round(s->scene->frames.preroll_s * s->scene->frames.fps) / s->scene->frames.fps;
}

bool shot_begin(shot *s, VkCommandBuffer *cmd, char *error, size_t error_size)
{
    return host_begin_frame(&s->device, cmd, error, error_size) &&
           shot_ok(s, virga_frame_begin(s->context, s->device.frame, s->device.completed), "beginning a frame", error,
                   error_size);
}

/* ---- stepping */

/* Where ripples are worth drawing: ahead of the camera, from its feet on. */
static void place_focus(const shot *s, const host_camera *camera, double time_s, double focus_m[3])
{
    const double ahead_m = shot_ripples_ahead(s, time_s);
    const float *m = camera->view_from_world; /* its third row points back */
    const double back[2] = {(double)m[2], (double)m[10]}, length = hypot(back[0], back[1]);
    memcpy(focus_m, camera->position_m, 3 * sizeof focus_m[0]);
    for (int axis = 0; axis < 2 && length > 1e-3; axis++)
        focus_m[axis * 2] -= back[axis] / length * ahead_m;
}

bool shot_record_time(shot *s, VkCommandBuffer cmd, double time_s, double dt_s, char *error, size_t error_size)
{
    host_camera camera;
    const host_camera_path eye = shot_eye(s);
    host_camera_at(&eye, time_s, s->options.width, s->options.height, NULL, &camera);
    virga_scene_frame info = {
        .dt_s = dt_s, .occluders = s->occluders, .occluder_count = s->occluder_count, .materials = s->materials};
    memcpy(info.camera_m, camera.position_m, sizeof info.camera_m);
    place_focus(s, &camera, time_s, info.focus_m);
    virga_scene_pane *panes = shot_panes_place(s, time_s);
    info.panes = panes;
    const bool stepped =
        shot_set_weather(s, time_s, error, error_size) &&
        shot_ok(s, virga_scene_record(s->rain_scene, cmd, &info), "stepping the rain", error, error_size);
    free(panes);
    s->camera_time_s = time_s;
    return stepped;
}

/* Time passes to `time_s`, by one frame. */
static bool record_step(shot *s, VkCommandBuffer cmd, double time_s, char *error, size_t error_size)
{
    if (!shot_record_time(s, cmd, time_s, s->began ? 1 / s->scene->frames.fps : 0, error, error_size))
        return false;
    s->began = true;
    return !s->options.points || shot_record_points(s, cmd, error, error_size);
}

static bool step_to(shot *s, double time_s, char *error, size_t error_size)
{
    VkCommandBuffer cmd;
    return shot_begin(s, &cmd, error, error_size) && record_step(s, cmd, time_s, error, error_size) &&
           host_submit(&s->device, error, error_size);
}

/* Frame by frame as those that are drawn, so that a shot whose rain has begun earlier shows what one shows that is
 * looked at later. */
bool shot_step_preroll(shot *s, char *error, size_t error_size)
{
    if (!step_to(s, -(double)s->preroll / s->scene->frames.fps, error, error_size))
        return false;
    s->preroll--;
    return true;
}

bool shot_step(shot *s, uint32_t frame, char *error, size_t error_size)
{
    while (s->preroll)
        if (!shot_step_preroll(s, error, error_size))
            return false;
    while (s->frame_index < frame || s->frame_index + 1 == s->scene->frames.first) {
        if (!step_to(s, shot_time(s, s->frame_index + 1), error, error_size))
            return false;
        s->frame_index++;
        if (s->frame_index >= frame)
            break;
    }
    return true;
}
