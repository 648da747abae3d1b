/* particle_spacing.h - how far apart simulated particles are, found out from their positions. */
#ifndef VIRGA_IO_PARTICLE_SPACING_H
#define VIRGA_IO_PARTICLE_SPACING_H

#include "particles.h"

typedef struct particle_spacing {
    double nearest; /* median distance of a particle to the nearest other one */
    double spacing; /* side of the cube of water that a particle inside the water stands for */
} particle_spacing;

/* In the unit of the positions. `spacing` is (particles per volume)^(-1/3): d on a cubic lattice, and 0.93 d in the
 * settled water of a program that gives particles a volume of 0.8 d^3. False: too few particles for a guess, or all at
 * one place. Deterministic. Costs 0.1 s for a million particles; 8 bytes each. */
bool particle_spacing_guess(const particles *frame, particle_spacing *guess);

/* The smallest box around all finite positions, and how many are not finite. False if none is finite. */
bool particles_bounds(const particles *frame, float low[3], float high[3], uint32_t *invalid);

#endif
