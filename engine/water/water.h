/* water/water.h - declares what a scene uses of this effect, in addition to its public functions. Internal. */
#ifndef VIRGA_WATER_WATER_H
#define VIRGA_WATER_WATER_H

#include "gpu/effect.h"

#include <virga/water.h>

extern const virga_effect_type water_type;

#endif
