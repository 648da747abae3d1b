/* rain/rain.h - the part of the rain that a scene uses besides its public functions. Internal. */
#ifndef VIRGA_RAIN_RAIN_H
#define VIRGA_RAIN_RAIN_H

#include "gpu/effect.h"

#include <virga/rain.h>

extern const virga_effect_type rain_type;

/* Time since the end of the newest tick (s): the part of a tick that has not run yet. */
double rain_since_tick_s(const virga_rain *rain);

#endif
