/* place.h - the light around a place in the street: drops show house fronts and road as well as the sky. As in many
 * games it comes from heights, not from pictures: whole, for a place, in some microseconds. */
#ifndef VIRGA_DRIVE_PLACE_H
#define VIRGA_DRIVE_PLACE_H

#include "mesh.h"

typedef struct place_heights {
    double low_m[2]; /* corner of the grid, in x and z */
    uint32_t columns, rows;
    float *high_m; /* the highest that each cell of PLACE_CELL_M has */
} place_heights;

#define PLACE_CELL_M 0.5

/* Of all of the mesh but what is cut out, as leaves are. False: no memory. */
bool place_heights_make(const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices,
                        place_heights *heights);
void place_heights_free(place_heights *heights); /* accepts one that is all zero */

/* Radiance around `at_m`, in the order of virga_lighting.environment_sh: that of `sky` where the sky is seen, else what
 * is lit by it. */
void place_light(const place_heights *heights, const float sky[9][3], const double at_m[3], float out[9][3]);

#endif
