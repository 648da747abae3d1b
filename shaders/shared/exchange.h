/* exchange.h - water that goes from cells of the ground into a simulation of water, and back. */
#ifndef VIRGA_SHARED_EXCHANGE_H
#define VIRGA_SHARED_EXCHANGE_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_exchanged_gpu virga_exchanged_gpu;
typedef struct virga_exchange_gpu virga_exchange_gpu;
#endif

/* The water of a particle, 16 bytes. */
struct virga_exchanged_gpu {
    float position[3]; /* m, relative to the origin of the particles */
    uint water_nl;     /* nl */
};

/* Head, 96 bytes. Two lists of `capacity` entries follow: what was taken from cells, and what is given to them. The
 * simulation owns them. It says in each step how many particles it has room for, and what it gives; ground takes up to
 * that number, and empties the list of what is given. Whoever reads a list empties it, and whoever writes to one that
 * is not empty leaves it alone. So water is neither lost nor counted twice, whichever of the steps is left out. */
struct virga_exchange_gpu {
    uint capacity;        /* of each list; 0 before the first step of the simulation */
    uint free_slots;      /* particles that the simulation has room for */
    uint particle_nl;     /* nl, water of a particle */
    float spacing_m;      /* m, distance of particles at rest */
    float floor_m;        /* m, height of the floor of the simulation's box, from its origin */
    float ceiling_m;      /* m */
    uint taken;           /* entries of the first list */
    uint waiting;         /* particles whose water stayed in the cells in the newest step, as there was no room */
    uint given;           /* entries of the second list */
    uint particles;       /* that the simulation has, those of other sources included */
    uint given_groups[3]; /* ceil(given / 64), 1, 1: for an indirect dispatch */
    uint begun;           /* particles that were ever made of taken water, modulo 2^32 */
    uint taken_nl[2];     /* nl, low and high word: all that became particles */
    uint given_nl[2];     /* nl, all that went to the ground */
    uint sprayed_nl[2];   /* nl, all that left as droplets which fly on their own */
    /* nl, two's complement: what particles that became droplets had more than these, or less; it goes to the ground
     * with the next particle */
    uint rest_nl[2];
    uint pad[2];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_exchanged_gpu, 16);
VIRGA_ASSERT_SIZE(virga_exchange_gpu, 96);
VIRGA_ASSERT_OFFSET(virga_exchange_gpu, given_groups, 40);
#undef uint
#endif

#endif
