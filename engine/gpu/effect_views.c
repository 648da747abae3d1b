/* gpu/effect_views.c - the views of an effect: a prepare takes one, draws find it by its handle.
 *
 * An effect has buffers and images for max_views views. The prepares of a frame take them in turn: a further one
 * replaces the oldest. So hosts that draw each view before they prepare the next need one. */
#include "gpu/effect_views.h"

#include "gpu/context.h"
#include "gpu/effect_record.h"
#include "gpu/errors.h"
#include "gpu/view.h"

#include <string.h>

/* ---- handles: 16 bits for the effect, 40 for the frame, 8 for the number of the prepare in it, from 1 on */

#define EFFECT_BITS  16
#define FRAME_BITS   40
#define PREPARE_BITS 8

static uint64_t low_bits(uint64_t value, int bits)
{
    return value & ((1ull << bits) - 1);
}

static uint64_t effect_part(const virga_effect *effect)
{
    return low_bits(effect->serial, EFFECT_BITS);
}

static uint64_t frame_part(const virga_effect *effect)
{
    return low_bits(effect->context->frame_index, FRAME_BITS);
}

static virga_prepared make_handle(const virga_effect *effect)
{
    return effect_part(effect) << (FRAME_BITS + PREPARE_BITS) | frame_part(effect) << PREPARE_BITS |
           low_bits(effect->prepares, PREPARE_BITS);
}

/* ---- the selected view */

void virga_effect_select(virga_effect *effect, uint32_t slot)
{
    const virga_effect_type *type = effect->type;
    effect->slot = slot;
    for (uint32_t i = 0; i < type->buffer_count; i++)
        if (type->buffers[i].per_view)
            memcpy(virga_effect_member(effect, type->buffers[i].member),
                   virga_effect_copy(effect, type->buffers[i].member, true, slot), sizeof(void *));
    for (uint32_t i = 0; i < type->image_count; i++)
        if (type->images[i].per_view)
            memcpy(virga_effect_member(effect, type->images[i].member),
                   virga_effect_copy(effect, type->images[i].member, true, slot), sizeof(void *));
}

virga_prepared virga_effect_newest(const virga_effect *effect)
{
    return effect->prepares_frame == effect->context->frame_index ? effect->newest : 0;
}

virga_result virga_effect_find_view(virga_effect *effect, const char *call, virga_prepared prepared)
{
    const virga_log *log = &effect->context->log;
    for (uint32_t slot = 0; slot < effect->max_views; slot++)
        if (effect->views[slot].handle == prepared && effect->views[slot].frame == effect->context->frame_index) {
            virga_effect_select(effect, slot);
            return VIRGA_OK;
        }
    if (prepared >> (FRAME_BITS + PREPARE_BITS) != effect_part(effect))
        return virga_wrong_argument(log, "%s: the view was prepared by another effect", call);
    if (low_bits(prepared >> PREPARE_BITS, FRAME_BITS) != frame_part(effect))
        return virga_wrong_argument(log, "%s: the view was prepared in another frame, and not in this one", call);
    return virga_wrong_argument(log,
                                "%s: a later step or prepare of %s has replaced the view: draw it before, or raise "
                                "max_views of the definition (%u)",
                                call, effect->type->name, effect->max_views);
}

void virga_effect_forget_views(virga_effect *effect, uint64_t frame)
{
    for (uint32_t slot = 0; slot < effect->max_views; slot++)
        if (!frame || effect->views[slot].frame == frame)
            effect->views[slot].handle = 0;
    if (!frame || effect->prepares_frame == frame)
        effect->newest = 0;
}

/* ---- prepares */

static void begin_view(virga_effect *effect)
{
    if (effect->prepares_frame != effect->context->frame_index)
        effect->prepares = 0;
    effect->prepares_frame = effect->context->frame_index;
    effect->newest = 0;
    virga_effect_select(effect, effect->prepares % effect->max_views);
}

virga_result virga_effect_check_prepare(virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                        const virga_view *view, double time_s, bool stepped)
{
    if (!cmd || !view)
        return virga_wrong_argument(&effect->context->log, "%s: NULL argument", call);
    if (effect->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    begin_view(effect);
    virga_result result = virga_view_check(effect->context, view, time_s);
    if (!result)
        result = virga_effect_ready(effect);
    return result ? result : stepped ? VIRGA_OK : VIRGA_NOT_READY;
}

virga_result virga_effect_push_view(virga_effect *effect, const char *call, virga_ring *ring, const void *block,
                                    size_t size, uint32_t *index, uint32_t *offset)
{
    *index = virga_ring_used(effect->context, ring);
    if (*index >= ring->blocks_per_frame)
        return virga_wrong_argument(&effect->context->log,
                                    "%s: more than %u views in a frame: expected virga_frame_begin before the next",
                                    call, ring->blocks_per_frame);
    *offset = virga_ring_push(effect->context, ring, block, size);
    return VIRGA_OK;
}

uint32_t virga_effect_view_index(const virga_effect *effect)
{
    return effect->prepares < VIRGA_MAX_VIEWS ? effect->prepares : VIRGA_MAX_VIEWS - 1;
}

/* A host that prepares more views than there is room for, before it draws the first of them, loses that one. */
static void log_undrawn(virga_effect *effect, const virga_effect_view *replaced)
{
    const bool undrawn = replaced->handle && replaced->frame == effect->context->frame_index && !replaced->drawn;
    if (!undrawn || effect->undrawn_logged)
        return;
    virga_log_write(&effect->context->log, VIRGA_LOG_WARNING, VIRGA_LOG_NOT_DRAWN,
                    "%s: a view was prepared, and the one that it replaces was never drawn: draw each view before the "
                    "next one is prepared, or raise max_views of the definition (%u)",
                    effect->type->name, effect->max_views);
    effect->undrawn_logged = true;
}

void virga_effect_set_view(virga_effect *effect, VkDescriptorSet set, uint32_t offset, const virga_view *view,
                           virga_prepared *prepared)
{
    virga_effect_view *to = &effect->views[effect->slot];
    log_undrawn(effect, to);
    effect->readback_views[effect->context->ring_slot] = virga_effect_view_index(effect) + 1;
    effect->prepares++;
    effect->newest = make_handle(effect);
    effect->newest_slot = effect->slot;
    *to = (virga_effect_view){.handle = effect->newest,
                              .frame = effect->context->frame_index,
                              .set = set,
                              .offset = offset,
                              .reversed_depth = view->reversed_depth,
                              .multiview_index = view->multiview_index};
    memcpy(to->viewport, view->viewport, sizeof to->viewport);
    if (prepared)
        *prepared = effect->newest;
}
