/* gpu/journal.c - see journal.h. */
#include "gpu/journal.h"

#include "gpu/context.h"

#include <string.h>

virga_result virga_journal_create(virga_context *context, virga_journal *journal)
{
    const VkDeviceSize bytes = (1 + context->frames_in_flight * VIRGA_JOURNAL_CALLS) * sizeof(uint32_t);
    const virga_result result =
        virga_buffer_create(context, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                            VIRGA_HEAP_READBACK, "marks of executed calls", &journal->marks);
    if (result)
        return result;
    memset(journal->marks->memory.block.mapped, 0, bytes);
    virga_buffer_flush(context, journal->marks, 0, bytes);
    return VIRGA_OK;
}

/* Index of the word for a call. */
static uint32_t word_of(const virga_context *context, uint64_t frame, uint32_t call)
{
    return 1 + (uint32_t)(frame % context->frames_in_flight) * VIRGA_JOURNAL_CALLS + call;
}

/* Differs from 0 and from the marks of the frames that used the word before. */
static uint32_t mark_of(uint64_t frame)
{
    return 1 + (uint32_t)(frame % UINT32_MAX);
}

void virga_journal_note(virga_context *context, virga_journal *journal, VkCommandBuffer cmd, uint32_t did)
{
    virga_journal_frame *entry = &journal->frames[context->ring_slot];
    if (entry->frame != context->frame_index)
        *entry = (virga_journal_frame){.frame = context->frame_index};
    const uint32_t call = entry->calls < VIRGA_JOURNAL_CALLS ? entry->calls++ : VIRGA_JOURNAL_CALLS - 1;
    entry->did[call] |= journal->doing | did;
    journal->doing = 0;
    context->vk.CmdFillBuffer(cmd, journal->marks->buffer, word_of(context, entry->frame, call) * sizeof(uint32_t),
                              sizeof(uint32_t), mark_of(entry->frame));
}

static virga_journal_frame *oldest(const virga_context *context, virga_journal *journal, uint64_t dropped)
{
    virga_journal_frame *found = NULL;
    for (uint32_t i = 0; i < context->frames_in_flight; i++) {
        virga_journal_frame *entry = &journal->frames[i];
        const bool known = entry->frame && (entry->frame <= context->completed_index || entry->frame == dropped);
        if (known && (!found || entry->frame < found->frame))
            found = entry;
    }
    return found;
}

bool virga_journal_take(virga_context *context, virga_journal *journal, uint64_t dropped,
                        virga_journal_outcome *outcome)
{
    virga_journal_frame *entry = oldest(context, journal, dropped);
    if (!entry)
        return false;
    *outcome = (virga_journal_outcome){.frame = entry->frame};
    const uint32_t *marks = journal->marks->memory.block.mapped;
    virga_buffer_invalidate(context, journal->marks);
    if (context->lost)
        return false;
    for (uint32_t call = 0; call < entry->calls; call++) {
        const bool there =
            entry->frame != dropped && marks[word_of(context, entry->frame, call)] == mark_of(entry->frame);
        *(there ? &outcome->executed : &outcome->lost) |= entry->did[call];
    }
    *entry = (virga_journal_frame){0};
    return true;
}
