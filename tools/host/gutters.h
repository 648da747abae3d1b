/* gutters.h - roofs' water: along the gutters at their eaves to downpipes, and out of these. */
#ifndef VIRGA_HOST_GUTTERS_H
#define VIRGA_HOST_GUTTERS_H

#include <stdbool.h>
#include <stdint.h>

#include <virga/splash.h>

/* A piece of an eave, from which more water comes than drips. */
typedef struct host_eave {
    uint32_t x, z;        /* its cell in a grid */
    double position_m[3]; /* just outside of it */
    double ground_m;      /* height of the ground below; NAN: there is none */
    double catch_m2;      /* level area that drains to it */
    double width_m, slope;
} host_eave;

/* The lower end of a downpipe. */
typedef struct host_downpipe {
    double position_m[3];
    double velocity_m_s[3]; /* of the water that leaves it */
} host_downpipe;

typedef struct host_gutters {
    virga_drip_site *sites; /* places from which it pours, in the order of pipes. Freed with free() */
    uint32_t site_count;
    double lost_m2; /* level area of roofs whose water finds no way to the ground */
} host_gutters;

/* Eaves that touch are one gutter. Its water goes to the downpipes that stand within a metre of it, from each piece to
 * the nearest. If `pipe_count` is 0 each gutter has a pipe of its own where it ends, which pours on the ground below.
 * A pipe pours from several places, as each has at most 2 m2 of the roof. Returns false without memory. */
bool host_gutters_find(const host_eave *eaves, uint32_t eave_count, const host_downpipe *pipes, uint32_t pipe_count,
                       host_gutters *gutters);

#endif
