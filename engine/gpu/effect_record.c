/* gpu/effect_record.c - recording that all effects share: checks, ring blocks, descriptors, statistics. */
#include "gpu/effect_record.h"

#include "gpu/builds.h"
#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <stdio.h>
#include <string.h>

virga_result virga_effect_ready(const virga_effect *effect)
{
    return effect->context->lost ? VIRGA_ERROR_DEVICE_LOST : virga_group_ready(&effect->passes);
}

virga_result virga_effect_check_step(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                     const void *info)
{
    const virga_log *log = &effect->context->log;
    if (!cmd || !info)
        return virga_wrong_argument(log, "%s: NULL argument", call);
    if (effect->context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!effect->context->frame_index)
        return virga_frame_not_begun(log, call);
    return VIRGA_OK;
}

virga_result virga_effect_check_one_step(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                         const void *info)
{
    return virga_effect_check_step_after(effect, call, cmd, info, effect->step_frame);
}

virga_result virga_effect_check_step_after(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                           const void *info, uint64_t last_frame)
{
    const virga_result result = virga_effect_check_step(effect, call, cmd, info);
    if (result || last_frame != effect->context->frame_index)
        return result;
    char again[96];
    snprintf(again, sizeof again, "%s: called again in frame %llu", call,
             (unsigned long long)effect->context->frame_index);
    return virga_frame_not_begun(&effect->context->log, again);
}

virga_result virga_effect_check_ticks(const virga_effect *effect, const virga_tick_range *range,
                                      const uint32_t *last_tick)
{
    const virga_log *log = &effect->context->log;
    if (range->count > range->max)
        return virga_wrong_argument(log, "step_info.ticks: expected up to max_ticks_per_step = %u, got %u", range->max,
                                    range->count);
    /* Tick numbers wrap around after years. */
    if (!range->count || !last_tick || (int32_t)(range->first - *last_tick) > 0)
        return VIRGA_OK;
    virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_FRAME_ORDER,
                    "step_info.first_tick: %u after %u, expected one behind it", range->first, *last_tick);
    return VIRGA_ERROR_INVALID;
}

void virga_effect_begin_step(virga_effect *effect, VkCommandBuffer cmd)
{
    virga_context *context = effect->context;
    virga_timers_reset(context, cmd);
    virga_effect_read_statistics(effect);
    effect->step_frame = context->frame_index;
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES | VIRGA_VERTICES | VIRGA_FRAGMENTS,
               VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES);
}

/* ---- rings */

uint32_t virga_ring_used(const virga_context *context, const virga_ring *ring)
{
    return ring->frame == context->frame_index ? ring->used : 0;
}

static uint32_t block_offset(const virga_context *context, const virga_ring *ring, uint32_t index)
{
    return (context->ring_slot * ring->blocks_per_frame + index) * ring->block_bytes;
}

uint32_t virga_ring_next_offset(const virga_context *context, const virga_ring *ring)
{
    return block_offset(context, ring, virga_ring_used(context, ring));
}

/* Blocks are filled elsewhere and copied at once, because mapped memory may be slow to read. */
uint32_t virga_ring_write(virga_context *context, virga_ring *ring, uint32_t index, const void *block, size_t size)
{
    const uint32_t offset = block_offset(context, ring, index);
    memcpy((char *)ring->buffer->memory.block.mapped + offset, block, size);
    virga_buffer_flush(context, ring->buffer, offset, ring->block_bytes);
    return offset;
}

uint32_t virga_ring_push(virga_context *context, virga_ring *ring, const void *block, size_t size)
{
    const uint32_t index = virga_ring_used(context, ring);
    ring->frame = context->frame_index;
    ring->used = index + 1;
    return virga_ring_write(context, ring, index, block, size);
}

/* ---- descriptors */

static VkSampler sampler_of(const virga_context *context, const virga_binding_kind *row)
{
    return row->sampler == VIRGA_SAMPLER_LINEAR ? context->linear : context->nearest;
}

