/* lens.h - declares the drops on the camera's lens of a scene file: the section `lens`. */
#ifndef VIRGA_EFFECTS_LENS_H
#define VIRGA_EFFECTS_LENS_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The camera's front element: a round pane before the lens's opening, square to its axis. virga/glass.h explains the
 * members that it has, too. */
typedef struct scene_lens {
    bool drops;                           /* it gets wet; false: there is none */
    double away_mm;                       /* from the opening, ahead */
    double diameter_mm;                   /* of the element */
    uint32_t kind;                        /* virga_glass_kind */
    double *advancing_deg, *receding_deg; /* NULL: the kind's */
    double shelter, air_share, air_outward, evaporation_mm_h, mist_max_mm, veil, starburst, starburst_deg;
    uint32_t starburst_rays;
    double wipe_every_s; /* a cloth wipes it so often; 0: never */
    double wipe_s;       /* from one side to the other */
    double cell_m;
    uint32_t max_drops;
} scene_lens;

/* The section of a scene. */
scene_lens *scene_lens_of(const scene_file *scene);

#ifdef __cplusplus
}
#endif
#endif
