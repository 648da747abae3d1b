/* gpu/frames.c - the host's frames: which one is recorded, and which ones the device has completed. */
#include "gpu/builds.h"
#include "gpu/context.h"
#include "gpu/effect_settle.h"
#include "gpu/effect_targets.h"
#include "gpu/retire.h"

virga_result virga_frame_begin(virga_context *context, uint64_t frame_index, uint64_t completed_index)
{
    if (!context)
        return VIRGA_ERROR_INVALID;
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (frame_index <= context->frame_index || completed_index >= frame_index ||
        completed_index < context->completed_index) {
        virga_log_write(
            &context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FRAME_ORDER,
            "frame %llu after %llu with %llu completed: indices start at 1 and rise, and completed is behind",
            (unsigned long long)frame_index, (unsigned long long)context->frame_index,
            (unsigned long long)completed_index);
        return VIRGA_ERROR_INVALID;
    }
    if (frame_index - completed_index > context->frames_in_flight) {
        virga_log_write(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FRAME_ORDER,
                        "frame %llu with %llu completed: more than %u frames in flight",
                        (unsigned long long)frame_index, (unsigned long long)completed_index,
                        context->frames_in_flight);
        return VIRGA_ERROR_INVALID;
    }
    context->frame_index = frame_index;
    context->completed_index = completed_index;
    context->ring_slot = (uint32_t)(frame_index % context->frames_in_flight);
    virga_effects_settle(context, 0);
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    virga_effects_free_targets(context);
    virga_builds_collect(context); /* a failure is also reported by its effect */
    virga_destroy_retired(context, false);
    return virga_timers_begin_frame(context);
}

virga_result virga_frame_completed(virga_context *context, uint64_t completed_index)
{
    if (!context)
        return VIRGA_ERROR_INVALID;
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (completed_index < context->completed_index || completed_index > context->frame_index) {
        virga_log_write(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FRAME_ORDER,
                        "frame %llu said to be complete, between %llu and %llu expected",
                        (unsigned long long)completed_index, (unsigned long long)context->completed_index,
                        (unsigned long long)context->frame_index);
        return VIRGA_ERROR_INVALID;
    }
    context->completed_index = completed_index;
    virga_effects_settle(context, 0);
    return context->lost ? VIRGA_ERROR_DEVICE_LOST : virga_timers_collect(context);
}

virga_result virga_frame_dropped(virga_context *context, uint64_t frame_index)
{
    if (!context)
        return VIRGA_ERROR_INVALID;
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (frame_index <= context->completed_index || frame_index > context->frame_index) {
        virga_log_write(&context->log, VIRGA_LOG_ERROR, VIRGA_LOG_FRAME_ORDER,
                        "virga_frame_dropped: expected a frame after %llu, which is completed, up to %llu, got %llu",
                        (unsigned long long)context->completed_index, (unsigned long long)context->frame_index,
                        (unsigned long long)frame_index);
        return VIRGA_ERROR_INVALID;
    }
    virga_effects_settle(context, frame_index);
    virga_timers_drop(context, frame_index);
    return context->lost ? VIRGA_ERROR_DEVICE_LOST : VIRGA_OK;
}

uint64_t virga_frames_lost(const virga_context *context)
{
    return context ? context->lost_frames : 0;
}
