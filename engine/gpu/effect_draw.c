/* gpu/effect_draw.c - an effect's pipelines for a target, and the common checks of its draws. */
#include "gpu/effect.h"

#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/target.h"

#include <string.h>

/* ---- targets */

/* Serial 0: a free one. */
static virga_effect_target *find_target(const virga_effect *effect, uint64_t serial)
{
    for (uint32_t i = 0; i < VIRGA_EFFECT_MAX_TARGETS; i++)
        if (effect->targets[i].serial == serial)
            return (virga_effect_target *)&effect->targets[i];
    return NULL;
}

static void retire_target(virga_effect *effect, virga_effect_target *target)
{
    for (uint32_t i = 0; i < VIRGA_EFFECT_MAX_DRAWS; i++)
        VIRGA_RETIRE(effect->context, target->draws[i]);
    target->serial = 0;
}

void virga_effect_retire_targets(virga_effect *effect)
{
    for (uint32_t i = 0; i < VIRGA_EFFECT_MAX_TARGETS; i++)
        retire_target(effect, &effect->targets[i]);
}

bool virga_effect_wants_motion(const virga_effect *effect)
{
    for (uint32_t i = 0; i < VIRGA_EFFECT_MAX_TARGETS; i++)
        if (effect->targets[i].serial && effect->targets[i].motion)
            return true;
    return false;
}

/* What all pipelines of a row have in common. */
static virga_graphics_def describe_row(const virga_effect *effect, const virga_effect_draw *row,
                                       virga_target_outputs outputs)
{
    const virga_effect_layout *layout = &effect->type->layouts[effect->type->draw_layout];
    const virga_bindings *bindings = *(virga_bindings **)virga_effect_member(effect, layout->member);
    const bool color_only = !row->fragment[VIRGA_OUTPUTS_BOTH].code;
    const virga_target_outputs written = color_only ? VIRGA_OUTPUTS_COLOR : outputs;
    const bool motion = (written & VIRGA_OUTPUTS_MOTION) && row->vertex[1].code;
    return (virga_graphics_def){.vertex = row->vertex[motion],
                                .fragment = row->fragment[written],
                                .outputs = written,
                                .layout = bindings->layout,
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
        virga_graphics_def def = describe_row(effect, row, virga_target_outputs_of(target));
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
    if (!effect->type->draw_count || find_target(effect, target->serial))
        return VIRGA_OK;
    virga_effect_target *slot = find_target(effect, 0);
    if (!slot)
        return virga_wrong_argument(log, "%s: more than %d targets", call, VIRGA_EFFECT_MAX_TARGETS);
    const virga_result result = create_draws(effect, target, slot);
    if (result < 0) {
        retire_target(effect, slot);
        return result;
    }
    slot->motion = virga_target_outputs_of(target) & VIRGA_OUTPUTS_MOTION;
    slot->serial = target->serial;
    return VIRGA_OK;
}

/* ---- draws */

void virga_effect_set_view(virga_effect *effect, VkDescriptorSet set, const float viewport[4])
{
    effect->view.ready = true;
    effect->view.frame = effect->context->frame_index;
    effect->view.set = set;
    memcpy(effect->view.viewport, viewport, sizeof effect->view.viewport);
}

virga_result virga_effect_find_target(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                      const virga_target *target, const virga_effect_target **found)
{
    const virga_log *log = &effect->context->log;
    if (!cmd || !target)
        return virga_wrong_argument(log, "%s: NULL argument", call);
    if (target->context != effect->context) /* serials of another context's targets are not unique here */
        return virga_wrong_argument(log, "%s: expected a target of the same context", call);
    if (effect->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    *found = find_target(effect, target->serial);
    return VIRGA_OK;
}

virga_result virga_effect_check_draw(virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                     const virga_target *target, virga_result ready, const virga_effect_target **found)
{
    const virga_result result = virga_effect_find_target(effect, call, cmd, target, found);
    if (result)
        return result;
    /* The buffers no longer hold what was prepared for an earlier frame or step. */
    if (!*found || !effect->view.ready || effect->view.frame != effect->context->frame_index)
        return virga_log_not_drawn(effect->context, call, *found != NULL, ready, &effect->not_drawn_logged);
    effect->not_drawn_logged = false;
    return VIRGA_OK;
}
