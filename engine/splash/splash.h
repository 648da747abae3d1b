/* splash/splash.h - declares what a scene uses of this effect, in addition to its public functions. Internal. */
#ifndef VIRGA_SPLASH_SPLASH_H
#define VIRGA_SPLASH_SPLASH_H

#include "gpu/effect.h"

#include <virga/splash.h>

extern const virga_effect_type splash_type;

#endif
