/* core/light.h - the check that every effect's lighting goes through. Internal. */
#ifndef VIRGA_CORE_LIGHT_H
#define VIRGA_CORE_LIGHT_H

#include "core/log.h"

#include <virga/light.h>

/* Clamps the count of lights, which sets *changed (never cleared) and says so. VIRGA_ERROR_INVALID, and nothing is
 * changed, where a number in use is not finite. `owner` is what the host calls the struct that holds it, e.g. "rain":
 * lines in the log begin with "rain.lighting.". */
virga_result virga_lighting_check(const virga_log *log, const char *owner, virga_lighting *lighting, bool *changed);

#endif
