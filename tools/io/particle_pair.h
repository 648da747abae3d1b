/* particle_pair.h - two frames of particles, which row of one is which of the other, and what is between them. Internal
 * to particle_sequence. */
#ifndef VIRGA_IO_PARTICLE_PAIR_H
#define VIRGA_IO_PARTICLE_PAIR_H

#include "particle_sequence.h"

#define PAIR_NONE UINT32_MAX

/* Rows of `a` that are alone, or have a partner in `b`. */
typedef struct particle_pair {
    const particles *a, *b;
    uint32_t *partner_of_a, *partner_of_b; /* PAIR_NONE: none. NULL: nobody has one */
} particle_pair;

/* Finds the partners. False: no memory, or an id that `b` has twice, in *twice; PAIR_NONE: no memory. */
bool pair_match(particle_pair *pair, const particles *a, const particles *b, particle_ids ids, uint32_t *twice);
void pair_free(particle_pair *pair);

/* Writes what is between them, `interval_s` apart, at [0; 1[ of that time; to a->count + b->count samples. Returns how
 * many there are. */
uint32_t pair_mix(const particle_pair *pair, double interval_s, double part, particle_sample *samples);

/* Writes a frame at rest. */
uint32_t pair_rest(const particles *a, particle_sample *samples);

#endif
