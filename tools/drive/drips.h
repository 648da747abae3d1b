/* drips.h - which edges of a street drip. It has thousands, and each costs time in each tick. Those that show the most
 * from where the camera is have a slot; the others wait until it comes near. */
#ifndef VIRGA_DRIVE_DRIPS_H
#define VIRGA_DRIVE_DRIPS_H

#include <virga/splash.h>

typedef struct drip_rank {
    double value;
    uint32_t place;
} drip_rank;

typedef struct drip_places {
    virga_drip_site *all;
    uint32_t count;
    uint32_t slots;   /* at most so many drip at a time */
    uint32_t *slot;   /* of each place; `slots`: it has none */
    drip_rank *ranks; /* of all places, by what they show; room behind them for those that come */
    double eye_m[3];  /* for which they were chosen ... */
    bool chosen;      /* ... if they were */
} drip_places;

/* Takes `all`, of malloc, numbers its places from 1 on, and frees it in the end. False: no memory. */
bool drip_places_create(virga_drip_site *all, uint32_t count, uint32_t slots, drip_places *places);
void drip_places_free(drip_places *places); /* accepts one that is all zero */

/* Chooses for a camera at `eye_m` if it has moved on by a metre, and writes the chosen to `sites`, slot by slot.
 * Returns how many: all that there are, or all slots. What stays chosen keeps its slot, and so its water; a slot whose
 * place has another number than before begins anew. */
uint32_t drip_places_choose(drip_places *places, const double eye_m[3], virga_drip_site *sites);

#endif
