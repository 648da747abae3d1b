/* streaks.h - where each streak of rain is in a picture: its outline, box and coverage, from the drops themselves. */
#ifndef VIRGA_TOOL_DATASET_STREAKS_H
#define VIRGA_TOOL_DATASET_STREAKS_H

#include "shot/shot.h"

#define STREAK_MAX_CORNERS 12 /* a quad that is cut by the four sides of a picture has up to 8 */

/* Pixels are from the upper left corner of the picture, right and down. */
typedef struct streak {
    uint32_t id;     /* of the drop, as in the point cache */
    double drops;    /* that it stands for: 1 near the camera, more far away */
    double coverage; /* (0; 1] of its center line, before the plate's depth cuts it */
    double diameter_mm, distance_m;
    double width_px, length_px;            /* as drawn, also where it leaves the picture */
    double corners[STREAK_MAX_CORNERS][2]; /* its outline inside the picture */
    uint32_t corner_count;
    double box[4]; /* left, top, width, height */
    double area;
} streak;

/* Finds the streaks of the frame that shot_draw has drawn last, at the time of that frame, with one sub-frame. Those
 * that cover less than `min_coverage`, or are hidden by the plate, are left out. In the order of the drops' slots, to
 * be freed by free(). The shot was opened with options.points. */
bool streaks_find(shot *s, uint32_t frame, double min_coverage, streak **streaks, uint32_t *count, char *error,
                  size_t error_size);

#endif
