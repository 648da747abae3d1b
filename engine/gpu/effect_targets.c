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
    const bool color_only = !row->fragment[VIRGA_OUTPUTS_BOTH].code;
    const virga_target_outputs written = color_only ? VIRGA_OUTPUTS_COLOR : outputs;
    const bool motion = (written & VIRGA_OUTPUTS_MOTION) && row->vertex[1].code;
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

static virga_result create_draws(const virga_effect *effect, const virga_target *target, virga_effect_target *slot)
{
    static const uint32_t no_constant[1] = {0};
    const virga_effect_type *type = effect->type;
    const uint32_t common = type->draw_constant ? type->draw_constant(effect) : 0;
    virga_result result = VIRGA_OK;
    virga_pipeline **pipeline = slot->draws;
    for (uint32_t i = 0; i < type->draw_count; i++) {
        const virga_effect_draw *row = &type->draws[i];
        const uint32_t count = row->constants ? row->constant_count : 1;
        virga_graphics_def def = describe_row(effect, row, target);
        for (uint32_t k = 0; k < count; k++, pipeline++) {
            def.constant = common | (row->constants ? row->constants : no_constant)[k];
            if (!row->lines || effect->context->lines)
                TRY(virga_target_pipeline(target, def, pipeline));
        }
    }
error:
    return result;
}

virga_result virga_effect_attach(virga_effect *effect, const char *call, const virga_target *target)
{
    const virga_log *log = &effect->context->log;
    if (!target || target->context != effect->context)
        return virga_wrong_argument(log, "%s: expected a target of the same context", call);
    if (effect->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!effect->type->draw_count || virga_effect_target_of(effect, target->class_of))
        return VIRGA_OK;
    virga_effect_target *made = virga_alloc(&effect->context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(effect->context, call);
    made->class_of = target->class_of;
    made->from = target;
    made->next = effect->targets;
    effect->targets = made;
    virga_target_class_use(made->class_of);
    const virga_result result = create_draws(effect, target, made);
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
