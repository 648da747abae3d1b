/* claims.h - frames that tasks draw into one folder at the same time: each frame is drawn by one task, and a frame that
 * has failed three times is left out.
 *
 * A claim is a lock on DIR/farm/frame.%04u.claim. The system releases it when the task ends in any way, on a shared
 * folder too. DIR/farm/frame.%04u.failed has a byte for each failure. DIR/farm/task.NAME has the frame that a task is
 * at, so that the script around the task can note a frame at which the program crashed. */
#ifndef VIRGA_TOOL_CLAIMS_H
#define VIRGA_TOOL_CLAIMS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CLAIM_MAX_FAILURES 3

typedef enum claim_result {
    CLAIM_TAKEN,
    CLAIM_THERE,  /* the frame was drawn meanwhile */
    CLAIM_BUSY,   /* another task draws it */
    CLAIM_FAILED, /* it has failed too often */
    CLAIM_ERROR,
} claim_result;

typedef struct claim {
    int descriptor;
    char path[4096];
} claim;

/* Makes DIR/farm. */
bool claims_open(const char *directory, char *error, size_t error_size);

claim_result claim_take(const char *directory, const char *task, uint32_t frame, claim *taken, char *error,
                        size_t error_size);

/* Releases a claim; `failed` counts a failure. */
void claim_release(const char *directory, uint32_t frame, claim *taken, bool failed);

/* For the state of a farm. Whether a frame is whole in the folder, and when it was written (may be NULL). */
bool claim_is_drawn(const char *directory, uint32_t frame, double *written_s);
uint32_t claim_failures(const char *directory, uint32_t frame);
bool claim_is_busy(const char *directory, uint32_t frame);

#endif
