/* fluid/fluid.h - declares what a scene uses of this effect, in addition to its public functions. Internal. */
#ifndef VIRGA_FLUID_FLUID_H
#define VIRGA_FLUID_FLUID_H

#include "gpu/effect.h"

#include <virga/fluid.h>

extern const virga_effect_type fluid_type;

#endif
