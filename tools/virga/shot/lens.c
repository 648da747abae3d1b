/* lens.c - the library's lens in a shot: the depth of layers, the blur, and the layers out of focus. */
#include "shot/lens.h"

#include "shot/focus.h"

#include <virga/lens.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct shot_lens {
    virga_lens *lens;
    /* The last effect that shows what is behind it shows it out of focus. So its layers, and those over them, have a
     * lens of their own, which works after the other. NULL: there is no such effect */
    virga_lens *front;
    uint32_t front_first; /* first layer of `front` */
    virga_target *depth_target;
    bool warned; /* that blur is cut */
} shot_lens;

static bool has_own_depth(const shot_layer *layer)
{
    return !layer->layer->is_data && layer->layer->depth == TOOL_DEPTH_DRAWN;
}

/* ---- create and destroy */

static bool create_lens(shot *s, virga_lens **lens, char *error, size_t error_size)
{
    virga_lens_def def = virga_default_lens_def();
    def.max_width = s->options.width < 16 ? 16 : s->options.width;
    def.max_height = s->options.height < 16 ? 16 : s->options.height;
    def.half_resolution = s->options.live;
    return shot_ok(s, virga_lens_create(s->context, &def, lens), "creating a lens", error, error_size) &&
           shot_ok(s, virga_lens_attach(*lens, s->layer_target), "building a lens", error, error_size);
}

/* Whether no layer before this one is of the same effect. */
static bool is_first(const shot *s, uint32_t index)
{
    for (uint32_t i = 0; i < index; i++)
        if (s->layers[i].effect == s->layers[index].effect)
            return false;
    return true;
}

/* The first layer of the last effect that shows what is behind it out of focus; 0: there is none, or nothing is behind
 * it. */
static uint32_t find_front(const shot *s)
{
    uint32_t first = 0;
    for (uint32_t i = 1; i < s->layer_count; i++)
        if (tool_effects[s->layers[i].effect]->shows_behind && !tool_effects[s->layers[i].effect]->in_air &&
            is_first(s, i))
            first = i;
    return first;
}

static bool check_count(const shot *s, uint32_t first, uint32_t end, char *error, size_t error_size)
{
    uint32_t colors = 0;
    for (uint32_t i = first; i < end; i++)
        colors += !s->layers[i].layer->is_data;
    return colors <= VIRGA_LENS_MAX_LAYERS ||
           host_fail(error, error_size, "camera.aperture_f: a lens blurs %d layers, the scene has %u",
                     VIRGA_LENS_MAX_LAYERS, colors);
}

static bool create_lenses(shot *s, char *error, size_t error_size)
{
    s->lens->front_first = find_front(s);
    return create_lens(s, &s->lens->lens, error, error_size) &&
           (!s->lens->front_first || create_lens(s, &s->lens->front, error, error_size));
}

static bool create_depth_target(shot *s, uint32_t layers, char *error, size_t error_size)
{
    virga_target_def def = virga_default_target_def();
    if (!layers)
        return true;
    host_target_describe_layer_depth(&s->target, &def);
    def.render_pass_class = 3;
    return shot_ok(s, virga_target_create(s->context, &def, &s->lens->depth_target), "creating a target for depth",
                   error, error_size) &&
           shot_ok(s, virga_scene_attach(s->simulation, s->lens->depth_target), "building pipelines for depth", error,
                   error_size);
}

bool shot_open_lens(shot *s, char *error, size_t error_size)
{
    uint32_t own_depths = 0;
    shot_close_lens(s);
    if (!s->options.draw || s->options.parts != HOST_PLATE_WHOLE || !shot_gathers(s))
        return true;
    s->lens = calloc(1, sizeof *s->lens);
    if (!s->lens)
        return host_fail(error, error_size, "no memory for a lens");
    const uint32_t front = find_front(s);
    if (!check_count(s, 0, front ? front : s->layer_count, error, error_size) ||
        !check_count(s, front, s->layer_count, error, error_size))
        return false;
    for (uint32_t i = 0; i < s->layer_count; i++)
        own_depths |= has_own_depth(&s->layers[i]) ? 1u << (s->layers[i].output - HOST_LAYER) : 0;
    return host_target_add_focus(&s->device, &s->target, own_depths, error, error_size) &&
           create_lenses(s, error, error_size) && create_depth_target(s, own_depths, error, error_size);
}

void shot_close_lens(shot *s)
{
    if (!s->lens)
        return;
    virga_lens_destroy(&s->lens->lens);
    virga_lens_destroy(&s->lens->front);
    virga_target_destroy(&s->lens->depth_target);
    free(s->lens);
    s->lens = NULL;
    host_target_drop_focus(&s->device, &s->target);
    s->target.in_focus = false;
}

/* ---- settings */

#define MAX_RADIUS_PX 63 /* of the library, at full resolution */

/* What is farthest is blurred the most, but for what is very near. */
static void warn_of_cut(shot *s, const virga_lens_settings *settings, double focus_inv_m)
{
    double focal[2], center[2];
    host_camera_intrinsics(&s->path, s->options.width, s->options.height, focal, center);
    const double radius_px = 0.5 * scene_camera_aperture_m(s->scene) * focal[1] * s->options.height * focus_inv_m;
    if (s->lens->warned || s->options.live || radius_px <= (double)settings->max_radius_px)
        return;
    host_warn(&s->device, "camera: blur of %.0f pixels is cut to %g; camera.blur=exact cuts none", radius_px,
              (double)settings->max_radius_px);
    s->lens->warned = true;
}

