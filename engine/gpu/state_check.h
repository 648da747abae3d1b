/* gpu/state_check.h - checks the contents of a saved state before they are used. Internal.
 *
 * A hash finds damage, but not bytes that were wrong before they were sealed. So all that later steps use as an index,
 * a count or a number of workgroups is checked: a wrong one would read out of bounds, or run for hours. Other wrong
 * contents only give a wrong picture.
 *
 * Rows of doubles and bools are checked for all effects alike; the rest by virga_effect_type.check_state. */
#ifndef VIRGA_GPU_STATE_CHECK_H
#define VIRGA_GPU_STATE_CHECK_H

#include "gpu/effect_type.h"

/* Farther from the world's origin nothing is, and squares of it are finite as floats. */
#define VIRGA_STATE_MAX_NUMBER 1e15

/* More ticks than a state can have: a million years. */
#define VIRGA_STATE_MAX_TICKS 1e15

typedef struct virga_state_check {
    const virga_effect *effect;
    const char *call;          /* name of the public function, for log lines */
    const char *host, *device; /* the effect's parts in the state */
    bool failed;               /* something was wrong, and the log has a line about the first of it */
} virga_state_check;

/* The saved bytes of a part of the object, which has a row in virga_effect_type.state_rows. */
const void *virga_state_saved_row(const virga_state_check *check, const void *part);

/* The saved bytes of a buffer; NULL: it was not created, or is no part of the state. */
const void *virga_state_saved_buffer(const virga_state_check *check, const virga_buffer *buffer);

/* A saved member of the object, e.g. VIRGA_STATE_SAVED(check, splash->current). */
#define VIRGA_STATE_SAVED(check, part) (*(const __typeof__(part) *)virga_state_saved_row(check, &(part)))

/* Writes the log line: name, value and range. */
void virga_state_refuse(virga_state_check *check, const char *name, double value, double min, double max);

/* `name`: of the row or buffer and its member, e.g. "splash.state.staying". */
static inline void virga_state_expect(virga_state_check *check, const char *name, double value, double min, double max)
{
    if (!(value >= min && value <= max))
        virga_state_refuse(check, name, value, min, max);
}

/* Numbers of workgroups of an indirect dispatch: x in [0; max], y and z 0 or 1. */
static inline void virga_state_expect_groups(virga_state_check *check, const char *name, const uint32_t groups[3],
                                             double max)
{
    for (uint32_t axis = 0; axis < 3; axis++)
        virga_state_expect(check, name, groups[axis], 0, axis ? 1 : max);
}

/* The rows of doubles and bools. */
void virga_state_check_rows(virga_state_check *check);

#endif
