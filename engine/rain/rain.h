/* rain/rain.h - the part of the rain that a scene uses besides its public functions. Internal. */
#ifndef VIRGA_RAIN_RAIN_H
#define VIRGA_RAIN_RAIN_H

#include "gpu/effect.h"

#include <virga/rain.h>

extern const virga_effect_type rain_type;

#endif
