/* frame.c - one frame of the window: advances time, draws the scene and the panel over it, and reads statistics. */
#include "view/view.h"

#include "frame/files.h"
#include "frame/layers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#define MIN_PX 16u

/* ---- where the picture lies */

/* The largest rectangle beside the panel with the aspect ratio of the scene's frames. */
static void fit_picture(const viewer *v, float area[4])
{
    const double room = (double)v->window.width - (v->panel ? fmin(VIEW_PANEL_PX, 0.5 * v->window.width) : 0);
    const double shape = (double)v->scene->frames.size[0] / v->scene->frames.size[1];
    const double width = fmin(room, v->window.height * shape), height = width / shape;
    area[0] = (float)floor(0.5 * (room - width));
    area[1] = (float)floor(0.5 * (v->window.height - height));
    area[2] = (float)fmax(floor(width), MIN_PX);
    area[3] = (float)fmax(floor(height), MIN_PX);
}

static bool fit_shot(viewer *v, const float area[4])
{
    const uint32_t divide = v->divide ? v->divide : 1;
    const uint32_t width = (uint32_t)area[2] / divide, height = (uint32_t)area[3] / divide;
    return shot_live_resize(&v->shot, width > MIN_PX ? width : MIN_PX, height > MIN_PX ? height : MIN_PX, v->error,
                            sizeof v->error);
}

/* ---- pictures to disk */

/* Sets the hash of the changed scene, for the picture's attributes. */
static void note_hash(viewer *v)
{
    char ignored[256];
    scene_file *tuned = view_load_tuned(v, ignored, sizeof ignored);
    if (tuned)
        v->scene->hash = scene_file_hash(tuned);
    scene_file_free(tuned);
}

static bool write_shot(viewer *v)
{
    host_camera camera;
    uint32_t layers;
    char error[512];
    const bool png = !strcmp(strrchr(v->shot_file, '.'), ".png");
    if (!host_wait(&v->shot.device, v->error, sizeof v->error) ||
        !shot_live_draw(&v->shot, v->samples, &camera, v->error, sizeof v->error))
        return false;
    note_hash(v);
    const bool written = png ? frame_save_preview(&v->shot, &v->shot.frame, v->shot_file, error, sizeof error)
                             : frame_layers_parse(NULL, &layers) && frame_layers_narrow(v->scene, &layers) &&
                                   frame_save_exr(&v->shot, &v->shot.frame, &camera, v->shot_file, v->shot.frame_index,
                                                  layers, error, sizeof error);
    view_print(v, written ? "wrote %s" : "%s", written ? v->shot_file : error);
    v->shot_file[0] = 0;
    return written || !v->script || host_fail(v->error, sizeof v->error, "%s", error);
}

static bool write_window(viewer *v)
{
    char error[512];
    if (!host_wait(&v->shot.device, v->error, sizeof v->error))
        return false;
    const bool written = view_window_write(&v->window, v->window_shot, error, sizeof error);
    view_print(v, written ? "wrote %s" : "%s", written ? v->window_shot : error);
    v->window_shot[0] = 0;
    return written || !v->script || host_fail(v->error, sizeof v->error, "%s", error);
}

/* ---- numbers */

static void put(view_graph *graph, double value)
{
    graph->values[graph->next] = (float)value;
    graph->next = (graph->next + 1) % VIEW_HISTORY;
}

static view_pass *pass_of(view_numbers *n, const char *name)
{
    for (uint32_t i = 0; i < n->pass_count; i++)
        if (!strcmp(n->passes[i].name, name))
            return &n->passes[i];
    if (n->pass_count == VIEW_MAX_TIMES)
        return NULL;
    n->passes[n->pass_count].name = name;
    return &n->passes[n->pass_count++];
}

static void read_times(viewer *v)
{
    view_numbers *n = &v->numbers;
    virga_pass_time times[VIEW_MAX_TIMES];
    const uint32_t there = virga_timings_get(v->shot.context, times, VIEW_MAX_TIMES);
    uint64_t frame = 0; /* what the newest frame did not record has no time in it */
    n->device_now_ms = 0;
    for (uint32_t i = 0; i < n->pass_count; i++)
        n->passes[i].newest = 0;
    for (uint32_t i = 0; i < there && i < VIEW_MAX_TIMES; i++)
        frame = times[i].frame_index > frame ? times[i].frame_index : frame;
    for (uint32_t i = 0; i < there && i < VIEW_MAX_TIMES; i++) {
        if (times[i].frame_index != frame)
            continue;
        view_pass *pass = pass_of(n, times[i].name);
        if (pass)
            pass->newest = times[i].milliseconds;
        n->device_now_ms += times[i].milliseconds;
    }
    for (uint32_t i = 0; i < n->pass_count; i++)
        put(&n->passes[i].milliseconds, n->passes[i].newest);
    put(&n->device_ms, n->device_now_ms);
}

