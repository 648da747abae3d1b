/* core/light.h - checks the lighting of every effect. Internal. */
#ifndef VIRGA_CORE_LIGHT_H
#define VIRGA_CORE_LIGHT_H

#include "core/log.h"

#include <virga/light.h>

/* Clamps the number of lights; if it changed, sets *changed (never clears it) and logs it. If a number in use is not
 * finite, returns VIRGA_ERROR_INVALID and changes nothing. `owner` is the host's name of the surrounding struct, e.g.
 * "rain": log lines then begin with "rain.lighting.". */
virga_result virga_lighting_check(const virga_log *log, const char *owner, virga_lighting *lighting, bool *changed);

#endif
