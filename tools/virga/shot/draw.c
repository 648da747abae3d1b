/* draw.c - the picture of a shot: the plate, the layers of effects, and a frame as an average of sub-frames. */
#include "shot/internal.h"

#include "effect.h"
#include "reuse.h"
#include "shot/distort.h"
#include "shot/focus.h"
#include "shot/lens.h"
#include "shot/plate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- layers */

static const tool_effect *effect_of(const shot_layer *layer)
{
    return tool_effects[layer->effect];
}

/* Whether a layer is the first of its effect. */
static bool is_first(const shot *s, uint32_t index)
{
    for (uint32_t i = 0; i < index; i++)
        if (s->layers[i].effect == s->layers[index].effect)
            return false;
    return true;
}

static bool draw_layer(const shot *s, VkCommandBuffer cmd, const shot_layer *layer, const virga_target *target,
                       char *error, size_t error_size)
{
    char what[80];
    const virga_result result = layer->layer->draw(s->states[layer->effect], cmd, target);
    snprintf(what, sizeof what, "drawing the layer %s", layer->layer->name);
    return shot_ok(s, result, what, error, error_size);
}

/* Colors of the first `count` layers, over what is there. Ends the pass. */
static bool draw_colors(const shot *s, VkCommandBuffer cmd, uint32_t count, const virga_target *target, char *error,
                        size_t error_size)
{
    bool drawn = true;
    for (uint32_t i = 0; i < count && drawn; i++)
        drawn = s->layers[i].layer->is_data || draw_layer(s, cmd, &s->layers[i], target, error, error_size);
    host_target_end_layer(&s->target, cmd);
    return drawn;
}

/* ---- sub-frames that share */

/* Of a sub-frame. */
typedef struct sample_moments {
    tool_moment own;
    tool_moment span; /* over all sub-frames of its group, see tool_layer.spans */
    bool has_mirrors; /* mirrors are drawn, not shared */
} sample_moments;

/* So many after each other share the shading of the plate. Through a lens each sees its things elsewhere, and where the
 * velocity is that of the water, it is drawn over the plate's. */
static uint32_t shading_share(const shot *s)
{
    const bool alone = s->plate || s->moving_target || shot_looks_through_lens(s);
    return alone ? 1 : host_reuse_share(s->options.samples);
}

/* Whether layers may be drawn over the time of several sub-frames. Panes show what is behind them in each, and the
 * velocity of water is drawn in each. */
static bool may_span(const shot *s)
{
    bool each = s->lens || shot_looks_through_lens(s) || s->moving_target;
    for (uint32_t i = 0; i < s->layer_count && !each; i++)
        each = effect_of(&s->layers[i])->shows_behind;
    return !each && host_accumulator_share(s->options.samples) > 1;
}

/* Whether a layer that is smooth has its turn in a sub-frame: one in each group. A lens blurs each sub-frame in its own
 * way, and needs them all. The sums have as many sub-frames as were drawn before this one. */
static bool has_turn(const shot *s, const shot_layer *layer)
{
    const uint32_t share = host_accumulator_share(s->options.samples),
                   place = host_camera_jitter_index(s->sums.samples, shading_share(s));
    const uint32_t from = layer->layer->shared_from;
    if (!from || s->options.samples < from || s->lens || shot_looks_through_lens(s) ||
        (layer->layer->spans && !may_span(s)))
        return true;
    return place % share == host_camera_jitter_turn(place / share, share);
}

/* Whether a layer is seen in a sub-frame, or through another that shows what is behind it. */
static bool is_needed(const shot *s, uint32_t index)
{
    bool seen = has_turn(s, &s->layers[index]);
    for (uint32_t i = index + 1; i < s->layer_count; i++)
        seen = seen || effect_of(&s->layers[i])->shows_behind;
    return seen;
}

/* Draws the plate with the lower layers, as input for an effect that shows what is behind it. These layers are drawn a
 * second time for it. */