/* In the order of effects. */
static void read_counts(viewer *v)
{
    uint32_t graph = 0;
    for (uint32_t i = 0; tool_effects[i]; i++)
        for (uint32_t k = 0; k < tool_effects[i]->count_count && graph < VIEW_MAX_COUNTS; k++)
            put(&v->numbers.counts[graph++], tool_effects[i]->counts[k].value(v->shot.states[i]));
}

static void read_numbers(viewer *v, double wall_s)
{
    view_numbers *n = &v->numbers;
    n->frame_now_ms = wall_s * 1e3;
    put(&n->frame_ms, n->frame_now_ms);
    read_times(v);
    read_counts(v);
    virga_memory_get(v->shot.context, &n->memory);
    put(&n->memory_mib, (double)n->memory.device_bytes / (1 << 20));
}

/* ---- the frame */

/* The time of a frame. With a script it is a frame of the scene, so that results are the same on all machines. */
static double time_of_frame(viewer *v, double wall_s)
{
    const double frame_s = 1 / v->scene->frames.fps;
    if (v->paused) {
        if (!v->steps)
            return 0;
        v->steps--;
        return frame_s * v->speed;
    }
    return (v->script ? frame_s : fmin(wall_s, frame_s)) * v->speed;
}

static bool record(viewer *v, VkCommandBuffer cmd, double dt_s, const view_shown *shown)
{
    char *error = v->error;
    const size_t size = sizeof v->error;
    view_picture_begin(cmd);
    if (!shot_live_record(&v->shot, cmd, dt_s, &v->seen, error, size))
        return false;
    v->picking = v->picking && v->shot.target.in_focus;
    if (v->picking)
        host_target_pick(&v->shot.target, cmd, v->pick_at);
    view_picture_prepare(&v->picture, cmd, &v->shot, &v->seen, shown);
    view_window_begin(&v->window, cmd);
    view_picture_draw(&v->picture, cmd, &v->shot, &v->window, shown);
    view_panel_draw(cmd);
    view_window_end(&v->window, cmd);
    return !v->window_shot[0] || view_window_copy(&v->window, cmd, error, size);
}

/* Actions that need an idle device. */
static bool between_frames(viewer *v, const float area[4])
{
    if (v->restart) {
        v->restart = v->needs_restart = false;
        if (!view_start_again(v))
            return false;
    }
    if (v->seeks) {
        v->seeks = false;
        if (!view_seek(v))
            return false;
    }
    return fit_shot(v, area) && (!v->shot_file[0] || !v->frame || write_shot(v));
}

static bool draw(viewer *v, double wall_s)
{
    view_shown shown = {.exposure_ev = (float)v->scene->preview.exposure_ev, .curve = v->scene->preview.curve};
    VkCommandBuffer cmd;
    view_panel_build(v);
    const double dt_s = time_of_frame(v, wall_s);
    view_camera_move(v, wall_s, dt_s);
    fit_picture(v, shown.area);
    view_focus_move(v, shown.area, v->script ? 1 / v->scene->frames.fps : wall_s);
    shown.mode = view_mode_items(&v->shot, v->mode) ? v->mode : 0;
    shown.item = v->item;
    if (!shot_live_light(&v->shot, dt_s, v->error, sizeof v->error) ||
        !shot_begin(&v->shot, &cmd, v->error, sizeof v->error) || !record(v, cmd, dt_s, &shown) ||
        !view_window_present(&v->window, v->error, sizeof v->error))
        return false;
    v->frame++;
    if (v->picking && !view_focus_pick(v))
        return false;
    read_numbers(v, wall_s);
    return !v->window_shot[0] || write_window(v);
}

bool view_frame(viewer *v)
{
    float area[4];
    bool ready = false;
    glfwPollEvents();
    v->quit = v->quit || glfwWindowShouldClose(v->window.glfw);
    if (!view_script_run(v))
        return false;
    if (v->quit)
        return true;
    fit_picture(v, area);
    if ((v->window.width && !between_frames(v, area)) ||
        !view_window_acquire(&v->window, &ready, v->error, sizeof v->error))
        return false;
    if (!ready) {
        glfwWaitEventsTimeout(0.05); /* minimised: nothing to draw into */
        return true;
    }
    const double now = glfwGetTime(), wall_s = fmin(now - v->wall_s, 1);
    v->wall_s = now;
    return draw(v, wall_s);
}
