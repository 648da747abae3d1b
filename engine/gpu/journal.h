/* gpu/journal.h - what an effect's calls recorded in each frame, and whether the device executed it. Internal.
 *
 * A host may throw a recorded command buffer away, e.g. when a buffer of its own grows in the middle of a frame. So
 * what a call recorded counts only when the device has executed it. Each call ends with a write of a mark into mapped
 * memory. When the host reports the frame as completed, a call whose mark is missing was never executed: it is lost.
 * The effect then does again what the call did (virga_effect_type.lost). */
#ifndef VIRGA_GPU_JOURNAL_H
#define VIRGA_GPU_JOURNAL_H

#include "gpu/resources.h"

#define VIRGA_JOURNAL_CALLS 32 /* marks per frame; further calls share the last one */

/* What a call recorded, as bits. The first VIRGA_EFFECT_PARTS bits are the parts of the statistics. */
enum {
    VIRGA_DID_CONTENTS = 1 << 4, /* first contents of buffers, and of images that every frame writes */
    VIRGA_DID_IMAGES = 1 << 5,   /* first contents of the images that outlive a frame */
    VIRGA_DID_UPLOAD = 1 << 6,
    VIRGA_DID_LOAD = 1 << 7, /* copied a saved state to the device */
    VIRGA_DID_OWN = 1 << 8,  /* from here on: the effect's own */
};

typedef struct virga_journal_frame {
    uint64_t frame; /* 0: none */
    uint32_t calls;
    uint32_t did[VIRGA_JOURNAL_CALLS];
} virga_journal_frame;

typedef struct virga_journal {
    /* Word 0: not 0 once the device has executed the first contents. Then the marks, frame by frame. */
    virga_buffer *marks;
    uint32_t doing; /* what the call that is being recorded did so far */
    virga_journal_frame frames[VIRGA_MAX_FRAMES_IN_FLIGHT];
} virga_journal;

/* Bytes of device memory with the maximum number of frames in flight. */
#define VIRGA_JOURNAL_BYTES ((1 + VIRGA_MAX_FRAMES_IN_FLIGHT * VIRGA_JOURNAL_CALLS) * sizeof(uint32_t))

virga_result virga_journal_create(virga_context *context, virga_journal *journal);

/* At the end of a call that recorded outside rendering. Adds `doing` and `did` to the journal, and records the mark.
 * The caller records a barrier from transfers to the host behind it. */
void virga_journal_note(virga_context *context, virga_journal *journal, VkCommandBuffer cmd, uint32_t did);

/* The calls of a frame, when their outcome is known. */
typedef struct virga_journal_outcome {
    uint64_t frame;
    uint32_t executed, lost; /* what the calls did, as bits */
} virga_journal_outcome;

/* Takes the oldest completed frame out of the journal. `dropped` (0: none) is a frame that the host has thrown away: it
 * counts as completed, and all its calls as lost. False: there is none. */
bool virga_journal_take(virga_context *context, virga_journal *journal, uint64_t dropped,
                        virga_journal_outcome *outcome);

#endif