static bool prepare_layer(shot *s, VkCommandBuffer cmd, uint32_t index, const tool_moment *at, char *error,
                          size_t error_size)
{
    const tool_effect *effect = effect_of(&s->layers[index]);
    virga_view view = *at->jittered;
    tool_moment behind = *at;
    if (!effect->shows_behind || !is_first(s, index) || !is_needed(s, index))
        return true;
    if (shot_lens_has_behind(s, index)) {
        if (!shot_record_behind(s, cmd, at, &view.color, error, error_size))
            return false;
    } else {
        host_target_begin_behind(&s->target, cmd);
        if (!draw_colors(s, cmd, index, s->layer_target, error, error_size))
            return false;
        view.color = host_target_behind(&s->target);
    }
    behind.jittered = &view;
    return effect->prepare(s, s->states[s->layers[index].effect], cmd, &behind, error, error_size);
}

/* Each into a picture of its own. */
static bool draw_layers(shot *s, VkCommandBuffer cmd, const tool_moment *at, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < s->layer_count; i++) {
        if (!prepare_layer(s, cmd, i, at, error, error_size))
            return false;
        if (!has_turn(s, &s->layers[i])) {
            host_accumulator_skip(&s->sums, s->layers[i].output);
            continue;
        }
        host_target_begin_output(&s->target, cmd, s->layers[i].output);
        const bool drawn = draw_layer(s, cmd, &s->layers[i], s->layer_target, error, error_size);
        host_target_end_layer(&s->target, cmd);
        if (!drawn)
            return false;
    }
    return true;
}

/* ---- the picture */

/* Of the layers of an effect: whether some are drawn now, and whether some span several sub-frames. Mirrors show haze
 * too, where they are drawn. */
static void find_uses(const shot *s, uint32_t effect, const sample_moments *moments, bool *drawn, bool *spans)
{
    *drawn = moments->has_mirrors;
    *spans = false;
    for (uint32_t i = 0; i < s->layer_count; i++) {
        if (s->layers[i].effect != effect)
            continue;
        *drawn = *drawn || is_needed(s, i);
        *spans = *spans || s->layers[i].layer->spans;
    }
    *spans = *spans && may_span(s);
}

/* In the order of layers, before the plate or after it; those that show what is behind them come later. */
static bool prepare(shot *s, VkCommandBuffer cmd, const sample_moments *moments, bool after_plate, char *error,
                    size_t error_size)
{
    for (uint32_t i = 0; i < s->layer_count; i++) {
        const tool_effect *effect = effect_of(&s->layers[i]);
        bool drawn, spans;
        if (!effect->prepare || effect->shows_behind || effect->after_plate != after_plate || !is_first(s, i))
            continue;
        find_uses(s, s->layers[i].effect, moments, &drawn, &spans);
        if (drawn && !effect->prepare(s, s->states[s->layers[i].effect], cmd, spans ? &moments->span : &moments->own,
                                      error, error_size))
            return false;
    }
    return true;
}

/* The opaque scene, or footage that replaces it. */
static bool record_plate(shot *s, VkCommandBuffer cmd, double camera_s, const host_camera *now,
                         const host_camera *frame_ago, char *error, size_t error_size)
{
    if (s->plate) {
        host_target_fill_plate(&s->target, cmd, &s->plate_buffer, s->plate->has_depth ? &s->plate_depth_buffer : NULL);
        if (!s->plate_ground)
            return true;
    }
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->before_plate &&
            !tool_effects[i]->before_plate(s, s->states[i], cmd, camera_s, error, error_size))
            return false;
    return s->plate ? host_renderer_footage(s->renderer, cmd, &s->target, now, frame_ago, error, error_size)
                    : host_renderer_plate(s->renderer, cmd, &s->target, now, frame_ago, error, error_size);
}

