/* lens/lens.h - declares the type of this effect. Internal. */
#ifndef VIRGA_LENS_EFFECT_H
#define VIRGA_LENS_EFFECT_H

#include "gpu/effect.h"

#include <virga/lens.h>

extern const virga_effect_type lens_type;

#endif