static virga_bound bound_of(const virga_effect *effect, const virga_binding_kind *row)
{
    const void *member = virga_effect_member(effect, row->member);
    switch (row->source) {
    case VIRGA_SOURCE_BUFFER: {
        const virga_buffer *buffer = *(virga_buffer *const *)member; /* NULL: its size is 0 */
        return (virga_bound){.buffer = buffer ? buffer->buffer : VK_NULL_HANDLE, .range = row->range};
    }
    case VIRGA_SOURCE_RING:
        return (virga_bound){.buffer = ((const virga_ring *)member)->buffer->buffer, .range = row->range};
    case VIRGA_SOURCE_TEXELS: {
        const virga_buffer *buffer = *(virga_buffer *const *)member;
        return (virga_bound){.texels = buffer ? buffer->texels : VK_NULL_HANDLE};
    }
    case VIRGA_SOURCE_IMAGE: {
        const virga_image_2d *image = *(virga_image_2d *const *)member;
        return (virga_bound){.view = image ? image->layer_views[0] : VK_NULL_HANDLE,
                             .image_layout = VK_IMAGE_LAYOUT_GENERAL,
                             .sampler = sampler_of(effect->context, row)};
    }
    default: return (virga_bound){0};
    }
}

void virga_effect_bound(const virga_effect *effect, const virga_bindings *bindings,
                        virga_bound bound[VIRGA_MAX_BINDINGS])
{
    for (uint32_t i = 0; i < bindings->count; i++)
        bound[i] = bound_of(effect, &bindings->kinds[i]);
}

virga_bound virga_bound_or_blank(const virga_image *image, const virga_image_2d *blank, VkSampler sampler)
{
    const bool given = image && image->view;
    return (virga_bound){.sampler = sampler,
                         .view = given ? image->view : blank->layer_views[0],
                         .image_layout = given ? image->before.layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

VkSampler virga_color_sampler(const virga_context *context, const virga_image *image)
{
    /* Not every device can filter textures of four 32-bit floats. */
    return image && image->format == VK_FORMAT_R32G32B32A32_SFLOAT ? context->nearest : context->linear;
}

/* ---- statistics */

/* The next passes and the next frame's copies wait for a call's copies and its mark, and so does the host. */
static void end_copies(virga_context *context, VkCommandBuffer cmd)
{
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_HOST_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
}

void virga_effect_note(virga_effect *effect, VkCommandBuffer cmd, uint32_t did)
{
    virga_journal_note(effect->context, &effect->journal, cmd, did);
    end_copies(effect->context, cmd);
}

void virga_effect_copy_statistics(virga_effect *effect, VkCommandBuffer cmd, uint32_t part, const virga_buffer *from,
                                  VkDeviceSize from_offset, VkDeviceSize to_offset, VkDeviceSize size)
{
    virga_context *context = effect->context;
    const VkDeviceSize frame_offset = (VkDeviceSize)context->ring_slot * effect->type->readback_bytes;
    const VkBufferCopy copy = {from_offset, frame_offset + to_offset, size};
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_COPIES, VIRGA_COPIES);
    context->vk.CmdCopyBuffer(cmd, from->buffer, effect->readback->buffer, 1, &copy);
    virga_journal_note(context, &effect->journal, cmd, 1u << part);
    end_copies(context, cmd);
    effect->readback_frames[part][context->ring_slot] = context->frame_index;
}

/* The oldest completed frame whose statistics were not read yet; 0: none. */
static uint64_t oldest_unread(const virga_effect *effect)
{
    uint64_t oldest = 0;
    for (uint32_t part = 0; part < VIRGA_EFFECT_PARTS; part++)
        for (uint32_t i = 0; i < effect->context->frames_in_flight; i++) {
            const uint64_t frame = effect->readback_frames[part][i];
            if (frame && frame <= effect->context->completed_index && (!oldest || frame < oldest))
                oldest = frame;
        }
    return oldest;
}

void virga_effect_read_statistics(virga_effect *effect)
{
    const char *mapped = effect->readback->memory.block.mapped;
    virga_buffer_invalidate(effect->context, effect->readback);
    for (uint64_t frame = oldest_unread(effect); frame; frame = oldest_unread(effect)) {
        const uint32_t slot = (uint32_t)(frame % effect->context->frames_in_flight);
        uint32_t parts = 0;
        for (uint32_t part = 0; part < VIRGA_EFFECT_PARTS; part++)
            if (effect->readback_frames[part][slot] == frame) {
                parts |= 1u << part;
                effect->readback_frames[part][slot] = 0;
            }
        effect->type->read_statistics(effect, frame, slot, parts, mapped + (size_t)slot * effect->type->readback_bytes);
    }
}
