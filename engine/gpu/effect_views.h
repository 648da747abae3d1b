/* gpu/effect_views.h - the views of an effect: a prepare takes one, draws find it by its handle. Internal. */
#ifndef VIRGA_GPU_EFFECT_VIEWS_H
#define VIRGA_GPU_EFFECT_VIEWS_H

#include "gpu/effect_type.h"

/* The common checks of a prepare. Selects a view for it, whose buffers and images it may write, and which is no longer
 * drawn. VIRGA_NOT_READY if passes are not built, or if `stepped` is false: before the first step. */
virga_result virga_effect_check_prepare(virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                        const virga_view *view, double time_s, bool stepped);

/* Pushes the block of a view into a ring. Returns the index of the view in this frame, and the offset of the block. An
 * error if the frame has no room for another view. */
virga_result virga_effect_push_view(virga_effect *effect, const char *call, virga_ring *ring, const void *block,
                                    size_t size, uint32_t *index, uint32_t *offset);

/* Ends a prepare: stores what draws need, and gives the handle of the view to *prepared, which may be NULL. `offset` is
 * that of its block in the ring. */
void virga_effect_set_view(virga_effect *effect, VkDescriptorSet set, uint32_t offset, const virga_view *view,
                           virga_prepared *prepared);

/* Makes the buffers and images of a view the object's members. */
void virga_effect_select(virga_effect *effect, uint32_t slot);

/* The selected view. */
static inline const virga_effect_view *virga_effect_selected(const virga_effect *effect)
{
    return &effect->views[effect->slot];
}

/* The view of the newest prepare of this frame; 0: none, or it failed. */
virga_prepared virga_effect_newest(const virga_effect *effect);

/* Selects a prepared view of this frame. VIRGA_ERROR_INVALID, logged, if there is none with this handle. */
virga_result virga_effect_find_view(virga_effect *effect, const char *call, virga_prepared prepared);

/* Views that were prepared are no longer drawn: of a frame, or of all frames (0). */
void virga_effect_forget_views(virga_effect *effect, uint64_t frame);

/* The index of the prepare that is being recorded among those of its frame, at most VIRGA_MAX_VIEWS - 1: that of its
 * statistics. */
uint32_t virga_effect_view_index(const virga_effect *effect);

#endif
