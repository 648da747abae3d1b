/* rain/rain.h - what a scene uses of this effect beside its public functions. Internal. */
#ifndef VIRGA_RAIN_RAIN_H
#define VIRGA_RAIN_RAIN_H

#include "gpu/effect.h"

#include <virga/rain.h>

extern const virga_effect_type rain_type;

#endif