/* The cameras of a sub-frame, where its shutter closes and opens and a frame before, and the view that they make. */
typedef struct sample_cameras {
    host_camera now, open, frame_ago;
    double focus_inv_m; /* 1 / view depth that is sharp */
} sample_cameras;

static bool record_picture(shot *s, VkCommandBuffer cmd, const sample_moments *moments, const sample_cameras *cameras,
                           char *error, size_t error_size)
{
    const tool_moment *at = &moments->own;
    shot_begin_lens(s);
    if (!prepare(s, cmd, moments, false, error, error_size) ||
        !record_plate(s, cmd, at->camera_s, &cameras->now, &cameras->frame_ago, error, error_size) ||
        !prepare(s, cmd, moments, true, error, error_size) || !draw_layers(s, cmd, at, error, error_size) ||
        !shot_record_lens(s, cmd, at, error, error_size))
        return false;
    if (!s->moving_target)
        return true;
    host_target_begin_moving(&s->target, cmd);
    return draw_colors(s, cmd, s->layer_count, s->moving_target, error, error_size);
}

/* Motion vectors as the layer of velocities has them: from a frame ago on, in pixels. */
static void set_frame_ago(const shot *s, const host_camera *frame_ago, virga_view *view)
{
    virga_temporal *temporal = &view->temporal;
    memcpy(temporal->position_m, frame_ago->position_m, sizeof frame_ago->position_m);
    memcpy(temporal->view_from_world, frame_ago->view_from_world, sizeof frame_ago->view_from_world);
    memcpy(temporal->clip_from_view, frame_ago->clip_from_view, sizeof frame_ago->clip_from_view);
    temporal->frame_interval_s = fmin(1 / s->scene->frames.fps, 1);
    temporal->motion_scale[0] = temporal->motion_scale[1] = -1;
    if (s->options.water_velocity)
        temporal->motion_coverage = 0.01f * (float)s->options.water_velocity;
}

/* All three cameras look from the same point of the lens, so that only motion is between them. */
static void place_cameras(shot *s, double close_s, double part_s, double shot_start, const float *jitter,
                          const double lens_m[2], sample_cameras *cameras)
{
    const double inv_m = cameras->focus_inv_m, focus_m = inv_m > 0 ? 1 / inv_m : 0;
    shot_camera(s, fmax(close_s, shot_start), inv_m, jitter, &cameras->now);
    cameras->now.samples = s->options.samples;
    shot_camera(s, fmax(close_s - part_s, shot_start), inv_m, jitter, &cameras->open);
    shot_camera(s, fmax(close_s - 1 / s->scene->frames.fps, shot_start), inv_m, jitter, &cameras->frame_ago);
    host_camera_move_on_lens(&cameras->now, lens_m, focus_m);
    host_camera_move_on_lens(&cameras->open, lens_m, focus_m);
    host_camera_move_on_lens(&cameras->frame_ago, lens_m, focus_m);
}

/* The sub-frame whose depth and id a frame has is shaded by itself. */
static bool is_kept(const shot *s, uint32_t sample)
{
    return sample == s->options.samples / 2;
}

static void share_shading(const shot *s, uint32_t sample, host_camera *camera)
{
    const double share = shading_share(s), shutter = s->scene->frames.shutter_deg / 360;
    camera->shares = (uint32_t)share;
    camera->follows = sample % camera->shares != 0 && !is_kept(s, sample);
    camera->part = (float)(shutter * (share - 1) / s->options.samples);
}

/* The lens, for streaks: each is blurred by its own depth, unless sub-frames look through the lens. */
static void set_lens(const shot *s, double focus_inv_m, virga_view *view)
{
    const scene_camera *camera = &s->scene->camera;
    const double aperture_m = camera->aperture_f > 0 ? scene_camera_aperture_m(s->scene) : 1e-3 * camera->aperture_mm;
    view->aperture_m = shot_looks_through_lens(s) ? 0 : (float)fmin(aperture_m, 1);
    view->focus_m = focus_inv_m > 1e-6 ? (float)(1 / focus_inv_m) : 0;
}

