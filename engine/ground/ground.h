/* ground/ground.h - the part of the ground that a scene uses besides its public functions. Internal. */
#ifndef VIRGA_GROUND_GROUND_H
#define VIRGA_GROUND_GROUND_H

#include "gpu/effect.h"

#include <virga/ground.h>

extern const virga_effect_type ground_type;

#endif
