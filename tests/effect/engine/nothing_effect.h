/* nothing_effect.h - what a scene uses of it, as engine/rain/rain.h does for rain. */
#ifndef VIRGA_TESTS_NOTHING_EFFECT_H
#define VIRGA_TESTS_NOTHING_EFFECT_H

#include "gpu/effect.h"

extern const virga_effect_type nothing_type;

#endif
