/* place.h - the light around a place in the street: drops show house fronts and road as well as the sky. As in many
 * games it comes from heights, not from pictures: whole, for a place, in some microseconds. */
#ifndef VIRGA_DRIVE_PLACE_H
#define VIRGA_DRIVE_PLACE_H

#include "heights.h"

#define PLACE_CELL_M 0.5 /* of the heights: fine enough for house fronts */

/* Radiance around `at_m`, in the order of virga_lighting.environment_sh: that of `sky` where the sky is seen, else what
 * is lit by it. */
void place_light(const host_heights *heights, const float sky[9][3], const double at_m[3], float out[9][3]);

#endif