static virga_view look_through(shot *s, double part_s, uint32_t sub_frames, const sample_cameras *cameras)
{
    virga_view view = virga_default_view();
    view.depth = host_target_depth(&s->target);
    view.color = host_target_color(&s->target);
    host_camera_view(&cameras->now, &cameras->open, part_s, &view);
    view.sub_frames = sub_frames;
    memcpy(view.jitter_px, cameras->now.jitter_px, sizeof view.jitter_px);
    set_frame_ago(s, &cameras->frame_ago, &view);
    set_lens(s, cameras->focus_inv_m, &view);
    return view;
}

/* Where on the lens a sub-frame looks from, to the right and up. */
static void lens_point(const shot *s, uint32_t sample, double lens_m[2])
{
    const scene_camera *camera = &s->scene->camera;
    const double radius_m = 0.5 * scene_camera_aperture_m(s->scene);
    lens_m[0] = lens_m[1] = 0;
    if (!shot_looks_through_lens(s))
        return;
    shot_lens_point(camera, sample, s->options.samples, lens_m);
    lens_m[0] *= radius_m;
    lens_m[1] *= -radius_m; /* it was down */
}

/* One of `count` equal parts of the shutter's time; the last closes at the frame's time. */
typedef struct shutter_part {
    double time_s; /* of the frame */
    uint32_t index, count;
    float jitter_px[2];
    double lens_m[2];
} shutter_part;

/* The views of a moment, and what they are made of. */
typedef struct sample_views {
    virga_view steady, jittered;
    sample_cameras cameras; /* of the jittered one */
} sample_views;

static tool_moment make_moment(shot *s, const shutter_part *part, sample_views *views)
{
    const host_camera_path eye = shot_eye(s);
    const double part_s = s->scene->frames.shutter_deg / 360 / s->scene->frames.fps / part->count;
    const double late_s = part_s * (part->count - 1 - part->index), close_s = part->time_s - late_s;
    const double shot_start = host_camera_shot_start(&eye, part->time_s), camera_s = fmax(close_s, shot_start);
    sample_cameras steady = {.focus_inv_m = shot_focus_inv_m(s, camera_s)};
    views->cameras = steady;
    place_cameras(s, close_s, part_s, shot_start, NULL, part->lens_m, &steady);
    place_cameras(s, close_s, part_s, shot_start, part->jitter_px, part->lens_m, &views->cameras);
    views->steady = look_through(s, part_s, part->count, &steady);
    views->jittered = look_through(s, part_s, part->count, &views->cameras);
    return (tool_moment){.jittered = &views->jittered,
                         .steady = &views->steady,
                         .camera_s = camera_s,
                         .late_s = late_s,
                         .focus_inv_m = steady.focus_inv_m};
}

/* The shutter closes at the frame's time. */
bool shot_record_sample(shot *s, VkCommandBuffer cmd, uint32_t sample, double time_s, char *error, size_t error_size)
{
    const uint32_t share = host_accumulator_share(s->options.samples);
    shutter_part part = {.time_s = time_s, .index = sample, .count = s->options.samples};
    sample_views own, span;
    sample_moments moments;
    host_camera_jitter(host_camera_jitter_index(sample, shading_share(s)), s->options.samples, part.jitter_px);
    lens_point(s, sample, part.lens_m);
    moments.own = make_moment(s, &part, &own);
    own.cameras.now.sample = sample;
    share_shading(s, sample, &own.cameras.now);
    moments.has_mirrors = !own.cameras.now.follows;
    part.index /= share;
    part.count /= share;
    moments.span = make_moment(s, &part, &span);
    return record_picture(s, cmd, &moments, &own.cameras, error, error_size);
}

