/* gpu/effect_settle.c - what became of completed frames: effects learn it, and do again what is lost. */
#include "gpu/effect_settle.h"

#include "gpu/context.h"
#include "gpu/effect_views.h"
#include "gpu/retire.h"

/* The object may have replaced the buffer in the meantime: the new one is not copied yet. */
static void end_uploads(virga_effect *effect, uint64_t frame)
{
    for (uint32_t i = 0; i < VIRGA_EFFECT_MAX_UPLOADS; i++) {
        virga_effect_upload *upload = &effect->uploads[i];
        if (!upload->staging || upload->first_frame > frame)
            continue;
        if (*upload->staging == upload->buffer)
            VIRGA_RETIRE(effect->context, *upload->staging);
        upload->staging = NULL;
    }
}

static void drop_statistics(virga_effect *effect, uint64_t frame, uint32_t lost)
{
    for (uint32_t part = 0; part < VIRGA_EFFECT_PARTS; part++) {
        uint64_t *unread = &effect->readback_frames[part][frame % effect->context->frames_in_flight];
        if ((lost & 1u << part) && *unread == frame)
            *unread = 0;
    }
}

/* Counts a frame once, however many effects lost something in it. A dropped frame is no surprise to its host. */
static void count_lost(virga_effect *effect, uint64_t frame, bool dropped)
{
    virga_context *context = effect->context;
    uint64_t *lost = &context->lost_of_slot[frame % context->frames_in_flight];
    if (*lost == frame)
        return;
    *lost = frame;
    context->lost_frames++;
    uint64_t power = 1;
    while (power < context->lost_frames)
        power *= 10;
    if (!dropped && power == context->lost_frames)
        virga_log_write(&context->log, VIRGA_LOG_WARNING, VIRGA_LOG_FRAME_LOST,
                        "frame %llu is reported as completed, but the device has not executed what %s recorded in it; "
                        "%llu such frames so far (see virga_frame_dropped)",
                        (unsigned long long)frame, effect->type->name, (unsigned long long)context->lost_frames);
}

static void settle_frame(virga_effect *effect, const virga_journal_outcome *outcome, bool dropped)
{
    if (outcome->executed & VIRGA_DID_CONTENTS)
        effect->contents = VIRGA_EXECUTED;
    else if ((outcome->lost & VIRGA_DID_CONTENTS) && outcome->frame == effect->contents_frame &&
             effect->contents != VIRGA_EXECUTED)
        effect->contents = VIRGA_NOT_RECORDED;
    if (outcome->executed & VIRGA_DID_IMAGES)
        effect->images = VIRGA_EXECUTED;
    else if ((outcome->lost & VIRGA_DID_IMAGES) && effect->images != VIRGA_EXECUTED)
        effect->images = VIRGA_NOT_RECORDED;
    if (outcome->executed & VIRGA_DID_UPLOAD)
        end_uploads(effect, outcome->frame);
    if (!outcome->lost)
        return;
    drop_statistics(effect, outcome->frame, outcome->lost);
    count_lost(effect, outcome->frame, dropped);
    if (outcome->lost & VIRGA_DID_LOAD)
        virga_log_write(&effect->context->log, VIRGA_LOG_WARNING, VIRGA_LOG_FRAME_LOST,
                        "frame %llu, which had to copy a loaded state of %s to the device, is lost: load it again",
                        (unsigned long long)outcome->frame, effect->type->name);
    /* What was lost before a load is not missed after it. */
    if (effect->type->lost && outcome->frame >= effect->load_frame)
        effect->type->lost(effect, outcome->frame, outcome->lost);
}

void virga_effects_settle(virga_context *context, uint64_t dropped)
{
    virga_journal_outcome outcome;
    for (virga_effect *effect = context->first_effect; effect; effect = effect->next_effect) {
        if (dropped)
            virga_effect_forget_views(effect, dropped);
        while (virga_journal_take(context, &effect->journal, dropped, &outcome))
            settle_frame(effect, &outcome, outcome.frame == dropped);
    }
}
