/* gpu/effect_targets.c - an effect's pipelines for the classes of targets. */
#include "gpu/effect_targets.h"

#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/retire.h"

virga_effect_target *virga_effect_target_of(const virga_effect *effect, const virga_target_class *class_of)
{
    virga_effect_target *found = effect->targets;
    while (found && found->class_of != class_of)
        found = found->next;
    return found;
}

static void retire_draws(virga_effect *effect, virga_effect_target *target)
{
    for (uint32_t i = 0; i < VIRGA_EFFECT_MAX_DRAWS; i++)
        VIRGA_RETIRE(effect->context, target->draws[i]);
}

/* Takes the target at *at out of the list. */
static void free_target(virga_effect *effect, virga_effect_target **at)
{
    virga_effect_target *target = *at;
    *at = target->next;
    retire_draws(effect, target);
    virga_target_class_leave(effect->context, target->class_of);
    virga_free(&effect->context->heap, target);
}

void virga_effect_retire_targets(virga_effect *effect)
{
    while (effect->targets)
        free_target(effect, &effect->targets);
}

void virga_effects_free_targets(virga_context *context)
{
    for (virga_effect *effect = context->first_effect; effect; effect = effect->next_effect) {
        virga_effect_target **at = &effect->targets;
        while (*at)
            if ((*at)->class_of->targets)
                at = &(*at)->next;
            else
                free_target(effect, at);
    }
}

bool virga_effect_wants_motion(const virga_effect *effect)
{
    for (const virga_effect_target *target = effect->targets; target; target = target->next)
        if (target->class_of->targets && target->class_of->like.motion_attachment)
            return true;
    return false;
}

/* What all pipelines of a row have in common. */
static virga_graphics_def describe_row(const virga_effect *effect, const virga_effect_draw *row,
                                       const virga_target *target)
{
    const virga_target_outputs outputs = virga_target_outputs_of(target);
    const virga_effect_layout *layout = &effect->type->layouts[effect->type->draw_layout];
    const virga_bindings *bindings = *(virga_bindings **)virga_effect_member(effect, layout->member);
    const bool color_only = !row->fragment[VIRGA_OUTPUTS_BOTH];
    const virga_target_outputs written = color_only ? VIRGA_OUTPUTS_COLOR : outputs;
    const bool motion = (written & VIRGA_OUTPUTS_MOTION) && row->vertex[1];
    return (virga_graphics_def){.vertex = row->vertex[motion + (target->def.view_mask ? VIRGA_VIEWS_FORM : 0)],
                                .fragment = row->fragment[written],
                                .outputs = written,
                                .layout = bindings->shared,
                                .blend_premultiplied = !row->replace,
                                .depth_test = !row->no_depth,
                                .cull_back = row->cull_back,
                                .lines = row->lines,
                                .name = row->name};
}

static uint32_t constants_of(const virga_effect_draw *row)
{
    return row->constants ? row->constant_count : 1;
}

/* Creates those of a row: `pipeline` is the first. */
static virga_result create_row(const virga_effect *effect, const virga_effect_draw *row, const virga_target *target,
                               virga_pipeline **pipeline)
{
    static const uint32_t no_constant[1] = {0};
    const uint32_t common = effect->type->draw_constant ? effect->type->draw_constant(effect) : 0;
    virga_graphics_def def = describe_row(effect, row, target);
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < constants_of(row); i++) {
        def.constant = common | (row->constants ? row->constants : no_constant)[i];
        if (!row->lines || effect->context->lines)
            TRY(virga_target_pipeline(target, def, &pipeline[i]));
    }
error:
    return result;
}

/* Creates the rows of `wanted` that are missing. If one fails, those before it stay. */
static virga_result create_draws(const virga_effect *effect, const virga_target *target, uint32_t wanted,
                                 virga_effect_target *slot)
{
    virga_result result = VIRGA_OK;
    virga_pipeline **pipeline = slot->draws;
    for (uint32_t i = 0; i < effect->type->draw_count; i++) {
        const virga_effect_draw *row = &effect->type->draws[i];
        if (wanted & ~slot->rows & 1u << i) {
            TRY(create_row(effect, row, target, pipeline));
            slot->rows |= 1u << i;
        }
        pipeline += constants_of(row);
    }
error:
    return result;
}

static uint32_t wanted_by(const virga_effect *effect, const void *settings)
{
    return effect->type->wanted_draws ? effect->type->wanted_draws(effect, settings) : UINT32_MAX;
}

virga_result virga_effect_want_draws(virga_effect *effect, const void *settings)
{
    virga_result result = VIRGA_OK;
    for (virga_effect_target *slot = effect->targets; slot && !result; slot = slot->next)
        if (slot->from)
            result = create_draws(effect, slot->from, wanted_by(effect, settings), slot);
    return result;
}

virga_result virga_effect_attach(virga_effect *effect, const char *call, const virga_target *target)
{
    const virga_log *log = &effect->context->log;
    if (!target || target->context != effect->context)
        return virga_wrong_argument(log, "%s: expected a target of the same context", call);
    if (effect->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!effect->type->draw_count)
        return VIRGA_OK;
    const uint32_t wanted = wanted_by(effect, virga_effect_member(effect, effect->type->settings.member));
    virga_effect_target *made = virga_effect_target_of(effect, target->class_of);
    if (made) {
        made->from = made->from ? made->from : target;
        return create_draws(effect, made->from, wanted, made);
    }
    made = virga_alloc(&effect->context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(effect->context, call);
    made->class_of = target->class_of;
    made->from = target;
    made->next = effect->targets;
    effect->targets = made;
    virga_target_class_use(made->class_of);
    const virga_result result = create_draws(effect, target, wanted, made);
    if (result < 0)
        free_target(effect, &effect->targets);
    return result < 0 ? result : VIRGA_OK;
}

static bool waits(const virga_effect_target *target)
{
    for (uint32_t i = 0; i < VIRGA_EFFECT_MAX_DRAWS; i++)
        if (target->draws[i] && target->draws[i]->waits)
            return true;
    return false;
}

static const virga_target *another_of(const virga_context *context, const virga_target_class *class_of)
{
    const virga_target *other = context->first_target;
    while (other && other->class_of != class_of)
        other = other->next_target;
    return other;
}

void virga_effects_forget_target(const virga_target *target)
{
    const virga_target *other = another_of(target->context, target->class_of);
    for (virga_effect *effect = target->context->first_effect; effect; effect = effect->next_effect) {
        virga_effect_target **at = &effect->targets;
        while (*at && (*at)->from != target)
            at = &(*at)->next;
        if (!*at)
            continue;
        if (!waits(*at)) {
            (*at)->from = other;
            continue;
        }
        free_target(effect, at);
        if (other)
            virga_effect_attach(effect, "virga_target_destroy", other); /* a failure is logged, and draws are refused */
    }
}