/* What is not drawn is not added up: colors, and the layer that a target has from the start. */
static void skip_outputs(shot *s)
{
    if (s->options.parts == HOST_PLATE_WHOLE)
        return;
    host_accumulator_skip(&s->sums, HOST_COLOR);
    host_accumulator_skip(&s->sums, HOST_LAYER);
    for (int i = 0; s->options.parts == HOST_PLATE_DEPTH && i < HOST_LAYER; i++)
        if (i != HOST_DEPTH)
            host_accumulator_skip(&s->sums, (host_output)i);
}

/* Cat's eye, where sub-frames look through the lens. */
static bool weigh_sample(shot *s, uint32_t sample, char *error, size_t error_size)
{
    const scene_camera *camera = &s->scene->camera;
    double point[2];
    if (!shot_looks_through_lens(s) || camera->cats_eye <= 0)
        return true;
    float *weights = host_accumulator_weigh(&s->sums, error, error_size);
    shot_lens_point(camera, sample, s->options.samples, point);
    if (weights)
        shot_lens_weights(camera, point, s->options.width, s->options.height, weights);
    return weights;
}

/* One is recorded while the device draws the one before. */
static bool draw_sample(shot *s, uint32_t sample, double time_s, char *error, size_t error_size)
{
    VkCommandBuffer cmd;
    if (!shot_begin(s, &cmd, error, error_size) || !shot_record_sample(s, cmd, sample, time_s, error, error_size) ||
        !weigh_sample(s, sample, error, error_size))
        return false;
    skip_outputs(s);
    if (!host_accumulator_add(&s->sums, cmd, &s->target, is_kept(s, sample), error, error_size))
        return false;
    if (sample + 1 == s->options.samples)
        host_accumulator_copy_out(&s->sums, cmd, &s->target);
    return host_submit(&s->device, error, error_size);
}

/* From the pinhole's picture to that of the lens. The plate keeps its own pixels where nothing was drawn over them. */
static void distort(shot *s)
{
    shot_distortion_kind kinds[HOST_MAX_LAYERS] = {SHOT_DISTORT_COLOR};
    shot_distortion_plate plate = {.color = NULL};
    if (s->plate)
        plate = (shot_distortion_plate){.color = s->plate->picture,
                                        .undone = s->lens || s->plate_ground ? s->plate->rgba : NULL,
                                        .depth = s->plate_ground ? NULL : s->plate->distance};
    for (uint32_t i = 0; i < s->layer_count; i++) {
        const tool_layer *layer = s->layers[i].layer;
        kinds[s->layers[i].output - HOST_LAYER] = !layer->is_data     ? SHOT_DISTORT_COLOR
                                                  : layer->offset > 0 ? SHOT_DISTORT_OFFSET
                                                  : layer->offset < 0 ? SHOT_DISTORT_MOTION
                                                                      : SHOT_DISTORT_DATA;
    }
    shot_distortion_redo(s->distortion, &s->pinhole, kinds, s->layer_count, &plate, &s->frame);
}

bool shot_draw_samples(shot *s, double time_s, host_camera *camera, char *error, size_t error_size)
{
    shot_camera(s, time_s, shot_focus_inv_m(s, time_s), NULL, camera);
    host_accumulator_reset(&s->sums);
    if (s->plate)
        memcpy(s->plate_buffer.mapped, s->plate->rgba, s->plate_buffer.size);
    if (s->plate && s->plate->has_depth)
        memcpy(s->plate_depth_buffer.mapped, s->plate->depth, s->plate_depth_buffer.size);
    for (uint32_t sample = 0; sample < s->options.samples; sample++)
        if (!draw_sample(s, sample, time_s, error, error_size))
            return false;
    if (!host_wait(&s->device, error, error_size))
        return false;
    host_accumulator_finish(&s->sums, &s->target, s->distortion ? &s->pinhole : &s->frame);
    if (s->distortion)
        distort(s);
    return true;
}
