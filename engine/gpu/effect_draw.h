/* gpu/effect_draw.h - the common checks of an effect's draws. Internal. */
#ifndef VIRGA_GPU_EFFECT_DRAW_H
#define VIRGA_GPU_EFFECT_DRAW_H

#include "gpu/effect_type.h"

/* The common checks of a draw. Selects the view, and returns the target's pipelines in *found. VIRGA_NOT_READY if the
 * target is not attached or `prepared` is 0, as nothing was prepared in this frame; this is logged once, if the effect
 * is ready and was `stepped`: without a step nothing can be prepared. VIRGA_ERROR_INVALID if there is no such view, or
 * if its depth and that of the target run in different directions. */
virga_result virga_effect_check_draw(virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                     const virga_target *target, virga_prepared prepared, bool stepped,
                                     const virga_effect_target **found);

/* The same for draws that need no prepare. *found is NULL for a target that is not attached. */
virga_result virga_effect_find_target(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                      const virga_target *target, const virga_effect_target **found);

/* VIRGA_ERROR_INVALID, logged, if the target has several views and not this one, see virga_view.multiview_index. */
virga_result virga_effect_check_multiview(const virga_effect *effect, const char *call, const virga_target *target,
                                          uint32_t index);

#endif