static bool apply(shot *s, virga_lens *lens, double focus_inv_m, char *error, size_t error_size)
{
    const scene_camera *camera = &s->scene->camera;
    virga_lens_settings to = virga_default_lens_settings();
    to.focal_m = (float)fmin(fmax(scene_camera_focal_m(s->scene), 0.001), 10);
    to.aperture_f = (float)(camera->aperture_f * (double)to.focal_m / scene_camera_focal_m(s->scene));
    to.focus_m = focus_inv_m > 1e-6 ? (float)(1 / focus_inv_m) : 0;
    to.blades = camera->blades;
    to.blade_roundness = (float)camera->blade_roundness;
    to.blade_rotation_deg = (float)camera->blade_rotation_deg;
    to.cats_eye = (float)camera->cats_eye;
    to.max_radius_px = MAX_RADIUS_PX;
    warn_of_cut(s, &to, focus_inv_m);
    return shot_ok(s, virga_lens_set(lens, &to), "setting the lens", error, error_size);
}

/* ---- recording */

/* Layers from `first` on, before `end`, as the library wants them. */
typedef struct layer_list {
    virga_lens_layer layers[VIRGA_LENS_MAX_LAYERS];
    host_output outputs[VIRGA_LENS_MAX_LAYERS];
    uint32_t count;
} layer_list;

static void list_layers(const shot *s, uint32_t first, uint32_t end, double focus_inv_m, layer_list *list)
{
    for (uint32_t i = first; i < end; i++) {
        const shot_layer *from = &s->layers[i];
        if (from->layer->is_data)
            continue;
        virga_lens_layer *to = &list->layers[list->count];
        *to = (virga_lens_layer){.color = host_target_layer(&s->target, from->output)};
        to->on_scene = from->layer->depth == TOOL_DEPTH_SCENE;
        to->depth_m = (float)fmin(fmax(1 / fmax(focus_inv_m, 1e-6), 0.001), 1e6);
        if (has_own_depth(from))
            to->depth = host_target_layer_depth(&s->target, from->output);
        list->outputs[list->count++] = from->output;
    }
}

static bool draw_depths(shot *s, VkCommandBuffer cmd, uint32_t first, uint32_t end, char *error, size_t error_size)
{
    for (uint32_t i = first; i < end; i++) {
        const shot_layer *layer = &s->layers[i];
        if (!has_own_depth(layer))
            continue;
        host_target_begin_layer_depth(&s->target, cmd, layer->output);
        const virga_result result = layer->layer->draw(s->states[layer->effect], cmd, s->lens->depth_target);
        host_target_end_layer(&s->target, cmd);
        if (!shot_ok(s, result, "drawing the depth of a layer", error, error_size))
            return false;
    }
    return true;
}

static bool draw_part(shot *s, virga_lens *lens, VkCommandBuffer cmd, host_output output, uint32_t part, char *error,
                      size_t error_size)
{
    host_target_begin_focused(&s->target, cmd, output);
    const virga_result result = virga_lens_draw_part(lens, cmd, s->layer_target, part);
    host_target_end_layer(&s->target, cmd);
    return shot_ok(s, result, "drawing what is out of focus", error, error_size);
}

/* The layers of one lens, and the scene's color where it is the first. */
static bool focus(shot *s, virga_lens *lens, VkCommandBuffer cmd, const tool_moment *at, uint32_t first, uint32_t end,
                  char *error, size_t error_size)
{
    layer_list list = {.count = 0};
    virga_view view = *at->jittered;
    /* Footage is as sharp as it was filmed, and the second lens only needs the layers. */
    if (s->plate || first)
        view.depth = (virga_image){0};
    list_layers(s, first, end, at->focus_inv_m, &list);
    if (!apply(s, lens, at->focus_inv_m, error, error_size) || !draw_depths(s, cmd, first, end, error, error_size))
        return false;
    for (uint32_t i = 0; i < list.count; i++)
        host_target_read_layer(&s->target, cmd, list.outputs[i]);
    if (!shot_ok(s, virga_lens_prepare(lens, cmd, &view, list.layers, list.count, at->camera_s), "focusing", error,
                 error_size) ||
        (!first && !draw_part(s, lens, cmd, HOST_COLOR, 0, error, error_size)))
        return false;
    for (uint32_t i = 0; i < list.count; i++)
        if (!draw_part(s, lens, cmd, list.outputs[i], i + 1, error, error_size))
            return false;
    return true;
}

bool shot_lens_has_behind(const shot *s, uint32_t layer)
{
    return s->target.in_focus && s->lens->front && layer == s->lens->front_first;
}

bool shot_record_behind(shot *s, VkCommandBuffer cmd, const tool_moment *at, virga_image *color, char *error,
                        size_t error_size)
{
    virga_lens_image picture;
    if (!focus(s, s->lens->lens, cmd, at, 0, s->lens->front_first, error, error_size))
        return false;
    virga_lens_picture(s->lens->lens, &picture);
    const virga_image_state state = {VK_IMAGE_LAYOUT_GENERAL,
                                     VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                     VK_ACCESS_SHADER_READ_BIT};
    *color = (virga_image){.image = picture.image,
                           .view = picture.view,
                           .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                           .extent = {picture.width, picture.height, 1},
                           .layers = 1,
                           .before = state,
                           .after = state};
    return true;
}

void shot_begin_lens(shot *s)
{
    s->target.in_focus = s->lens && shot_gathers(s);
}

bool shot_record_lens(shot *s, VkCommandBuffer cmd, const tool_moment *at, char *error, size_t error_size)
{
    if (!s->target.in_focus)
        return true;
    const uint32_t first = s->lens->front_first;
    return focus(s, first ? s->lens->front : s->lens->lens, cmd, at, first, s->layer_count, error, error_size);
}
