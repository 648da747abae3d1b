/* gpu/effect_draw.c - the common checks of an effect's draws. */
#include "gpu/effect_draw.h"

#include "gpu/context.h"
#include "gpu/effect_record.h"
#include "gpu/effect_targets.h"
#include "gpu/effect_views.h"
#include "gpu/errors.h"
#include "gpu/target.h"
#include "gpu/timers.h"

/* With a wrong direction every fragment fails the depth test, and nothing is seen. */
static virga_result check_depth(const virga_effect *effect, const char *call, const virga_target *target)
{
    const bool of_target = target->def.reversed_depth, of_view = virga_effect_selected(effect)->reversed_depth;
    if (!target->def.depth_attached || of_target == of_view)
        return VIRGA_OK;
    return virga_wrong_argument(&effect->context->log,
                                "%s: target_def.reversed_depth is %s, and view.reversed_depth of the prepared view is "
                                "%s: expected the same",
                                call, of_target ? "true" : "false", of_view ? "true" : "false");
}

/* A draw shows in one view of the pass. */
virga_result virga_effect_check_multiview(const virga_effect *effect, const char *call, const virga_target *target,
                                          uint32_t index)
{
    if (!target->def.view_mask || target->def.view_mask >> index & 1)
        return VIRGA_OK;
    return virga_wrong_argument(&effect->context->log,
                                "%s: view.multiview_index is %u, which is not in target_def.view_mask (0x%x)", call,
                                index, target->def.view_mask);
}

virga_result virga_effect_find_target(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                      const virga_target *target, const virga_effect_target **found)
{
    const virga_log *log = &effect->context->log;
    if (!cmd || !target)
        return virga_wrong_argument(log, "%s: NULL argument", call);
    if (target->context != effect->context)
        return virga_wrong_argument(log, "%s: expected a target of the same context", call);
    if (effect->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    virga_timers_expect(effect->context, target->def.view_mask != 0);
    *found = virga_effect_target_of(effect, target->class_of);
    return VIRGA_OK;
}

virga_result virga_effect_check_draw(virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                     const virga_target *target, virga_prepared prepared, bool stepped,
                                     const virga_effect_target **found)
{
    virga_result result = virga_effect_find_target(effect, call, cmd, target, found);
    if (result)
        return result;
    const virga_result ready = stepped ? virga_effect_ready(effect) : VIRGA_NOT_READY;
    if (!*found || !prepared)
        return virga_log_not_drawn(effect->context, call, *found != NULL, ready, &effect->not_drawn_logged);
    result = virga_effect_find_view(effect, call, prepared);
    if (result)
        return result;
    effect->not_drawn_logged = false;
    effect->views[effect->slot].drawn = true;
    result = virga_effect_check_multiview(effect, call, target, virga_effect_selected(effect)->multiview_index);
    return result ? result : check_depth(effect, call, target);
}
