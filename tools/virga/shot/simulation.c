/* simulation.c - the effects of a shot: created from the scene file, and stepped through time. */
#include "shot/internal.h"

#include "effect.h"

#include <stdlib.h>
#include <string.h>

/* ---- life */

static bool create_simulation(shot *s, char *error, size_t error_size)
{
    virga_scene_def def = virga_default_scene_def();
    for (uint32_t i = 0; tool_effects[i]; i++) {
        const tool_effect *effect = tool_effects[i];
        if (i == SHOT_MAX_EFFECTS)
            return host_fail(error, error_size, "the program has more than %d effects", SHOT_MAX_EFFECTS);
        s->states[i] = calloc(1, effect->state_size + 1);
        if (!s->states[i])
            return host_fail(error, error_size, "no memory for an effect");
        if (effect->define && !effect->define(s, s->states[i], &def, error, error_size))
            return false;
    }
    return shot_ok(s, virga_scene_create(s->context, &def, &s->simulation), "creating the simulation", error,
                   error_size);
}

bool shot_resize_effects(shot *s, char *error, size_t error_size)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->resize && !tool_effects[i]->resize(s, s->states[i], error, error_size))
            return false;
    return true;
}

static bool create_target(shot *s, const virga_target_def *def, virga_target **target, char *error, size_t error_size)
{
    return shot_ok(s, virga_target_create(s->context, def, target), "creating a target", error, error_size) &&
           shot_ok(s, virga_scene_attach(s->simulation, *target), "building pipelines", error, error_size);
}

bool shot_renew_targets(shot *s, char *error, size_t error_size)
{
    virga_target_def layer = virga_default_target_def(), moving = virga_default_target_def();
    virga_target_destroy(&s->layer_target);
    virga_target_destroy(&s->moving_target);
    host_target_describe_layer(&s->target, &layer);
    layer.render_pass_class = 1; /* the render passes of all sizes are compatible */
    if (!create_target(s, &layer, &s->layer_target, error, error_size))
        return false;
    if (!s->options.water_velocity)
        return true;
    host_target_describe_moving(&s->target, &moving);
    moving.render_pass_class = 2;
    return create_target(s, &moving, &s->moving_target, error, error_size);
}

static bool attach_targets(shot *s, char *error, size_t error_size)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->attach && !tool_effects[i]->attach(s, s->states[i], error, error_size))
            return false;
    return shot_renew_targets(s, error, error_size);
}

bool shot_open_effects(shot *s, char *error, size_t error_size)
{
    if (!create_simulation(s, error, error_size))
        return false;
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->open && !tool_effects[i]->open(s, s->states[i], error, error_size))
            return false;
    return !s->options.draw || (shot_resize_effects(s, error, error_size) && attach_targets(s, error, error_size));
}

void shot_close_effects(shot *s)
{
    virga_target_destroy(&s->layer_target);
    virga_target_destroy(&s->moving_target);
    for (uint32_t i = 0; tool_effects[i]; i++) {
        if (s->states[i] && tool_effects[i]->close)
            tool_effects[i]->close(s, s->states[i]);
        free(s->states[i]);
        s->states[i] = NULL;
    }
    virga_scene_destroy(&s->simulation);
}

/* ---- time */

bool shot_apply_settings(shot *s, double time_s, char *error, size_t error_size)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->apply && !tool_effects[i]->apply(s, s->states[i], time_s, error, error_size))
            return false;
    return true;
}

/* Fills the simulation's input for a step. */
static bool fill_frame(shot *s, double time_s, virga_scene_frame *frame, char *error, size_t error_size)
{
    host_camera camera;
    const host_camera_path eye = shot_eye(s);
    host_camera_at(&eye, time_s, s->options.width, s->options.height, NULL, &camera);
    memcpy(frame->camera_m, camera.position_m, sizeof frame->camera_m);
    frame->occluders = s->occluders;
    frame->occluder_count = s->occluder_count;
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->fill_frame &&
            !tool_effects[i]->fill_frame(s, s->states[i], time_s, &camera, frame, error, error_size))
            return false;
    return true;
}

static bool record_before(shot *s, VkCommandBuffer cmd, double time_s, double dt_s, char *error, size_t error_size)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->before_step &&
            !tool_effects[i]->before_step(s, s->states[i], cmd, time_s, dt_s, error, error_size))
            return false;
    return true;
}

bool shot_record_time(shot *s, VkCommandBuffer cmd, double time_s, double dt_s, char *error, size_t error_size)
{
    virga_scene_frame frame = {.dt_s = dt_s, .is_unseen = s->is_unseen};
    if (!record_before(s, cmd, time_s, dt_s, error, error_size) || !fill_frame(s, time_s, &frame, error, error_size) ||
        !shot_apply_settings(s, time_s, error, error_size) ||
        !shot_ok(s, virga_scene_record(s->simulation, cmd, &frame), "stepping the simulation", error, error_size))
        return false;
    s->camera_time_s = time_s;
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->step && !tool_effects[i]->step(s, s->states[i], cmd, dt_s, error, error_size))
            return false;
    return true;
}

bool shot_record_points(shot *s, VkCommandBuffer cmd, char *error, size_t error_size)
{
    for (uint32_t i = 0; tool_effects[i]; i++) {
        const tool_effect *effect = tool_effects[i];
        if (!tool_effect_is_used(effect, s->scene))
            continue;
        for (const tool_points *points = effect->points; points; points = points->next)
            if (!points->record(s, s->states[i], cmd, error, error_size))
                return false;
    }
    return true;
}
