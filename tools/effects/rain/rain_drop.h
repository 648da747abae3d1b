/* rain_drop.h - one drop of the point cache of the rain: a row of rain_effect.points. */
#ifndef VIRGA_EFFECTS_RAIN_DROP_H
#define VIRGA_EFFECTS_RAIN_DROP_H

#include "point_columns.h"

#include <stddef.h>
#include <stdint.h>

typedef struct rain_drop {
    POINT_MEMBERS; /* in the world */
    float weight;  /* how many drops it stands for */
} rain_drop;

#endif
